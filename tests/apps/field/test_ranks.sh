#!/bin/sh
# mpirun -np N dvi run writes the rows of dvi run, byte for byte, goes on after one of its processes
# was killed, and refuses with one sentence what processes cannot share. The rest is in
# tests/apps/cluster/ranks.sh. Skipped where dvi has no module for processes.
# Usage: test_ranks.sh DVI
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../check.sh"
. "$here/ranks_setup.sh"

# started RANK: run as if two processes had been started.
started() { OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=$1 "$dvi" run wave.yaml 2>&1; }

# The processes refuse to run the same twice, and the first one says why.
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
if [ ! -e "$(dirname "$dvi")/dvi_petsc.so" ]; then
  alone 'this dvi has no module for them'
  said=$("$dvi" bench wave.yaml --scale ranks=1,2 2>&1) && fail "ranks without a module: $said"
  [ $failures -eq 0 ] || exit 1
  echo "DVI_PETSC is OFF: no tests with MPI"
  exit 77
fi
as_one 3 probes.yaml
as_one 2 grid.yaml
together 2 'kepler is none' kepler
killed 3 1 2
exit $((failures > 0))
