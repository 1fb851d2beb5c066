#!/bin/sh
# dvi resonance: peaks where theory has them, a bound, files, refusals.
# Usage: test_resonance.sh DVI
. "$(dirname "$0")/check.sh"

# Kicks -h/2 q before and after a turn by a = omega h have the trace 2 (cos a - h/(2 omega) sin a):
# largest in size, and beyond 2, at a = k pi - atan(h/(2 omega)). The instability is twice
# atan(h/(2 omega)) wide; the largest error of a finite run may be a tenth of that beside its
# middle.
search='resonance oscillators --method respa:substeps=exact --h 0.1 --t-end 1000'
search="$search --sweep omega=1:140"
# shellcheck disable=SC2086
{
expect 0 'four resonances' $search --grid 33 --csv all.csv --threads 1
awk '
  $4 + 0 > 1 && $3 == "DVI_OK" {
    k++
    s = atan2(0.1, 2*$1)
    a = 0.1*$1 - k*3.14159265358979 + s
    n += a*a <= (0.1*s + 0.1*$2)^2
  }
  END { exit k != 4 || n != 4 }' out ||
  { fail 'the peaks are where theory has them'; cat out; }
says all.csv '^omega,status,steps,t,error,growth$' 'the columns'
points=$(sed -n 's/ points of omega from 1 to 140, begun with 33.*//p' out)
[ "$(wc -l <all.csv)" -eq $((points + 1)) ] || fail 'all points are in the table'
[ "$points" -le 250 ] || fail "$points points were needed"
expect 0 'threads' $search --grid 33 --csv three.csv --threads 3
same all.csv three.csv 'the number of threads does not matter'
}
expect 0 'a flank' resonance oscillators --method respa:substeps=exact --h 0.1 --t-end 100 \
  --sweep omega=110:125 --grid 9
says out '^at the end 125 of the range the error still rises' 'what lies beyond'

# Verlet's substeps give the same peaks to 1e-4 of a half turn.
if [ -z "${DVI_TEST_FEWER:-}" ]; then
  expect 0 'substeps' resonance oscillators --method respa:substeps=100 --h 0.1 --t-end 1000 \
    --sweep omega=110:135 --grid 9 --width 0.003
  awk '
    $3 == "DVI_OK" {
      n++
      d = $1*0.1/3.14159265358979 - 3.99724
      good = d*d < 1e-8 && $4 > 1000 && $5 > 0.007
    }
    END { exit n != 1 || !good }' out ||
    { fail 'the fourth resonance'; cat out; }
fi

# No resonances.
flat='resonance oscillators --method imex --h 0.1 --t-end 1000 --sweep omega=0:141.4'
# shellcheck disable=SC2086
{
expect 0 'imex' $flat --bound 3e-3
says out '^no peaks$' 'flat'
says out '^bound 0.003: holds$' 'the bound'
expect 3 'a bound that is missed' $flat --bound 1e-3
says out '^bound 0.001: MISSED$' 'the word'
}

# The step as the swept parameter: Verlet is stable up to h omega = 2, and unbounded from there on.
cat >soft.yaml <<'END'
parameters: {k: 1}
coordinates: {x: scalar}
kinetic: x'^2/2
potentials: {spring: k*x^2/2}
initial: {x: 1}
method: verlet
step: 1
until: 2000
END
expect 0 'a scene, steps' resonance soft.yaml --sweep h=1.5:2.5 --grid 9 --width 1e-4
awk '/^unbounded/ { good = $6 > 2 && $6 < 2.002 } END { exit !good }' out || {
  fail 'where it ends to be stable'
  cat out
}

# Some points fail, and some sweeps have too few points.
expect 1 'too few points' resonance oscillators --method respa:substeps=exact --h 0.1 --t-end 100 \
  --sweep omega=1:140 --grid 33 --points 40
says err '40 points do not find all peaks' 'the reason'
expect 1 'points that fail' resonance kepler --method midpoint --sweep e=0.5:1.5 --grid 5 \
  --t-end 1 --csv kepler.csv
says kepler.csv ',refused,0,,,$' 'the word for it'
says err 'e=1.5: the problem cannot be made' 'which'
expect 1 'a run that fails at once has no error' resonance oscillator --method verlet --h 0.1 \
  --t-end 1 --sweep k=1e305:1e306 --grid 3 --points 5 --csv wide.csv
says wide.csv '^1e+306,DVI_NOT_FINITE,0,0,,$' 'its row'
[ "$(grep -c 'the largest error' out)" -eq 0 ] || fail 'there is no largest error'
expect 2 'a range that overflows' resonance oscillator --method verlet --h 0.1 --t-end 1 \
  --sweep k=1:1e308
says err 'the range is too wide' 'why'
expect 2 'no range' resonance oscillators --method imex
says err '\-\-sweep NAME=FROM:TO is missing' 'what is missing'
for wrong in omega omega= omega=1 omega=1:2:3 omega=2:1 omega=1:inf =1:2 omega=a:b; do
  expect 2 "range $wrong" resonance oscillators --method imex --sweep "$wrong"
done
expect 2 'an unknown parameter' resonance oscillators --method imex --sweep omeha=1:2
says err "did you mean 'omega'" 'the nearest'
expect 2 'an unknown invariant' resonance oscillators --method imex --sweep omega=1:2 --watch I_1
expect 2 'set twice' resonance oscillators --method imex --sweep omega=1:2 --set omega=1
expect 2 'backward' resonance oscillators --method imex --sweep h=0.1:0.2 --t-end -1
expect 2 'a step and steps' resonance oscillators --method imex --sweep h=0.1:0.2 --h 0.1
expect 2 'a grid of 2' resonance oscillators --method imex --sweep omega=1:2 --grid 2
expect 2 'a width of roundoff' resonance oscillators --method imex --sweep omega=1:2 --width 1e-16
expect 2 'one file' resonance oscillators --method imex --sweep omega=1:2 --csv a.svg --plot a.svg
no_trace 'all of these'
finish
