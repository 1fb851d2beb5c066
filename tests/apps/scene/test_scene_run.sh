#!/bin/sh
# A scene declares events, columns and rows of its run, and no file is written over the scene.
# Usage: test_scene_run.sh DVI
. "$(dirname "$0")/../check.sh"
cat >ball.yaml <<'END'
parameters: {g: 10}
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 - g*y
symmetries: {push: {x: 1}}
events:
  top: {zero: y', direction: falling}
  half: {zero: x - 0.5}
  never: {zero: y', direction: rising}
  ground: {zero: y, direction: falling, stop: yes}
initial: {x: 0, y: 1, x': 1, y': 2}
method: verlet
step: 0.1
until: 20
END

# holds NUMBER NUMBER NAME: require numbers that agree to 1e-12.
holds() {
  awk -v a="$1" -v b="$2" 'BEGIN { d = a - b; exit !(d < 1e-12 && d > -1e-12) }' ||
    fail "$3: $1 is not $2"
}

# The ball is thrown from 1 at speed 2: on a parabola verlet is exact, it turns at 0.2 and lands at
# (2 + sqrt(24))/10.
expect 0 'an event ends the run' run ball.yaml --events events.csv --out rows.csv
says err "event 'ground' ended the run at t = 0.6898979" 'the event is named'
says err "event 'half': found 1 time" 'what was found is counted'
says err "event 'never': found 0 times" 'and what was not'
[ "$(wc -l <rows.csv)" -eq 9 ] || fail 'the start, six steps, and the event'
[ "$(head -n 1 events.csv)" = 'event,t,x,y,v_x,v_y' ] || fail 'the columns of events'
[ "$(cut -d, -f1 events.csv | tr '\n' ' ')" = 'event top half ground ' ] ||
  fail 'events stand in the order of the run'
holds "$(sed -n 2p events.csv | cut -d, -f2)" 0.2 'the top'
holds "$(sed -n 3p events.csv | cut -d, -f2)" 0.5 'half the way'
holds "$(sed -n 4p events.csv | cut -d, -f2)" 0.68989794855663562 'the ground'
holds "$(tail -n 1 rows.csv | cut -d, -f1)" 0.68989794855663562 'the last row is the event'
holds "$(tail -n 1 rows.csv | cut -d, -f3)" 0 'and its state'
holds "$(tail -n 1 rows.csv | cut -d, -f5)" -4.8989794855663562 'with its momentum'
expect 0 'rows on standard output' run ball.yaml --every 4
[ "$(sed '1d;$d' out | cut -d, -f1 | tr '\n' ' ')" = '0 0.40000000000000002 ' ] ||
  fail 'rows between'
tail -n 1 out >end.csv
tail -n 1 rows.csv >whole_end.csv
same end.csv whole_end.csv 'the event is the last row, wherever rows are'
expect 0 'events on standard output' run ball.yaml --out rows.csv --events -
same out events.csv 'the same events'
expect 0 'no event in time' run ball.yaml --t-end 0.1 --events few.csv
[ "$(wc -l <few.csv)" -eq 1 ] || fail 'a header alone'
expect 0 'a method that chooses its steps' run ball.yaml --method sem --final
expect 0 'steps in another time' run ball.yaml --method midpoint --time-transform acceleration \
  --final
tail -n 1 out | awk -F, '{ exit !($3 < 1e-3 && $3 > -1e-3) }' ||
  fail 'it ends at the event, too, as far as its path is right'
expect 0 'backward' run ball.yaml --t-end -1
says err "event 'ground' ended the run at t = -0.28989794855" \
  'falling and rising are meant in the direction of the run'
expect 0 'a sweep' sweep ball.yaml --set g=0.1,10 --out sweep.csv
says sweep.csv '^0.1,DVI_OK,200,20,' 'no event'
says sweep.csv '^10,event ground,7,0.6898979' 'an event is no failure'
expect 2 'of the catalogue' run kepler --method verlet --events no.csv
says err 'kepler has none' 'the reason'
expect 2 'two tables' run ball.yaml --events -
for command in 'order ball.yaml --method midpoint --levels 4' \
  'bench ball.yaml --method verlet --scale g=1,2 --steps 1 --rounds 1' \
  'path ball.yaml --method midpoint --ends fixed --to 1,0 --t-end 1 --steps 4'; do
  # shellcheck disable=SC2086
  "$dvi" $command >out 2>err
  says err 'events of ball are not looked for' "${command%% *} goes past events, and says so"
done
expect 0 'explain' explain ball.yaml
says out \
  'events  *top (falling), half (both directions), never (rising), ground (falling, ends the run)' \
  'events in words'
sed 's/zero: y,/zero: log(0.5 - x),/' ball.yaml >root.yaml
expect 1 'an event that is no number' run root.yaml
says err 'root.yaml:9:18: log(0.5 - x).* is not finite, at t = 0.5' 'which part of it'

# Columns.
sed 's/^until.*/until: 0.4/; $a report: {every: 2, columns: [push, y]}' ball.yaml >two.yaml
expect 0 'columns' run two.yaml
printf 't,push,y\n0,1,1\n0.20000000000000001,1,1.2\n0.40000000000000002,1,1\n' >expected.csv
same out expected.csv 'columns and rows of the report'
expect 0 'other columns' run two.yaml --columns energy,t,p_y --every 4
[ "$(head -n 1 out)" = t,energy,p_y ] || fail 'the option comes before the scene'
expect 0 'all rows' run two.yaml --every 1
[ "$(wc -l <out)" -eq 6 ] || fail 'the option comes before the scene'
expect 0 'the catalogue' run kepler --method verlet --t-end 1 --final --columns angular_momentum
expect 2 'an unknown column' run two.yaml --columns enrgy
says err "did you mean 'energy'" 'the nearest'
expect 2 'a column twice' run two.yaml --columns y,x,y
sed 's/push, y/push, z/' two.yaml >wrong.yaml
expect 2 'an unknown column of a scene' run wrong.yaml
says err '^dvi: wrong.yaml:14:36: there is no column .z.' 'its place'
sed 's/push, y/push, push/' two.yaml >wrong.yaml
expect 2 'a column twice in a scene' run wrong.yaml
sed 's/push, y/h/' two.yaml >chosen.yaml
expect 2 'a column that the method has not' run chosen.yaml
says err 'chosen by verlet.* has no column .h.' 'which method'
cat >height.yaml <<'END'
coordinates: {h: scalar}
lagrangian: h'^2/2 - h^2/2
initial: {h: 1}
method: verlet
step: 0.1
until: 1
END
expect 0 'a coordinate h' run height.yaml
expect 2 'and the steps of sem' run height.yaml --method sem
says err 'two columns .h., one of them the method' 'which columns'
sed 's/^method: .*/method: verlot/' chosen.yaml >verlot.yaml
expect 2 'a method that is not there' run verlot.yaml
says err '^dvi: verlot.yaml:[0-9]*:9: verlot: unknown method .*verlet' 'where it stands'
expect 2 'the same on the command line' run verlot.yaml --method vorlet
says err '^dvi: --method vorlet: unknown method' 'where it stands there'
expect 0 'a column that the method has' run chosen.yaml --method sem
[ "$(head -n 1 out)" = t,h ] || fail 'the steps that sem chose'

# A step that is too large shows in the energy, and the run warns. A good run does not.
cat >wild.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2
initial: {x: 1}
method: verlet
step: 2.5
until: 50
END
expect 0 'a step that is too large' run wild.yaml --final
says err 'run: the energy error of verlet with --h 2.5 passed 1 % of the kinetic energy at t = ' \
  'how it shows'
expect 0 'without the energy' run wild.yaml --final --columns x
says err 'run: the energy error of verlet' 'it is told all the same'
expect 0 'a step in its bounds' run wild.yaml --final --h 0.1
[ ! -s err ] || fail 'nothing is wrong'
sed "s/x^2.2/x^2*(1 + t)/; s/until: 50/until: 500/" wild.yaml >driven.yaml
expect 0 'a drive' run driven.yaml --final --h 0.01
[ ! -s err ] || fail 'a drive changes the energy'

# A pole is no zero.
sed 's/zero: y,/zero: 1\/(y - 1.1234),/' ball.yaml >pole.yaml
expect 0 'a pole' run pole.yaml --final
cmp -s pole.yaml ball.yaml && fail 'there is a pole'
says err "event 'ground': found 0 times" 'no zero'

# An invariant that has no value at the start.
cat >root.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2
invariants: {a: log(x - 1)}
initial: {x: 1}
method: verlet
step: 0.1
until: 1
END
expect 1 'dvi check' check root.yaml
says err 'root.yaml:3:17: log(x - 1).* is not finite' 'which one'
expect 1 'dvi run' run root.yaml
grep -q 'smaller --h' err && fail 'no step is to blame'

# Derivatives without an operation are derived all the same.
cat >linear.yaml <<'END'
coordinates: {x: scalar}
hamiltonian: p(x)*x
initial: {x: 1, p(x): 0.5}
step: 0.1
until: 1
END
expect 0 'derivatives without an operation' check linear.yaml --method hamiltonian
says out 'gradient 0 ([1-9][0-9]* points), Hessian 0 ([1-9][0-9]* points), 1 entry' \
  'that they are evaluated'

# The energy is not evaluated if no column shows it: from x = 1.8 on the potential overflows, but
# its derivative is 1.
cat >overflow.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - 1e308*x/1e308
symmetries: {growth: {x: x}}
invariants: {square: x^2}
initial: {x: 1, x': 20}
method: verlet
step: 0.1
until: 1
END
expect 1 'no energy' run overflow.yaml
says err '1e308.x, x = 2.995 is not finite, at t = 0.1' 'why'
expect 0 'columns without energy' run overflow.yaml --columns x,growth,square
expect 1 'columns with it' run overflow.yaml --columns x,energy
expect 0 'nor does a plot show it' run overflow.yaml --columns x --plot overflow.svg
expect 1 'a plot that shows it' run overflow.yaml --columns x,energy --plot overflow.svg

# Every option of dvi run is used or refused; test_scene_sections.sh tries the sections.
cat >spring.yaml <<'END'
parameters: {k: 1, x0: 1, far: 2*x0, idle: 1}
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 - k*(x^2 + y^2)/2
initial: {x: far, y: 0, y': 1}
method: midpoint
step: 0.1
until: 1
END
expect 0 'as it stands' run spring.yaml
cp out base.csv
for option in '--method verlet' '--h 0.05' '--t-end 2' '--time-transform arclength' \
  '--step-control arclength' '--every 3' '--final' '--set k=2' '--set x0=2' \
  '--momenta 0,2' '--columns y' '--checkpoint spring.state --columns x'; do
  # shellcheck disable=SC2086
  expect 0 "$option" run spring.yaml $option
  cmp -s out base.csv && fail "$option does not show"
done
expect 0 'a checkpoint' run spring.yaml --checkpoint-every 3 --checkpoint spring.state --t-end 0.5 \
  --final
expect 0 'and on from there' run spring.yaml --resume spring.state --final
tail -n 1 base.csv >last.csv
tail -n 1 out | cmp -s - last.csv || fail 'two parts are one run'
refuses() { # PATTERN OPTIONS
  pattern=$1
  shift
  expect 2 "$*" run spring.yaml "$@"
  says err "$pattern" "why not $*"
}
refuses 'neither symplectic' --tolerance 1e-6
refuses 'spring has none' --project
refuses 'spring has none' --events no.csv
refuses 'wants 2 finite numbers' --momenta 1
refuses 'has no column' --columns z
refuses "no parameter 'kk'; did you mean k" --set kk=1
refuses "'idle' is set, but nothing in the scene mentions it" --set idle=2
refuses "'x' is no finite number" --set far=x
refuses 'x0=3 places the start, which --resume replaces' --resume spring.state --set x0=3
expect 1 'another system' run spring.yaml --resume spring.state --set k=2
expect 0 'check' check spring.yaml
says out '^idle: nothing in the scene mentions it' 'what has no use is told'

# No command writes over its scene.
cp ball.yaml kept.yaml
ln -s ball.yaml link.svg
for line in 'run ball.yaml --out ./ball.yaml' 'run ball.yaml --events ball.yaml' \
  'run ball.yaml --checkpoint ball.yaml' 'run ball.yaml --plot link.svg' \
  'order ball.yaml --csv ball.yaml' 'order ball.yaml --plot link.svg' \
  'bench ball.yaml --csv ball.yaml' 'bench ball.yaml --plot link.svg' \
  'bench ball.yaml --at 1e-6 --at-csv ball.yaml' \
  'path ball.yaml --method midpoint --ends initial --steps 2 --out ball.yaml' \
  'sweep ball.yaml --set g=1,2 --out ball.yaml' 'emit-c ball.yaml --out ball.yaml'; do
  # shellcheck disable=SC2086
  expect 2 "over the scene: $line" $line
  says err 'would write over the scene' "$line"
done
echo mine >other.yaml
expect 2 'over a scene that it may include' run ball.yaml --out other.yaml
says err 'would write over another scene' 'the reason'
[ "$(cat other.yaml)" = mine ] || fail 'another scene was overwritten'
expect 1 'an example over the scene' init ball.yaml
same ball.yaml kept.yaml 'the scene stays'
no_trace 'scenes'
# Differences near a singularity are taken over steps that do not reach it.
for x in 0.994 0.98; do
  cat >satellite.yaml <<END
parameters: {mu: 0.012277471}
coordinates: {x: scalar, y: scalar}
lagrangian: ((x' - y)^2 + (y' + x)^2)/2 + (1-mu)/hypot(x+mu,y) + mu/hypot(x-1+mu,y)
initial: {x: $x, y: 0, y': -2.00158510637908}
method: galerkin:degree=6
step: 0.001
until: 0.01
END
  expect 0 "a singularity near $x" check satellite.yaml
done
sed "s/^lagrangian: .*/lagrangian: (1 + x^2)*x'^2 + y'^2/" satellite.yaml >general.yaml
expect 2 'a base that does not serve' run general.yaml --method composition:order=4 --final
says err 'composition: choose another base=, this one does not serve: verlet: ' \
  'a base that does not serve'

finish
