#!/bin/sh
# All that mpirun -np N dvi run does: the rows of dvi run, checkpoints that go on with other numbers
# of processes, files, signals, kills, refusals; dvi explain, and dvi bench --scale ranks=. Skipped
# where dvi has no module for processes.
# Usage: ranks.sh DVI
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../check.sh"
. "$here/../field/ranks_setup.sh"
modules=$(dirname "$dvi")
[ -e "$modules/dvi_petsc.so" ] || { echo "DVI_PETSC is OFF: no tests with MPI"; exit 77; }

# ---- rows ----

as_one 3 torus.yaml --columns energy,gauss,e
as_one 4 box.yaml --every 5
as_one 2 probes.yaml
as_one 4 grid.yaml
sed -e 's/{cpml: 2}/absorbing/' \
  -e 's/^  s: .*/  s: {of: B, at: [0.9, 0.9, 0.9], along: [0, 0, 1]}/' grid.yaml >walls.yaml
as_one 3 walls.yaml --columns energy,gauss,charge,divergence,e,s
by 2 wave.yaml >all.csv || fail "no rows on standard output"
by 1 wave.yaml >one.csv
same one.csv all.csv "standard output"
as_one 2 wave.yaml --final --plot all.svg
[ -s all.svg ] || fail "no plot"

# Processes explain who owns what: all cells have an owner, and every message is counted.
mpirun -np 3 "$dvi" explain torus.yaml --csv shares.csv >out || fail "explain fails"
says out '^shares: 324 cells among 3 processes by [a-z]*, 10[0-9] to 1[0-9]* each' explain
awk -F, 'NR > 1 { cells += $3
    wrong += !($4 > 0 && $5 == 2 && $6 == 2 && $7 > 0 && $7 % 8 == 0) }
  END { exit !(NR == 4 && cells == 324 && !wrong) }' shares.csv ||
  fail "explain: $(cat shares.csv)"

# A step is measured on processes that dvi starts, and predicted for more of them.
"$dvi" bench torus.yaml --scale ranks=1,2,4,...,300 --rounds 1 --steps 2 --csv scale.csv \
  >out || fail "bench: no scaling"
for words in '^Ranks that share torus.yaml' '^triad .* of 2 processes together' \
  '^  network: .*shared memory' '^  fit: .*the largest deviation is' '^What breaks first'; do
  grep -q "$words" out || fail "bench: no '$words' in: $(cat out)"
done
header=scaling,problem,ranks,rank_cells,step_seconds,efficiency,exchange,messages,bytes
header=$header,measured_seconds,measured_efficiency,oversubscribed,measured_lower
header=$header,measured_upper,cells
[ "$(head -n 1 scale.csv)" = $header ] || fail "bench: $(head -n 1 scale.csv)"
# One rank waits for nobody, and what was measured stands in its rows alone.
awk -F, 'NR == 1 { next }
  { measured = $3 == 1 || ($3 == 2 && $1 == "strong")
    if (!($5 > 0 && $6 > 0 && $7 >= 0 && $7 < 1)) bad++
    if (($7 == 0) != ($3 == 1) || ($10 != "") != measured) bad++
    if ($15 != ($1 == "weak" ? 324 * $3 : 324)) bad++ }
  END { exit !(NR == 21 && !bad) }' scale.csv || fail "bench: $(cat scale.csv)"
# What makes no sense is refused before processes start.
for option in '--scale ranks=1,2 --latency 0' '--scale ranks=1,2 --bandwidth nan' \
  '--scale ranks=2,1' '--scale ranks=1,2 --method avi' '--scale ranks=1,2 --at 1e-6' \
  '--latency 1e-6' '--scale threads=1,2 --weak n'; do
  # shellcheck disable=SC2086
  "$dvi" bench torus.yaml $option >out 2>&1
  [ $? -eq 2 ] || fail "bench $option: $(cat out)"
done

# ---- checkpoints ----

# goes_on N M SCENE OPTION...: half of a run by N, and the rest by M, are the whole one.
goes_on() {
  first=$1 second=$2 file=part.$rows
  shift 2
  rm -f "$file" a.state
  by "$first" "$@" --t-end 0.4 --out $file --checkpoint a.state || fail "$*: $first fail"
  same half.state a.state "$*: the checkpoint of $first"
  by "$second" "$@" --t-end 1 --out $file --resume a.state || fail "$*: $second do not go on"
  if [ $rows = h5 ]; then
    "$dvi" plot $file --out part.svg >/dev/null 2>&1
    h5diff whole.h5 part.h5 rows || fail "$*: $first and then $second have other rows"
  else
    { cat half.csv; sed 1,2d part.csv; } >joined.csv
    same whole.csv joined.csv "$*: $first and then $second"
  fi
}

# every_way SCENE OPTION...: checkpoints go on with other numbers of processes.
every_way() {
  by 1 "$@" --t-end 0.4 --out half.csv --checkpoint half.state || fail "$*: no checkpoint"
  by 1 "$@" --t-end 1 --out whole.csv || fail "$*: no run"
  rows=csv
  goes_on 1 3 "$@"
  goes_on 3 1 "$@"
  goes_on 2 4 "$@"
  command -v h5diff >/dev/null && [ -e "$modules/dvi_hdf5.so" ] || return
  rows=h5
  rm -f whole.h5
  by 1 "$@" --t-end 1 --out whole.h5 || fail "$*: no run"
  goes_on 3 2 "$@"
}
every_way wave.yaml --h 0.002 --every 4
every_way grid.yaml --h 0.01 --every 5
every_way torus.yaml --h 0.004 --every 5
together 1 'cannot read' wave.yaml --resume nowhere
together 2 'half.state. stands at t = ' torus.yaml --h 0.004 --t-end 0.1 --resume half.state

# ---- kills and signals ----

killed 3 0 1
killed 3 2 3
killed 2 1 4
killed 4 0 2

begin 2 rows.h5 wave.yaml --t-end 2e4 --every 1000 --out rows.h5
kill -KILL "$(nth 1)"
ended
told 'without a checkpoint' "$code" 137 'rank 1 was killed.*there is no checkpoint: start again'
rm -f a.state
begin 2 rows.h5 wave.yaml --t-end 2e4 --every 1000 --out rows.h5 --checkpoint a.state
kill -SEGV "$(nth 0)"
ended
told 'a crash' "$code" 139 'rank 0 was killed, or has crashed; there is no checkpoint yet'

# Where nobody ends the others, they end by themselves.
export OMPI_MCA_orte_enable_recovery=1
begin 3 rows.h5 wave.yaml --t-end 2e4 --every 1000 --out rows.h5
kill -KILL "$(nth 1)"
ended
told 'without the help of mpirun' 1 1 'rank 1 was killed'
unset OMPI_MCA_orte_enable_recovery

# A signal that reaches one process ends all of them, and the rows are complete.
rm -f long.csv a.state
begin 2 a.state wave.yaml --t-end 2e4 --every 1000 --out long.csv --checkpoint a.state \
  --checkpoint-every 1000
kill -TERM "$(nth 1)"
ended
[ "$code" -eq 143 ] || fail "a signal: no exit code 143"
says err '^dvi: run: signal 15 ended the run at t' 'a signal'
says err '^dvi: run: continue with --resume a.state' 'a signal'
tail -n 1 long.csv | grep -q '^[0-9.]*,[0-9.]*$' || fail "a signal: the last row is not complete"
no_trace 'a signal'

# mpirun hands a signal on, and waits.
export OMPI_MCA_odls_base_sigkill_timeout=5
rm -f long.csv a.state
begin 2 a.state wave.yaml --t-end 2e4 --every 1000 --out long.csv --checkpoint a.state \
  --checkpoint-every 1000
kill -TERM "$mpirun"
ended
[ "$code" -ne 0 ] || fail "a signal to mpirun: exit code 0"
says err '^dvi: run: signal 15 ended the run at t' 'a signal to mpirun'
[ -s long.csv ] || fail "a signal to mpirun: no rows"
unset OMPI_MCA_odls_base_sigkill_timeout

# ---- refusals ----

alone 'MPI knows of 1'
together 2 'kepler is none' kepler
together 2 'leapfrog and yee alone, not verlet' wave.yaml --method verlet
sed 's/exp(/sqrt(x - 0.5)*exp(/' wave.yaml >nan.yaml
sed 's/0.9, 0.13/3, 4/' probes.yaml >outside.yaml
together 2 'the start is not finite at vertex' nan.yaml # on one process, on which the others wait
together 2 '--method yee: several processes share yee on grids' wave.yaml --method yee
sed -e 's/cells: .*/cells: [50]}/' -e 's/{E: .*/{E: x}/' -e '/^ *[es]:/d' -e '/^probes/d' \
  -e '/cpml/d' grid.yaml >line.yaml
together 2 'yee: a grid of one axis cannot be divided' line.yaml
together 2 "the probe 'b' is outside of the mesh" outside.yaml
together 1 "cannot write '/nowhere/rows.csv'" wave.yaml --out /nowhere/rows.csv
together 1 "cannot write '/nowhere/state'" wave.yaml --checkpoint /nowhere/state
exit $((failures > 0))
