# What is solved on shares has the same bits on 1 to 4 processes. Usage: implicit.sh MPIEXEC PROGRAM
set -e
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for ranks in 1 2 3 4; do
  "$1" -n $ranks "$2" >"$work/$ranks"
  cmp "$work/1" "$work/$ranks"
done
test -s "$work/1"
