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
  expect 2 'a state in parts without the module' run wave.yaml --checkpoint a.h5
  says err 'this dvi has no module for it' 'a state in parts without the module'
  [ $failures -eq 0 ] || exit 1
  echo "DVI_PETSC is OFF: no tests with MPI"
  exit 77
fi
as_one 3 probes.yaml
as_one 2 grid.yaml
as_one 3 solid.yaml
drawn 3 pvd field.pvd torus.yaml --every 12
killed 3 1 2

# A checkpoint in parts is the same file for any number of processes.
by 1 wave.yaml --h 0.002 --t-end 0.1 --final --checkpoint one.h5 >out || fail "no state in parts"
by 3 wave.yaml --h 0.002 --t-end 0.1 --final --checkpoint all.h5 >out || fail "3 write no state"
same one.h5 all.h5 'a state in parts'
by 1 wave.yaml --h 0.002 --t-end 0.2 --final --resume all.h5 --out rest.csv ||
  fail "one does not go on from a state of three"
by 1 wave.yaml --h 0.002 --t-end 0.2 --final --out whole.csv
same whole.csv rest.csv 'one goes on from a state of three'
expect 2 'a state of a mechanical system' run kepler --method verlet \
  --h 0.1 --checkpoint a.h5
says err 'is a state in parts by its name' 'a state of a mechanical system'
expect 2 'a state in parts of one process' run kink.yaml --method midpoint --h 0.05 \
  --resume all.h5
says err 'midpoint of one process .* or start 2 processes or more' 'a state in parts of one process'
expect 1 'a state as a mesh' mesh all.h5
says err 'its layout is "dvi state 1" and not "dvi mesh 1"' 'a state as a mesh'
if [ -e "$(dirname "$dvi")/dvi_hdf5.so" ]; then
  "$dvi" run wave.yaml --final --out rows.h5 || fail "no rows in HDF5"
  expect 1 'rows as a mesh' mesh rows.h5
  says err 'it has no text "layout": it is of another kind' 'rows as a mesh'
fi

# A mesh that processes read in parts.
sed 's/^mesh: .*/mesh: {file: torus.h5}/' torus.yaml >parts.yaml
"$dvi" mesh bcc-torus --cells 3,3,3 --size 1,1,1 --write torus.h5 >out ||
  fail "torus.h5 is not written"
"$dvi" mesh torus.h5 >again || fail "torus.h5 is not described"
grep -v '^bcc-torus:' out >described
grep -v '^torus.h5:' again | cmp -s - described || fail "another mesh: $(cat again)"
"$dvi" run torus.yaml --columns energy,gauss,e --out one.csv || fail "torus.yaml: dvi run fails"
"$dvi" run parts.yaml --columns energy,gauss,e --out all.csv || fail "parts.yaml: dvi run fails"
same one.csv all.csv "one process reads torus.h5"
expect 2 'a sweep of a mesh in parts' sweep parts.yaml --out swept.csv
says err "'torus.h5' is a mesh in parts, which dvi run reads" 'a sweep of a mesh in parts'
by 3 parts.yaml --columns energy,gauss,e --out all.csv || fail "parts.yaml: 3 processes fail"
same one.csv all.csv "3 processes read torus.h5"
"$dvi" mesh staggered --cells 9,9 --size 1,1 --write plane.h5 >out || fail "no plane.h5"
sed 's/^mesh: .*/mesh: {file: plane.h5}/' probes.yaml >plane.yaml
"$dvi" run probes.yaml --out one.csv || fail "probes.yaml: dvi run fails"
by 3 plane.yaml --out all.csv || fail "plane.yaml: 3 processes fail"
same one.csv all.csv "3 processes read plane.h5"

# The table of modes is that of one process, but for the line about how they were found.
"$dvi" modes box.yaml --count 3 >one || fail "dvi modes fails"
if mpirun -np 2 "$dvi" modes box.yaml --count 3 >all 2>err; then
  says all '^by 2 processes: ' modes
  grep -v '^by 2 processes: ' all >table
  same one table "2 processes find modes"
else
  says err '^dvi: .*SLEPc' "modes of two processes"
fi
exit $((failures > 0))
