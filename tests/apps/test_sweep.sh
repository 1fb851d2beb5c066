#!/bin/sh
# dvi sweep: points, columns, failures, and that interrupted sweeps go on.  Usage: test_sweep.sh DVI
. "$(dirname "$0")/check.sh"
"$dvi" init cart.yaml
cart='sweep cart.yaml --t-end 2'

# lines FILE N NAME: require N lines.
lines() { [ "$(wc -l <"$1")" -eq "$2" ] || fail "$3: $(wc -l <"$1") lines instead of $2 in $1"; }

# alone FILE NAME: require that no rows of an unfinished sweep were left.
alone() { [ ! -e "$1.part" ] || fail "$2: $1.part was left behind"; }

# shellcheck disable=SC2086
{
# The section of a scene, and the options that replace it.
expect 0 'the section' $cart --threads 1 --out one.csv
lines one.csv 10 'three lengths, three masses'
says one.csv '^l,m,status,steps,t,x,theta,p_x,p_theta,energy,along_the_rail,height,energy_error$' \
  'the columns'
alone one.csv 'a complete sweep'
expect 0 'threads' $cart --threads 3 --out three.csv
same one.csv three.csv 'the number of threads does not matter'
expect 0 'a list' $cart --set m=0.2,0.3 --set g=1:2:3 --out list.csv
lines list.csv 19 'three lengths of the section, two masses, three of g'
[ "$(sed -n 2,5p list.csv | cut -d, -f1-3 | tr '\n' ' ')" = \
  '0.25,0.2,1 0.25,0.2,1.5 0.25,0.2,2 0.25,0.3,1 ' ] || fail 'the order of the points'
expect 0 'one point' $cart --set l=0.7 --set m=0.3 --out point.csv
expect 0 'its run' run cart.yaml --t-end 2 --set l=0.7 --set m=0.3 --final
[ "$(sed -n 2p point.csv | cut -d, -f5-12)" = "$(sed -n 2p out)" ] ||
  fail 'a row is the last one of dvi run'
expect 0 'the catalogue' sweep kepler --method galerkin:degree=4 --set e=0:0.6:3 --h 0.1 --t-end 1 \
  --out kepler.csv
lines kepler.csv 4 'three orbits'
expect 0 'its run' run kepler --method galerkin:degree=4 --set e=0.3 --h 0.1 --t-end 1 --final
[ "$(sed -n 3p kepler.csv | cut -d, -f4-10)" = "$(sed -n 2p out | cut -d, -f1-7)" ] ||
  fail 'a row of the catalogue is the last one of dvi run'

# Points that fail.
expect 1 'points that fail' sweep kepler --method midpoint --set e=0,0.5,2 --h 0.1 --t-end 1 \
  --out some.csv
says some.csv '^0.5,DVI_OK,10,1,' 'the others are there'
says some.csv '^2,refused,0,,,,,' 'the word for it'
says err '1 of 3 points failed' 'how many'
says err 'sweep: e=2: ' 'which'
alone some.csv 'a sweep with failures is complete'
cat >root.yaml <<'END'
parameters: {k: 1}
coordinates: {x: scalar}
lagrangian: x'^2/2 - k*sqrt(x)
initial: {x: 1}
method: verlet
step: 0.01
until: 5
END
expect 1 'a run that fails on its way' sweep root.yaml --set k=0,1 --out root.csv
says root.csv '^0,DVI_OK,500,5,1,0,' 'the other point'
says root.csv '^1,DVI_CALLBACK_RETRY,188,1.88' 'the last good state'
cat >family.yaml <<'END'
parameters: {N: 2}
coordinates: {"x[N]": scalar}
lagrangian: sum(i, x[i]'^2 - x[i]^2)/2
initial: {"x[i]": 1}
method: verlet
step: 0.1
until: 1
END
expect 1 'sizes' sweep family.yaml --set N=2,3 --out family.csv
says family.csv '^2,DVI_OK,' 'the size of the scene'
says err 'N=3: with these values the problem has other coordinates' 'the reason'

# An interrupted sweep keeps its complete rows, even if the last row is torn. These sweeps last long
# enough to be interrupted; under sanitizers the shorter one takes as long.
end=400
[ -z "${DVI_TEST_FEWER:-}" ] || end=40
long="sweep cart.yaml --set l=0.5 --set m=0.2 --set g=9:10:30 --t-end $end"
expect 0 'all at once' $long --out whole.csv
for signal in 15 9; do
  "$dvi" $long --threads 2 --out cut.csv 2>err &
  for _ in $(seq 200); do
    [ "$(cat cut.csv.part 2>/dev/null | wc -l)" -ge 4 ] && break
    sleep 0.02
  done
  kill "-$signal" $!
  ends $((128 + signal)) "signal $signal"
  [ -e cut.csv ] && fail "signal $signal: an unfinished sweep is not in place"
  printf '17 0 00' >>cut.csv.part
  expect 2 "signal $signal: another method" $long --method verlets --out cut.csv
  expect 1 "signal $signal: another step" $long --h 0.01 --out cut.csv
  says err 'was begun with another scene or other settings' 'the reason'
  sed 's/theta: 1$/theta: 1.5/' cart.yaml >other.yaml
  expect 1 "signal $signal: another scene" sweep other.yaml --set l=0.5 --set m=0.2 \
    --set g=9:10:30 --t-end $end --out cut.csv
  expect 0 "signal $signal: the same" $long --threads 1 --out cut.csv
  says err 'points are in .cut.csv.part. already' 'it went on'
  same cut.csv whole.csv "signal $signal: as if nothing had happened"
  alone cut.csv "signal $signal: the end"
  rm cut.csv
done

# The files of components belong to the scene.
cp cart.yaml part.yaml
cat >outer.yaml <<'END'
include: {a: part.yaml}
method: galerkin:degree=2
step: 0.02
until: 20
END
outer="sweep outer.yaml --set a_l=0.5 --set a_g=9:10:30 --t-end $end --out outer.csv"
# shellcheck disable=SC2086
"$dvi" $outer --threads 2 2>err &
for _ in $(seq 200); do
  [ "$(cat outer.csv.part 2>/dev/null | wc -l)" -ge 2 ] && break
  sleep 0.02
done
kill -15 $!
ends 143 'a sweep over a component'
sed -i 's/theta: 1$/theta: 1.5/' part.yaml
expect 1 'another component' $outer
says err 'was begun with another scene or other settings' 'the reason'
rm -f outer.csv.part

# A file that is no sweep's stays.
echo 'my notes' >notes.csv.part
expect 1 'a foreign file' $cart --out notes.csv
[ "$(cat notes.csv.part)" = 'my notes' ] || fail 'a foreign file was changed'

# On a full disk the rows that were found stay, and the sweep goes on when there is room.
(
  failures=0
  ulimit -f 2
  expect 1 'no room' $long --out full.csv
  says err 'cannot write .full.csv.part.' 'the reason'
  [ "$failures" -eq 0 ]
) || fail 'no room'
[ ! -e full.csv ] || fail 'an unfinished sweep is not in place'
expect 0 'room again' $long --out full.csv
same full.csv whole.csv 'after a full disk'

# Command lines that make no sense.
expect 2 'over the scene' $cart --out ./cart.yaml
expect 2 'no file' $cart
expect 2 'too wide' $cart --set l=-1e308:1e308:3 --out no.csv
says err 'l=-1e308:1e308:3: the range is too wide' 'which range'
expect 2 'standard output' $cart --out -
says err 'rows go to a file' 'why not standard output'
expect 2 'no method' sweep kepler --set e=0,0.1 --out no.csv
expect 2 'nothing to sweep' sweep kepler --method midpoint --out no.csv
expect 2 'an unknown name' $cart --set ll=1,2 --out no.csv
says err "did you mean 'l'" 'a hint'
for values in 1,,2 1:2 1:2:1 1:2:2.5 :1:2 a:b:c 1:inf:3 1:2:1e9; do
  expect 2 "values $values" $cart --set l=$values --out no.csv
done
expect 2 'a name twice' $cart --set l=1 --set l=2 --out no.csv
expect 2 'too many points' $cart --set l=0:1:10000 --set m=0:1:10000 --out no.csv
expect 2 'no step' $cart --h 0 --out no.csv
expect 2 'the wrong way' $cart --h -0.1 --out no.csv
expect 1 'no scene' sweep none.yaml --out no.csv
expect 1 'no folder' $cart --out none/no.csv
[ ! -e no.csv ] && [ ! -e no.csv.part ] || fail 'a file of a refused sweep'
}
no_trace 'sweep'
finish
