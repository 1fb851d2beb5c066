#!/bin/sh
# dvi view: what it finds in scenes and files, and what it refuses.  Usage: test_view.sh DVI
scenes=$(cd "$(dirname "$0")/../../../apps/scenes" && pwd) || exit 1
. "$(dirname "$0")/../check.sh"
TMPDIR=$folder
export TMPDIR

# holds PAGE TEXT NAME: require a text in the numbers of a page.
holds() { grep -qF -e "$2" "$1" || fail "$3: no '$2' in $1"; }

expect 0 'points' view "$scenes/figure-eight.yaml" --out eight.html --frames 50 --t-end 1
[ ! -s err ] || fail 'points: not silent'
holds eight.html '"points":["q_1","q_2","q_3"]' 'points'
holds eight.html '"links":[]' 'gravity is no spring'
holds eight.html '"isPlane":true' 'points of a plane'
holds eight.html '{"name":"angular_momentum"' 'a curve'
holds eight.html 'Permission is hereby granted, free of charge' 'the licence of three.js'
holds eight.html 'three.js authors' 'the licence of three.js'
grep -q '"frames":5[01],' eight.html || fail 'frames: not as many as were asked for'

expect 0 'bodies' view "$scenes/bodies/two-body.yaml" --out bodies.html --t-end 1
holds bodies.html '"bodies":[{"name":"B_1_R","point":0,"moments":{"mass":1,' 'bodies'
holds bodies.html '"second":[0.0204166667,0,0,0.015,0,0.00375]}}]' 'moments of a body'
cat >rods.yaml <<'END'
title: two masses, one held by a spring & one by a <rod>
parameters: {k: 3}
coordinates: {"q[3]": vector(3)}
lagrangian: "sum(i, dot(q[i]', q[i]'))/2 - k/2*dot(q[2] - q[1], q[2] - q[1])"
constraints: {rod: "dot(q[3] - q[2], q[3] - q[2]) - 1"}
initial: {"q[1]": [0, 0, 0], "q[2]": [1, 0, 0], "q[3]": [1, 1, 0], "q[3]'": [1, 0, 1]}
method: galerkin:degree=1
step: 0.05
until: 1
report: {columns: [energy]}
END
expect 0 'links' view rods.yaml --out rods.html --link origin:q_1
holds rods.html '"links":[[1,2],[0,1],[-1,0]]' 'rods, springs and links that are asked for'
holds rods.html '"title":"two masses, one held by a spring & one by a \u003crod>"' 'a title'
holds rods.html '&lt;rod>' 'the title of the page'
expect 0 'a chain' view chain --method verlet --h 0.1 --t-end 5 --set n=3 --out chain.html
holds chain.html '"links":[[0,1],[1,2]]' 'a chain'
cat >net.yaml <<'END'
coordinates: {"x[2,2]": scalar, "y[2,2]": scalar}
kinetic: sum(i, sum(j, x[i,j]'^2 + y[i,j]'^2))/2
potentials:
  rows: sum(j, (hypot(x[2,j] - x[1,j], y[2,j] - y[1,j]) - 1)^2)
  columns: sum(i, (hypot(x[i,2] - x[i,1], y[i,2] - y[i,1]) - 1)^2)
initial: {"x[i,j]": "i", "y[i,j]": "2*j"}
method: verlet
step: 0.1
until: 1
END
expect 0 'a net in the plane' view net.yaml --out net.html
holds net.html '"points":["1_1","1_2","2_1","2_2"]' 'a net in the plane'
holds net.html '"links":[[0,1],[0,2],[1,3],[2,3]]' 'its springs'
holds net.html '"isPlane":true' 'a net in the plane'
expect 0 'a number' view "$scenes/pendulum.yaml" --out pendulum.html --t-end 1
holds pendulum.html '"points":["state"]' 'a number and its momentum'

# Definitions are points where coordinates are none.
expect 0 'angles' view "$scenes/double-pendulum.yaml" --out double.html --t-end 2
holds double.html '"points":["upper","lower"]' 'definitions'
holds double.html '"links":[[-1,0],[0,1]]' 'rods'
expect 0 'directions' view "$scenes/bodies/spherical-double-pendulum.yaml" --out two.html --t-end 1
holds two.html '"points":["first","second"]' 'definitions in place of directions'
expect 0 'a top' view "$scenes/bodies/heavy-top.yaml" --out top.html --t-end 0.1
holds top.html '"points":["centre"]' 'a body and a definition'
holds top.html '"bodies":[{"name":"R","point":-1,"moments":{"mass":0,' 'a body and a definition'
expect 0 'one of them' view "$scenes/double-pendulum.yaml" --out lower.html --t-end 2 --point lower
holds lower.html '"points":["lower"]' 'one of them'
holds lower.html '"links":[],' 'a distance that changes is none of a rod'
expect 2 'no such definition' view "$scenes/double-pendulum.yaml" --out x.html --point lowr
says err "\-\-point lowr: .*(did you mean 'lower'?)" 'no such definition'
expect 2 'a definition of the catalogue' view kepler --method verlet --out x.html --point lower

cat >rod.yaml <<'END'
parameters: {J: [[1.6, 0, 0], [0, 1.4, 0], [0, 0, 1.2]], K: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}
domain: {x: [0, 1]}
space: fem:degree=1,cells=2
fields: {R: rotation}
density: dot(omega(R), J*omega(R))/2 - dot(kappa(R,x), K*kappa(R,x))/2
boundary: free
initial: {R: "turn([0, 0, 1], x)"}
method: lie-verlet
step: 0.01
until: 0.1
END
expect 0 'sections of a rod' view rod.yaml --out rod.html
holds rod.html '"points":["R_1","R_2","R_3"]' 'sections side by side'
holds rod.html '"title":"rod"' 'the name of a scene without a title'

expect 0 'the catalogue' view double-pendulum --method galerkin:degree=2 --h 0.02 --t-end 2 \
  --set l1=1 --out double.html
holds double.html '"links":[[-1,0],[0,1]]' 'definitions of the scene of the catalogue'

# Files of runs give the page of the scene.
columns=q_1_x,q_1_y,q_1_z,q_2_x,q_2_y,q_2_z,q_3_x,q_3_y,q_3_z,energy
expect 0 'a run' run rods.yaml --out rods.csv --columns "$columns"
expect 0 'rows and a scene' view rods.csv --scene rods.yaml --link origin:q_1 --out again.html
numbers() { sed -n '/^,"points"/,/^<\/script>/p' "$1"; }
numbers rods.html >of_scene
numbers again.html >of_rows
same of_scene of_rows 'a page of rows'
expect 0 'rows alone' view rods.csv --out alone.html
holds alone.html '"points":["q_1","q_2","q_3"]' 'names tell points'
"$dvi" view - --out stdin.html <rods.csv || fail 'standard input'
numbers alone.html >of_file
numbers stdin.html >of_stdin
same of_file of_stdin 'standard input'
"$dvi" view rods.csv --out - >stdout.html || fail 'standard output'
numbers stdout.html >of_stdout
same of_file of_stdout 'standard output'

cat >wave.yaml <<'END'
mesh: {generator: disk, cells: [3]}
field: wave
boundary: fixed
initial: {u: "1 - x^2 - y^2"}
method: leapfrog
step: {fraction: 0.5}
until: 1
END
expect 0 'a field' view wave.yaml --out wave.html --frames 5
holds wave.html '"fields":[' 'a field'
holds wave.html '{"name":"u","isByCell":false' 'a field'
holds wave.html '{"name":"energy"' 'curves beside a field'
expect 0 'grids' run wave.yaml --pvd wave.pvd --out wave.csv
expect 0 'grids of a file' view wave.pvd --rows wave.csv --field u --out grids.html
expect 0 'one grid' view wave_000001.vtu --out one.html
holds one.html '"frames":1,' 'one grid'

# What is refused.
expect 2 'no page' view rods.yaml
says err '^dvi: view: --out PAGE.html is missing' 'no page'
expect 2 'no page' view rods.yaml --out x.htm
says err 'the name of a page ends in .html' 'no page'
expect 2 'frames' view rods.yaml --out x.html --frames 1
expect 1 'no folder' view rods.yaml --out nowhere/x.html
says err "cannot write 'nowhere/x.html'" 'no folder'
expect 1 'no file' view nowhere.csv --out x.html
says err 'nowhere.csv' 'no file'
expect 1 'no list' view nowhere.pvd --out x.html
says err "cannot read 'nowhere.pvd'" 'no list'
expect 1 'no grid' view nowhere.vtu --out x.html
expect 1 'no file of HDF5' view rods.h5 --out x.html
says err "'rods.h5'" 'no file of HDF5'
expect 2 'rows and a method' view rods.csv --method verlet --out x.html
says err '\-\-method is for scenes' 'rows and a method'
expect 2 'a setting of nothing' view rods.csv --set k=2 --out x.html
expect 2 'no such point' view rods.csv --link q_1:q_4 --out x.html
says err "no point 'q_4' (did you mean 'q_1'?)" 'no such point'
expect 2 'half a link' view rods.csv --link q_1 --out x.html
expect 2 'links of fields' view wave.pvd --link a:b --out x.html
expect 2 'a point of rows alone' view rods.csv --point q --out x.html
says err '\-\-point is for scenes; give --scene' 'a point of rows alone'
expect 2 'no such field' view wave.pvd --field v --out x.html
says err "no field 'v' among" 'no such field'
expect 2 'fields of points' view rods.csv --field u --out x.html
expect 2 'rows of another run' view wave.pvd --rows rods.csv --out x.html
says err "has .* rows, and 'wave.pvd'" 'rows of another run'
expect 2 'another scene' view rods.csv --scene "$scenes/kepler.yaml" --out x.html
says err "has no column 'x', a coordinate of kepler" 'another scene'
head -n 1 rods.csv >header.csv
expect 2 'no rows' view header.csv --out x.html
says err 'has a header and no rows' 'no rows'
sed 's/^t,/time,/' rods.csv >time.csv
expect 2 'no time' view time.csv --out x.html
says err "has no column 't'" 'no time'
head -c 400 rods.csv >cut.csv
expect 1 'cut short' view cut.csv --out x.html
says err 'was cut short' 'cut short'
awk -F, -v OFS=, 'NR == 3 { $3 = "nan" } { print }' rods.csv >nan.csv
expect 1 'not a number' view nan.csv --out x.html
says err "row 2 has no number in column 'q_1_y'" 'not a number'
awk -F, -v OFS=, 'NR == 3 { $3 = "1e300" } { print }' rods.csv >large.csv
expect 1 'too large' view large.csv --out x.html
head -c 200 wave.pvd >cut.pvd
expect 1 'a list that was cut short' view cut.pvd --out x.html
says err 'it is cut short' 'a list that was cut short'
head -c 300 wave_000001.vtu >cut.vtu
expect 1 'a grid that was cut short' view cut.vtu --out x.html
expect 2 'the scene itself' view rods.yaml --out rods.yaml
cp rods.yaml kept.html
expect 1 'a failed run' view rods.yaml --method galerkin:degree=1 --h 4 --t-end 4 --out kept.html
same rods.yaml kept.html 'a failed run leaves the old page'
[ ! -e x.html ] || fail 'a page without a reason'
# A run that a signal ends has the page of its rows, and the code of dvi run.
"$dvi" view kepler --method verlet --h 1e-3 --t-end 1e9 --out ended.html 2>err &
for _ in $(seq 100); do
  ls dvi-view-*/rows.csv.part-* >/dev/null 2>&1 && break
  sleep 0.1
done
kill -INT $!
ends 130 'Ctrl-C'
holds ended.html '"points":["point"]' 'the page of an ended run'

for left in dvi-view-*; do [ ! -e "$left" ] || fail "$left was left behind"; done
no_trace 'view'
finish
