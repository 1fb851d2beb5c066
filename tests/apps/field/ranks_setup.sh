# The tests of dvi run with mpirun source this file behind check.sh: scenes, and what processes must
# do.

# Open MPI refuses root, and more processes than cores, unless it is told otherwise.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe

cat >wave.yaml <<'SCENE'
mesh: {generator: staggered, cells: [9, 9], size: [1, 1]}
field: wave
materials:
  all: {rho: 1 + x, a: 1 + y}
boundary: fixed
initial: {u: exp(-30*((x - 0.4)^2 + (y - 0.5)^2))}
method: leapfrog
step: {fraction: 0.5}
until: 1
SCENE
{
  cat wave.yaml
  echo 'probes: {a: {at: [0.5, 0.5]}, b: {at: [0.9, 0.13]}, c: {integral: u^2*x, over: all}}'
} >probes.yaml
cat >torus.yaml <<'SCENE'
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
SCENE
cat >box.yaml <<'SCENE'
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
SCENE

cat >grid.yaml <<'SCENE'
mesh: {generator: box, cells: [6, 7, 9]}
field: maxwell
boundary: {boundary: pec, left: {cpml: 2}}
materials:
  all: {eps: 1 + 0.5*x, sigma: 0.1}
initial: {E: [sin(pi*y), 0, cos(2*pi*x)]}
probes:
  e: {of: E, at: [0.4, 0.4, 0.5], along: [1, 0.2, 0]}
  s: {flux: {from: [0.5, 0.1, 0.1], to: [0.5, 0.9, 0.95]}}
method: yee
step: {fraction: 0.5}
until: 1
SCENE

# A grid of which steps are taken together.
cat >deep.yaml <<'SCENE'
mesh: {generator: box, cells: [16, 32, 80]}
field: maxwell
boundary: {boundary: pec, left: {cpml: 3}}
initial: {E: [sin(pi*y), 0, cos(2*pi*x)]}
method: yee
step: {fraction: 0.5}
until: 1
SCENE
cat >bar.yaml <<'SCENE'
mesh: {generator: kuhn, cells: [8, 2, 2], size: [3, 1, 1]}
field: elastic
materials: {all: {law: linear, young: 200, poisson: 0.3, rho: 1}}
boundary: {left: fixed}
initial: {u': "[0, 0, 0.1*x]"}
method: avi
step: {fraction: 0.6}
until: 1
SCENE
cat >solid.yaml <<'SCENE'
mesh: {generator: kuhn, cells: [4, 2, 2], size: [2, 1, 1], grading: [1.4, 1, 1]}
field: elastic
materials: {all: {law: neo-hookean, young: 1, poisson: 0.3, rho: 1, alpha: 0.1}}
boundary: {left: {fixed: "[0, 0.1*sin(t), 0]"}}
loads: {gravity: "[0, 0, -0.1]", right: {traction: "[0, -0.05*t, 0]"}}
probes: {tip: {of: x, at: [2, 1, 1]}, middle: {of: von_mises, at: [1, 0.4, 0.3]}}
method: avi
step: {fraction: 0.5}
until: 1
SCENE
{ cat wave.yaml; echo 'potential: 1 - cos(u)'; } >kink.yaml

# by N ARGUMENT...: dvi run by N processes, without mpirun if N is 1.
by() {
  ranks=$1
  shift
  [ "$ranks" -eq 1 ] || set -- "$dvi" run "$@"
  [ "$ranks" -eq 1 ] && { "$dvi" run "$@"; return; }
  mpirun -np "$ranks" "$@"
}

# as_one N SCENE OPTION...: N processes write the rows of one.
as_one() {
  count=$1
  shift
  by 1 "$@" --out one.csv || fail "$*: dvi run fails"
  by "$count" "$@" --out all.csv || fail "$*: $count processes fail"
  same one.csv all.csv "$count processes, $*"
}

# drawn N OPTION FILE SCENE OPTION...: N processes write the files of one, and say the same. MPI may
# have words of its own.
drawn() {
  count=$1 option=$2 file=$3 drawn=../$4
  shift 4
  set -- "$drawn" "$@"
  rm -rf alone together
  mkdir alone together
  (cd alone && by 1 "$@" --out rows.csv "--$option" "$file" 2>said) ||
    fail "$*: dvi run --$option fails"
  (cd together && by "$count" "$@" --out rows.csv "--$option" "$file" 2>said) ||
    fail "$*: $count processes fail with --$option"
  for where in alone together; do
    grep '^dvi: ' $where/said >words
    mv words $where/said
  done
  diff -r alone together || fail "$*: $count processes draw other files with --$option"
}

# told NAME CODE WANTED WORDS: an exit code, and one sentence with the words, in the file err.
told() {
  [ "$2" -eq "$3" ] || fail "$1: exit code $2, not $3"
  [ "$(grep -c '^dvi: ' err)" -eq 1 ] || fail "$1: not one sentence: $(cat err)"
  says err "^dvi: .*$4" "$1"
}

# together CODE WORDS ARGUMENT...: two processes end with the code and one sentence, without rows.
together() {
  code=$1 words=$2 got=0
  shift 2
  by 2 "$@" >out 2>err || got=$?
  told "$*" "$got" "$code" "$words"
  [ ! -s out ] || fail "$*: rows"
}

# begin N FILE ARGUMENT...: start N processes in the background, and wait until a new FILE is there.
# The process of rank R is then $(nth R).
begin() {
  count=$1 file=$2 tries=0
  shift 2
  rm -rf "$file" ./*.part-*
  mpirun -np "$count" "$dvi" run "$@" >out 2>err &
  mpirun=$!
  while [ ! -e "$file" ] && [ $tries -lt 200 ]; do
    sleep 0.05
    tries=$((tries + 1))
  done
}
nth() { ps -o pid= --ppid "$mpirun" | sed -n "$(($1 + 1))p"; }

# ended: wait for mpirun, and give its exit code in `code`.
ended() {
  code=0
  wait "$mpirun" || code=$?
}

# killed N RANK M: kill one of N processes, and go on with M to the rows of an uninterrupted run.
killed() {
  rm -f a.state rows.csv
  begin "$1" a.state wave.yaml --h 0.002 --t-end 2e4 --every 100 --out rows.csv \
    --checkpoint a.state --checkpoint-every 500
  kill -KILL "$(nth "$2")"
  ended
  told "rank $2 of $1 is killed" "$code" 137 \
    "rank $2 was killed, or has crashed; go on with --resume a.state, which stands at t = [0-9]"
  [ ! -e rows.csv ] || fail "rank $2 of $1 is killed: rows"
  end=$(sed -n 's/^dvi: .*stands at t = \([0-9]*\).*/\1/p' err)
  end=$((end + 10))
  by "$3" wave.yaml --h 0.002 --t-end $end --every 100 --resume a.state --out rest.csv ||
    fail "$3 processes do not go on"
  "$dvi" run wave.yaml --h 0.002 --t-end $end --every 100 --out whole.csv
  sed 1,2d rest.csv >rest
  tail -n "$(wc -l <rest)" whole.csv >whole
  same rest whole "rank $2 of $1 is killed, and $3 go on"
  [ "$(wc -l <rest)" -ge 40 ] || fail "the rest has too few rows"
}

# started RANK: run as if two processes had been started.
started() { OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=$1 "$dvi" run wave.yaml 2>&1; }

# alone WORDS: processes without mpirun refuse to run the same twice, and the first one says why.
alone() {
  said=$(started 0)
  [ $? -eq 2 ] || fail "two processes without mpirun: no exit code 2"
  case $said in
    "dvi: 2 processes were started, and $1"*) ;;
    *) fail "two processes without mpirun: $said" ;;
  esac
  said=$(started 1) || fail "the second process without mpirun fails"
  [ -z "$said" ] || fail "the second process without mpirun says: $said"
}
