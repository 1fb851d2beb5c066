#!/bin/sh
# All that mpirun -np N dvi run does: the rows of dvi run, checkpoints that go on with other numbers
# of processes, files, signals, kills, refusals. Skipped where dvi has no module for processes.
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
columns=energy,growth,momentum_x,angular_z,tip_z,middle
as_one 2 solid.yaml --columns $columns
as_one 3 solid.yaml --columns $columns --threads 2
as_one 4 solid.yaml --columns $columns --method verlet
as_one 3 solid.yaml --columns $columns --method avi:classes=no
sed -e 's/{cpml: 2}/absorbing/' \
  -e 's/^  s: .*/  s: {of: B, at: [0.9, 0.9, 0.9], along: [0, 0, 1]}/' grid.yaml >walls.yaml
as_one 3 walls.yaml --columns energy,gauss,charge,divergence,e,s
by 2 wave.yaml >all.csv || fail "no rows on standard output"
by 1 wave.yaml >one.csv
same one.csv all.csv "standard output"
as_one 2 wave.yaml --final --plot all.svg
[ -s all.svg ] || fail "no plot"

# ---- drawn fields ----

cat >block.yaml <<'SCENE'
mesh: {generator: kuhn, cells: [2, 2, 2], size: [1, 1, 1], grading: 2}
field: elastic
materials: {all: {law: neo-hookean, lambda: 1, mu: 1, rho: 1}}
initial: {u: "[0, 0, 0]", u': "[0.2*y, -0.1*z, 0.15*x*z]"}
method: avi
step: {fraction: 0.5}
until: 1
SCENE
sed 's/^mesh: .*/mesh: {generator: kuhn, cells: [40], size: [1]}/
  /^ *all:/d; /^materials/d; s/exp(.*)/exp(-30*(x - 0.4)^2)/' wave.yaml >string.yaml
drawn 2 pvd u.pvd wave.yaml --every 10
drawn 4 pvd u.pvd block.yaml --every 5
drawn 3 pvd u.pvd grid.yaml --every 10
sed -e 's/^boundary:.*/boundary: periodic/' -e '/^ *s: /d' grid.yaml >around.yaml
drawn 2 pvd u.pvd around.yaml --every 10 # a grid small enough for a mesh, which processes share
drawn 3 map u.svg string.yaml
drawn 2 map u.svg string.yaml --map-of u
"$dvi" mesh bcc-torus --cells 3,3,3 --size 1,1,1 --write torus.h5 >out || fail "no torus.h5"
sed 's/^mesh: .*/mesh: {file: torus.h5}/' torus.yaml >parts.yaml
mkdir parts
"$dvi" run torus.yaml --every 12 --out rows.csv --pvd field.pvd
(cd parts && by 3 ../parts.yaml --every 12 --out rows.csv --pvd field.pvd) ||
  fail "no fields of a mesh in parts"
for file in field.pvd field_00000*.vtu; do same $file parts/$file "a mesh in parts"; done
if [ -e "$modules/dvi_hdf5.so" ]; then
  drawn 3 pvd u.vtkhdf torus.yaml --every 12
  drawn 2 pvd u.vtkhdf block.yaml --every 5
  drawn 2 pvd u.vtkhdf wave.yaml --every 10
  drawn 4 pvd u.vtkhdf grid.yaml --every 10
  together 1 'cannot write' wave.yaml --out rows.csv --pvd /nowhere/u.vtkhdf
fi
together 1 'cannot write' wave.yaml --out rows.csv --pvd /nowhere/u.pvd
together 2 'the name ends in .pvd' wave.yaml --pvd u.vtu
together 2 'is on a mesh of more dimensions' wave.yaml --map u.svg

# ---- implicit methods ----

# By implicit methods any number of processes writes the same rows, which are those of one up to
# roundoff. Their last step is shorter where h does not divide the time.
for method in midpoint imex galerkin:degree=2; do
  for count in 1 2 3; do
    by $count kink.yaml --method $method --h 0.05 --t-end 0.53 --every 2 >rows$count.csv ||
      fail "$count processes: no rows by $method"
  done
  same rows2.csv rows3.csv "two and three processes by $method"
  paste -d , rows1.csv rows3.csv | awk -F , '
    NR == 1 { if ($1 != $3 || $2 != $4) exit 1; next }
    $1 != $3 || ($2 - $4) ^ 2 > 1e-26 { exit 1 }
    END { if (NR != 8 || $1 != 0.53) exit 1 }' ||
    fail "$method: $(cat rows3.csv), and of one $(cat rows1.csv)"
done

# The states of several processes go on with other numbers of them. That of one is another file.
for count in 1 2; do
  by $count kink.yaml --method midpoint --h 0.05 --t-end 0.5 --checkpoint from$count.state >half ||
    fail "$count processes: no state of midpoint"
done
by 2 kink.yaml --method galerkin --h 0.05 --t-end 0.5 --checkpoint half.state >half ||
  fail "no state of galerkin"
by 2 kink.yaml --method galerkin --h 0.05 --t-end 1 --every 5 | tail -n 2 >whole
by 3 kink.yaml --method galerkin --h 0.05 --t-end 1 --every 5 --resume half.state >part
tail -n 2 part >rest
same whole rest "two processes and then three by galerkin"
together 2 'galerkin on shares has degree=1 or degree=2' wave.yaml --method galerkin:degree=3
together 1 'is the state of an integrator, and of no march' kink.yaml --method midpoint --h 0.05 \
  --resume from1.state
by 1 kink.yaml --method midpoint --h 0.05 --resume from2.state 2>err && fail "one goes on"
says err 'it is the state of a march of a field' 'the state of two processes'

# What a product by midpoint exchanges of Maxwell's fields are edges, which are more than cells.
by=$(mpirun -np 3 "$dvi" explain torus.yaml --method midpoint --h 0.05 --csv shares.csv) ||
  fail "explain by midpoint fails: $by"
awk -F, 'NR > 1 && !($7 > 8 * $4) { bad++ } END { exit NR != 4 || bad }' shares.csv ||
  fail "explain by midpoint: $(cat shares.csv)"

# ---- steps of more processes ----

# Solids, and meshes that no process reads as a whole.
"$dvi" mesh bcc-torus --cells 3,3,3 --size 1,1,1 --write torus.h5 >out || fail "no torus.h5"
sed 's/^mesh: .*/mesh: {file: torus.h5}/' torus.yaml >parts.yaml
for scene in 'bar.yaml --method verlet' parts.yaml; do
  # shellcheck disable=SC2086
  mpirun -np 3 "$dvi" bench $scene --scale ranks=1,2,3,...,40 --rounds 1 --steps 2 \
    --csv scale.csv >out || fail "$scene: no scaling"
  awk -F, '$1 == "strong" { rows++; measured += $10 != ""; bad += !($5 > 0 && $6 > 0) }
    END { exit !(rows >= 8 && measured == 3 && !bad) }' scale.csv ||
    fail "$scene: $(cat scale.csv)"
done
says out '^  start: ranks read the mesh in parts' parts.yaml
says out '^mesh: 324 cells' parts.yaml
# Maxwell's fields by midpoint: the same energy as that of the system on one process.
for count in 1 2 3; do
  by $count torus.yaml --method midpoint --h 0.1 --columns energy --out torus$count.csv ||
    fail "$count processes: no Maxwell by midpoint"
done
same torus2.csv torus3.csv "two and three processes by midpoint"
paste -d , torus1.csv torus3.csv | awk -F , '
  NR > 1 && ($1 != $3 || ($2 - $4) ^ 2 > 1e-28) { exit 1 }' ||
  fail "Maxwell by midpoint: $(cat torus3.csv), and of one $(cat torus1.csv)"

# A start by B has a potential.
{
  sed -e '/^probes/,/^  e:/d' -e '/^sources/,/ring/d' -e 's/left: absorbing/left: pec/' box.yaml
  echo 'initial: {B: [x*(1-x)*(1-2*y), -(1-2*x)*y*(1-y), 0]}'
} >curl.yaml
as_one 2 curl.yaml
by 2 curl.yaml --method midpoint --h 0.1 --final >out || fail 'no start from B by midpoint'

# ---- checkpoints ----

# goes_on N M SCENE OPTION...: half of a run by N, and the rest by M, are the whole one.
goes_on() {
  first=$1 second=$2 file=part.$rows
  shift 2
  rm -f "$file" "a.$state"
  by "$first" "$@" --t-end 0.4 --out $file --checkpoint "a.$state" || fail "$*: $first fail"
  same "half.$state" "a.$state" "$*: the checkpoint of $first"
  by "$second" "$@" --t-end 1 --out $file --resume "a.$state" || fail "$*: $second do not go on"
  if [ $rows = h5 ]; then
    "$dvi" plot $file --out part.svg >/dev/null 2>&1
    h5diff whole.h5 part.h5 rows || fail "$*: $first and then $second have other rows"
  else
    { cat half.csv; sed 1,2d part.csv; } >joined.csv
    same whole.csv joined.csv "$*: $first and then $second"
  fi
}

# other_counts ENDING SCENE OPTION...: checkpoints go on with other numbers of processes.
other_counts() {
  rows=csv state=$1
  shift
  by 1 "$@" --t-end 0.4 --out half.csv --checkpoint "half.$state" || fail "$*: no checkpoint"
  by 1 "$@" --t-end 1 --out whole.csv || fail "$*: no run"
  goes_on 1 3 "$@"
  goes_on 3 1 "$@"
  goes_on 2 4 "$@"
}

# every_way SCENE OPTION...: the same, and with rows in files of HDF5.
every_way() {
  other_counts state "$@"
  command -v h5diff >/dev/null && [ -e "$modules/dvi_hdf5.so" ] || return
  rows=h5
  rm -f whole.h5
  by 1 "$@" --t-end 1 --out whole.h5 || fail "$*: no run"
  goes_on 3 2 "$@"
}
every_way wave.yaml --h 0.002 --every 4
every_way grid.yaml --h 0.01 --every 5
every_way solid.yaml --h 0.004 --every 5 --method verlet

# States in parts.
other_counts h5 block.yaml --h 0.01 --every 5
other_counts h5 wave.yaml --h 0.002 --every 4
by 2 kink.yaml --method midpoint --h 0.05 --t-end 0.5 --out half.csv --checkpoint kink.h5
by 3 kink.yaml --method midpoint --h 0.05 --t-end 1 --out rest.csv --resume kink.h5
by 2 kink.yaml --method midpoint --h 0.05 --t-end 1 --out whole.csv
{ cat half.csv; sed 1,2d rest.csv; } >joined.csv
same whole.csv joined.csv 'midpoint in parts'
cp half.state old.h5
head -c 3000 half.h5 >cut.h5
together 1 'it is no file of HDF5' wave.yaml --h 0.002 --resume old.h5
together 1 'cut short' wave.yaml --h 0.002 --resume cut.h5
together 1 'is of another field' wave.yaml --h 0.001 --resume half.h5
together 2 'is a state in parts by its name.*and yee has not' grid.yaml --checkpoint a.h5
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

# mpirun hands a signal on, and waits for a second.
rm -f long.csv a.state
begin 2 a.state wave.yaml --t-end 1e7 --every 1000 --out long.csv --checkpoint a.state \
  --checkpoint-every 1000
kill -TERM "$mpirun"
ended
[ "$code" -ne 0 ] || fail "a signal to mpirun: exit code 0"
says err '^dvi: run: signal 15 ended the run at t' 'a signal to mpirun'
[ -s long.csv ] || fail "a signal to mpirun: no rows"

# ---- refusals ----

alone 'MPI knows of 1'
together 2 'kepler is none' kepler
together 2 'leapfrog, midpoint, imex and galerkin alone, not verlet' wave.yaml --method verlet
# The process that owns the stiffest cell speaks.
together 1 'the step 1 is not below the bound' wave.yaml --h 1
# That cell is at one end of a string, and then at the other one: the first process is silent once.
for stiff in '1 + 9*x' '10 - 9*x'; do
  sed -e "s/rho: .*/rho: 1, a: $stiff}/" -e 's/exp(.*)/x*(1 - x)/' \
    -e 's/^mesh: .*/mesh: {generator: interval, cells: 40}/' wave.yaml >stiff.yaml
  together 1 'the step 1 is not below the bound' stiff.yaml --h 1
done
sed 's/exp(/sqrt(x - 0.5)*exp(/' wave.yaml >nan.yaml
sed 's/0.9, 0.13/3, 4/' probes.yaml >outside.yaml
together 2 'the start is not finite at vertex' nan.yaml # on one process, on which the others wait
together 2 'run: 2 processes share yee alone, not avi; take yee, or' grid.yaml --method avi
together 2 'run: 2 processes share avi and verlet alone, not tents; take avi, or' solid.yaml \
  --method tents
together 2 'kink.yaml:7:9: march: the field has a potential, .*; midpoint does' kink.yaml
together 2 '--method yee: several processes share yee on grids' torus.yaml --method yee
together 2 'run: --alarm is for mechanical methods such as midpoint in one process' wave.yaml \
  --alarm energy=1

# edited SCENE EDIT PLACE WORDS: processes refuse an edited scene at a place.
edited() {
  sed "$2" "$1" >edited.yaml
  together 2 "edited.yaml:$3: .*$4" edited.yaml
}
edited wave.yaml 's/^method: .*/method: yee/' 7:9 'imex and galerkin alone, not yee; take l'
edited wave.yaml 's/^boundary.*/&\nstar: barycentric/' 6:7 'not diagonal .* take midpoint, the c'
edited wave.yaml 's/^boundary.*/&\ndamping: 0.1/' 6:10 'takes the friction in one process'
edited torus.yaml 's/^field.*/&\nstar: whitney/' 3:7 'not diagonal .* take the circumcentric star'
edited torus.yaml 's/{E: .*/{B: [0, 0, 1]}/' 5:10 'no potential has this field B'
edited solid.yaml 's/alpha: 0.1/beta: 0.1/' 3:12 'a damping beta .* take one process'
edited wave.yaml 's/^field: .*/space: fem:degree=1\nfields: {u: scalar}\ndensity: u'"'"'^2\/2/
  /^ *all/d; /^materials/d; s/fixed/free/; s/leapfrog/midpoint/; s/{fraction: 0.5}/0.1/' 4:10 \
  'no densities: run this one in one process'
sed -e 's/cells: .*/cells: [50]}/' -e 's/{E: .*/{E: x}/' -e '/^ *[es]:/d' -e '/^probes/d' \
  -e '/cpml/d' grid.yaml >line.yaml
together 2 'line.yaml:1:7: yee: a grid of one axis cannot be divided' line.yaml
together 2 "the probe 'b' is outside of the mesh" outside.yaml
together 1 "cannot write '/nowhere/rows.csv'" wave.yaml --out /nowhere/rows.csv
together 1 "cannot write '/nowhere/state'" wave.yaml --checkpoint /nowhere/state
exit $((failures > 0))
