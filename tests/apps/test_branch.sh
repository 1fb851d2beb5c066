#!/bin/sh
# No run goes on along another branch of solutions than the one connected to h = 0. Searches with
# random problems and steps found these cases; they followed each step from h = 0 in long double.
# Usage: test_branch.sh DVI
. "$(dirname "$0")/check.sh"

# near VALUE TOLERANCE NAME: require that the last number of the output is near VALUE.
near() {
  tail -n 1 out |
    awk -F, -v wanted="$1" -v most="$2" '{ d = $NF - wanted; exit !(d <= most && -d <= most) }' ||
    fail "$3: $(tail -n 1 out), not $1"
}

# right ENERGY TOLERANCE ARGUMENTS...: require a right energy, or a refusal with a sentence.
right() {
  energy=$1 most=$2
  shift 2
  code=0
  "$dvi" run "$@" --final --columns energy >out 2>err || code=$?
  case $code in
    0) near "$energy" "$most" "$*" ;;
    1) says err \
      'a step too large: the solution that continues those of shorter steps ends at h = ' "$*" ;;
    *) fail "$*: exit code $code" ;;
  esac
}

expect 0 'degree 12' run double-pendulum --method galerkin:degree=12 --h 0.078 --t-end 26.52 \
  --final --columns energy
near -40.2181791758673 1e-9 'degree 12'

# The motion is chaotic, so that last digits of a machine decide the end and its energy error. Over
# 32 runs whose g differs in the 12th digit, the largest errors are 0.038, of sem 0.65.
for h in $(some 0.063 0.078 0.0934 0.11 0.127 0.14 0.155 0.17 0.183 0.199); do
  for method in galerkin:degree=8 hamiltonian:degree=8; do
    right -40.2181791758673 0.1 double-pendulum --method $method --h $h --t-end 40
  done
  right -40.2181791758673 1.5 double-pendulum --method sem:degree=4,hmax=0.2 --h $h --t-end 40
done
for h in $(some 0.1 0.12 0.14 0.16 0.18 0.2); do
  for solver in kinsol certified; do
    right -40.2181791758673 0.02 double-pendulum --method galerkin:degree=8,solver=$solver --h $h \
      --t-end 30
  done
done
right -0.5 0.15 kepler --method galerkin:degree=2 --h 0.64 --t-end 60
right 0.5 10 stiff-pendulum --method galerkin:degree=12 --h 0.064 --t-end 60

# one NAME STEP COORDINATES LAGRANGIAN INITIAL [METHOD]: write a scene of one step.
one() {
  cat >"$1.yaml" <<END
coordinates: {$3}
lagrangian: $4
initial: {$5}
method: ${6:-midpoint}
step: $2
until: $2
END
}

# A light pendulum on a heavy cart.
cart="27009.9*x'^2 - 915.89*x^2"
pendulum="0.7277*((x' + 0.402608*cos(y)*y')^2 + (0.402608*sin(y)*y')^2) + 2.99126*cos(y)"
one cart 0.450971 'x: scalar, y: scalar' "$cart + $pendulum" \
  "x: -2.46809, x': 2.04087, y: -1.85655, y': -0.244602"
expect 0 'a light part' run cart.yaml --t-end 4.058739 --final --columns y
near 1.7666411073 1e-7 'a light part'

# The attitude of a satellite whose place is in metres.
one satellite 23.1363 'x: scalar, y: scalar, z: scalar' \
  "699.7*(x'^2 + y'^2) + 5.57801e17/sqrt(x^2 + y^2) + 30.68225*z'^2 + 0.501412*cos(z)" \
  "x: 7154310, x': 0, y: 0, y': 8953.49, z: -1.88252, z': -0.106374"
expect 0 'other units' run satellite.yaml --t-end 208.2267 --final --columns z
near 4.7216325852 1e-6 'other units'

# Two bodies that fly together: the energy of their encounter is a small part of the total.
one flight 2.0648 'x: scalar, y: scalar, z: scalar, w: scalar' \
  "0.1750525*(x'^2 + y'^2) + 0.266008*(z'^2 + w'^2) + 0.186261/sqrt((x - z)^2 + (y - w)^2)" \
  "x: 0.838327, x': 4.29083, y: 0, y': 0.375245, z: -0.551679, z': 4.29083, w: 0, w': -0.246938" \
  galerkin:degree=3,nodes=4
expect 1 'beyond a fold' run flight.yaml --t-end 4.1296 --final
says err 'ends at h = 1.92' 'beyond a fold'

# Beyond h kappa = 2, kappa the rate at which a motion leaves an unstable place, the midpoint rule
# has another solution near the guess; of two such motions the determinant has its old sign again.
one over 2.042035224833366 'z: scalar' "z'^2/2 + cos(z)" "z: 1.25899445291308, z': 1.84379959393625"
expect 0 'over the top' run over.yaml --final --columns z
near 4.02805529520 1e-9 'over the top'
for method in midpoint midpoint:solver=newton hamiltonian:degree=1; do
  one upright 2.0734511513692637 'x: scalar' "x'^2/2 - cos(x)" "x: 0.001, x': 0" $method
  expect 0 "upright, $method" run upright.yaml --final --columns x
  near 1.31870759930 1e-9 "upright, $method"
done
one both 2.0734511513692637 'x: scalar, y: scalar' "(x'^2 + y'^2)/2 - cos(x) - cos(y)" \
  "x: 0.001, y: 0.0015, x': 0, y': 0"
expect 0 'two upright' run both.yaml --final --columns y
near 1.32479062103 1e-9 'two upright'
one third 2.0734511513692637 'x: scalar, y: scalar, z: scalar' \
  "(x'^2 + y'^2 + z'^2)/2 - cos(x) - cos(y) + 0.9*cos(z)" \
  "x: 1e-4, y: 1.5e-4, z: 2.2, x': 0, y': 0, z': 0.3"
expect 0 'two upright and a third' run third.yaml --final --columns x
near 1.30751352384 1e-9 'two upright and a third'
place='x: 22896737.791516867, y: 58327.225027519475, z: 15.220008717851609'
momenta='p(x): -1435.6130390313663, p(y): 673021.0130002721, p(z): 5.4047857974354585'
one orbit 1.82746 'x: scalar, y: scalar, z: scalar' \
  "73.803*(x'^2 + y'^2) + 58835800000000000/sqrt(x^2 + y^2) + 5.08665*z'^2 + 13.4464*cos(z)" \
  "$place, $momenta"
expect 0 'an attitude in orbit' run orbit.yaml --final --columns z
near 14.649084 1e-6 'an attitude in orbit'

# Branches that end just before the step does, near other ones.
cart="7159.4*x'^2 - 169.4135*x^2"
short="0.1108695*((x' + 0.330511*cos(y)*y')^2 + (0.330511*sin(y)*y')^2) + 0.142932*cos(y)"
long="0.06866*((x' + 1.28162*cos(z)*z')^2 + (1.28162*sin(z)*z')^2) + 0.343237*cos(z)"
one pendula 0.502517 'x: scalar, y: scalar, z: scalar' "$cart + $short + $long" \
  "x: 1.98362, x': -0.690857, y: 2.77826, y': -2.25441, z: 0.429879, z': 3.86232" \
  galerkin:degree=1,quadrature=lobatto,solver=newton
expect 1 'a gap' run pendula.yaml --t-end 1.507551 --final
says err 'ends at h = 0.474' 'a gap'
cart="2887.485*x'^2 - 305.444*x^2"
pendulum="0.3059875*((x' + 0.335559*cos(y)*y')^2 + (0.335559*sin(y)*y')^2) + 0.259816*cos(y)"
one cart2 0.431511 'x: scalar, y: scalar' "$cart + $pendulum" \
  "x: -0.959121, x': -1.22796, y: -1.26813, y': -3.89561" trapezoidal
expect 1 'a fold' run cart2.yaml --t-end 1.726044 --final
says err 'ends at h = 0.42' 'a fold'

# A right step that was refused: its residual was at roundoff.
cat >mixed.yaml <<'END'
coordinates: {x: scalar, y: scalar}
hamiltonian: >-
  p(x)^2/2*(1 + 0.188447*x^2) + p(y)^2/2 - 0.84595*p(x)*sin(y) + x^4/4 + 2.79146*cos(x - y) + y^2/2
initial: {x: 1.85564, y: -1.66799, p(x): -0.447391, p(y): 0.543073}
method: shooting:type=2,onestep=gauss
step: 0.377911
until: 0.377911
END
expect 0 'at roundoff' run mixed.yaml --final

finish
