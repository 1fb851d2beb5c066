#!/bin/sh
# Time transforms and step control on the command line end at the right time, resume bit for bit,
# and refuse systems and options that they cannot take.
# Usage: test_transform.sh DVI
. "$(dirname "$0")/check.sh"

# A run ends at --t-end, whatever its steps are, forward and backward.
comet='kepler --set e=0.9 --method galerkin:degree=4'
# shellcheck disable=SC2086
expect 0 'a transformed run' run $comet --time-transform distance --h 0.3 --t-end 20 --out whole.csv
tail -n 1 whole.csv | grep -q '^20,' || fail 'the last row is at t = 20'
awk -F, 'NR > 2 && $1 <= t { exit 1 } { t = $1 }' whole.csv || fail 'the time goes on in every row'
awk -F, 'NR > 1 { d = $6 + 0.5; if (d > 1e-6 || d < -1e-6) exit 1 }' whole.csv ||
  fail 'the energy is kept'
# shellcheck disable=SC2086
expect 0 'backward' run $comet --time-transform distance --h -0.3 --t-end -20 --final
tail -n 1 out | grep -q '^-20,' || fail 'the last row is at t = -20'
expect 0 'to a time exactly' run kepler --method verlet --step-control distance --h=-0.1 \
  --t-end=-3 --final --checkpoint end.state
says out '^-3,' 'the end is met to the last digit'
expect 0 'the checkpoint of an end' run kepler --method verlet --step-control distance --h=-0.1 \
  --t-end=-3 --final --resume end.state

# A run that fails on its way says why.
expect 1 'a step too large' run kepler --set e=0.99 --method verlet --step-control distance \
  --h 1.5 --t-end 63 --final
says err '^dvi: verlet: step [0-9]* from t = .* with h = 1.5 failed' 'the step that failed is named'

# A checkpoint goes on, in the same time only. (tests/integrator/test_transform.c has the bits: here
# the first part ends with a shortened step.)
for way in '--time-transform distance' '--step-control distance:power=1.2'; do
  # shellcheck disable=SC2086
  expect 0 'first part' run $comet $way --h 0.3 --t-end 7 --checkpoint half.state --out first.csv
  # shellcheck disable=SC2086
  expect 0 'second part' run kepler --method galerkin:degree=4 $way --h 0.3 --t-end 20 \
    --resume half.state --out second.csv
  [ "$(tail -n 1 first.csv)" = "$(sed -n 2p second.csv)" ] ||
    fail 'the second part begins where the first one ended'
  tail -n 1 second.csv | grep -q '^20,' || fail 'the resumed run ends at t = 20'
  # shellcheck disable=SC2086
  expect 1 'resume without it' run kepler --method galerkin:degree=4 --h 0.3 --t-end 20 \
    --resume half.state
  says err 'not of steps of time' 'why it is not resumed'
done

# The same orders as without.
expect 0 'order' order kepler --set e=0.9 --method galerkin:degree=2 --time-transform distance \
  --levels 5 --csv order.csv
says out 'galerkin:degree=2 @ distance: claimed order 4, fitted [34]\.[0-9]*.*ok' \
  'the order is found'
says order.csv '^galerkin:degree=2 @ distance,kepler,' 'the row names the transform'
expect 0 'order of a controlled run' order kepler --method verlet \
  --step-control distance:power=1.2 --levels 5
says out 'verlet @ control distance:power=1.2: claimed order 2, fitted' 'the order is found'
expect 0 'order without bodies' order henon-heiles --method galerkin:degree=2 \
  --time-transform arclength --levels 5

# Plain and transformed rows stand beside each other, and the transformed ones need fewer
# evaluations.
expect 0 'bench' bench kepler --set e=0.99 --t-end 6.2 --method galerkin:degree=4 \
  --time-transform none --time-transform distance \
  --at 1e-6 --rounds 1 --at-csv at.csv
says out '^galerkin:degree=4 @ distance$' 'the transformed method has its own levels'
awk -F, '$4 == "galerkin:degree=4" { plain = $7 }
         $4 == "galerkin:degree=4 @ distance" { transformed = $7 }
         END { exit !(transformed > 0 && plain > 10 * transformed) }' at.csv ||
  fail 'a tenth of the evaluations at an error of 1e-6'
expect 2 'a monitor twice' bench kepler --time-transform distance --time-transform distance
expect 2 'no transform of single steps' bench kepler --method midpoint --scale degree=1,2 \
  --time-transform distance

expect 0 'explain' explain pythagorean --method galerkin --time-transform distance
says out '^time: transformed, dt/dtau = g(q), distance:power=1.5,bodies=3,dimension=2' \
  'the monitor is explained'
for bodies in kepler figure-eight outer-solar; do
  expect 0 "distances of $bodies" explain $bodies --method midpoint --time-transform distance
done
expect 0 'explain control' explain toda --method verlet --step-control arclength
says out '^time: steps follow arclength by reversible control' 'control is explained'

# Combinations that are refused.
for command in run order explain; do
  expect 2 "both ways of $command" $command kepler --method midpoint --time-transform distance \
    --step-control distance
  says err 'give one of them' "both ways of $command"
  expect 2 "an unknown monitor of $command" $command kepler --method midpoint \
    --time-transform distances
  says err 'distance, arclength and acceleration' 'those that there are'
  expect 2 "an unknown key of $command" $command kepler --method midpoint \
    --time-transform distance:pwer=2
  says err 'it takes power' 'the keys that there are'
  expect 2 "no bodies of $command" $command toda --method midpoint --time-transform distance
  says err 'toda has no bodies' 'why there are no distances'
  expect 2 "an explicit method of $command" $command kepler --method verlet \
    --time-transform distance
  says err 'verlet: the system declares a general Lagrangian' 'why verlet is refused'
  expect 2 "not symmetric: $command" $command kepler --method galerkin:quadrature=radau-left \
    --step-control distance
  says err 'is not symmetric' 'why a Radau rule is refused'
  expect 2 "general Lagrangian of $command" $command double-pendulum --method midpoint \
    --time-transform arclength
  says err 'constant mass' 'why there is no arc length'
  for way in --time-transform --step-control; do
    expect 2 "$way of $command on a one-form" $command lotka-volterra --method dg $way arclength
    says err 'the system declares a one-form' "why $way is refused"
  done
done
expect 2 'no transform of a one-form' bench lotka-volterra --method dg --time-transform arclength
for wrong in bodies=2 bodies=1,dimension=1 dimension=4; do
  expect 2 "$wrong of kepler" run kepler --method midpoint --time-transform "distance:$wrong"
  says err 'kepler is bodies=1,dimension=2' 'what the problem is'
done
expect 0 'keys that are the problem' explain kepler --method midpoint \
  --time-transform distance:power=1,bodies=1,dimension=2
for bad in power=0 power=-1 power=nan power=x; do
  code=0
  "$dvi" run kepler --method midpoint --time-transform "distance:$bad" >out 2>err || code=$?
  [ "$code" -ne 0 ] || fail "distance:$bad is taken"
done
# An oscillator's acceleration vanishes: steps leap, and no search among them ends at the solution.
expect 1 'order of leaps' order oscillator --method verlet --step-control acceleration --levels 4
says err '^dvi: verlet: its steps do not lead to the solution at t = 50' 'why there is no order'
expect 1 'bench of leaps' bench oscillator --method midpoint --time-transform acceleration \
  --levels 2 --rounds 1
says err 'step .* failed' 'why there is no bench'
expect 2 'momentum-centred steps' run kepler --method hp:type=4 --time-transform distance --h 0.1 \
  --t-end 1
says err 'type=4 has no path' 'why type 4 is not transformed'
expect 0 'steps of type 3' run kepler --method hp:type=3,degree=3 --time-transform distance \
  --h 0.1 --t-end 1 --final
expect 2 'naive steps' run kepler --method verlet --tolerance 1e-6
says err 'neither symplectic nor symmetric' 'why there is no tolerance'
expect 2 'wrong sign' run kepler --method midpoint --time-transform distance --h -0.1 --t-end 1
expect 2 'no step' run kepler --method midpoint --time-transform distance --h 0 --t-end 1
finish
