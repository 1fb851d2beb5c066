#!/bin/sh
# Marches of fields with densities in the commands: multisymplectic steps.
# Usage: test_density_marches.sh DVI
. "$(dirname "$0")/check.sh"

cat >sine.yaml <<END
domain: {x: [0, 2*pi]}
space: fem:degree=1,cells=21
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))
boundary: periodic
initial: {u: 1.5 + 0.5*cos(x), u': 0.3*sin(x)}
probes: {ear: u(1.5), mean: {integral: u/(2*pi)}, rate: {of: "u'", at: 1}}
method: multisymplectic:space=exact,time=midpoint
step: 0.1
until: 4
END

expect 0 'a run' run sine.yaml --final
says out '^t,energy,momentum_x,ear,mean,rate$' 'what is conserved, and the probes'
# the values of galerkin:degree=3 on the same space, beside which the steps err by O(h^2)
about out ear -1.81177 1e-3
about out mean -1.47340 1e-3
about out rate 0.53561 5e-3
expect 0 'a check' check sine.yaml
says out 'multisymplectic [0-9.]*e-1[5-9], linearised' 'the form formula holds'
expect 0 'orders' order sine.yaml --t-end 1
says out 'claimed order 2, fitted 2.00 .*: ok' 'the order'
expect 2 'another mass' order sine.yaml --method multisymplectic
says err 'take space=exact with fem:degree=1' 'which weight has the mass of the space'
sed "s/^initial.*/initial: {u: 1.5 + 0.5*cos(x - t)}/" sine.yaml >motion.yaml
expect 2 'a start that moves' order motion.yaml
says err 'and a start without t' 'whose first step is not that of the space'
expect 0 'an explanation' explain sine.yaml
says out 'with steps of 0.1' 'the steps'
expect 1 'a long step' run sine.yaml --method multisymplectic --h 5
says err 'beyond the bound 0.299' 'the bound'

refused sine.yaml cfl 's/^step.*/step: 5/;s/:space=exact.*//' 'beyond the bound' 9:7
refused sine.yaml even 's/cells=21/cells=20/;s/exact/midpoint/' 'take an odd number of cells' 2:8
refused sine.yaml quadratic 's/degree=1/degree=2/' 'on the cells of linear functions' 2:8
refused sine.yaml bent "s/fem:degree=1/spline:degree=3/;s/d(u,x)^2/d(u,x,x)^2/" \
  'linear functions' 2:8
refused sine.yaml first "s/scalar/complex/;s/u'^2.*/u[1]'*u[2] - dot(d(u,x),d(u,x))\/2/;/^initial/d
  /^probes/d" 'one-form' 4:10
refused sine.yaml word 's/exact/half/' '"space=half" is no option' 8:9
refused sine.yaml axes 's/exact/exact:0/' 'weights of 2 axes, and the field has 1' 8:9
refused sine.yaml mesh \
  's/^domain.*/mesh: {generator: disk, cells: 4}/;s/,cells=21//;/boundary/d;/probes/d' \
  'a mesh has none' 1:7

cat >lattice.yaml <<END
domain: {x: [0, 2*pi], y: [0, 2*pi]}
space: fem:degree=1,cells=12
fields: {psi: complex}
density: (dot(psi',psi') - dot(d(psi,x),d(psi,x)) - dot(d(psi,y),d(psi,y)))/2 - dot(psi,psi)^2/4
boundary: periodic
initial: {psi: "[1 + 0.5*cos(x)*cos(y), 0]", psi': "[0, 1]"}
method: multisymplectic:space=1/6
step: {fraction: 0.5}
until: 2
report: {columns: [charge_psi, momentum_y]}
END
expect 0 'a run in a plane' run lattice.yaml --final
# the integral of re(psi) im(psi'), 4 pi^2 at the start
about out charge_psi 39.478417604357 1e-11
expect 0 'laws of a symmetry' check lattice.yaml
says out 'noether [0-9.]*e-1[5-9]' "Noether's theorem"

# shifts of a wave are a symmetry where no end is fixed, and the box scheme has local laws
sed 's/ - (1 - cos(u))//' sine.yaml >wave.yaml
expect 0 'a wave' run wave.yaml --columns momentum_u --final
about out momentum_u 0 1e-13
sed "s/u': 0.3/u': 0.25 + 0.3/" wave.yaml >drift.yaml
expect 0 'a drift' run drift.yaml --columns momentum_u --final
about out momentum_u 1.5707963267949 1e-12
expect 0 'laws of the box scheme' check wave.yaml --method multisymplectic:space=1/4,time=1/4
says out 'energy [0-9.]*e-1[3-9], momentum [0-9.]*e-1[3-9]$' 'energy and momentum in each place'
sed 's/boundary: periodic/boundary: fixed/' wave.yaml >fixed.yaml
expect 2 'no shift' run fixed.yaml --columns momentum_u

finish

# A potential that depends on time has no energy to watch, but steps beyond the bound show.
cat >parametric.yaml <<END
domain: {x: [0, 1]}
space: fem:degree=2,cells=4
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - 1000*u^2*(1 + 0.1*cos(t))
boundary: fixed
initial: {u: sin(pi*x)}
method: verlet
step: 0.05
until: 1
END
expect 0 'an unstable step' run parametric.yaml --final
says err 'verlet is unstable with h = 0.05 at t = 0' 'the start'
says err 'as those of an unstable step do' 'the growth'
expect 0 'a stable step' run parametric.yaml --final --h 0.01
test ! -s err || fail 'a stable step is silent'
