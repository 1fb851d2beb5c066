#!/bin/sh
# dvi control: digits, columns, bounds, refusals.  Usage: test_control.sh DVI
. "$(dirname "$0")/check.sh"

cat >swing-up.yaml <<'E1'
parameters: {most: 10}
coordinates: {a: scalar}
controls: {u: {cost: u^2/2, within: [-most, most]}}
lagrangian: a'^2/2 + cos(a)
forces: {a: u}
initial: {a: 0, a': 0}
final: {a: pi, a': 0}
method: galerkin:degree=4
step: 0.125
until: 5
E1
cp "$(dirname "$0")/../../apps/scenes/control/swing-up.yaml" free.yaml

expect 0 'a swing-up' control free.yaml --out u.csv
says out '^cost  *1.212590595721[45]' 'its cost'
says out 'minimum: 161 negative for 161 multipliers, 0 zero' 'the second variation'
[ "$(head -n 1 u.csv)" = t,a,p_a,u,costate_a,costate_p_a ] || fail 'columns'
[ "$(wc -l <u.csv)" -eq 42 ] || fail 'a header and 41 nodes'
sed -n 2p u.csv | grep -q '^0,0,[^,]*,0.5744761139[45]' || fail 'the first control'
expect 0 'rows on standard output' control free.yaml --out -
same out u.csv 'standard output has what the file has'
says err '^gradient ' 'then the report is on standard error'
expect 0 'a guess' control free.yaml --guess u.csv --method midpoint --steps 100
says out '100 steps of midpoint' 'steps and method'
# With sanitizers problems with bounds take minutes.
if [ -z "${DVI_TEST_FEWER:-}" ]; then
  expect 0 'bounds' control swing-up.yaml --method midpoint --set most=0.85 --out b.csv
  says out '^barrier ' 'the barrier'
  awk -F, 'NR > 1 && ($4 >= 0.85 || $4 <= -0.85) { exit 1 }' b.csv || fail 'controls within bounds'
  awk -F, 'NR > 1 && $4 > 0.8499 { found = 1 } END { exit !found }' b.csv || fail 'bounds are met'
  expect 1 'bounds that are too narrow' control swing-up.yaml --method midpoint --set most=0.1
  says err 'no stationary path' 'no solution'
  [ ! -s out ] || fail 'nothing is reported'
fi

# A free time: the pendulum swings up in the time that costs least.
sed 's/u^2\/2/u^2\/2 + 0.2/' free.yaml >priced.yaml
expect 0 'a free time' control priced.yaml --free-time
says out '^span  *4.84271156112' 'the time'
says out '^cost  *2.20975498330' 'its cost'

# An end that is free costs less, and its costate is 0.
sed "s/, a': 0}$/}/; s/initial: {a: 0}/initial: {a: 0, a': 0}/" free.yaml >loose.yaml
expect 0 'a free velocity' control loose.yaml --out loose.csv
tail -n 1 loose.csv | awk -F, '{ exit !($6 < 1e-12 && $6 > -1e-12) }' || fail 'its costate'

# Without an end, without a control that acts.
grep -v final free.yaml >endless.yaml
expect 2 'no end' control endless.yaml
says err 'no section final' 'what is missing'
sed 's/a: u/a: -a/' free.yaml >idle.yaml
expect 2 'a control that does not act' control idle.yaml
says err 'no control of idle stands in its forces' 'why'
grep -v 'controls\|final\|forces' free.yaml >plain.yaml
expect 2 'no controls' control plain.yaml
says err 'no section controls' 'what is missing'
expect 2 'a problem of the catalogue' control pendulum
says err 'no scene' 'why'
expect 2 'verlet' control free.yaml --method verlet
says err 'verlet is no discrete action' 'why'
expect 2 'emit-c' emit-c free.yaml --out -
says err 'controls, which C files do not have' 'why'
sed 's/u^2\/2}/-u^2}/' free.yaml >concave.yaml
expect 1 'a concave cost' control concave.yaml
says err 'no minimum in the controls' 'why'
expect 0 'a run takes controls as 0' run free.yaml --final
says out '^5,0,0,-1,0$' 'the pendulum hangs'
finish
