#!/bin/sh
# Fields on meshes that move in the commands: run, solve, check, refusals.
# Usage: test_moving.sh DVI
. "$(dirname "$0")/check.sh"

# steady FILE COLUMN TOLERANCE: require that a column changes by no more.
steady() {
  awk -F, -v name="$2" -v tolerance="$3" '
    NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i; next }
    NR == 2 { first = $column }
    { d = $column - first; if (d > tolerance || d < -tolerance) bad = 1 }
    END { exit !column || bad }' "$1" || { fail "$2 changes"; cat "$1"; }
}

cat >ring.yaml <<END
# a sine-Gordon kink of speed 0.9, once around a ring of 64 cells that travel with it
parameters: {c: 0.9, g: "1/sqrt(1 - c^2)"}
domain: {x: [-10, 10]}
space: fem:degree=1,cells=64
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))
boundary: periodic
initial: {u: 4*atan(exp(g*x)), u': -c*2*g/cosh(g*x)}
moving: {mu: 0.01, kappa: 0.05, monitor: "sqrt(1 + (2*g/cosh(g*x))^2)", velocity: c, jump: 2*pi}
probes: {middle: u(0), mean: {integral: u}, slope: {of: "d(u,x)", at: 8}}
method: midpoint
step: 0.05
until: 20
report: {every: 40}
END
expect 0 'a kink' run ring.yaml
says out '^t,energy,momentum_x,middle,mean,slope$' 'what is watched'
steady out energy 1e-6
steady out momentum_x 1e-12
expect 0 'nodes' run ring.yaml --columns x_1,u_64 --t-end 1 --final
says out '^t,x_1,u_64$' 'the names of positions and values'
expect 0 'a check' check ring.yaml
says out '^derivatives: ' 'the derivatives are right'

# Maps have places that rest, past which the nodes run.
expect 0 'a map' run ring.yaml --final --map ring.svg
says err 'draws u over x and t' 'what it draws'
expect 0 'a map of slopes' run ring.yaml --t-end 1 --final --map slope.svg --map-of 'd(u,x)'
says err 'draws d(u,x) over x and t' 'what it draws'
expect 2 'a second derivative' run ring.yaml --map x.svg --map-of 'd(u,x,x)'
says err 'first derivatives alone' 'why not'
expect 2 'frames of nodes that move' run ring.yaml --pvd x.pvd
says err 'the nodes of ring move' 'why not'

cat >steep.yaml <<END
# Burgers' equation inside of a wave that steepens
parameters: {A: 0.3}
domain: {x: [0, 2*pi]}
space: fem:degree=1,cells=32
fields: {u: scalar}
density: u'^2/2 - (1 + d(u,x))^4/12
boundary: periodic
initial: {u: -A*cos(x), u': "-(A*sin(x) + (A*sin(x))^2/2)"}
moving: {mu: 0.02, kappa: 0.02}
method: midpoint
step: 0.8/A/128
until: 0.8/A
report: {every: 16}
END
expect 0 'a wave that steepens' run steep.yaml
says out '^t,energy,momentum_x,momentum_u$' 'both momenta'
steady out momentum_x 1e-14
steady out momentum_u 1e-14
# half of the last difference from the exact values at nodes, 1.76e-3 (docs/fields/moving.md)
expect 0 'a node' run steep.yaml --columns u_1 --final
about out u_1 0.2074 2e-3

cat >kink.yaml <<END
domain: {x: [-10, 10]}
space: fem:degree=1,cells=8
fields: {u: scalar}
density: -d(u,x)^2/2 - (1 - cos(u))
boundary: {left: {fixed: 4*atan(exp(x))}, right: {fixed: 4*atan(exp(x))}}
initial: {u: 4*atan(exp(x))}
moving: {kappa: 1e-7}
probes: {height: {integral: 1 - cos(u)}}
END
expect 0 'a static kink' solve kink.yaml --csv nodes.csv
says out '^energy  *8.07638' 'its energy'
says out '^height ' 'its probes'
says nodes.csv '^x,u$' 'its nodes'
about nodes.csv x 10 0
sed 's/cells=8/cells=32/' kink.yaml >fine.yaml
expect 0 'a finer mesh' solve fine.yaml
says out '^energy  *8.00538' 'its energy'
expect 2 'modes' modes kink.yaml
says err 'the mesh of kink moves' 'why there are none'

# a path of the nodes, on which fields u = b t + c x stay as they are
cat >path.yaml <<END
domain: {x: [0, 1]}
space: fem:degree=1,cells=6
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2
initial: {u: 0.5*x, u': 0.3}
moving: {motion: x + 0.1*sin(2*t)*sin(pi*x), path_step: 0.1}
probes: {a: u(0.5)}
method: midpoint
step: 0.1
until: 1
END
sed 's/^initial/boundary: {left: {fixed: 0}}\n&/;s/0.3/0/' path.yaml >held.yaml
expect 0 'a path' run path.yaml --final
expect 0 'a path beside a fixed end' run held.yaml --final
expect 2 'a tangled path' run path.yaml --set no=1
sed 's/^moving.*/moving: {motion: equal, stretch: 0.5, mu: 0.01}/;s/0.5\*x/0.5*sin(x)/' path.yaml \
  >arcs.yaml
expect 0 'arcs of one length' run arcs.yaml --final

# a density that depends on the position, which nodes feel
sed 's/1 - cos(u)/(1 + 0.2*sin(0.3*x))*(1 - cos(u)) + 0.1*x*d(u,x)^2/' ring.yaml >placed.yaml
expect 0 'derivatives by the position' check placed.yaml
says out 'derivatives: within\|derivatives: as right' 'the derivatives are right'
says out 'a mesh of 64 cells whose nodes are unknowns: mu = 0.01, kappa = 0.05' 'the mesh'

refused ring.yaml curved 's/degree=1/degree=2/' 'cells that move are linear' 4:8
refused ring.yaml curved 's/degree=1/degree=12/' 'cells that move are linear' 4:8
refused ring.yaml rapid 's/fem:degree=1/msfem:fine=4/' 'cells that move are linear' 4:8
refused ring.yaml plane 's/^domain.*/domain: {x: [0, 1], y: [0, 1]}/' 'on a domain of one axis' 9:9
refused ring.yaml word 's/^moving.*/moving: slowly/' "is yes, no, or tells how" 9:9
refused ring.yaml key 's/kappa/kapa/' "kappa" 9:20
refused ring.yaml negative 's/mu: 0.01/mu: -1/' 'mu is 0 or more' 9:14
refused ring.yaml massless 's/mu: 0.01, /mu: 0, /;s/4.atan.*}/0}/' 'give mu > 0' 9:9
refused ring.yaml leap "s/periodic/{left: {fixed: 0}}/" \
  'a jump is what a field on a periodic axis' 9:92
refused ring.yaml rate "s/d(u,x)\", at/u'\", at/" "'slope' has others" 10:45
refused ring.yaml flux 's/^boundary.*/boundary: {left: {free: 1}}/;s/, jump.*}/}/' \
  'no flux and no robin' 7:11
expect 2 'frames' run ring.yaml --pvd ring.pvd

finish
