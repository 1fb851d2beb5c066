#!/bin/sh
# Scenes with joints and forces on bodies: each part of them shows in a run, and multipliers are
# columns that can be asked for.
# Usage: test_scene_joints.sh DVI
. "$(dirname "$0")/../check.sh"

cat >arm.yaml <<'END'
coordinates: {upper: motion, lower: motion}
kinetic: >-
  dot(upper.x', upper.x')/2 + dot(lower.x', lower.x')/2
  + 0.1*dot(omega(upper), omega(upper)) + 0.1*dot(omega(lower), omega(lower))
potentials: {weight: "9.81*(upper.x[3] + lower.x[3])"}
forces:
  omega(lower): -0.05*omega(lower)
joints:
  shoulder: {hinge: [ground, upper], at: [0, 0, 0], axis: [0, 1, 0]}
  elbow: {ball: [upper, lower], at: [1, 0, 0]}
initial:
  upper.R: turn([0, 1, 0], 0)
  upper.x: [0.5, 0, 0]
  lower.R: turn([0, 1, 0], 0)
  lower.x: [1.5, 0, 0]
method: lie-galerkin:degree=2
step: 0.05
until: 0.5
END
expect 0 'an arm' run arm.yaml
cp out base
for change in 's/-0.05/-0.06/' 's/omega(lower): -/lower.x: -/;s/\*omega(lower)$/*lower.x'"'"'/' \
  's/at: \[1, 0, 0\]/at: [1, 0, 0.1]/' 's/axis: \[0, 1, 0\]/axis: [0, 0, 1]/' 's/hinge/slider/'; do
  sed "$change" arm.yaml >other.yaml
  cmp -s arm.yaml other.yaml && fail "'$change' changes nothing"
  expect 0 "$change" run other.yaml
  cmp -s out base && fail "the change '$change' does not show"
done

# At rest a chain that hangs straight down pulls by its weight.
sed '/^forces/,+1d;s/at: \[1, 0, 0\]/at: [0, 0, -1]/;s/upper.x: .*/upper.x: [0, 0, -0.5]/
s/lower.x: .*/lower.x: [0, 0, -1.5]/' arm.yaml >hang.yaml
expect 0 'multipliers' run hang.yaml --columns lambda_shoulder_3,lambda_elbow_3 --t-end 0.05
tail -1 out | awk -F, '{ exit !($2^2 - 19.62^2 < 1e-6 && $3^2 - 9.81^2 < 1e-6 && $3^2 > 96) }' ||
  fail "the weight is not in the multipliers: $(tail -1 out)"
says base '^t,[^l]*' 'the header'
grep -q lambda base && fail 'multipliers stand in a row unasked'
{ cat arm.yaml; echo 'report: {columns: [lambda_elbow_1, energy_balance]}'; } >report.yaml
expect 0 'columns of a report' run report.yaml
says out '^t,lambda_elbow_1,energy_balance$' 'columns of a report'
sed 's/elbow_1/elbow_4/' report.yaml >odd.yaml
expect 2 'a row that is not there' run odd.yaml
says err "has no column 'lambda_elbow_4'" 'a row that is not there'

# Nonholonomic rows have theirs, behind those of holonomic constraints. In a circle the ground holds
# a disk by m R spin turn.
expect 0 'multipliers of rows' run rolling-disk --method nonholonomic --t-end 0.05 \
  --columns lambda_rolling_1,lambda_rolling_2
sed -n 2p out | awk -F, '{ exit !($2^2 < 1e-12 && ($3 + 1.05)^2 < 1e-12) }' ||
  fail "the force of the ground is not in the multipliers: $(sed -n 2p out)"
cat >mixed.yaml <<'END'
coordinates: {x: scalar, y: scalar, z: scalar, c: scalar, s: scalar, th: scalar}
lagrangian: (x'^2 + y'^2 + z'^2 + c'^2 + s'^2 + th'^2)/2 - z
constraints: {table: z, circle: (c^2 + s^2 - 1)/2}
nonholonomic: {rolls: x' - c*th', slips: y' - s*th'}
initial: {x: 0, y: 0, z: 0, c: 1, s: 0, th: 0, x': 1, s': 1, th': 1}
method: nonholonomic
step: 0.05
until: 0.5
report: {columns: [lambda_table, lambda_circle, lambda_rolls, lambda_slips]}
END
expect 0 'multipliers of both' run mixed.yaml
tail -1 out | awk -F, '{ exit !(NF == 5 && ($2 + 1)^2 < 1e-9) }' ||
  fail "the weight is not in the multipliers: $(tail -1 out)"

for method in verlet lie-verlet euler-poincare galerkin; do
  expect 2 "$method takes no joints" run arm.yaml --method $method
done

# ---- a loop of hinges with parallel axes has rows to spare: it moves as with two balls ----

cat >loop.yaml <<'END'
coordinates: {A: motion, B: motion, C: motion}
lagrangian: >-
  (dot(A.x', A.x') + dot(B.x', B.x') + dot(C.x', C.x')
  + 0.1*(dot(omega(A), omega(A)) + dot(omega(B), omega(B)) + dot(omega(C), omega(C))))/2
  - 9.81*(A.x[3] + B.x[3] + C.x[3])
joints:
  a: {hinge: [ground, A], at: [0, 0, 0], axis: [0, 1, 0]}
  b: {hinge: [A, B], at: [0.6, 0, -0.8], axis: [0, 1, 0]}
  c: {hinge: [B, C], at: [2.1, 0, -0.8], axis: [0, 1, 0]}
  d: {hinge: [C, ground], at: [1.5, 0, 0], axis: [0, 1, 0]}
initial:
  A.R: turn([0, 1, 0], 0)
  A.x: [0.3, 0, -0.4]
  B.R: turn([0, 1, 0], 0)
  B.x: [1.35, 0, -0.8]
  C.R: turn([0, 1, 0], 0)
  C.x: [1.8, 0, -0.4]
method: lie-galerkin:degree=3
step: 0.02
until: 1
END
sed 's/\([bc]\): {hinge: \(.*\), axis.*/\1: {ball: \2}/' loop.yaml >balls.yaml
expect 0 'a loop of hinges' run loop.yaml --final --columns A_x_x,B_x_z
mv out hinges
expect 0 'a loop with balls' run balls.yaml --final --columns A_x_x,B_x_z
paste -d, hinges out | tail -1 |
  awk -F, '{ exit !(($2 - $5)^2 < 1e-24 && ($3 - $6)^2 < 1e-24) }' ||
  fail "hinges and balls move apart: $(paste hinges out | tail -1)"
expect 0 'a loop is explained' explain loop.yaml
grep -q "constraints: 20 rows of rank 17; 'b', 'c', 'd': redundant" out ||
  fail "explain does not name the joints: $(grep constraints: out)"
expect 2 'lie-verlet takes independent rows' run loop.yaml --method lie-verlet
grep -q 'lie-verlet takes independent constraints' err || fail "$(cat err)"
finish
