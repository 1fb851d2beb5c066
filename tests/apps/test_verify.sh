#!/bin/sh
# dvi run --verify claims no more digits than are right, and refuses some options.
# Usage: test_verify.sh DVI
# It prints the table of docs/trust.md: ctest -V -R apps/verify.
. "$(dirname "$0")/check.sh"

# Each problem by three methods or more, of which the last ones come near roundoff. The judge of dvi
# order is the exact solution or the stored digits of quadruple precision.
sed '/^#/d' >jobs <<'END'
oscillator 50 0.05 verlet
oscillator 50 0.25 galerkin:degree=2
oscillator 50 0.5 galerkin:degree=4
pendulum 20 0.02 verlet
pendulum 20 0.1 galerkin:degree=2
pendulum 20 0.1 composition:order=6
kepler 10 0.01 verlet
kepler 10 0.02 hp:type=1,degree=2
kepler 10 0.1 galerkin:degree=4
henon-heiles 20 0.05 verlet
henon-heiles 20 0.2 galerkin:degree=3
henon-heiles 20 0.1 galerkin:degree=6
double-pendulum 1 0.005 midpoint
double-pendulum 1 0.02 galerkin:degree=2
double-pendulum 1 0.05 galerkin:degree=4,quadrature=lobatto
double-pendulum 20 0.05 midpoint
driven-pendulum 5 0.02 midpoint
driven-pendulum 5 0.05 galerkin:degree=2
driven-pendulum 5 0.1 galerkin:degree=4
fpu 1 0.001 imex
fpu 1 0.001 verlet
fpu 1 0.02 galerkin:degree=4
toda 10 0.02 verlet
toda 10 0.1 galerkin:degree=2
toda 10 0.1 galerkin:degree=8
figure-eight 10 0.01 verlet
figure-eight 10 0.02 sem
figure-eight 10 0.05 galerkin:degree=3
pythagorean 1.5 0.005 verlet
pythagorean 1.5 0.025 galerkin:degree=3
pythagorean 1.5 0.05 galerkin:degree=6
stiff-pendulum 1 0.002 midpoint
stiff-pendulum 1 0.005 galerkin:degree=2
stiff-pendulum 1 0.02 galerkin:degree=6
lotka-volterra 1 0.05 vprk:nodes=1
lotka-volterra 1 0.1 vprk:nodes=2
lotka-volterra 1 0.1 vprk:nodes=4
circle-dirac 2 0.02 dg-phase
circle-dirac 2 0.05 dg-phase:degree=2
circle-dirac 2 0.1 dg-phase:degree=4
elastica 2 0.02 hamiltonian:type=3,degree=1
elastica 2 0.1 hamiltonian:type=2,degree=2
elastica 2 0.2 hamiltonian:type=2,degree=4
two-body 5 0.02 lie-verlet
two-body 5 0.05 composition:order=4,base=lie-verlet
two-body 5 0.1 lie-galerkin:degree=2
END

# claimed PROBLEM T H METHOD: print error, digits and size of the row for all coordinates.
claimed() {
  "$dvi" run "$1" --method "$4" --h "$3" --t-end "$2" --verify --csv - 2>err |
    sed -n 's/^all coordinates,,//p' | tr ',' ' '
}

# actual PROBLEM T H METHOD: print the error that the judge finds.
actual() {
  "$dvi" order "$1" --method "$4" --h "$3" --t-end "$2" --levels 1 --csv - 2>err |
    awk -F, \
    'NR == 1 { for (i = NF; i > 0 && $i != "error"; i--) back++ } NR == 2 { print $(NF - back) }'
}

echo '| problem | t | method | h | digits claimed | digits that are right |'
echo '|---|---|---|---|---|---|'
judged=0
while read -r problem t h method; do
  # shellcheck disable=SC2046
  set -- $(claimed "$problem" "$t" "$h" "$method") $(actual "$problem" "$t" "$h" "$method")
  [ $# -eq 4 ] || { fail "$problem by $method: no digits"; cat err; continue; }
  right=$(awk -v error="$4" -v size="$3" '
    BEGIN { printf "%.1f", (error > 0 ? -log(error / size) / log(10) : 16) }')
  echo "| $problem | $t | \`$method\` | $h | $2 | $right |"
  # One digit of 17 may be lost in the spelling of the figures; less than two are given away where
  # there are errors to see.
  awk -v claimed="$2" -v right="$right" 'BEGIN { exit !(claimed <= right + 0.05) }' ||
    [ "$2" -eq 0 ] || fail "$problem by $method: $2 claimed, $right right"
  awk -v claimed="$2" -v right="$right" 'BEGIN { exit !(claimed > right - 2) }' ||
    fail "$problem by $method: only $2 claimed of $right"
  judged=$((judged + 1))
done <jobs
[ "$judged" -eq "$(wc -l <jobs)" ] || fail 'every job is judged'

# The output and the exit code.
expect 0 'enough digits' run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --verify \
  --digits 6
says out '^  all coordinates  *[0-9.]*e-08 *7$' 'the state'
says out '^  y  *-0.2836685002[0-9]* *[0-9.]*e-08 *6$' \
  'a column, its value, its error and its digits'
says out '^halving the step divides the error by [0-9]*; order 8 makes that 256$' 'the errors fall'
says out '^second method: IDA, .* ends [0-9.]*e-08 away' 'another method'
expect 3 'too few digits' run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --verify \
  --digits 9
says err 'run: --digits 9: 7 can be trusted' 'how many there are'
step=$(sed -n 's/.*try --h //p' err)
expect 0 'the step that is advised' run kepler --method galerkin:degree=4 --h "$step" --t-end 10 \
  --verify --digits 9
expect 3 'columns that are asked for count' run kepler --method galerkin:degree=4 --h 0.1 \
  --t-end 10 --verify --digits 7 --columns x,y
expect 0 'others do not' run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --verify \
  --digits 7
expect 3 'nothing is right' run kepler --method midpoint --h 30 --t-end 60 --verify --digits 1
says out '^  all coordinates .* 0$' 'no digit'
says out '^halving the step does not halve the error' 'why'
expect 3 'chaos' run pendulum-3d --method lie-verlet --h 0.01 --t-end 60 --verify --digits 1
says out '^  all coordinates .* 0$' 'no digit of a chaotic motion'
expect 0 'csv' run kepler --method verlet --h 0.01 --t-end 1 --verify --csv digits.csv
says digits.csv '^column,value,error,digits,size$' 'the header'
says digits.csv '^x,-0\.[0-9]*,[0-9.e-]*,3,' 'a row'
"$dvi" run kepler --method verlet --h 0.01 --t-end 1 --final | tail -n 1 | cut -d, -f2 >value
says digits.csv "^x,$(cat value)," 'the value is that of the run, to the last bit'
expect 0 'a step that does not divide the way' run kepler --method galerkin:degree=3 --h 0.3 \
  --t-end 1 --verify --digits 3
says out '^halving the step divides the error by [0-9.]*; order 6 makes that 64$' 'the errors fall'
expect 0 'in another time' run kepler --set e=0.9 --method galerkin:degree=4 \
  --time-transform distance --h 0.2 --t-end 10 --verify --digits 5
expect 0 'controlled' run kepler --method verlet --step-control distance --h 0.01 --t-end 10 \
  --verify
says out '^second method: IDA' 'controlled: compared'
expect 0 'backward' run kepler --method galerkin:degree=4 --h -0.1 --t-end -10 --verify --digits 6
for refused in '--out rows.csv' '--plot x.svg' '--checkpoint a' '--resume a' '--every 3' \
  '--alarm energy=1'; do
  # shellcheck disable=SC2086
  expect 2 "--verify with $refused" run kepler --method verlet --verify $refused
  says err "leave out ${refused%% *}" "--verify with $refused: which option"
done
expect 2 'digits alone' run kepler --method verlet --digits 3
says err '\-\-digits 3 is for --verify' 'digits alone'
expect 2 'csv alone' run kepler --method verlet --csv -
expect 2 'more digits than there are' run kepler --method verlet --verify --digits 17

# If an event ends the run, the time of the event has digits, too.
cat >fall.yaml <<'END'
parameters: {m: 2, g: 9.81}
coordinates: {y: scalar}
lagrangian: m/2*y'^2 - m*g*y - y^4/100
initial: {y: 3}
events: {ground: {zero: y, direction: falling, stop: yes}}
method: galerkin:degree=2
step: 0.1
until: 5
END
expect 0 'an event' run fall.yaml --verify --digits 4
says out '^  t  *0.768[0-9]* ' 'the time of the end'
says out '^no second method: an event ended the run$' 'no second method'

# IDA's error in the momenta is 1.5e-10, while in the coordinates, which pass zero there, its
# tolerances agree by chance. The method is right to rounding: IDA does not contradict it.
cat >springs.yaml <<'END'
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 - (x - y)^2/2
initial: {x: 1, y: -1}
method: galerkin:degree=4
step: 0.1
until: 10
END
expect 0 'an error of IDA' run springs.yaml --verify --digits 12 --columns x,p_x,energy
says out '^second method: IDA' 'it is told'
grep -q 'contradicts' out && fail 'IDA does not contradict beyond its own error'
says out '^  p_x  *-1.41419610549[0-9]*  *[0-9.]*e-1[56]  *1[45]$' \
  'the error of the method, not of IDA'

# No step of the three evaluates the force where it is, and their errors fall: IDA sees it.
cat >kick.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2 + 10*x*exp(-(700*(t - 1.00625))^2)
initial: {x: 1}
method: verlet
step: 0.05
until: 3
END
expect 3 'an error that three step sizes share' run kick.yaml --verify --digits 3
says out '^halving the step divides the error by 4;' 'the steps see nothing of it'
says out '^second method: IDA, .* ends 2\.[0-9]e-02 away in the coordinates, .*: it contradicts' \
  'IDA does'
says out '^  all coordinates  *2\.[0-9]e-02  *1$' 'its distance is the error'

# A system with 2000 coordinates: factorisations of IDA's Jacobian would cost more than the runs.
expect 0 'a large system' run fpu --set ell=1000 --method verlet --h 0.001 --t-end 0.1 --verify \
  --columns energy
says out '^no second method: IDA is asked for 500 coordinates at most' 'IDA is left out'

# IDA does not take contacts.
cat >ball.yaml <<'END'
coordinates: {y: scalar}
lagrangian: y'^2/2 - 9.81*y
contacts: {floor: {gap: y, restitution: 0.8}}
initial: {y: 1}
method: verlet
step: 0.01
until: 1
END
expect 0 'contacts' run ball.yaml --verify
says out '^no second method: IDA does not take such a system$' 'IDA refuses contacts'

# A step of 1e-7 is no advice; the method that is advised has the digits.
expect 3 'far too few digits' run kepler --method verlet --h 0.01 --t-end 1 --verify --digits 12
small='--h [0-9.]*e-0[78] would do, at [0-9]* times the cost'
says err "run: $small; try --method galerkin:degree=4 --h 0.01\$" 'a higher order'
better=$(sed -n 's/.*try --method \([^ ]*\) .*/\1/p' err)
expect 0 'the method that is advised' run kepler --method "$better" --h 0.01 --t-end 1 --verify \
  --digits 12

# w, its momentum and the sum of the others are 0 up to rounding: no digit of them is wrong.
cat >zero.yaml <<'END'
coordinates: {x: scalar, y: scalar, z: scalar, w: scalar}
lagrangian: >-
  (x'^2 + y'^2 + z'^2 + w'^2)/2 + cos(x - y) + cos(y - z) + cos(z - x) - w*(x + y + z)/10 - w^2/2
initial: {x: 0.1, y: 0.2, z: -0.3, w: 0, x': 0.7, y': -0.3, z': -0.4}
invariants: {total: p(x) + p(y) + p(z)}
method: galerkin:degree=4
step: 0.1
until: 20
END
expect 0 'zero up to rounding' run zero.yaml --verify --digits 10 --columns x,w,p_w,total
expect 0 'a vector along an axis' run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 \
  --verify --digits 6 --columns laplace_y
expect 3 'no more than its error' run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 \
  --verify --digits 8 --columns laplace_y

# size COLUMN: the magnitude that the digits of a column in the table `out` are relative to.
size() { awk -F, -v column="$1" '$1 == column { print $5 }' out; }

# The scale of an invariant that is 0 is one of the motion, however many steps it has.
for h in 0.1 0.005; do
  expect 0 "a scale by --h $h" run kepler --method galerkin:degree=4 --h $h --t-end 10 --verify \
    --columns laplace_y --csv -
  size laplace_y >scale.$h
done
paste scale.0.1 scale.0.005 | awk '{ exit !($1 > $2/1.5 && $1 < 1.5*$2) }' ||
  fail "the scale of laplace_y depends on the step: $(paste scale.0.1 scale.0.005)"

# Momenta of a system at rest are roundings, and have the digits of its coordinates.
cat >rest.yaml <<'END'
coordinates: {"x[4]": scalar, "y[4]": scalar}
kinetic: sum(i, x[i]'^2 + y[i]'^2)/2
potentials:
  springs: 40*sum(i=1..3, (hypot(x[i+1] - x[i], y[i+1] - y[i]) - 0.2)^2)
  hook: 40*(hypot(x[1], y[1]) - 0.2)^2
initial: {"x[i]": "0.12*i", "y[i]": "-0.16*i"}
method: galerkin:degree=2
step: 0.01
until: 10
END
expect 0 'a net at rest' run rest.yaml --verify --digits 10

# A membrane has no more energy than its motion, and no more digits of it than are right.
cat >square.yaml <<'END'
mesh: {generator: staggered, cells: [40, 40], size: [1, 1]}
field: wave
boundary: fixed
initial: {u: sin(pi*x)*sin(2*pi*y)}
method: verlet
step: 0.0101
until: 1
END
expect 0 'a membrane' run square.yaml --verify --columns energy --csv -
size energy | awk '{ exit !($1 > 6 && $1 < 6.3) }' || fail "a membrane's energy: $(size energy)"
finish
