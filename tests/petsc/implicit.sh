# What is solved on shares has the same bits on any number of processes.
# Usage: implicit.sh MPIEXEC PROGRAM WHAT RANKS...
set -e
mpiexec=$1 program=$2 what=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for ranks; do
  "$mpiexec" -n "$ranks" "$program" "$what" >"$work/$ranks"
  cmp "$work/$1" "$work/$ranks"
done
test -s "$work/$1"
