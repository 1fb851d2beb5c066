#!/bin/sh
# mpirun -np N dvi run writes the rows of dvi run, byte for byte, and refuses with one sentence what
# processes cannot share. Skipped where dvi has no module for them.
# Usage: test_ranks.sh DVI
set -u
dvi=$1
# Open MPI refuses root, and more processes than cores, unless it is told otherwise.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
rc=0

wrong() { echo "$*"; rc=1; }

cat >torus.yaml <<'END'
mesh: {generator: bcc-torus, cells: [3, 3, 3], size: [1, 1, 1]}
field: maxwell
materials:
  all: {eps: 1 + 0.5*x, sigma: 0.1}
initial: {E: [sin(2*pi*y), 0, cos(2*pi*x)]}
probes:
  e: {of: E, at: [0.3, 0.4, 0.5], along: [1, 0.2, 0]}
method: leapfrog
step: {fraction: 0.5}
until: 1
END
cat >box.yaml <<'END'
mesh: {generator: box, cells: [6, 4, 5]}
field: maxwell
boundary: {boundary: pec, left: absorbing}
sources:
  ring: {at: [0.5, 0.5, 0.5], current: [0, 0, sin(9*t)]}
probes:
  e: {of: E, at: [0.3, 0.4, 0.5], along: [1, 0.2, 0]}
method: leapfrog
step: {fraction: 0.5}
until: 1
END
cat >wave.yaml <<'END'
mesh: {generator: staggered, cells: [9, 9], size: [1, 1]}
field: wave
materials:
  all: {rho: 1 + x, a: 1 + y}
boundary: fixed
initial: {u: exp(-30*((x - 0.4)^2 + (y - 0.5)^2))}
method: leapfrog
step: {fraction: 0.5}
until: 1
END
# started RANK: run as if two processes had been started.
started() { OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=$1 "$dvi" run wave.yaml 2>&1; }

# The processes refuse to run the same twice, and the first one says why.
alone() {
  said=$(started 0)
  [ $? -eq 2 ] || wrong "two processes without mpirun: no exit code 2"
  case $said in
    "dvi: 2 processes were started, and $1"*) ;;
    *) wrong "two processes without mpirun: $said" ;;
  esac
  said=$(started 1) || wrong "the second process without mpirun fails"
  [ -z "$said" ] || wrong "the second process without mpirun says: $said"
}
if [ ! -e "$(dirname "$dvi")/dvi_petsc.so" ]; then
  alone 'this dvi has no module for them'
  said=$("$dvi" bench wave.yaml --scale ranks=1,2 2>&1) && wrong "ranks without a module: $said"
  [ $rc -eq 0 ] || exit $rc
  echo "DVI_PETSC is OFF: no tests with MPI"
  exit 77
fi
alone 'MPI knows of 1'

{ cat wave.yaml; echo 'probes: {a: {at: [0.5, 0.5]}}'; } >probes.yaml
sed 's/exp(/sqrt(x - 0.5)*exp(/' wave.yaml >nan.yaml

# same N SCENE OPTION...: N processes write the rows of one.
same() {
  ranks=$1 scene=$2
  shift 2
  "$dvi" run "$scene" "$@" --out one.csv || wrong "$scene: dvi run fails"
  mpirun -np "$ranks" "$dvi" run "$scene" "$@" --out all.csv || wrong "$scene: $ranks fail"
  cmp one.csv all.csv || wrong "$scene: $ranks processes have other rows"
}
same 3 torus.yaml --columns energy,gauss,e
same 4 box.yaml --every 5
mpirun -np 2 "$dvi" run wave.yaml >all.csv || wrong "no rows on standard output"
"$dvi" run wave.yaml | cmp - all.csv || wrong "other rows on standard output"

# Processes explain who owns what: all cells have an owner, and every message is counted.
mpirun -np 3 "$dvi" explain torus.yaml --csv shares.csv >out.txt || wrong "explain fails"
grep -q '^shares: 324 cells among 3 processes by [a-z]*, 10[0-9] to 1[0-9]* each' out.txt ||
  wrong "explain: $(cat out.txt)"
awk -F, 'NR > 1 { cells += $3
    wrong += !($4 > 0 && $5 == 2 && $6 == 2 && $7 > 0 && $7 % 8 == 0) }
  END { exit !(NR == 4 && cells == 324 && !wrong) }' shares.csv ||
  wrong "explain: $(cat shares.csv)"

# A step is measured on processes that dvi starts, and predicted for more of them.
"$dvi" bench torus.yaml --scale ranks=1,2,4,...,300 --rounds 1 --steps 2 --csv scale.csv \
  >out.txt || wrong "bench: no scaling"
for words in '^Ranks that share torus.yaml' '^triad .* of 2 processes together' \
  '^  network: .*shared memory' '^  fit: .*the largest deviation is' '^What breaks first'; do
  grep -q "$words" out.txt || wrong "bench: no '$words' in: $(cat out.txt)"
done
header=scaling,problem,ranks,rank_cells,step_seconds,efficiency,exchange,messages,bytes
header=$header,measured_seconds,measured_efficiency,oversubscribed,measured_lower
header=$header,measured_upper,cells
[ "$(head -n 1 scale.csv)" = $header ] || wrong "bench: $(head -n 1 scale.csv)"
# One rank waits for nobody, and what was measured stands in its rows alone.
awk -F, 'NR == 1 { next }
  { measured = $3 == 1 || ($3 == 2 && $1 == "strong")
    if (!($5 > 0 && $6 > 0 && $7 >= 0 && $7 < 1)) bad++
    if (($7 == 0) != ($3 == 1) || ($10 != "") != measured) bad++
    if ($15 != ($1 == "weak" ? 324 * $3 : 324)) bad++ }
  END { exit !(NR == 21 && !bad) }' scale.csv || wrong "bench: $(cat scale.csv)"
# What makes no sense is refused before processes start.
for option in '--scale ranks=1,2 --latency 0' '--scale ranks=1,2 --bandwidth nan' \
  '--scale ranks=2,1' '--scale ranks=1,2 --method avi' '--scale ranks=1,2 --at 1e-6' \
  '--latency 1e-6' '--scale threads=1,2 --weak n'; do
  # shellcheck disable=SC2086
  "$dvi" bench torus.yaml $option >out.txt 2>&1
  [ $? -eq 2 ] || wrong "bench $option: $(cat out.txt)"
done

# refused CODE WORDS ARGUMENT...: processes end with the code, and one sentence.
refused() {
  code=$1 words=$2
  shift 2
  mpirun -np 2 "$dvi" run "$@" >out.txt 2>err.txt
  got=$?
  [ $got -eq "$code" ] || wrong "$*: exit code $got, not $code"
  [ "$(grep -c '^dvi: ' err.txt)" -eq 1 ] || wrong "$*: not one sentence: $(cat err.txt)"
  grep -q "^dvi: .*$words" err.txt || wrong "$*: no '$words' in: $(cat err.txt)"
  [ ! -s out.txt ] || wrong "$*: rows"
}
refused 2 'kepler is none' kepler
refused 2 'leapfrog and midpoint alone, not verlet' wave.yaml --method verlet
refused 2 '--checkpoint needs the whole mesh' wave.yaml --checkpoint state
refused 2 'probes of a wave need the whole mesh' probes.yaml
# One process alone fails here, on which the others wait.
refused 2 'the start is not finite at vertex' nan.yaml
# So does the first one, which alone writes.
refused 1 "cannot write '/nowhere/rows.csv'" wave.yaml --out /nowhere/rows.csv

# A signal that reaches one process ends all of them, and the rows are complete.
mpirun -np 2 "$dvi" run wave.yaml --t-end 1e6 --every 1000 --out long.csv 2>err.txt &
mpirun=$!
tries=0
while [ ! -e long.csv ] && [ $tries -lt 100 ] && ! ls ./long.csv* >/dev/null 2>&1; do
  sleep 0.1
  tries=$((tries + 1))
done
sleep 0.5
for child in $(ps -o pid= --ppid $mpirun); do kill -TERM "$child"; break; done
wait $mpirun
[ $? -eq 143 ] || wrong "a signal: no exit code 143"
grep -q '^dvi: run: signal 15 ended the run at t' err.txt || wrong "a signal: $(cat err.txt)"
tail -n 1 long.csv | grep -q '^[0-9.]*,[0-9.]*$' || wrong "a signal: the last row is not complete"

# By midpoint any number of processes writes the same rows, which are those of one up to roundoff.
{ cat wave.yaml; echo 'potential: 1 - cos(u)'; } >kink.yaml
for ranks in 2 3; do
  mpirun -n $ranks "$dvi" run kink.yaml --method midpoint --h 0.05 --every 5 >rows$ranks.csv ||
    wrong "$ranks processes: no rows by midpoint"
done
cmp rows2.csv rows3.csv || wrong "two and three processes write other rows by midpoint"
"$dvi" run kink.yaml --method midpoint --h 0.05 --every 5 >rows1.csv || wrong "midpoint fails"
paste -d , rows1.csv rows3.csv | awk -F , '
  NR == 1 { if ($1 != $3 || $2 != $4) exit 1; next }
  $1 != $3 || ($2 - $4) ^ 2 > 1e-26 { exit 1 }
  END { if (NR != 6) exit 1 }' || wrong "midpoint: $(cat rows3.csv), and of one $(cat rows1.csv)"
exit $rc
