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

# What a run would not look at is refused.
{ cat ring.yaml; echo 'final: {u: 1}'; } >final.yaml
expect 2 'an end' run final.yaml
says err "'final' is not for meshes that move" 'no paths'
expect 2 'a lattice' run ring.yaml --method multisymplectic
says err 'no mesh that moves' 'multisymplectic steps'

# Maps have places that rest, past which the nodes run.
expect 0 'a map' run ring.yaml --final --map ring.svg
says err 'draws u over x and t' 'what it draws'
expect 0 'a map of slopes' run ring.yaml --t-end 1 --final --map slope.svg --map-of 'd(u,x)'
says err 'draws d(u,x) over x and t' 'what it draws'
expect 2 'a second derivative' run ring.yaml --map x.svg --map-of 'd(u,x,x)'
says err 'first derivatives alone' 'why not'
expect 0 'frames of nodes that move' run ring.yaml --t-end 0.2 --every 2 --pvd x.pvd
says x.pvd 'x_000002.vtu' 'a file for each row'
says x_000000.vtu 'NumberOfPoints="65" NumberOfCells="64"' 'nodes and cells'

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
# on a ring with a jump a field 0.7 t + 1.3 x stays to rounding, in a plane with two points a step
cat >affine.yaml <<END
domain: {x: [0, 1]}
space: fem:degree=1,cells=8
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - d(u,x)^4/12
boundary: periodic
initial: {u: 1.3*x, u': 0.7}
moving: {motion: x + 0.1*sin(2*t)*sin(2*pi*x), path_step: 0.05, jump: 1.3}
probes: {a: u(0.5), b: {integral: "(d(u,x) - 1.3)^2 + (u' - 0.7)^2"}}
method: midpoint
step: 0.05
until: 1
END
expect 0 'an affine field' run affine.yaml --final
about out a 1.35 5e-15
about out b 0 1e-26
sed "s/x: .0, 1./&, y: [0, 1]/;s/cells=8/cells=3/;s/d(u,x)^2.2/dot(grad(u),grad(u))\/2/
  s/motion: \(.*\), path.*/motion: [\1, y - 0.05*sin(3*t)], jump: {x: 1.3}, path_step: 0.05}/
  s/u(0.5)/'u(0.5, 0.5)'/;s/'u(\(.*\))'/\"u(\1)\"/" affine.yaml >sheet.yaml
expect 0 'an affine field of a plane' run sheet.yaml --final --method galerkin:degree=1,nodes=2
about out a 1.35 5e-15

# the order in time of nodes that are unknowns
expect 0 'an order' order steep.yaml --set A=0.3 --t-end 0.5 --h 0.1 --levels 4
says out 'midpoint: claimed order 2, fitted .*: ok' 'the order'

sed 's/^moving.*/moving: {motion: equal, stretch: 0.5, mu: 0.01}/;s/0.5\*x/0.5*sin(x)/' path.yaml \
  >arcs.yaml
expect 0 'arcs of one length' run arcs.yaml --final

# nodes that collide: the step does not end beyond that
sed 's/^initial.*/initial: {u: 0.1*sin(x)}/
  s/^moving.*/moving: {mu: 100, velocity: -sin(x)}/' steep.yaml >collide.yaml
expect 1 'a step that tangles its mesh' run collide.yaml --h 1.2 --t-end 6
says err 'step 1 from t = 0 with h = 1.2 failed.* the mesh is tangled, cell .* of 32' 'where'

# the same wave across a torus, on triangles: exact momenta of both axes, a jump and conditions
cat >plane.yaml <<END
parameters: {A: 0.3, T: 0.8/A, there: (pi/2 + (1 + A)*T)/sqrt(2)}
definitions: {s: (x + y)/sqrt(2), w: (0.9 + A*sin(s))/sqrt(2)}
domain: {x: [0, 2*pi*sqrt(2)], y: [0, 2*pi*sqrt(2)]}
space: fem:degree=1,cells=5
fields: {u: scalar}
density: u'^2/2 - (1 + (d(u,x) + d(u,y))/sqrt(2))^4/12 - (d(u,x) - d(u,y))^2/4
boundary: periodic
initial: {u: -A*cos(s), u': -(A*sin(s) + (A*sin(s))^2/2)}
moving: {mu: 0.02, kappa: 1, velocity: [w, w]}
probes:
  crest: u(there, there)
  rate: {of: "u' + d(u,x)*u", at: [0.3, 8]}
  mean: {integral: "u'"}
method: midpoint
step: T/8
until: T
END
for method in midpoint galerkin:degree=1; do
  expect 0 'triangles that move' run plane.yaml --every 4 --method $method
  says out '^t,energy,momentum_x,momentum_y,momentum_u,crest,rate,mean$' 'all momenta'
  steady out momentum_x 2e-13
  steady out momentum_y 2e-13
  steady out momentum_u 2e-14
  steady out mean 2e-14 # without u in the density, the mean rate is momentum_u
done
expect 0 'what is kept' explain plane.yaml
says out '^a mesh of 50 triangles whose nodes are unknowns: mu = 0.02, kappa = 1, 6 p' 'the mesh'
says out '^momentum_x, momentum_y, momentum_u: kept to roundoff' 'the momenta'
! grep caution out || fail 'a caution without a reason'
sed 's/w: (0.9/w: (1/' plane.yaml >fast.yaml
expect 0 'nodes as fast as waves' explain fast.yaml
says out '^caution: as fast as waves or faster are 25 of the nodes, such as' 'a caution'
sed '/^until/d;s/^moving.*/moving: {motion: x - 0.9*t}/' steep.yaml >outrun.yaml
expect 0 'a path that is faster than some waves' explain outrun.yaml
says out '^caution: as fast as waves or faster are' 'a caution'
sed 's/0.9\*t/0.6*t/' outrun.yaml >slow.yaml
expect 0 'a path that is slower than waves' explain slow.yaml
! grep caution out || fail 'a caution without a reason'
expect 0 'derivatives in a plane' check plane.yaml
expect 0 'nodes of a plane' run plane.yaml --t-end 0.5 --columns x_1,y_25,u_2 --pvd plane.pvd
says plane_000000.vtu 'NumberOfCells="50"' 'triangles'
expect 2 'a map of a plane' run plane.yaml --map x.svg
says err 'is in a plane' 'why not'

# a rate at a place: a wave that travels along y with its nodes, u_t + u_y = 0 but for cells
sed "s/^initial.*/initial: {u: x + 2*y, u': -1}/
  s/^moving.*/moving: {motion: [x + 0.3*t, y], jump: {x: 2*pi*sqrt(2), y: 4*pi*sqrt(2)}}/
  s/of: .*, at/of: \"u'\", at/" plane.yaml >tilt.yaml
expect 0 'a rate beside a jump' run tilt.yaml --t-end 0.5 --final
about out rate -1 1e-12
about out mean "$(awk 'BEGIN { p = atan2(0, -1); printf "%.15g", -8 * p * p }')" 1e-10

# ends of a plane: fixed values at rest, nodes that slide, and a density that nodes feel
sed 's/^boundary.*/boundary: {bottom: {fixed: -A*cos(s)}, left: {fixed: -A*cos(s)}}/
  s/velocity: .*}/slide: yes}/
  s/- (d(u,x) - /- (1 + 0.1*x*sin(y))*(d(u,x) - /' plane.yaml >held.yaml
expect 0 'a plane with ends' run held.yaml --t-end 0.5 --final --columns x_1,y_20,u_25
expect 0 'derivatives by both positions' check held.yaml
says out 'derivatives: within\|derivatives: as right' 'the derivatives are right'
sed '/^domain\|^space\|^boundary/d
  s/^fields/mesh: {generator: kuhn-torus, cells: [4, 4], size: [8.885766, 8.885766]}\n&/
  s/, velocity.*/}/' plane.yaml >torus.yaml
expect 0 'a mesh of its own' run torus.yaml --t-end 0.5 --final
sed "/^method\|^step\|^until/d;s/^density.*/density: -(dot(grad(u),grad(u)) + u^2)\/2/
  s/^boundary.*/boundary: {boundary: {fixed: 1}}/;s/^initial.*/initial: {u: 1}/
  s/^moving.*/moving: {kappa: 1e-3, slide: yes}/;s/, .rate.*//;/rate\|mean/d" plane.yaml >layer.yaml
expect 0 'a static plane' solve layer.yaml --csv layer.csv --vtu layer.vtu
says layer.csv '^x,y,u$' 'its nodes'
says layer.vtu 'NumberOfPoints="36" NumberOfCells="50"' 'its mesh'

refused plane.yaml uneven 's/^domain: {x: \[0, /&1, /' 'equal cells of each axis' 3:10
refused plane.yaml few 's/cells=5/cells=2/' 'need 3 at least' 4:8
refused plane.yaml flat 's/velocity.*}/jump: 1}/' "a jump is one along an axis, as in '{x: 1}'" 9:36
refused plane.yaml one 's/velocity.*}/velocity: 1}/' 'where a vector of 2 is needed' 9:40
refused plane.yaml graded 's/velocity.*}/monitor: 1}/' 'a monitor, which fields of one' 9:9
refused plane.yaml flow 's/^boundary.*/boundary: {left: {free: 1}}/' 'flux, a rate or robin' 7:11
refused plane.yaml outside \
  's/^boundary.*/boundary: {boundary: {fixed: -A*cos(s)}}/;s/there, there/1, 9/;s/velocity.*/}/' \
  "the probe 'crest': moving: the point (1, 9) is outside of the mesh" 11:3
refused plane.yaml slow 's/velocity.*}/slide: 3}/' 'slide is yes or no' 9:37

# ends that are moved, straight over each step: the error at nodes is 4.28e-5, which is 6.09e-4 if
# they are not straight
cat >moved.yaml <<END
domain: {x: [0, 1]}
space: fem:degree=1,cells=20
fields: {u: scalar}
density: (u'^2 - d(u,x)^2)/2
boundary: {x: {fixed: sin(t - x), straight: 0.05}}
initial: {u: -sin(x), u': cos(x)}
method: midpoint
step: 0.05
until: 2
END
expect 0 'ends that move straight' run moved.yaml --final --columns "$(seq -s , -f 'u_%g' 1 19)"
tail -n 1 out | awk -F, '{ for (i = 1; i < 20; i++) { d = $(i + 1) - sin(2 - i / 20)
  if (d < 0) d = -d; if (d > most) most = d } exit !(most > 4.27e-5 && most < 4.285e-5) }' ||
  fail 'the error at nodes is not 4.28e-5'
refused moved.yaml bent 's/fixed: /free: /' 'straight is the time above 0' 5:44
refused moved.yaml flat 's/: 0.05}/: 0}/' 'straight is the time above 0' 5:45

# a density that depends on the position, which nodes feel
sed 's/1 - cos(u)/(1 + 0.2*sin(0.3*x))*(1 - cos(u)) + 0.1*x*d(u,x)^2/' ring.yaml >placed.yaml
expect 0 'derivatives by the position' check placed.yaml
says out 'derivatives: within\|derivatives: as right' 'the derivatives are right'
says out 'a mesh of 64 cells whose nodes are unknowns: mu = 0.01, kappa = 0.05' 'the mesh'

refused ring.yaml curved 's/degree=1/degree=2/' 'cells that move are linear' 4:8
refused ring.yaml curved 's/degree=1/degree=12/' 'cells that move are linear' 4:8
refused ring.yaml rapid 's/fem:degree=1/msfem:fine=4/' 'cells that move are linear' 4:8
refused ring.yaml space 's/^domain.*/domain: {x: [0, 1], y: [0, 1], z: [0, 1]}/' \
  'on a domain of one or two axes' 9:9
refused ring.yaml word 's/^moving.*/moving: slowly/' "is yes, no, or tells how" 9:9
refused ring.yaml key 's/kappa/kapa/' "kappa" 9:20
refused ring.yaml negative 's/mu: 0.01/mu: -1/' 'mu is 0 or more' 9:14
refused ring.yaml massless 's/mu: 0.01, /mu: 0, /;s/4.atan.*}/0}/' 'give mu > 0' 9:9
refused ring.yaml leap "s/periodic/{left: {fixed: 0}}/" \
  'a jump is what a field on a periodic axis' 9:92
refused ring.yaml second 's/d(u,x)", at/d(u,x,x)", at/' "'slope' has others" 10:45
refused ring.yaml flux 's/^boundary.*/boundary: {left: {free: 1}}/;s/, jump.*}/}/' \
  'no flux and no robin' 7:11

finish
