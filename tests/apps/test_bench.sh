#!/bin/sh
# dvi bench: columns, peers, notes, asked errors, sizes.  Usage: test_bench.sh DVI
. "$(dirname "$0")/check.sh"

expect 0 'methods and peers' bench kepler --method verlet --method galerkin:degree=4 --against cvode,arkode,ida --rounds 1 --levels 3 \
  --csv - --plot bench.svg
# The first seven are older than the rest: programs that read them by place shall go on.
[ "$(head -n 1 out)" = integrator,problem,setting,error,energy_error,cpu_seconds,evaluations,cpu_lower,cpu_upper,steps ] || fail 'header'
awk -F, 'NF != 10' out | grep -q . && fail 'every row has 10 fields'
grep -qi 'nan\|inf' out && fail 'every field is a number'
[ "$(grep -c '^verlet,kepler,h=' out)" -eq 3 ] || fail 'three steps of verlet'
for peer in cvode-adams arkode ida; do
  [ "$(grep -c "^$peer,kepler,tol=" out)" -ge 3 ] || fail "several tolerances of $peer"
done
awk -F, 'NR > 1 && !($4 > 0 && $5 > 0 && $6 > 0 && $7 > 0 && $10 > 0)' out | grep -q . && fail 'errors, times and counts are positive'
awk -F, 'NR > 1 && !($8 > 0 && $8 <= $6 && $6 <= $9)' out | grep -q . && fail 'the median lies between the quartiles'
# verlet takes the steps it is given: the end of this study is t = 10.
awk -F, '$1 == "verlet" { split($3, h, "="); if (h[2] * $10 < 9.999 || h[2] * $10 > 10.001) print }' out | grep -q . && fail 'steps of verlet'
# A tolerance a thousand times smaller gives a smaller error: the setting does what it says.
awk -F, '$1 == "ida" && $3 == "tol=1e-04" { a = $4 } $1 == "ida" && $3 == "tol=1e-10" { b = $4 } END { exit !(b < a / 100) }' out ||
  fail 'IDA obeys its tolerance'
says err 'SUNDIALS [0-9].*Caution' 'the version and the caution'
says err 'judge at t' 'the judge'
says err '^processor: .' 'the processor'
says err '^compiler: .*-ffp-contract=off' 'the compiler and its flags'
says err '^libraries: dvi [0-9.]*, SUNDIALS [0-9]' 'the libraries'
says err '^calibration: 1e8 dependent multiplications in [0-9.]* s' 'the calibration'
if command -v gnuplot >/dev/null; then says bench.svg '</svg>' 'the plot is whole'; fi

expect 0 'the selection on a general Lagrangian' bench double-pendulum --rounds 1 --levels 2 --csv bench.csv
says out 'Speed against error on double-pendulum' 'for people'
says bench.csv '^galerkin' 'the file has the rows'
grep -q '^verlet' bench.csv && fail 'verlet cannot run here'
expect 2 'verlet, asked for' bench double-pendulum --method verlet
expect 2 'a method twice' bench kepler --method verlet --method verlet
expect 1 'no folder' bench kepler --method verlet --csv nowhere/a.csv

# Asked errors. The kinds of answers depend on errors alone; only which settings lie on the frontier depends on the clock.
expect 0 'asked errors' bench kepler --method verlet --method galerkin:degree=4 --rounds 2 --levels 4 --csv all.csv --at 1e-5,1e-20,1e3 --at-csv at.csv
[ "$(head -n 1 at.csv)" = asked_error,problem,judged,integrator,cpu_seconds,ratio,evaluations,answer ] || fail 'header of asked errors'
[ "$(awk -F, 'NF == 8' at.csv | wc -l)" -eq 7 ] || fail 'two integrators at three errors'
[ "$(grep -c ',no,.*,,,,not reached$' at.csv)" -eq 2 ] || fail '1e-20 is neither reached nor judged'
[ "$(grep -c ',yes,.*,at most$' at.csv)" -eq 2 ] || fail 'of 1e3 the cheapest settings are bounds'
grep -q ',yes,verlet,,,,not reached$' at.csv || fail 'verlet does not reach 1e-5 in four levels'
grep '^1[.0-9]*e-05,.*,galerkin' at.csv | awk -F, '!($5 > 0 && $6 == 1 && $7 > 0)' | grep -q . && fail 'who is alone is the fastest'
awk -F, 'NR > 1 && !($8 <= $6 && $6 <= $9)' all.csv | grep -q . && fail 'the median of two rounds lies between the quartiles'
awk -F, 'NR > 1 && $8 < $6 && $6 < $9' all.csv | grep -q . || fail 'two rounds never take the same time to the last nanosecond, in no setting'
# Evaluations are interpolated between the two settings of galerkin around 1e-5 (each level is better and dearer than the one before).
awk -F, 'FNR == NR { if ($1 ~ /^galerkin/) { e[++n] = $4; c[n] = $7 } next }
         $4 ~ /^galerkin/ && $1 < 1.1e-5 && $1 > 0.9e-5 {
           for (k = 1; k < n; k++) if (e[k] > $1 && e[k + 1] <= $1) {
             wanted = c[k + 1] * (c[k] / c[k + 1]) ^ (log($1 / e[k + 1]) / log(e[k] / e[k + 1])); seen = 1
             if ($7 < 0.999999 * wanted || $7 > 1.000001 * wanted) print "evaluations", $7, wanted } }
         END { if (!seen) print "no neighbours" }' all.csv at.csv | grep . && fail 'evaluations at 1e-5'
says out '^At an error of 1e-5$' 'for people'
says out "^At an error of 1e-20: .* not to be trusted" 'what the judge cannot tell'
# verlet, of order 2, needs more levels for 1e-5 than the six that it gets at first: they end at 2.6e-5.
expect 0 'asked errors without levels' bench kepler --method verlet --rounds 1 --csv - --at 1e-4,1e-5 --at-csv at.csv
[ "$(grep -c '^verlet' out)" -gt 6 ] || fail 'more than six levels'
awk -F, 'NR > 1 { if ($4 > 1e-5) more++; else less++ } END { exit less != 1 || more < 6 }' out || fail 'levels end with the first that is good enough'
grep -q ',not reached$' at.csv && fail 'both are reached'
expect 0 'asked errors to standard output' bench kepler --method verlet --rounds 1 --levels 2 --at 1 --at-csv -
[ "$(wc -l <out)" -eq 2 ] || fail 'nothing but the table'
says err '^Speed against error' 'the words are elsewhere'
for bad in 0 -1 x nan inf '' , 1e-3, ,1e-3 1e-3,,1e-4 1e-3,0.001 1e-3,x 1e-3x; do expect 2 "at '$bad'" bench kepler --method verlet --at "$bad"; done
says err "not '1e-3x'" 'which number makes no sense'
expect 2 'too many errors' bench kepler --at "$(seq -s, 40)"
expect 2 'at-csv alone' bench kepler --method verlet --at-csv a.csv
expect 2 'two tables on one output' bench kepler --method verlet --at 1e-3 --csv - --at-csv -
expect 2 'two tables in one file' bench kepler --method verlet --at 1e-3 --csv a.csv --at-csv ./a.csv
expect 1 'asked errors, no folder' bench kepler --method verlet --at 1e-3 --at-csv nowhere/a.csv
[ ! -e a.csv ] || fail 'a refused command wrote'

# Sizes.
expect 0 'sizes' bench fpu --method verlet --method galerkin:degree=2 --scale ell=5,50,10 --rounds 1 --csv - --plot scale.svg
[ "$(head -n 1 out)" = method,problem,parameter,value,n,h,step_seconds,step_lower,step_upper,bytes,step_evaluations ] || fail 'header of sizes'
[ "$(awk -F, 'NF == 11' out | wc -l)" -eq 7 ] || fail 'two methods at three sizes'
awk -F, 'NR > 1 && !($5 == 2 * $4 && $7 > 0 && $8 <= $7 && $7 <= $9 && $11 > 0)' out | grep -q . && fail 'two coordinates to a spring, times, counts'
awk -F, 'NR > 1 && $6 != 0.005' out | grep -q . && fail "the problem's own step"
# verlet evaluates once a step, and once at the start; 32 steps are counted.
awk -F, '$1 == "verlet" && $11 * 32 != 33' out | grep -q . && fail 'evaluations of verlet'
# The heap is not known under a sanitizer; where it is, more coordinates take more.
bytes() { awk -F, -v ell="$1" '$1 == "verlet" && $4 == ell { print $10 }' out; }
[ -z "$(bytes 5)" ] || [ "$(bytes 50)" -gt "$(bytes 5)" ] || fail 'bytes grow'
says err '^processor: .' 'sizes: the processor'
says err '  step_seconds ~ n^[-0-9.]*' 'the exponent of time'
says err 'step_evaluations ~ n^-\{0,1\}0.00' 'the exponent of evaluations: verlet takes as many for any size'
if command -v gnuplot >/dev/null; then says scale.svg '</svg>' 'the plot of sizes is whole'; fi
expect 0 'sizes for people' bench fpu --method verlet --scale ell=5,50 --set omega=10 --h 0.01 --rounds 1
says out '^Cost of a step on fpu' 'sizes for people'
for bad in ell ell= =5,6 ell=5 ell=5, ell=5,5 ell=5,x ell=5,-6 ell=5,0 ell=5.5,6 ll=5,6 ell=5,1e99; do
  expect 2 "scale $bad" bench fpu --method verlet --scale "$bad"
done
expect 2 'a parameter that is no size' bench kepler --method verlet --scale e=0.1,0.2
says err 'e=0.1 and at e=0.2 alike' 'why it is no size'
expect 2 'sizes without a method' bench fpu --scale ell=5,6
expect 2 'a size that is set' bench fpu --method verlet --scale ell=5,6 --set ell=7
expect 2 'sizes with a wrong method' bench fpu --method verlett --scale ell=5,6
for other in '--at 1e-3' '--against ida' '--levels 3' '--t-end 1' '--h 0'; do
  # shellcheck disable=SC2086
  expect 2 "sizes with $other" bench fpu --method verlet --scale ell=5,6 $other
done
# Members.
expect 0 'members' bench kepler --method verlet --method galerkin:degree=2 --scale members=1,16,100 --rounds 1 --csv - --plot members.svg
[ "$(head -n 1 out)" = method,problem,members,n,h,step_seconds,step_lower,step_upper,alone_seconds,alone_lower,alone_upper,gain,step_evaluations ] ||
  fail 'header of members'
[ "$(awk -F, 'NF == 13' out | wc -l)" -eq 7 ] || fail 'two methods with three numbers of members'
awk -F, 'NR > 1 && !($4 == 2 && $5 == 0.05 && $6 > 0 && $7 <= $6 && $6 <= $8 && $9 > 0 && $10 <= $9 && $9 <= $11 && $12 > 0)' out | grep -q . &&
  fail 'times of members'
# 64 steps, a gradient for each, two more at the start.
awk -F, '$1 == "verlet" && $13 * 64 != 66' out | grep -q . && fail 'evaluations of members'
says err "^Cost of a member's step on kepler" 'members: the words are elsewhere'
if command -v gnuplot >/dev/null; then says members.svg '</svg>' 'the plot of members is whole'; fi
expect 0 'one number of members, for people' bench pendulum --method midpoint --scale members=8 --set q0=1 --h 0.05 --rounds 1
says out '^gain: alone_seconds over step_seconds' 'members for people'
for bad in '' 0 -1 1.5 x 4, 8,8 2000000; do expect 2 "members=$bad" bench kepler --method verlet --scale "members=$bad"; done
expect 2 'members without a method' bench kepler --scale members=4
expect 2 'members of a wrong problem' bench keppler --method verlet --scale members=4
expect 2 'members of a method that cannot' bench double-pendulum --method verlet --scale members=4
expect 1 'members that fail' bench kepler --method midpoint --set e=0.6 --h 0.3 --scale members=4 --rounds 1
# Degree 8 finds no solution at the first steps of this span: the levels that can be solved are shown.
expect 0 'a level that cannot be solved' bench double-pendulum --t-end 20 --method galerkin:degree=8 --rounds 1
says err 'left out galerkin' 'which level'
expect 2 'h without sizes' bench kepler --method verlet --h 0.1
no_trace 'bench'
finish
