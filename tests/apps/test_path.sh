#!/bin/sh
# dvi path: ends, guesses, reports, refusals.  Usage: test_path.sh DVI
. "$(dirname "$0")/check.sh"
eight='path figure-eight --method galerkin:degree=8 --ends periodic'
pendulum='path pendulum --method midpoint --ends fixed --t-end 2'
kepler='path kepler --method galerkin:degree=4 --ends fixed --t-end 3 --steps 30'

# shellcheck disable=SC2086
{
# Fixed ends, and the run that has them.
expect 0 'a run' run pendulum --method midpoint --h 0.04 --t-end 2 --out run.csv
end=$(tail -n 1 run.csv | cut -d, -f2)
expect 2 'rotations' path free-body --method lie-galerkin --ends initial --steps 10 --t-end 1
says err 'paths are found between ends in R\^n' 'refused with the reason'
expect 0 'fixed ends' $pendulum --to "$end" --steps 50 --out path.csv
says out 'minimum: 0 negative, 0 zero' 'what the action has there'
[ "$(head -n 1 path.csv)" = "$(head -n 1 run.csv)" ] || fail 'columns are those of dvi run'
[ "$(wc -l <path.csv)" -eq 52 ] || fail 'a header and 51 nodes'
# differ SQUARE: fail and print the first row in which the first four columns differ from the next
# four by more than the root of SQUARE.
differ() {
  awk -F, -v square="$1" '
    NR > 1 { for (i = 1; i <= 4; i++) if (($i - $(i + 4)) ^ 2 > square) { print; exit 1 } }'
}
paste -d, run.csv path.csv | differ 1e-22 || fail 'the path is the run'
expect 0 'rows on standard output' $pendulum --to "$end" --steps 50 --out -
same out path.csv 'standard output has what the file has'
says err '^gradient ' 'then the report is on standard error'
expect 0 'ends from a guess' $pendulum --guess run.csv --steps 50 --out again.csv
says out '^span  *2$' 'the span'
expect 0 'initial ends' path pendulum --method midpoint --ends initial --t-end 2 --steps 50 \
  --out initial.csv
paste -d, run.csv initial.csv | differ 1e-24 || fail 'joined steps are the run'
says out 'not defined' 'no second variation between initial ends'
# A scene brings its method, and each member of a family has it.
cat >own.yaml <<'E1'
parameters: {k: 1}
coordinates: {x: scalar}
lagrangian: x'^2/2 - k*x^2/2
initial: {x: 1}
method: galerkin:degree=3
step: 0.1
until: 1
E1
expect 0 "the scene's method" path own.yaml --ends fixed --to 0.5 --steps 10
says out 'steps of galerkin:degree=3' 'its name'
expect 0 "a family with the scene's method" path own.yaml --ends fixed --to 0.5 --steps 10 \
  --continue k=1:2:2
says out 'steps of galerkin:degree=3' 'its name'
expect 2 'no method' path pendulum --ends fixed --to 0.5 --steps 10
says err 'path: --method is missing' 'who lacks it'
expect 0 'places' $kepler --from 1,0 --to=-0.5,1
expect 0 'a momentum' path kepler --method galerkin:degree=4 --ends initial --t-end 3 --steps 30 \
  --from 1,0 --momentum 0,1.1

# The report on the energy along the path.
double='path double-pendulum --method galerkin:degree=2 --t-end 2'
double="$double --ends fixed --from 2.8,1.5 --to=-1,-1.5"
expect 0 'steps that resolve a motion' $double --steps 16
says out \
  '^energy spread  *1.2e+00, 6.8e-03 of the kinetic energy; at most 5.1e-03 of it in a step' \
  'how much it changes'
expect 1 'steps that follow none' $double --steps 4 --out coarse.csv
says out '^energy spread  *[1-9.]*e+02, 9.[0-9]e-01 of the kinetic energy' \
  'how much it changes then'
says err 'from node 3 to 4, t = 1.5 to 2, the energy changes by .*; try about 13 steps' \
  'where, and what helps'
[ ! -e coarse.csv ] || fail 'no file of a path that is not solved'
expect 1 'a family that comes to such a path' $double --steps 4 --continue g=0:9.8:2
says err 'this was at g=' 'where in the family'
expect 0 'a system that depends on time' path driven-pendulum --method midpoint --ends fixed \
  --to 1 --t-end 1 --steps 10
says out '^energy spread  *not defined: the system depends on time' 'it keeps no energy'

# The figure eight from three points.
cat >sketch.csv <<'END'
t,x_1,y_1,x_2,y_2,x_3,y_3
0,0,0,0.9,-0.3,-0.9,0.3
1,0.9,0.3,0,0,-0.9,-0.3
2,0.9,-0.3,-0.9,0.3,0,0
END
third='--symmetry 3,4,5,6,1,2 --steps 10 --guess sketch.csv'
expect 0 'one third of the figure eight' $eight $third --period 2.10863799333333333
says out '^energy  *-1.287141996' 'its energy'
says out 'minimum: 0 negative, 4 zero (4 of symmetry)' 'a minimum among choreographies'
expect 0 'with its energy instead' $eight $third --period 2.2 --free-period \
  --energy -1.28714199602879
says out '^span  *2.108637993' 'the period that belongs to it'
expect 0 'the whole' $eight --steps 24
says out '^action  *24.42704864077' 'its action'
expect 0 'a family' path kepler --method galerkin:degree=6 --ends initial --steps 20 --t-end 2 \
  --continue e=0.1:0.8:7
expect 0 'a family of one' path kepler --method galerkin:degree=6 --ends initial --steps 20 \
  --t-end 2 --set e=0.8
expect 1 'conjugate ends' path oscillator --method galerkin:degree=4 --ends fixed --from 0 --to 1 \
  --t-end 4.442882938158366 --steps 20
says err 'its ends are conjugate' 'a reason is given'
expect 1 'through the centre' path kepler --method galerkin:degree=4 --ends fixed --from 1,0 \
  --to=-1,0 --t-end 0.1 --steps 20
says err 'singularity' 'a reason is given'

# Command lines that make no sense.
expect 2 'no method' path kepler --ends fixed --steps 3
expect 2 'no ends' path kepler --method midpoint --steps 3
expect 2 'unknown ends' path kepler --method midpoint --ends loose --steps 3
expect 2 'no steps' path kepler --method midpoint --ends periodic
expect 2 'no end' path kepler --method midpoint --ends fixed --steps 3
says err '--to' 'what is missing'
for period in 0 -1; do expect 2 "period $period" $eight --steps 24 --period=$period; done
expect 2 'period nan' $eight --steps 24 --period nan
expect 2 'steps 0' $eight --steps 0
expect 2 'too many steps' $eight --steps 3000000000
expect 2 'more unknowns than an int counts' $eight --steps 2000000000 --guess sketch.csv
says err 'more than an int can count' 'a reason is given'
expect 2 'an end of another size' $kepler --from 1,0,0 --to 0,1
says err 'has 3 numbers; kepler has 2 coordinates' 'what is expected'
expect 2 'an end that is no number' $kepler --from 1,x --to 0,1
expect 2 'an option without use' $eight --steps 24 --to 0,1
expect 2 'a period without use' $kepler --from 1,0 --to 0,1 --period 3
expect 2 'an energy of a given period' $eight --steps 24 --energy -1
expect 2 'a free period between fixed ends' $kepler --from 1,0 --to 0,1 --free-period
expect 2 'a coordinate that is none' $eight --steps 8 --symmetry 3,4,5,6,1,7
expect 2 'a coordinate twice' $eight --steps 8 --symmetry 3,4,5,6,1,1
expect 2 'verlet' path kepler --method verlet --ends fixed --to 0,1 --steps 9
says err 'galerkin, midpoint, trapezoidal, and hp and hamiltonian of types 1 to 3 are' \
  'what is possible'
for method in hp:type=1,degree=4 hamiltonian:type=2,degree=4; do
  expect 0 "a path by $method" path figure-eight --method $method --ends periodic --steps 24
  says out '^energy            -1.28714' "a path by $method"
done
expect 2 'a family without values' $kepler --from 1,0 --to 0,1 --continue e=0.1
expect 2 'a family of an unknown parameter' $kepler --from 1,0 --to 0,1 --continue g=0.1:0.2:3

# Guesses that are no good.
expect 1 'no such file' $eight --steps 9 --guess missing.csv
cut -d, -f1-6 sketch.csv >narrow.csv
expect 2 'a column is missing' $eight --steps 9 --guess narrow.csv
says err '6 of the 7 columns' 'what is missing'
sed '1s/,y_1,/,x_1,/' sketch.csv >repeated.csv
expect 2 'a column twice in the place of another' $eight --steps 9 --guess repeated.csv
says err "'repeated.csv' has two columns 'x_1'" 'which one'
sed '1s/,y_1,/,t,/' sketch.csv >clocks.csv
expect 2 'the time twice' $eight --steps 9 --guess clocks.csv
says err "has two columns 't'" 'which one'
head -n 2 sketch.csv >short.csv
expect 2 'one point' $eight --steps 9 --guess short.csv
sed 's/^1,0.9/1,word/' sketch.csv >word.csv
expect 2 'a field that is no number' $eight --steps 9 --guess word.csv
says err "line 3: 'word' is no number" 'where it is'
sed 's/^1,0.9,/1,/' sketch.csv >ragged.csv
expect 2 'a row that is too short' $eight --steps 9 --guess ragged.csv
(cat sketch.csv; tail -n 1 sketch.csv) >twice.csv
expect 2 'times that do not ascend' $eight --steps 9 --guess twice.csv
says err 'line 5: the time 2 does not come after 2' 'where it is'
expect 1 'a folder' $eight --steps 9 --guess /
says err "cannot read '/'" 'a folder is not empty'
expect 1 'an end beyond all numbers' $pendulum --to 1e300 --steps 50
says err 'path: step [0-9]* of 50, from t = ' 'where it fails'
: >empty.csv
expect 2 'an empty file' $eight --steps 9 --guess empty.csv
expect 1 'no folder' $eight --steps 24 --out nowhere/path.csv
}
finish
