#!/bin/sh
# Commands that processes do not share refuse to do the same N times: the first process says why and
# what to do, the others are silent, and nothing is written.
# Usage: test_started.sh DVI
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../check.sh"

# as RANK ARGUMENT...: run dvi as one of three processes of mpirun.
as() {
  rank=$1 code=0
  shift
  OMPI_COMM_WORLD_SIZE=3 OMPI_COMM_WORLD_RANK=$rank "$dvi" "$@" >out 2>err || code=$?
}

"$dvi" init cart.yaml >/dev/null || fail "no scene"
commands=$("$dvi" --help | awk '/^Commands:/ { rows = 1; next } !NF { rows = 0 } rows { print $1 }')
for command in $commands; do
  case $command in
    run | explain | modes | bench) continue ;; # they start MPI, in test_ranks.sh
    sweep) remedy='leave mpirun out, and share the points by --part K/N' ;;
    order) remedy='leave mpirun out, and start it once for each method' ;;
    resonance) remedy='leave mpirun out: its threads take all cores' ;;
    mesh) remedy='leave mpirun out, and let dvi run share the mesh.h5 that --write makes' ;;
    *) remedy='leave mpirun out' ;;
  esac
  as 0 "$command" other.yaml --out other.csv
  [ $code -eq 2 ] || fail "$command: exit code $code"
  [ "$(cat out err)" = \
    "dvi: $command: 3 processes were started, and all would do the same; $remedy" ] ||
    fail "$command says: $(cat out err)"
  as 2 "$command" other.yaml --out other.csv
  [ $code -eq 0 ] && [ ! -s out ] && [ ! -s err ] || fail "the third of $command: $(cat err)"
done
# So do they where there is no command.
for command in nonsense --version; do
  as 2 $command
  [ $code -eq 0 ] && [ ! -s out ] && [ ! -s err ] || fail "the third of $command: $(cat out err)"
done
as 0 nonsense
[ $code -eq 2 ] || fail "no command: exit code $code"
says err "unknown command 'nonsense'" 'no command'
[ "$(ls)" = "cart.yaml
err
out" ] || fail "files: $(ls)"

# Each of them may have its own part of a sweep.
for rank in 0 1 2; do
  as $rank sweep cart.yaml --set l=0.2:0.4:3 --t-end 0.1 --out l.csv --part $((rank + 1))/3
  [ $code -eq 0 ] || fail "part $rank: $(cat err)"
done
expect 0 join sweep cart.yaml --set l=0.2:0.4:3 --t-end 0.1 --out l.csv --join l.csv.*-of-3
[ "$(grep -c . l.csv)" -eq 10 ] || fail "the parts have no nine rows"
exit $((failures > 0))
