#!/bin/sh
# dvi mesh, dvi modes, dvi solve, and scenes of fields: digits, files, refusals.
# Usage: test_fields.sh DVI
. "$(dirname "$0")/check.sh"

# near FILE NAME VALUE: require that the row of a quantity in FILE is VALUE to 12 digits.
near() {
  awk -F, -v name="$2" -v value="$3" '
    $1 == name { found = 1; d = $2 - value; wrong = d*d > 1e-24 * (1 + value*value) }
    END { exit !found || wrong }' "$1" || { fail "$2 is $3"; grep "^$2," "$1"; }
}

# ---- dvi mesh ----

expect 0 'an audit' mesh staggered --cells 8,8 --csv -
near out vertices 85
near out edges 220
near out triangles 136
near out betti_0 1
near out betti_1 0
near out orientable 1
near out manifold 1
near out zero_duals_1 0
expect 0 'a surface of genus 2' mesh genus-2 --csv genus.csv
near genus.csv betti_1 4
expect 0 'to glue' mesh kuhn --cells 2,2,2 --repair glue --csv - --write glued.msh
near out boxes 8
near out zero_duals_1 0
expect 0 'what was written' mesh glued.msh --csv -
near out boxes 8
near out total_volume_3 1
expect 0 'help' mesh --help
says out '--repair' 'the options'
expect 2 'another repair' mesh disk --repair weld
expect 2 'a word for a number' mesh disk --cells many
expect 2 'a part of a cell' mesh disk --cells 1.5
expect 2 'cells of a file' mesh glued.msh --cells 2
expect 1 'no file' mesh nothing.msh
expect 2 'to flip boxes' mesh box --repair flip
printf '$MeshFormat\n4.1 0 8\n' >cut.msh
expect 1 'a file cut short' mesh cut.msh
says err 'cut.msh' 'the file is named'

printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n3 0 1 2\n3 0 3 4\n' >pinch.off
expect 0 'a vertex of two fans' mesh pinch.off
says out '1 pinched, .* vertex 0, at (0, 0)' 'the pinched vertex is named'
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n' >book.off
expect 0 'an edge of three triangles' mesh book.off
says out 'more than two cells, .* number 0, at (0.5, 0, 0), of the edges' 'the edge is named'
expect 2 'a generator that is none' mesh disc
says err "neither a file nor a generator (did you mean 'disk'?)" 'the nearest generator'

# ---- scenes ----

cat >drum.yaml <<END
mesh: {generator: staggered, cells: [8, 8]}
field: wave
boundary: fixed
source: 2*pi^2*sin(pi*x)*sin(pi*y)
initial: {u: sin(pi*x)*sin(pi*y)}
method: verlet
step: 0.02
until: 1
END
expect 0 'modes' modes drum.yaml --count 2 --csv -
near out 1 19.362777564429
near out 2 46.629256462815
expect 0 'a free rim' modes drum.yaml --count 2 --near 50 --csv near.csv --vtu modes.vtu
says near.csv '^index,eigenvalue,omega$' 'the columns'
says modes.vtu 'mode_2' 'the shapes'
sed 's/boundary: fixed/boundary: free/' drum.yaml >free.yaml
expect 0 'a free rim' modes free.yaml --count 2 --csv -
near out 1 9.743283624691
near out 2 9.755353316864
says err '1 of frequency zero' 'zero modes are counted'
expect 0 'a static problem' solve drum.yaml --csv - --vtu u.vtu
awk -F, '$2 == 0.5 && $3 == 0.5 { d = $4 - 1.020206; exit !(d*d < 1e-12) }' out ||
  fail 'the error at the centre'
says u.vtu 'Name="u"' 'the values'
expect 1 'data out of balance' solve free.yaml
says err 'sum to' 'why there is no solution'
expect 0 'a run' run drum.yaml --final
says out '^t,energy$' 'invariants are the columns'
expect 0 'a series' run drum.yaml --every 25 --pvd wave.pvd --out rows.csv
says wave.pvd 'timestep="0.5".*wave_000001.vtu' 'the list of files'
says wave_000002.vtu 'Name="u"' 'the last file'
expect 2 'a series of another name' run drum.yaml --pvd wave.vtu
expect 2 'a series without a field' run kepler --method verlet --pvd wave.pvd
expect 0 'an order study' order drum.yaml
says out 'verlet: claimed order 2' 'the order'
expect 0 'a check' check drum.yaml
expect 1 'a step that is too long' run drum.yaml --h 0.5 --final
says err 'h may be' 'the bound is named'

cat >plates.yaml <<END
mesh: {generator: staggered, cells: [8, 8]}
field: wave
boundary: {left: {fixed: 1}, right: {fixed: 3}}
probes: {ear: {at: [0.25, 0.5]}}
END
expect 0 'two plates' solve plates.yaml
says out '^energy     2$' 'the energy, with that of the fixed values'
says out '^ear        1.5$' 'the probe'

cat >mixed.yaml <<END
parameters: {k: 2}
mesh: {generator: staggered, cells: [16, 16]}
field: wave
materials: {all: {rho: 1 + x, a: k}}
boundary:
  left: {fixed: sin(y)}
  all: {free: "k*dot(normal, [exp(x)*sin(y), exp(x)*cos(y)])"}
solve: {mean: 0}
END
expect 0 'mixed data' solve mixed.yaml --csv -
awk -F, 'NR > 1 { d = $4 - exp($2)*sin($3); if (d*d > 1e-5) exit 1 }' out ||
  fail 'the solution exp(x) sin(y)'
expect 0 'a scene without a start' run mixed.yaml --method verlet --h 0.01 --t-end 0.1 --final

expect 0 'probes of a march' run plates.yaml --method leapfrog --h 0.01 --t-end 0.1 --final
says out '^t,energy,ear$' 'probes of a march'

cat >kink.yaml <<END
parameters: {v: 0.5}
mesh: {generator: interval, cells: 200, size: 40, origin: -20}
field: wave
potential: 1 - cos(u)
initial:
  u: 4*atan(exp((x + 5)/sqrt(1 - v^2)))
  u': -2*v/sqrt(1 - v^2)/cosh((x + 5)/sqrt(1 - v^2))
method: galerkin:degree=2
step: 0.1
until: 10
END
expect 0 'a kink' run kink.yaml --final
awk -F, 'NR == 2 { d = $2 - 9.2376; exit !(d*d < 1e-3) }' out || fail 'the energy of a kink'
expect 0 'a kink, checked' check kink.yaml
sed 's/^until:.*/until: 1/' drum.yaml >ear.yaml
printf 'probes: {ear: {at: [0.5, 0.5]}, rim: {at: [0, 0.3]}}\n' >>ear.yaml
expect 0 'probes' run ear.yaml --every 50
awk -F, 'NR == 1 { good = $0 == "t,energy,ear,rim" }
  NR == 2 { d = $3 - 1; good = good && d*d < 1e-20 && $4 == 0 } END { exit !good }' out ||
  { fail 'the value at the centre'; cat out; }

# The integral of x (1 + x) by the trapezoidal rule in four cells is 4 + 2/3 + 1/12.
cat >sums.yaml <<END
mesh: {generator: box, cells: [4, 4], size: [2, 1]}
field: wave
initial: {u: 1 + x}
probes:
  area: {integral: 1}
  mean: {integral: u*1/2, over: all}
  moment: {integral: x*u}
  ear: {at: [1, 0.5]}
method: verlet
step: 0.01
until: 0.01
END
expect 0 'integrals' run sums.yaml --every 1
awk -F, 'NR == 1 { good = $0 == "t,energy,area,mean,moment,ear" }
  NR == 2 { good = good && $3 == 2 && $4 == 2 && $5 == 4.75 && $6 == 2 } END { exit !good }' out ||
  { fail 'integrals over a rectangle'; cat out; }

# refuse NAME WORDS: require that the scene on standard input is refused with these words.
refuse() {
  cat >wrong.yaml
  expect 2 "$1" check wrong.yaml
  says err "$2" "$1"
}
refuse 'no field' "section 'field' is missing" <<END
mesh: {generator: disk}
END
refuse 'no mesh' "has no 'mesh'" <<END
field: wave
END
refuse 'mechanics beside a mesh' "no section 'lagrangian'" <<END
mesh: {generator: disk}
field: wave
lagrangian: 1
END
refuse 'another field' 'field is wave' <<END
mesh: {generator: disk}
field: flux
END
refuse 'another star' 'star is circumcentric, barycentric, whitney or spectral' <<END
mesh: {generator: disk}
field: wave
star: galerkin
END
refuse 'no such part' "has no part 'left'" <<END
mesh: {generator: disk}
field: wave
boundary: {left: fixed}
END
refuse 'u in a source' 'without u' <<END
mesh: {generator: disk}
field: wave
source: u^2
END
refuse 'a normal in a value' 'no normal' <<END
mesh: {generator: disk}
field: wave
boundary: {rim: {fixed: "normal[1]"}}
END
refuse 'no such name' 'z' <<END
mesh: {generator: disk}
field: wave
source: z
END
refuse 'a source that is not finite' 'wrong.yaml:3' <<END
mesh: {generator: disk}
field: wave
source: 1/x
END
refuse 'a density that is not positive' 'rho is -0.0625 in cell 2, where a number above 0' <<END
mesh: {generator: disk}
field: wave
materials: {all: {rho: x}}
END
refuse 'a generator that is none' 'there is no generator "dish"' <<END
mesh: {generator: dish}
field: wave
END
refuse 'a file outside' "'..'" <<END
mesh: {file: ../outside.msh}
field: wave
END
for name in t energy u_1 p_u_2; do
  refuse "a probe named $name" "there is a column '$name' already" <<END
mesh: {generator: interval}
field: wave
probes: {$name: {at: 0.5}}
END
done
refuse 'a probe named as a momentum' "there is a column 'momentum_x' already" <<END
mesh: {generator: interval, periodic: 1}
field: wave
probes: {momentum_x: {at: 0.5}}
END
refuse 'a probe outside' 'outside of the mesh' <<END
mesh: {generator: disk}
field: wave
probes: {ear: {at: [2, 0]}}
END
refuse 'a point and an integral' 'or an integral' <<END
mesh: {generator: disk}
field: wave
probes: {ear: {at: [0, 0], integral: u}}
END
refuse 'an integral over a rim' "no part 'rim' of cells" <<END
mesh: {generator: disk}
field: wave
probes: {ear: {integral: u, over: rim}}
END
refuse 'two meshes' 'a generator or a file' <<END
mesh: {generator: disk, file: glued.msh}
field: wave
END
expect 0 'a mesh of a file' mesh disk --write disk.msh
printf 'mesh: {file: disk.msh}\nfield: wave\nboundary: {rim: fixed}\n' >file.yaml
expect 0 'modes of a file' modes file.yaml --count 1
expect 2 'modes without a field' modes kepler
for command in check run modes solve explain; do
  expect 2 'a parameter that is none' $command file.yaml --set heavy=1
  says err "there is no parameter 'heavy'" 'the parameter is named'
done
sed 's/^field:/parameters: {k: 1}\nmaterials: {all: {a: k}}\nfield:/' ear.yaml >tuned.yaml
expect 0 'a sweep' sweep tuned.yaml --set k=1,4 --out sweep.csv
says sweep.csv '^k,status,steps,t,energy,ear,rim,energy_error$' 'probes are the columns'
expect 0 'a plot of probes' run ear.yaml --final --plot ear.svg
says err 'draws over t: ear, rim; change since the start: energy' 'probes are signals'
expect 0 'what is there' explain drum.yaml
says out '^field: 53 unknowns' 'unknowns'
says out 'verlet and leapfrog are stable below h = 0.1' 'the stable step'
head -c 300 disk.msh >cut.msh
printf 'mesh: {file: cut.msh}\nfield: wave\n' >cut.yaml
expect 1 'a mesh that is cut short' check cut.yaml
says err 'cut.yaml:1:14: cut.msh' 'scene and mesh are named'
finish
