#!/bin/sh
# dvi bench: columns, peers, notes.  Usage: test_bench.sh DVI
. "$(dirname "$0")/check.sh"

expect 0 'methods and peers' bench kepler --method verlet --method galerkin:degree=4 --against cvode,arkode,ida --rounds 1 --levels 3 \
  --csv - --plot bench.svg
[ "$(head -n 1 out)" = integrator,problem,setting,error,energy_error,cpu_seconds,evaluations ] || fail 'header'
awk -F, 'NF != 7' out | grep -q . && fail 'every row has 7 fields'
grep -qi 'nan\|inf' out && fail 'every field is a number'
[ "$(grep -c '^verlet,kepler,h=' out)" -eq 3 ] || fail 'three steps of verlet'
for peer in cvode-adams arkode ida; do
  [ "$(grep -c "^$peer,kepler,tol=" out)" -ge 3 ] || fail "several tolerances of $peer"
done
awk -F, 'NR > 1 && !($4 > 0 && $6 > 0 && $7 > 0)' out | grep -q . && fail 'errors, times and counts are positive'
# A tolerance a thousand times smaller gives a smaller error: the setting does what it says.
awk -F, '$1 == "ida" && $3 == "tol=1e-04" { a = $4 } $1 == "ida" && $3 == "tol=1e-10" { b = $4 } END { exit !(b < a / 100) }' out ||
  fail 'IDA obeys its tolerance'
says err 'SUNDIALS [0-9].*Caution' 'the version and the caution'
says err 'judge at t' 'the judge'
if command -v gnuplot >/dev/null; then says bench.svg '</svg>' 'the plot is whole'; fi

expect 0 'the selection on a general Lagrangian' bench double-pendulum --rounds 1 --levels 2 --csv bench.csv
says out 'Speed against error on double-pendulum' 'for people'
says bench.csv '^galerkin' 'the file has the rows'
grep -q '^verlet' bench.csv && fail 'verlet cannot run here'
expect 2 'verlet, asked for' bench double-pendulum --method verlet
expect 1 'no folder' bench kepler --method verlet --csv nowhere/a.csv
no_trace 'bench'
finish
