#!/bin/sh
# dvi run: rows, files, checkpoints, signals, failures.  Usage: test_run.sh DVI
. "$(dirname "$0")/check.sh"
kepler='run kepler --method galerkin:degree=3 --h 0.125'

# shellcheck disable=SC2086
{
expect 0 'plain run' $kepler --t-end 4
cp out all.csv
says out '^t,x,y,p_x,p_y,energy,' 'header'
[ "$(wc -l <out)" -eq 34 ] || fail 'a header, the start and 32 steps are 34 lines'
awk -F, 'NF != 9' out | grep -q . && fail 'every row has 9 fields'
grep -qi 'nan\|inf' out && fail 'every field is a number'
says out '^4,' 'the end is the last row'
expect 0 'every' $kepler --t-end 4 --every 5
[ "$(cut -d, -f1 out | tr '\n' ' ')" = 't 0 0.625 1.25 1.875 2.5 3.125 3.75 4 ' ] ||
  fail 'every 5 steps, and the end'
expect 0 'final' $kepler --t-end 4 --final
{ head -n 1 all.csv; tail -n 1 all.csv; } >final.csv
same out final.csv 'final is the header and the last row'
expect 0 'out' $kepler --t-end 4 --out whole.csv
same whole.csv all.csv 'the file has what standard output has'
[ -s out ] && fail 'with --out, standard output is empty'
expect 0 'set' run kepler --method verlet --set e=0 --t-end 1 --final
says out '^1,0.540' 'with e = 0 the orbit is a circle'
expect 0 'backward' run kepler --method verlet --h -0.125 --t-end -4 --final
says out '^-4,' 'backward to -4'
expect 0 'a last, shorter step' $kepler --t-end 0.3 --final
says out '^0.29999999999999999,' 'the end is met'
expect 0 'no way to go' $kepler --t-end 0 --final

# Momenta of the start: with a one-form only p = alpha(q), or momenta that are projected onto it.
expect 0 'momenta' run kepler --method verlet --momenta 0,1 --t-end 0
says out '^0,.*,.*,0,1,' 'the momenta are the start'
expect 1 'off the constraint' run lotka-volterra --method vprk --momenta 1,2 --t-end 1
says err 'p\[1\] is 2, but the one-form has alpha = 1 there, 1 away' 'the distance is said'
says err '^dvi: run: --project moves the start onto the constraints$' 'the remedy is named'
expect 0 'on the constraint' run lotka-volterra --method vprk --t-end 1
cp out constrained.csv
expect 0 'projected' run lotka-volterra --method vprk --momenta 1,2 --project --t-end 1
same out constrained.csv 'a projected start is that of alpha(q)'
expect 2 'nothing to project' run kepler --method verlet --project
says err 'kepler has none' 'the reason is given'
for list in 1 1,2,3 1,x 1,inf '1;2'; do
  expect 2 "momenta $list" run kepler --method verlet --momenta "$list"
done
expect 2 'momenta of a resumed run' $kepler --resume any.state --momenta 0,1

# Rotations and directions: velocities before the momenta, and the distance from the manifold last.
# It is rounding, or the run says so.
expect 0 'a body' run free-body --method lie-galerkin --h 0.1 --t-end 10
invariants=energy,angular_momentum_x,angular_momentum_y,angular_momentum_z
says out "^t,R11,.*,R33,Omega1,Omega2,Omega3,Pi1,Pi2,Pi3,$invariants,distance\$" \
  'the columns of a body'
awk -F, 'NR > 1 && ($NF > 1e-14 || (3 * $11 - $14) ^ 2 > 1e-28) { bad = 1 } END { exit bad }' out ||
  fail 'Pi1 = J1 Omega1, and R is a rotation'
expect 0 'two bodies' run two-body --method lie-verlet --h 0.1 --t-end 1 --final
says out \
  '^t,R11_1,.*,x_1,y_1,z_1,R11_2,.*,z_2,Omega1_1,.*,v_z_2,Pi1_1,.*,p_z_2,energy,.*,distance$' \
  'the columns of two bodies'
expect 0 'directions' run spherical-chain --set n=2 --method lie-verlet --h 0.1 --t-end 1 --final
says out '^t,q1_x,q1_y,q1_z,q2_x,q2_y,q2_z,v_q1_x,.*,p_q2_z,energy,angular_momentum_z,distance$' \
  'the columns of directions'
expect 0 'off the manifold' run free-body --method lie-rk:scheme=explicit-midpoint --h 0.1 \
  --t-end 10 --final
awk -F, 'NR > 1 && $NF < 1e-4 { bad = 1 } END { exit bad }' out || fail 'the distance is told'
expect 2 'a method for R^n' run free-body --method galerkin
says err 'factors of its configuration space, which this method cannot use' \
  'refused with the reason'
expect 2 'an inertia of no body' run free-body --method lie-verlet --set J1=4
says err 'that of no body' 'refused with the reason'
expect 0 'half of a body' run free-body --method lie-galerkin --h 0.125 --t-end 1 \
  --checkpoint body.state
expect 0 'the other half' run free-body --method lie-galerkin --h 0.125 --t-end 2 \
  --resume body.state --final
cp out halves.csv
expect 0 'one piece' run free-body --method lie-galerkin --h 0.125 --t-end 2 --final
same out halves.csv 'two halves of a body are one piece'

# A method that chooses its steps has one more column, their lengths, and reports the energy on
# standard error.
expect 0 'sem' run kepler --method sem --set e=0.6 --h 0.01 --t-end 5
says out '^t,.*,laplace_y,h$' 'the lengths are the last column'
awk -F, \
  'NR > 2 { d = $1 - t - $NF; if (d > 1e-12 || d < -1e-12) bad = 1 } { t = $1 } END { exit bad }' \
  out || fail 'h is the distance of two rows'
says err 'run: no step was a fallback' 'no fallback is said'
says err 'ordinary step of given length' 'the last step is said to be an ordinary one'
expect 0 'sem with fallbacks' run kepler --method sem --set e=0.9 --h 0.001 --t-end 1 --final
says err 'run: [0-9]* fallbacks* to the least-squares step; the largest energy jump is' \
  'fallbacks and their jumps are said'
expect 2 'sem with a first step out of its bounds' run kepler --method sem:hmin=0.1 --h 0.01 \
  --t-end 1
says err 'the first step h = 0.01 is below hmin=0.1' 'the bound is named'
expect 2 'sem with bounds in the wrong order' run kepler --method sem:hmin=0.2,hmax=0.1 --h 0.15 \
  --t-end 1
expect 2 'sem away from the end' run kepler --method sem --h -0.1 --t-end 1
expect 0 'sem backward' run kepler --method sem --h -0.01 --t-end -5 --final
says out '^-5,' 'backward to -5'

# A run in two halves gives the same bits, for one method of each kind and for a general Lagrangian.
for pair in 'kepler verlet' 'kepler galerkin:degree=4' 'kepler composition:order=6,base=midpoint' \
  'double-pendulum galerkin:degree=2' \
  'fpu midpoint' 'toda trapezoidal'; do
  problem=${pair% *} method=${pair#* }
  expect 0 "one piece: $pair" run "$problem" --method "$method" --h 0.015625 --t-end 2 --every 3
  cp out one.csv
  expect 0 "first half: $pair" run "$problem" --method "$method" --h 0.015625 --t-end 1 --every 3 \
    --checkpoint half.state
  expect 0 "second half: $pair" run "$problem" --method "$method" --h 0.015625 --t-end 2 --every 3 \
    --resume half.state
  awk -F, 'NR > 2 && $1 > 1' one.csv >tail1.csv
  awk -F, 'NR > 2 && $1 > 1' out >tail2.csv
  [ "$(wc -l <tail1.csv)" -eq 22 ] || fail "rows of the second half: $pair"
  same tail1.csv tail2.csv "two halves are one piece: $pair"
done

# Checkpoints that are no good are refused, and nothing else happens.
expect 0 'checkpoint' $kepler --t-end 1 --checkpoint good.state --checkpoint-every 2 --final
echo old >old.csv
head -c 20 good.state >short.state
expect 1 'truncated checkpoint' $kepler --resume short.state --out old.csv
expect 1 'missing checkpoint' $kepler --resume missing.state --out old.csv
expect 1 'checkpoint of another problem' run toda --method galerkin:degree=3 --resume good.state \
  --out old.csv
expect 1 'checkpoint of another method' run kepler --method verlet --resume good.state --out old.csv
says err '.' 'a reason is given'
expect 0 'a checkpoint past the end by a rounding' $kepler --resume good.state \
  --t-end 0.9999999999999998 --final
expect 2 'checkpoint past the end' $kepler --resume good.state --t-end 0.5 --out old.csv
expect 2 'the same with the step of the problem' ${kepler% --h*} --resume good.state --t-end 0.5 \
  --out old.csv
says err "stands at t = 1, past --t-end 0.5; --h -[0-9.]* would lead back" 'how to go back'
[ "$(cat old.csv)" = old ] || fail 'a refused run leaves the old file'

# A step too large to solve: the message names the step, and the file stays.
expect 1 'numerical failure' run double-pendulum --method galerkin:degree=2 --h 0.3 --t-end 60 \
  --out old.csv
for word in 'step [0-9]' 't = [0-9]' 'residual [0-9]' 'try '; do
  says err "$word" 'failure names step, time, residual and remedy'
done
[ "$(cat old.csv)" = old ] || fail 'a failed run leaves the old file'

# The run names a file that cannot be written, and leaves no half-written file.
expect 1 'no folder' $kepler --out nowhere/a.csv
expect 1 'a folder as file' $kepler --out .
expect 1 'no folder for the checkpoint' $kepler --checkpoint nowhere/a
expect 1 'no folder for the plot' $kepler --plot nowhere/a.svg
( ulimit -f 8; "$dvi" $kepler --t-end 200 --out old.csv 2>err ) &&
  fail 'a file that outgrows its limit is a failure'
[ "$(cat old.csv)" = old ] || fail 'a file that outgrows its limit leaves the old one'
no_trace 'failures'
ln -s old.csv link.csv
expect 0 'through a link' $kepler --t-end 1 --out link.csv
[ -L link.csv ] && says old.csv '^1,' 'a link stays a link'
ln -s made.csv dangling.csv
expect 0 'through a link to nothing' $kepler --t-end 1 --out dangling.csv
[ -L dangling.csv ] || fail 'a dangling link stays a link'
[ ! -L made.csv ] && says made.csv '^1,' 'and what it names is made'
mkdir folder
ln -s ../made2.csv folder/up.csv
expect 0 'through a link from another folder' $kepler --t-end 1 --out folder/up.csv
[ -L folder/up.csv ] && says made2.csv '^1,' 'a link is read from its own folder'
ln -s nowhere/made.csv astray.csv
ln -s circle.csv circle.csv
expect 1 'a link into no folder' $kepler --t-end 1 --out astray.csv
expect 1 'a link to itself' $kepler --t-end 1 --out circle.csv
[ -L astray.csv ] && [ -L circle.csv ] || fail 'links that lead nowhere stay'
no_trace 'links'
if [ -w /dev/full ]; then
  expect 1 'full device as file' $kepler --t-end 4 --out /dev/full
  [ -c /dev/full ] || fail 'a device stays a device'
  code=0
  "$dvi" $kepler --t-end 1000 >/dev/full 2>err || code=$?
  [ "$code" -eq 1 ] || fail "full device: exit code $code"
  says err 'standard output' 'full device is named'
fi
# If the reader of a pipe goes away, the run ends soon and without a message.
{ "$dvi" $kepler --t-end 1e7 2>err; echo $? >code; } | head -n 2 >/dev/null
[ "$(cat code)" -eq 1 ] || fail "closed pipe: exit code $(cat code)"
[ -s err ] && fail 'a closed pipe is no news'

# Signals end a run after its step: output complete, checkpoint written, and the run can go on to
# the same bits.
for signal in INT:130 TERM:143 HUP:129; do
  # A background job of a script ignores SIGINT unless it takes it back, which dvi does.
  "$dvi" run kepler --method verlet --h 0.0078125 --t-end 1e6 --every 1000 --out cut.csv \
    --checkpoint cut.state 2>err &
  sleep 1
  kill -"${signal%:*}" $!
  ends "${signal#*:}" "$signal"
  says err 'resume' "$signal: the way on is named"
  [ "$(awk -F, 'END { print NF }' cut.csv)" -eq 9 ] || fail "$signal: the last row is whole"
  reached=$(tail -n 1 cut.csv | cut -d, -f1)
  until=$(awk "BEGIN { printf \"%.17g\", $reached + 16 }")
  expect 0 "$signal: resume" run kepler --method verlet --h 0.0078125 --t-end "$until" \
    --resume cut.state --final
  cp out resumed.csv
  expect 0 "$signal: in one piece" run kepler --method verlet --h 0.0078125 --t-end "$until" --final
  same out resumed.csv "$signal: same bits"
done
no_trace 'signals'
# A run that was started with SIGHUP ignored, as by nohup, goes on after the signal.
(
  trap '' HUP
  exec "$dvi" run kepler --method verlet --h 0.0078125 --t-end 1e6 --final --out kept.csv 2>err
) &
wait_for_part kept.csv
kill -HUP $!
sleep 0.3
kill -TERM $!
ends 143 'SIGHUP under nohup'
no_trace 'SIGHUP under nohup'
# While the plot is drawn, here by a program that takes long, the first Ctrl-C is noted and the
# second ends the run at once. Of SIGTERM one cause may send two.
mkdir slow
printf '#!/bin/sh\nexec sleep 3\n' >slow/gnuplot
chmod +x slow/gnuplot
PATH=$PWD/slow:$PATH "$dvi" run kepler --method verlet --t-end 5 --final --out drawn.csv \
  --plot drawn.svg 2>err &
wait_for_part drawn.svg
for signal in TERM TERM INT; do
  part_of drawn.svg || fail "the run had ended before $signal"
  kill -"$signal" $!
  sleep 0.2
done
ends 130 'a second signal'
says err 'second Ctrl-C' 'a second signal: it is said'
[ -e drawn.svg ] && fail 'a second signal: there is no plot'
no_trace 'a second signal'

# With a checkpoint, parameters that only place the start cannot be set. Those of the system can, if
# they have the same values.
for setting in 'kepler e=0.5' 'kepler e=0.6' 'pendulum q0=1'; do
  problem=${setting% *} parameter=${setting#* }
  expect 0 "a checkpoint of $problem" run "$problem" --method verlet --t-end 1 \
    --checkpoint start.state --final
  expect 2 "$setting and a checkpoint" run "$problem" --method verlet --t-end 2 \
    --resume start.state --set "$parameter"
  says err "$parameter places the start, which --resume replaces" \
    "why $setting and a checkpoint do not go together"
done
expect 0 'a checkpoint of henon-heiles' run henon-heiles --method verlet --set lambda=0.5 \
  --t-end 1 --checkpoint well.state --final
expect 0 'the same system' run henon-heiles --method verlet --set lambda=0.5 --t-end 2 \
  --resume well.state
expect 1 'another system' run henon-heiles --method verlet --set lambda=0.25 --t-end 2 \
  --resume well.state

# Files left behind by a killed process of the same number do no harm.
DVI=$dvi sh -c 'touch left.state.part-$$-0 left.state.part-$$-1
  exec "$DVI" run kepler --method verlet --t-end 1 --final --checkpoint left.state' \
  >out 2>err || fail 'a checkpoint beside stale files'
says out '^1,' 'the row is written'
expect 0 'what was written beside stale files' run kepler --method verlet --t-end 2 \
  --resume left.state --final
rm -f left.state.part-*

# A run may go on in its own checkpoint.
expect 0 'its own checkpoint' $kepler --t-end 1 --checkpoint own.state --final
expect 0 'in place' $kepler --t-end 2 --resume own.state --checkpoint ./own.state --final
expect 0 'and again' $kepler --t-end 3 --resume own.state --final
cp out again.csv
expect 0 'in one piece' $kepler --t-end 3 --final
same again.csv out 'three parts are one run'

# A signal while the problem is built ends the run at once; no file was opened.
"$dvi" run fpu --method midpoint --set ell=4000000 --t-end 1 --out big.csv --checkpoint big.state \
  2>err &
for _ in 1 2 3 4 5; do
  sleep 0.3
  kill -INT $! 2>kill.err ||
    break # it has ended; a signal that comes before the program has begun is lost
done
ends 130 'signal during the set-up'
says err 'before its first step' 'signal during the set-up: it is said'
for name in big.csv big.state; do
  [ ! -e "$name" ] || fail "signal during the set-up: $name was written"
done
no_trace 'signal during the set-up'
}

# An alarm says when a bound was passed, and changes nothing else.
long_steps='run fpu --method imex --h 0.3 --t-end 20 --columns I'
# shellcheck disable=SC2086
{
expect 0 'no alarm' $long_steps --out quiet.csv
grep -q alarm err && fail 'no alarm: nothing is said of one'
expect 0 'alarms' $long_steps --alarm I=1.2 --alarm energy=100 --out loud.csv
same quiet.csv loud.csv 'an alarm changes no row'
[ "$(grep -c alarm err)" -eq 1 ] || fail 'the energy does not pass its bound'
first=$(awk -F, 'NR > 1 && $2 > 1.2 { printf "%.6g", $1; exit }' loud.csv)
most=$(awk -F, 'NR > 1 && $2 > most { most = $2 } END { printf "%.6g", most }' loud.csv)
says err "^dvi: run: alarm: I passed 1.2 at t = $first; at most it was $most, at t = " \
  'when, and how far'
expect 2 'two bounds of one invariant' $long_steps --alarm I=1.2 --alarm I=1.2
for wrong in I I= I=0 I=-1 I=x =1 J=1 I_=1; do
  expect 2 "alarm $wrong" $long_steps --alarm "$wrong"
done
}

# A plot is drawn whole.
expect 0 'plot' run kepler --method verlet --t-end 5 --final --plot orbit.svg
says orbit.svg '</svg>' 'the plot is whole'
invariants='energy, angular_momentum, laplace_x, laplace_y'
says err "^dvi: run: --plot orbit.svg draws over t: x, y; change since the start: $invariants\$" \
  'what is drawn'

# draws NAME PATTERN ARGUMENTS...: require a sentence that names the curves of a plot, and labels
# for them, at most eight in a panel.
draws() {
  # shellcheck disable=SC2086
  expect 0 "$1" run $3 --final --plot drawn.svg
  says err "^dvi: run: --plot drawn.svg draws over t: $2" "$1"
  says drawn.svg "${2%%[,;]*}" "$1: the first curve is named"
  grep -q 'R11\|R33' drawn.svg && fail "$1: entries of a matrix"
}
draws 'a body that only turns' \
  'Omega1, Omega2, Omega3; change since the start: energy, angular_momentum_x' \
  'free-body --method lie-verlet'
draws 'bodies: places before matrices' 'x_1, y_1, z_1, x_2, y_2, z_2; change' \
  'two-body --method lie-verlet --t-end 5'
draws 'places before directions' 'x, y, z, q1_x, q1_y, q1_z; change .*; --columns chooses others$' \
  'satellite --method lie-verlet --t-end 5'
draws 'a chain: some of it' \
  'q_1, q_2, q_3, q_4, q_5, q_6; change since the start: energy; --columns chooses others$' \
  'chain --method verlet --t-end 5'
draws 'columns that are asked for' 'x, p_x; change since the start: laplace_x$' \
  'kepler --method verlet --t-end 5 --columns x,p_x,laplace_x'
draws 'columns, not all of them' \
  'q_9, q_8, q_7, q_6, q_5, q_4, q_3, q_2; --columns chooses others$' \
  'chain --method verlet --t-end 5 --columns q_9,q_8,q_7,q_6,q_5,q_4,q_3,q_2,q_1'
expect 0 'no columns' run kepler --method verlet --t-end 5 --final --columns t --plot none.svg
says err "no plot in 'none.svg': --columns names nothing to draw" 'no columns'
no_trace 'plots'
finish
