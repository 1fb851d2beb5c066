#!/bin/sh
# Fields of rotations in scenes: digits, clamped rods, potentials, refusals.
# Usage: test_rotation_fields.sh DVI
. "$(dirname "$0")/check.sh"

cat >ring.yaml <<END
parameters:
  J: [[1.6, 0, 0], [0, 1.4, 0], [0, 0, 1.2]]
  K: [[1.1, 0, 0], [0, 1.0, 0], [0, 0, 0.9]]
domain: {x: [0, 2*pi]}
space: fem:degree=1,cells=16
fields: {R: rotation}
density: dot(omega(R), J*omega(R))/2 - dot(kappa(R,x), K*kappa(R,x))/2
boundary: periodic
initial:
  R: "turn([0,0,1], x)*turn([0.4*sin(x), 0.3*cos(x), 0], norm([0.4*sin(x), 0.3*cos(x), 0]))"
  omega(R): "[0.3*cos(x), 0.2, 0.1*sin(2*x)]"
method: lie-verlet
step: 0.04
until: 2
END
expect 0 'a ring' run ring.yaml --final
says out '^t,energy,momentum_x,momentum_y,momentum_z$' 'energy and momenta are the columns'
about out momentum_x 1.43511553 5e-9
about out momentum_y -.01845935 5e-9
about out momentum_z -.44432863 5e-9
expect 0 'the start' run ring.yaml --t-end 0
about out energy 3.230177861 5e-10
# energy_error STEP VALUE: require the largest error of the energy.
energy_error() {
  expect 0 "the step $1" run ring.yaml --h "$1" --out rows.csv
  awk -F, -v value="$2" 'NR == 2 { first = $2 }
    NR > 1 { d = $2 - first; if (d < 0) d = -d; if (d > most) most = d }
    END { d = most / value - 1; exit d > 0.05 || d < -0.05 }' rows.csv ||
    fail "the energy is off by $2 with the step $1"
}
energy_error 0.04 7.1e-5
energy_error 0.02 1.8e-5
energy_error 0.01 4.5e-6
expect 0 'orders' order ring.yaml --t-end 0.5
says out 'lie-verlet: claimed order 2, fitted 2.00 .*: ok' 'the order'
expect 0 'a check' check ring.yaml
says out '^derivatives: ' 'the derivatives are right'
says out '^rotations at 16 nodes' 'the nodes'
expect 0 'nodes' run ring.yaml --columns R_1_11,R_16_33,omega_R_1_x --final
says out '^t,R_1_11,R_16_33,omega_R_1_x$' 'the names of nodes'

# a rod that is clamped at one end, and heavy
cat >rod.yaml <<END
parameters: {J: [[1, 0, 0], [0, 1, 0], [0, 0, 2]], g: 1}
domain: {x: [0, 1]}
space: fem:degree=1,cells=10
fields: {R: rotation}
density: dot(omega(R), J*omega(R))/2 - dot(kappa(R,x), kappa(R,x))/2 - g*(1 + x)*R[3,3]
boundary: {left: fixed}
initial: {R: "turn([1,0,0], 0.3*x)"}
method: lie-verlet
step: 0.01
until: 1
END
expect 0 'a rod' run rod.yaml --final
says out '^t,energy$' 'there is no momentum'
expect 0 'derivatives of a rod' check rod.yaml
says out '^derivatives: ' 'the derivatives are right'
cat >sheet.yaml <<END
domain: {x: [0, 1], y: [0, 2]}
space: fem:degree=1,cells=4
fields: {R: rotation}
density: dot(omega(R),omega(R))/2 - dot(kappa(R,x),kappa(R,x))/2 - dot(kappa(R,y),kappa(R,y))
boundary: {x: periodic}
initial: {R: "turn([0,0,1], 0.1*y)"}
method: lie-verlet
step: 0.05
until: 1
END
expect 0 'a sheet' run sheet.yaml --final

refused rod.yaml two 's/R: rotation/R: rotation, u: scalar/' 'is the only one of its scene' 4:9
refused rod.yaml rate \
  "s/kappa(R,x), kappa(R,x)/omega(R), d(R[1,1]', x)*kappa(R,x)/" 'no other derivatives' 5:54
refused rod.yaml slope 's/kappa(R,x), kappa(R,x)/d(R[1], x), d(R[1], x)/' \
  'no other derivatives' 5:44
refused rod.yaml curved 's/kappa(R,x))\/2/kappa(R,x))^2/' 'with constant J and K' 5:10
refused rod.yaml mixed 's/J\*omega(R))\/2/R*omega(R))/' 'with constant J and K' 5:10
refused rod.yaml driven 's/(1 + x)/sin(t)/' 'does not depend on time' 5:10
refused rod.yaml start 's/^initial.*/initial: {R: "[[2,0,0],[0,1,0],[0,0,1]]"}/' 'no rotation' 7:10
sed '/^boundary/d' rod.yaml >free.yaml
sed 's/^initial.*/initial: {R: "[[2,0,0],[0,1,0],[0,0,1]]"}/' free.yaml >off.yaml
expect 2 'a start that is off' run off.yaml
says err '^dvi: off.yaml:6:10: the start is no rotation at x = 0: off by 1' 'the reason'
refused rod.yaml key "s/^initial.*/initial: {R': 0}/" "is 'R' and 'omega(R)'" 7:11
refused rod.yaml fine 's/degree=1/degree=2/' 'has equal cells' 3:8
refused rod.yaml turned 's/^boundary.*/boundary: {left: {robin: 1}}/' \
  'are free, or fixed where the start' 6:11
# probes are what the columns of their node have
cat ring.yaml - >probes.yaml <<END
probes: {tilt: {of: "R[3,2] + x + 0*t", at: pi/4}, spin: {of: "omega(R)[1]", at: 0}}
END
expect 0 'probes' run probes.yaml --columns tilt,spin,R_3_32,omega_R_1_x --final
awk -F, 'END { d = $2 - $4 - atan2(1, 1); e = $3 - $5
  exit !(d < 1e-14 && d > -1e-14 && e < 1e-14 && e > -1e-14) }' out || fail 'probes at nodes'
refused rod.yaml seen 's/^step/probes: {a: R}\n&/' 'a probe is a field at a point' 9:13
refused rod.yaml whole 's/^step/probes: {a: R(0.5)}\n&/' 'where a number is needed' 9:13
refused rod.yaml sum 's/^step/probes: {a: {integral: "R[1,1]"}}\n&/' 'no integrals' 9:10
refused rod.yaml between 's/^step/probes: {a: {of: "R[1,1]", at: 0.26}}\n&/' \
  'the nearest one that moves is at x = 0.3' 9:10
refused rod.yaml held 's/^step/probes: {a: {of: "R[1,1]", at: 0}}\n&/' 'is at x = 0.1' 9:10
refused rod.yaml curvature 's/^step/probes: {a: {of: "kappa(R,x)[1]", at: 0.5}}\n&/' \
  'has the entries of R and omega(R)' 9:10
refused rod.yaml word 's/rotation/spinor/' 'scalar, complex, vector(d) or rotation' 4:13
refused rod.yaml bent 's/kappa(R,x), kappa(R,x)/kappa(R), kappa(R)/' 'as in kappa(R,x)' 5:44

finish

# ---- what is not for them ----

expect 2 'a map' run ring.yaml --map map.svg
says err 'not for fields of rotations.*--plot' 'why not'
for command in modes solve; do
  expect 2 "$command" $command ring.yaml
  says err "$command: not for fields of rotations" 'why not'
done
