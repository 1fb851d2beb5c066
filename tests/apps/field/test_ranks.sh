#!/bin/sh
# mpirun -np N dvi run writes the rows of dvi run, byte for byte, and goes on after one of its
# processes was killed. The rest is in tests/apps/cluster/ranks.sh. Skipped where dvi has no module
# for processes.
# Usage: test_ranks.sh DVI
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../check.sh"
. "$here/ranks_setup.sh"

if [ ! -e "$(dirname "$dvi")/dvi_petsc.so" ]; then
  alone 'this dvi has no module for them'
  said=$("$dvi" bench wave.yaml --scale ranks=1,2 2>&1) && fail "ranks without a module: $said"
  [ $failures -eq 0 ] || exit 1
  echo "DVI_PETSC is OFF: no tests with MPI"
  exit 77
fi
as_one 3 probes.yaml
as_one 2 grid.yaml
killed 3 1 2
exit $((failures > 0))
