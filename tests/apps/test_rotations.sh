#!/bin/sh
# The command on problems with rotations and directions: columns, and refusals that help.
# Usage: test_rotations.sh DVI
. "$(dirname "$0")/check.sh"

# Columns: the time, R row by row, Omega and Pi in the body's frame, energy, the other invariants,
# the distance.
expect 0 'columns' run free-body --method lie-verlet --h 0.1 --t-end 1 --out body.csv
columns=t,R11,R12,R13,R21,R22,R23,R31,R32,R33,Omega1,Omega2,Omega3,Pi1,Pi2,Pi3,energy
columns=$columns,angular_momentum_x,angular_momentum_y,angular_momentum_z,distance
[ "$(head -n 1 body.csv)" = $columns ] || fail 'columns of a body'
# Pi = J Omega with J = diag(3,2,1.5); the angular momentum in space is R Pi.
awk -F, 'function off(a, b) { d = a - b; return d > 1e-14 || d < -1e-14 }
  NR > 1 && (off($14, 3 * $11) || off($15, 2 * $12) || off($16, 1.5 * $13) ||
    off($18, $2 * $14 + $3 * $15 + $4 * $16) || $21 > 1e-14)' body.csv |
  grep -q . && fail 'Pi = J Omega, and R Pi is the angular momentum'
expect 0 'momenta of a body' run free-body --method lie-verlet --momenta 3,2,1.5 --t-end 0.1 --out -
awk -F, 'NR == 2 && !($11 == 1 && $12 == 1 && $13 == 1) { exit 1 }' out ||
  fail '--momenta are Pi1, Pi2, Pi3'
expect 0 'columns of directions' run spherical-chain --set n=1 --method sphere-galerkin \
  --t-end 0.1 --final
[ "$(head -n 1 out)" = \
  t,q1_x,q1_y,q1_z,v_q1_x,v_q1_y,v_q1_z,p_q1_x,p_q1_y,p_q1_z,energy,angular_momentum_z,distance ] ||
  fail 'columns of a direction'
expect 1 'a momentum along its direction' run spherical-chain --set n=1 --method lie-verlet \
  --momenta 1,1,1
says err 'not orthogonal' 'what is wrong with it'

# A refusal names the method or the option, and the ones that can be used instead.
expect 2 'a method for R^n' run free-body --method galerkin
says err 'methods for this system: composition, lie-galerkin, lie-verlet, lie-rk, euler-poincare$' \
  'methods for rotations'
expect 2 'a method for directions' run heavy-top --method sphere-galerkin
says err 'sphere-galerkin: the system declares rotations' 'why it is refused'
grep -q 'lie-rk, sphere-galerkin' err && fail 'sphere-galerkin does not suggest itself'
expect 2 'a method for R^n on directions' run spherical-chain --method verlet
says err 'lie-rk, sphere-galerkin$' 'sphere-galerkin is for directions'
expect 0 'a composition on groups' explain free-body --method composition:order=6
says out 'each by lie-verlet' 'its base'
for paced in '--time-transform arclength' '--time-transform distance' \
  '--step-control acceleration' '--step-control distance'; do
  # shellcheck disable=SC2086
  expect 2 "$paced" run two-body --method lie-galerkin $paced
  says err 'take steps of equal length' "$paced: the remedy"
done
expect 2 'a path' path free-body --method midpoint --ends initial --steps 4
says err 'dvi run goes forward' 'path: the remedy'
expect 2 'project' run spherical-chain --method lie-verlet --project
says err 'spherical-chain has none' 'what --project is for'

# Inertias: each in its range, together those of a body.
expect 2 'no body' run free-body --method lie-verlet --set J1=3.6
triangle='no principal moment may be larger than the sum of the others'
says err "free-body with these parameters: .*$triangle" 'the triangle inequality'
expect 0 'a rod' run free-body --method lie-verlet --set J1=3.5 --final
for bad in J1=0 J1=-1 J1=nan J1=1e99 Omega1=1e99; do
  expect 2 "$bad" run free-body --method lie-verlet --set "$bad"
done
expect 2 'an unknown parameter' run free-body --method lie-verlet --set q=1
grep -q 'did you mean' err && fail 'no word of one letter is near another one'
expect 2 'a direction without length' run spherical-double-pendulum --method lie-verlet --set l=0

# Steps that are too large.
for method in lie-galerkin lie-verlet euler-poincare composition:base=lie-verlet \
  lie-rk:scheme=implicit-midpoint; do
  for h in 5 1e10; do
    expect 1 "$method, h = $h" run free-body --method $method --h $h --t-end 1e11 --final
    says err 'try a smaller step' "$method, h = $h: the remedy"
  done
  for h in 0 nan; do expect 2 "$method, h = $h" run free-body --method $method --h $h; done
  expect 0 "$method, backward" run free-body --method $method --h -0.1 --t-end -1 --final
done
for problem in spherical-double-pendulum satellite two-body; do
  expect 1 "lie-rk on $problem" run $problem --method lie-rk --h 1e10 --t-end 5e10 --final
  says err 'a state inside the step is not finite' "lie-rk on $problem: the reason"
done
expect 1 'a row that has no numbers' run free-body --method lie-rk --h 50 --t-end 100
says err 'no row at t = .*try a smaller --h' 'which row, and the remedy'

expect 0 'the list' list problems
says out '^spherical-double-pendulum  *two masses' 'a long name is followed by a blank'
expect 2 'a method twice' order free-body --method lie-verlet --method lie-verlet
says err 'names lie-verlet twice' 'which one'
finish
