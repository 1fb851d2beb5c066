#!/bin/sh
# dvi bench: columns, peers, notes, asked errors, sizes.  Usage: test_bench.sh DVI
. "$(dirname "$0")/check.sh"

expect 0 'methods and peers' bench kepler --method verlet --method galerkin:degree=4 \
  --against cvode,arkode,ida --rounds 1 --levels 3 \
  --csv - --plot bench.svg
# The first seven are older than the rest: programs that read them by place shall go on.
header=integrator,problem,setting,error,energy_error,cpu_seconds,evaluations,cpu_lower,cpu_upper
header=$header,steps,create_seconds,calibration_seconds,calibration_least
[ "$(head -n 1 out)" = $header ] || fail 'header'
awk -F, 'NF != 13' out | grep -q . && fail 'every row has 13 fields'
grep -q ' $' err && fail 'no blanks at the end of a line'
grep -qi 'nan\|inf' out && fail 'every field is a number'
[ "$(grep -c '^verlet,kepler,h=' out)" -eq 3 ] || fail 'three steps of verlet'
for peer in cvode-adams arkode ida; do
  [ "$(grep -c "^$peer,kepler,tol=" out)" -ge 3 ] || fail "several tolerances of $peer"
done
awk -F, 'NR > 1 && !($4 > 0 && $5 > 0 && $6 > 0 && $7 > 0 && $10 > 0)' out | grep -q . &&
  fail 'errors, times and counts are positive'
awk -F, 'NR > 1 && !($8 > 0 && $8 <= $6 && $6 <= $9)' out | grep -q . &&
  fail 'the median lies between the quartiles'
# Creation is a part of a job; a peer is created and run in one call.
awk -F, 'NR > 1 && $3 ~ /^h=/ && !($11 > 0 && $11 < $9)' out | grep -q . &&
  fail 'creation takes a part of the time'
awk -F, 'NR > 1 && $3 ~ /^tol=/ && $11 != ""' out | grep -q . &&
  fail 'creation of a peer is not known'
awk -F, 'NR > 1 && !($13 > 0 && $13 <= $12)' out | grep -q . &&
  fail 'the calibration stands in every row'
# verlet takes the steps it is given: the end of this study is t = 10.
awk -F, \
  '$1 == "verlet" { split($3, h, "="); if (h[2] * $10 < 9.999 || h[2] * $10 > 10.001) print }' out |
  grep -q . && fail 'steps of verlet'
# A tolerance a thousand times smaller gives a smaller error, so the setting is obeyed.
awk -F, '$1 == "ida" && $3 == "tol=1e-04" { a = $4 }
  $1 == "ida" && $3 == "tol=1e-10" { b = $4 }
  END { exit !(b < a / 100) }' out ||
  fail 'IDA obeys its tolerance'
says err '^SUNDIALS [0-9.]* from /.*: \(compiled with\|not known whether\)' 'how it was compiled'
says err 'judge at t' 'the judge'
says err '^processor: .' 'the processor'
says err '^compiler: .*-ffp-contract=off' 'the compiler and its flags'
says err '^libraries: dvi [0-9.]*, SUNDIALS [0-9]' 'the libraries'
says err '^calibration: 1e8 dependent multiplications in [0-9.]* s (least [0-9.]*, quartiles' \
  'the calibration'
if command -v gnuplot >/dev/null; then says bench.svg '</svg>' 'the plot is whole'; fi

expect 0 'the selection on a general Lagrangian' bench double-pendulum --rounds 1 --levels 2 \
  --csv bench.csv
says out 'Speed against error on double-pendulum' 'for people'
says bench.csv '^galerkin' 'the file has the rows'
grep -q '^verlet' bench.csv && fail 'verlet cannot run here'
expect 0 'rotations' bench free-body --method lie-verlet --method lie-galerkin \
  --against cvode,arkode,ida --rounds 1 --levels 2
expect 0 'the selection on rotations' bench spherical-double-pendulum --rounds 1 --levels 2
expect 0 'sizes of a chain of directions' bench spherical-chain --method lie-verlet --scale n=4,8 \
  --rounds 1
expect 0 'an ensemble of bodies' bench free-body --method lie-verlet --scale members=4 --rounds 1
expect 0 'one on a sphere' bench spherical-constrained --method verlet --scale members=4 --rounds 1
expect 2 'verlet, asked for' bench double-pendulum --method verlet
expect 2 'a method twice' bench kepler --method verlet --method verlet
expect 1 'no folder' bench kepler --method verlet --csv nowhere/a.csv

# Asked errors. The kinds of answers depend on errors alone; only which settings lie on the frontier
# depends on the clock.
expect 0 'asked errors' bench kepler --method verlet --method galerkin:degree=4 --rounds 2 \
  --levels 4 --csv all.csv --at 1e-5,1e-20,1e3 --at-csv at.csv
header=asked_error,problem,judged,integrator,cpu_seconds,ratio,evaluations,answer,create_seconds
header=$header,calibration_seconds,calibration_least
[ "$(head -n 1 at.csv)" = $header ] || fail 'header of asked errors'
[ "$(awk -F, 'NF == 11' at.csv | wc -l)" -eq 7 ] || fail 'two integrators at three errors'
[ "$(grep -c ',no,.*,,,,not reached,,' at.csv)" -eq 2 ] ||
  fail '1e-20 is neither reached nor judged'
[ "$(awk -F, '$1 == 1000 && $3 == "yes" && $8 == "at most"' at.csv | wc -l)" -eq 2 ] ||
  fail 'of 1e3 the cheapest settings are bounds'
grep -q ',yes,verlet,,,,not reached,,' at.csv || fail 'verlet does not reach 1e-5 in four levels'
grep '^1[.0-9]*e-05,.*,galerkin' at.csv | awk -F, '!($5 > 0 && $6 == 1 && $7 > 0)' | grep -q . &&
  fail 'who is alone is the fastest'
awk -F, 'NR > 1 && !($8 <= $6 && $6 <= $9)' all.csv | grep -q . &&
  fail 'the median of two rounds lies between the quartiles'
awk -F, 'NR > 1 && $8 < $6 && $6 < $9' all.csv | grep -q . ||
  fail 'two rounds never take the same time to the last nanosecond, in no setting'
# Evaluations are interpolated between the two settings of galerkin around 1e-5 (each level is
# better and dearer than the one before).
awk -F, 'FNR == NR { if ($1 ~ /^galerkin/) { e[++n] = $4; c[n] = $7 } next }
         $4 ~ /^galerkin/ && $1 < 1.1e-5 && $1 > 0.9e-5 {
           for (k = 1; k < n; k++) if (e[k] > $1 && e[k + 1] <= $1) {
             part = log($1 / e[k + 1]) / log(e[k] / e[k + 1])
             wanted = c[k + 1] * (c[k] / c[k + 1]) ^ part
             seen = 1
             if ($7 < 0.999999 * wanted || $7 > 1.000001 * wanted) print "evaluations", $7, wanted
           }
         }
         END { if (!seen) print "no neighbours" }' all.csv at.csv | grep . &&
  fail 'evaluations at 1e-5'
says out '^At an error of 1e-5$' 'for people'
grep -q ' $' out && fail 'no blanks at the end of a line'
says out "^At an error of 1e-20: .* not to be trusted" 'what the judge cannot tell'
# verlet, of order 2, needs more levels for 1e-5 than the six that it gets at first: they end at
# 2.6e-5.
expect 0 'asked errors without levels' bench kepler --method verlet --rounds 1 --csv - \
  --at 1e-4,1e-5 --at-csv at.csv
[ "$(grep -c '^verlet' out)" -gt 6 ] || fail 'more than six levels'
awk -F, 'NR > 1 { if ($4 > 1e-5) more++; else less++ } END { exit less != 1 || more < 6 }' out ||
  fail 'levels end with the first that is good enough'
grep -q ',not reached,' at.csv && fail 'both are reached'
expect 0 'asked errors to standard output' bench kepler --method verlet --rounds 1 --levels 2 \
  --at 1 --at-csv -
[ "$(wc -l <out)" -eq 2 ] || fail 'nothing but the table'
says err '^Speed against error' 'the words are elsewhere'
for bad in 0 -1 x nan inf '' , 1e-3, ,1e-3 1e-3,,1e-4 1e-3,0.001 1e-3,x 1e-3x; do
  expect 2 "at '$bad'" bench kepler --method verlet --at "$bad"
done
says err "not '1e-3x'" 'which number makes no sense'
expect 2 '--steps 1000001 is too many, 1000000 are possible' bench kepler --method verlet \
  --scale degree=1,2 --steps 1000001
expect 2 'too many errors' bench kepler --at "$(seq -s, 40)"
expect 2 'at-csv alone' bench kepler --method verlet --at-csv a.csv
expect 2 'two tables on one output' bench kepler --method verlet --at 1e-3 --csv - --at-csv -
expect 2 'two tables in one file' bench kepler --method verlet --at 1e-3 --csv a.csv \
  --at-csv ./a.csv
expect 1 'asked errors, no folder' bench kepler --method verlet --at 1e-3 --at-csv nowhere/a.csv
[ ! -e a.csv ] || fail 'a refused command wrote'

# All judges find the same error of one run, up to their own errors.
judged() {
  expect 0 "judge $1" bench kepler --t-end 30 --method galerkin:degree=4 --levels 3 --rounds 1 \
    --judge "$1" --csv -
  cut -d, -f3-4 out >"by_$1"
}
judged exact
says err 'judge at t = 30: exact solution, error' 'judge exact'
judged runs
runs='two runs of galerkin, degree 16 in [0-9]* steps and degree 12 in [0-9]*'
says err "judge at t = 30: $runs, error [0-9.]*e-1[0-9]\$" 'judge runs'
judged auto
says err 'judge at t = 30: exact solution' 'judge auto'
for other in runs auto; do
  paste -d, by_exact by_$other |
    awk -F, 'NR > 1 && !($1 == $3 && $2 - $4 < 1e-10 && $4 - $2 < 1e-10)' | grep -q . &&
    fail "judges exact and $other agree"
done
expect 0 'judge ida' bench kepler --t-end 1 --method verlet --levels 1 --rounds 1 --judge ida
says out 'judge at t = 1: IDA, run at two tolerances, error' 'judge ida'
expect 0 'a long span' bench fpu --t-end 200 --method galerkin:degree=6 --levels 1 --rounds 1
says out 'judge at t = 200: stored quadruple-precision result, error 5' 'digits of a long span'
expect 0 'IDA is not good enough' bench double-pendulum --t-end 10 --method galerkin:degree=8 \
  --levels 1 --rounds 1 --at 1e-9
witness='(IDA, of error [0-9.]*e-[01][0-9], is [0-9.]*e-[01][0-9] away)'
says out "two runs of galerkin, .* $witness, error [0-9.]*e-1[1-9]\$" 'which runs took its place'
grep -q 'not to be trusted' out && fail 'the runs can judge 1e-9'
expect 0 'IDA is good enough' bench double-pendulum --t-end 5 --method galerkin:degree=8 \
  --levels 1 --rounds 1 --at 1e-3
says out 'judge at t = 5: IDA, run at two tolerances, error' 'who stays'
# Roundoff decides whether steps of 0.4 are solved. A level that fails from a start disturbed in its
# last place is too rough on every machine.
for t in 4.58 4.86 4.88 5.12 5.24 5.44; do
  expect 0 "levels at the edge of what can be solved, t-end $t" bench double-pendulum --t-end $t \
    --method galerkin:degree=8 --levels 1 --rounds 1 --at 1e-3
  grep -q '^ *h=' out || fail "a level for t-end $t"
done
# Degree 16 is not judged by itself alone: the other run's distance is always left.
expect 0 'degree 16' bench pendulum --t-end 20 --method galerkin:degree=16 --levels 6 --rounds 1 \
  --judge runs --csv -
awk -F, 'NR > 1 && !($4 > 0)' out | grep -q . && fail 'no error is zero'
expect 2 'no exact solution' bench fpu --method verlet --judge exact
says err 'no known exact solution' 'no exact solution'
expect 2 'no digits at this end' bench fpu --method verlet --judge stored --t-end 3
expect 2 'no digits for these parameters' bench fpu --method verlet --judge stored --t-end 200 \
  --set ell=4
expect 1 'a judge that fails' bench pythagorean --t-end 60 --method verlet --levels 1 --rounds 1 \
  --judge runs
says err 'the judge, --judge runs, failed on pythagorean to t = 60:' 'who failed'
expect 2 'nobody' bench fpu --method verlet --judge run
says err "did you mean 'runs'" 'nobody'

# Callbacks of the one-point shape give the same digits and counts.
for shape in '' --one-point; do
  # shellcheck disable=SC2086
  expect 0 "shape '$shape'" bench double-pendulum --method galerkin:degree=3 --levels 3 --rounds 1 \
    --against cvode --csv - $shape
  cut -d, -f1-5,7,10 out >"shape$shape"
done
says err '^callbacks: one point a call' 'the shape is said'
same shape shape--one-point 'shapes'
expect 0 'sizes by one point' bench fpu --method galerkin --scale ell=5,50 --rounds 1 --one-point
says out '^callbacks: one point a call' 'the shape is said with sizes'

# Bare loops have the settings of their methods. Their errors are about the same, down to the floor
# of plain sums. At the smallest steps, which need no other solver, they have about the same
# evaluations. fpu's stiff springs are iterated in a bare loop, but not by galerkin.
bare_beside() {
  expect 0 "bare on $*" bench "$@" --levels 3 --rounds 1 --against bare --csv -
  says err '^galerkin:degree=[0-9]* over bare:degree=[0-9]* at equal steps.*: [0-9.]* (least' \
    "the ratio on $*"
  awk -F, -v most="$most" '
    $1 ~ /^galerkin/ { sub(/galerkin/, "bare", $1); error[$1 $3] = $4; count[$1 $3] = $7 }
    $1 ~ /^bare/ { d = $4 - error[$1 $3]; m = $7 / count[$1 $3]; many[$1] = m; found++
      if (d > 0.02 * $4 + 1e-10 || d < -0.02 * $4 - 1e-10 || !($6 > 0 && $11 > 0)) bad++ }
    END { for (name in many) if (many[name] > most || many[name] < 0.98) bad++
      exit bad || found < 2 }' out || { fail "bare loops on $*"; cat out; }
}
most=1.02
bare_beside kepler --t-end 40 --method galerkin:degree=8 --method galerkin:degree=3 \
  --method verlet
bare_beside kepler --t-end 40 --method galerkin:degree=16 --one-point
bare_beside outer-solar --t-end 20000 --method galerkin:degree=8 --at 1e-8
most=5
bare_beside fpu --t-end 5 --method galerkin:degree=8
expect 0 'bare without a method of its kind' bench kepler --method verlet --levels 1 --rounds 1 \
  --against bare
says err 'left out bare: no method here is galerkin:degree=S alone' 'which methods bare is beside'
expect 0 'bare with other degrees of freedom' bench double-pendulum --method galerkin:degree=4 \
  --levels 1 --rounds 1 --against bare
says err 'left out bare: it is for constant masses' 'which problems bare is for'
expect 2 'bare twice' bench kepler --method verlet --against bare,ida,bare
expect 2 'an unknown peer' bench kepler --method verlet --against cvod
expect 2 'a peer twice' bench kepler --method verlet --against cvode,cvode-adams
expect 0 'axes' bench kepler --method verlet --against ida --levels 2 --rounds 1 --plot axes.svg \
  --axes energy_error:evaluations --axes error:steps
if command -v gnuplot >/dev/null; then
  says axes.svg 'evaluations against energy_error: kepler, to t = 10' 'the first panel'
  [ "$(grep -c '<text>ida<' axes.svg)" -eq 2 ] || fail 'each panel names the peer'
fi
expect 2 'axes of a column of text' bench kepler --plot a.svg --axes setting:error
says err "column 'setting' has no numbers" 'which column is text'
# Tolerances below 1e-12 follow if the asked error wants them.
expect 0 'more tolerances' bench kepler --method verlet --levels 1 --rounds 1 \
  --against arkode,cvode --at 1e-10 --csv -
[ "$(grep -c '^arkode' out)" -eq 5 ] || fail 'arkode needs no more'
[ "$(grep -c '^cvode-adams' out)" -gt 5 ] || fail 'cvode needs more'

# Sizes.
expect 0 'sizes' bench fpu --method verlet --method galerkin:degree=2 --scale ell=5,50,10 \
  --rounds 1 --csv - --plot scale.svg
header=method,problem,parameter,value,n,h,step_seconds,step_lower,step_upper,bytes,create_seconds
header=$header,first_seconds,step_evaluations,step_residuals,step_factorizations
header=$header,calibration_seconds,calibration_least
[ "$(head -n 1 out)" = $header ] || fail 'header of sizes'
[ "$(awk -F, 'NF == 17' out | wc -l)" -eq 7 ] || fail 'two methods at three sizes'
awk -F, 'NR > 1 && !($5 == 2 * $4 && $7 > 0 && $8 <= $7 && $7 <= $9 && $11 > 0 && $12 > 0 &&
  $13 > 0)' out | grep -q . &&
  fail 'two coordinates to a spring, times, counts'
awk -F, 'NR > 1 && $6 != 0.005' out | grep -q . && fail "the problem's own step"
# verlet evaluates once a step, and once at the start; 32 steps are counted.
awk -F, '$1 == "verlet" && $13 * 32 != 33' out | grep -q . && fail 'evaluations of verlet'
# The heap is not known under a sanitizer; where it is, more coordinates take more.
bytes() { awk -F, -v ell="$1" '$1 == "verlet" && $4 == ell { print $10 }' out; }
[ -z "$(bytes 5)" ] || [ "$(bytes 50)" -gt "$(bytes 5)" ] || fail 'bytes grow'
says err '^processor: .' 'sizes: the processor'
says err '  step_seconds ~ n^[-0-9.]*' 'the exponent of time'
says err 'step_evaluations ~ n^-\{0,1\}0.00' \
  'the exponent of evaluations: verlet takes as many for any size'
if command -v gnuplot >/dev/null; then says scale.svg '</svg>' 'the plot of sizes is whole'; fi
expect 0 'sizes for people' bench fpu --method verlet --scale ell=5,50 --set omega=10 --h 0.01 \
  --rounds 1
says out '^Cost of a step on fpu' 'sizes for people'
for bad in ell ell= =5,6 ell=5 ell=5, ell=5,5 ell=5,x ell=5,-6 ell=5,0 ell=5.5,6 ll=5,6 \
  ell=5,1e99; do
  expect 2 "scale $bad" bench fpu --method verlet --scale "$bad"
done
expect 2 'a parameter that is no size' bench kepler --method verlet --scale e=0.1,0.2
says err 'e=0.1 and at e=0.2 alike' 'why it is no size'
expect 2 'sizes without a method' bench fpu --scale ell=5,6
expect 2 'a size that is set' bench fpu --method verlet --scale ell=5,6 --set ell=7
expect 2 'sizes with a wrong method' bench fpu --method verlett --scale ell=5,6
for other in '--at 1e-3' '--against ida' '--judge runs' '--levels 3' '--t-end 1' '--h 0' \
  '--plot a.svg --axes n:bytes'; do
  # shellcheck disable=SC2086
  expect 2 "sizes with $other" bench fpu --method verlet --scale ell=5,6 $other
done
# Members.
expect 0 'members' bench kepler --method verlet --method galerkin:degree=2 \
  --scale members=1,16,100 --rounds 1 --csv - --plot members.svg
header=method,problem,members,n,h,step_seconds,step_lower,step_upper,alone_seconds,alone_lower
header=$header,alone_upper,gain,step_evaluations
[ "$(head -n 1 out)" = $header ] || fail 'header of members'
[ "$(awk -F, 'NF == 13' out | wc -l)" -eq 7 ] || fail 'two methods with three numbers of members'
awk -F, 'NR > 1 && !($4 == 2 && $5 == 0.05 && $6 > 0 && $7 <= $6 && $6 <= $8 && $9 > 0 &&
  $10 <= $9 && $9 <= $11 && $12 > 0)' out | grep -q . &&
  fail 'times of members'
# 64 steps, a gradient for each, two more at the start.
awk -F, '$1 == "verlet" && $13 * 64 != 66' out | grep -q . && fail 'evaluations of members'
says err "^Cost of a member's step on kepler" 'members: the words are elsewhere'
if command -v gnuplot >/dev/null; then says members.svg '</svg>' 'the plot of members is whole'; fi
expect 0 'one number of members, for people' bench pendulum --method midpoint --scale members=8 \
  --set q0=1 --h 0.05 --rounds 1
says out '^gain: alone_seconds over step_seconds' 'members for people'
expect 0 'members on a one-form' bench lotka-volterra --method dg --scale members=2,8 --rounds 1 \
  --steps 20
for bad in '' 0 -1 1.5 x 4, 8,8 2000000; do
  expect 2 "members=$bad" bench kepler --method verlet --scale "members=$bad"
done
expect 2 'members without a method' bench kepler --scale members=4
expect 2 'members of a wrong problem' bench keppler --method verlet --scale members=4
expect 2 'members of a method that cannot' bench double-pendulum --method verlet --scale members=4
expect 1 'members that fail' bench kepler --method midpoint --set e=0.6 --h 0.3 --scale members=4 \
  --rounds 1

# Degrees: a key of every method. A residual of degree s with Gauss' quadrature evaluates at s
# points.
expect 0 'degrees' bench kepler --method galerkin --method composition:order=4,base=galerkin \
  --scale degree=1,4,2 --rounds 1 --csv - --plot scale.svg
[ "$(grep -c '^galerkin,kepler,degree,[142],2,' out)" -eq 3 ] || fail 'three degrees'
[ "$(grep -c '^"composition:order=4,base=galerkin",kepler,degree,' out)" -eq 3 ] ||
  fail 'three degrees of the base'
awk -F, '$1 == "galerkin" && !($14 > 0 && $13 == $4 * $14 && $15 == 0)' out | grep -q . &&
  fail 'evaluations and residuals of fixed point iteration'
says err '  step_seconds ~ degree^[-0-9.]*  bytes ~ .*  step_evaluations ~ degree^0' \
  'exponents of the degree'
if command -v gnuplot >/dev/null; then says scale.svg '</svg>' 'the plot of degrees is whole'; fi
expect 0 'factorisations' bench fpu --method galerkin:solver=newton --scale degree=1,2 --rounds 1 \
  --csv -
awk -F, '$1 ~ /^galerkin/ && !($15 > 0)' out | grep -q . && fail "factorisations of Newton's method"
for bad in degree=2,2.5 degree=1,200 degree=2 degree=2,2; do
  expect 2 "scale $bad" bench kepler --method galerkin --scale "$bad"
done
expect 2 'a degree that is given' bench kepler --method galerkin:degree=3 --scale degree=1,2
says err 'degree is given twice' 'why it is refused'
expect 2 'a method without degrees' bench kepler --method verlet --scale degree=1,2
expect 2 'a specification too long for a key' bench kepler \
  --method "galerkin:$(printf '%0600d' 0)" --scale degree=1,2

# The long steps of the first levels are solved, along the branch from h = 0.
expect 0 'levels of long steps' bench double-pendulum --t-end 20 --method galerkin:degree=8 \
  --rounds 1 --judge ida
grep -q 'left out galerkin' err && fail 'every level can be solved'
expect 2 'h without sizes' bench kepler --method verlet --h 0.1

# Threads, steps, and the traffic of temporal blocking: 120 bytes a coordinate.
expect 0 'threads' bench chain --set n=20000 --method verlet --method composition:order=4 \
  --scale threads=1,2 --steps 3 --rounds 2 --csv - --plot threads.svg
awk -F, 'NR > 1 && !($3 == "threads" && $5 == 20000 && $7 > 0 && $8 <= $7 && $7 <= $9)' out |
  grep -q . && fail 'threads: rows'
[ "$(awk -F, '$1 == "verlet" { print $4, $13 * 3 }' out | tr '\n' ' ')" = '1 4 2 4 ' ] ||
  fail 'one gradient a step, one at the start, on any number of threads'
says err '^  speed-up against threads=1:  [0-9.]*$' 'the speed-up'
rate='[0-9.]* GB/s: [0-9.]* of the [0-9.]* GB/s of an in-place axpy'
says err "^  threads=2: a step moves 2.4e+06 bytes, $rate" 'the traffic'
says err '^step_seconds: elapsed time of a step, mean of the first 3' 'which time'
grep -q 'step_seconds ~\|exponents' err && fail 'of threads there are no exponents'
if command -v gnuplot >/dev/null; then
  says threads.svg 'elapsed time of a step against threads: chain' 'the plot of threads'
fi
expect 0 'the traffic of waves alone' bench chain --method verlet --method verlet:blocking=none \
  --scale n=5,50 --steps 2 --rounds 1
[ "$(grep -c 'a step moves' out)" -eq 2 ] || fail 'a plain sweep does not know its traffic'
says out '^step_seconds: process time of a step, mean of the first 2' 'sizes: which time'
expect 2 'threads where there is no wave' bench fpu --method verlet --scale threads=1,2
says err 'no gradient_range' 'why there is none'
expect 2 'threads of a method without' bench chain --method midpoint --scale threads=1,2
for bad in threads=1,1.5 threads=1 threads=0,1 threads=1,65; do
  expect 2 "scale $bad" bench chain --method verlet --scale "$bad"
done
expect 2 'threads twice' bench chain --method verlet:threads=2 --scale threads=1,2
expect 2 'steps without sizes' bench chain --method verlet --steps 3
expect 2 'no steps' bench chain --method verlet --scale n=5,50 --steps 0
no_trace 'bench'
finish
