#!/bin/sh
# A program prints the same line and writes the same wave.state on one process and on three.
# Usage: page.sh MPIRUN PROGRAM
set -u
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
for ranks in 1 3; do
  "$1" -n $ranks "$2" >said.$ranks || exit 1
  mv wave.state state.$ranks || exit 1
done
grep -q '^energy -*[0-9]' said.1 && cmp said.1 said.3 && cmp state.1 state.3
