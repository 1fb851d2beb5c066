#!/bin/sh
# What commands write and draw of scenes with densities: maps over space and time, frames, files of
# static states and modes, spectra; and what other commands make of such scenes.
# Usage: test_density_output.sh DVI
. "$(dirname "$0")/check.sh"

# line FILE NUMBER COLUMN VALUE TOLERANCE: require a number in a line of a CSV file.
line() {
  awk -F, -v number="$2" -v column="$3" -v value="$4" -v tolerance="$5" '
    NR == number { d = $column - value; seen = d <= tolerance && d >= -tolerance }
    END { exit !seen }' "$1" || { fail "$1: line $2, column $3 is $4"; sed -n "$2p" "$1"; }
}

# The breather of the sine-Gordon equation, whose frequency is w.
cat >breather.yaml <<END
parameters: {w: 0.5, k: sqrt(1 - w^2)}
domain: {x: [-20, 20]}
space: fem:degree=2,cells=60
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))
boundary: periodic
initial: {u: "4*atan(k/w/cosh(k*x))"}
probes: {middle: u(0)}
method: verlet
step: 0.05
until: 200
END

# ---- maps ----

expect 0 'a map' run breather.yaml --final --map breather.svg --t-end 20
says err '^dvi: run: --map breather.svg draws u over x and t$' 'what it draws'
says breather.svg '<image' 'a picture'
expect 0 'a map of rates' run breather.yaml --every 50 --map rate.svg --map-of "u'" --t-end 20
says err "draws u' over x and t" 'what it draws'
cmp -s breather.svg rate.svg && fail 'two quantities have two pictures'
expect 0 'a map backward' run breather.yaml --final --map back.svg --h -0.05 --t-end -5
expect 2 'no such quantity' run breather.yaml --map x.svg --map-of v
says err "no such quantity.*the fields show u, u', and derivatives such as d(u,x)" 'what there is'
expect 0 'a map of slopes' run breather.yaml --every 50 --map slope.svg --t-end 20 \
  --map-of 'd(u, x)'
says err 'draws d(u,x) over x and t' 'what it draws'
cmp -s breather.svg slope.svg && fail 'two quantities have two pictures'
expect 0 'a map of slopes of rates' run breather.yaml --map x.svg --map-of "d(u',x)" --t-end 1
rm x.svg
expect 2 'no such axis' run breather.yaml --map x.svg --map-of 'd(u,y)'
expect 2 'no such field' run breather.yaml --map x.svg --map-of 'd(v,x)'
expect 2 'no SVG' run breather.yaml --map x.png
expect 2 'a quantity without a map' run breather.yaml --map-of u
expect 2 'a map of several runs' run breather.yaml --map x.svg --verify
expect 2 'one file for two pictures' run breather.yaml --map x.svg --plot x.svg
expect 2 'no field' run kepler --method verlet --h 0.1 --t-end 1 --map x.svg
says err '--map is for fields, and kepler is none' 'the reason'
expect 1 'one row' run breather.yaml --t-end 0 --map x.svg
says err 'it needs rows at two times' 'the reason'
[ ! -e x.svg ] || fail 'a picture of a run that was refused'

# ---- spectra ----

# Of the probe: w and its odd multiples. The mesh and the step move them by some 2e-4 of themselves.
expect 0 'rows for a spectrum' run breather.yaml --every 2 --out rows.csv
expect 0 'a spectrum' spectrum rows.csv --columns middle --band 0.3:2.6 --csv lines.csv
awk -F, 'NR > 1 && $5 > 0.05 {
    n = 2 * count++ + 1; d = $2 / (0.5 * n) - 1; if (d*d > 1e-7) bad = 1 }
  END { exit bad || count != 3 }' lines.csv || { fail 'w, 3 w and 5 w'; cat lines.csv; }

# ---- frames and files of a line ----

expect 0 'frames' run breather.yaml --every 100 --t-end 10 --pvd line.pvd --out /dev/null
says line.pvd 'timestep="5".*line_000001.vtu' 'the second frame'
grep -a -q 'NumberOfPoints="121" NumberOfCells="120"' line_000000.vtu ||
  fail 'two parts a cell, and both ends'
expect 0 'a curve' plot line_000001.vtu --out curve.svg
says curve.svg '>u<' 'its name'

cat >trap.yaml <<END
domain: {x: [-8, 8]}
space: spline:degree=3,cells=40
schroedinger: {potential: x^2/2}
boundary: fixed
initial: {psi: "[exp(-(x-1)^2/2)*cos(x), exp(-(x-1)^2/2)*sin(x)]"}
probes: {norm: {integral: "dot(psi,psi)"}}
method: vprk:nodes=2
step: 0.05
until: 1
END
expect 0 'a map of a complex field' run trap.yaml --final --map trap.svg --pvd trap.pvd
says err 'draws |psi|^2 over x and t' 'the square'
for name in psi_re psi_im '|psi|^2'; do
  grep -a -q -F "Name=\"$name\"" trap_000000.vtu || fail "a frame has $name"
done
expect 0 'its phase' run trap.yaml --final --map phase.svg --map-of 'phase(psi)'
expect 2 'a rate of a field of first order' run trap.yaml --map x.svg --map-of "psi_re'"
says err 'show psi_re, psi_im, |psi|^2, phase(psi)' 'what there is'
expect 0 'its curves' plot trap_000000.vtu --field psi_re --field '|psi|^2' --out curves.svg

# A march, whose values are those of vertices.
sed 's/^space.*/space: fem:degree=1,cells=100/; s/^method.*/method: multisymplectic/' \
  breather.yaml >lattice.yaml
expect 0 'a map of a march' run lattice.yaml --t-end 5 --final --map march.svg --pvd march.pvd
says err 'draws u over x and t' 'what it draws'
grep -a -q 'NumberOfPoints="101"' march_000000.vtu || fail 'a frame of a march'
expect 0 'rates of a march' run lattice.yaml --t-end 5 --final --map march.svg --map-of "u'"

cat >wave.yaml <<END
mesh: {generator: interval, cells: 50, size: 4}
field: wave
boundary: {left: fixed, right: fixed}
initial: {u: "exp(-((x - 2)/0.3)^2)"}
step: {fraction: 0.9}
until: 3
END
for method in leapfrog verlet; do
  expect 0 "a wave on a mesh, $method" run wave.yaml --method $method --final --map wave.svg
  says err 'draws u over x and t' 'what it draws'
done
expect 2 'what a wave does not show' run wave.yaml --method verlet --map x.svg --map-of v
says err 'shows u alone' 'the reason'

# ---- planes and space ----

cat >plate.yaml <<END
domain: {x: [0, 1], y: [0, 1]}
space: fem:degree=2,cells=6
fields: {u: scalar}
density: u'^2/2 - dot(grad(u),grad(u))/2 + u
boundary: fixed
initial: {u: "sin(pi*x)*sin(pi*y)"}
method: verlet
step: {fraction: 0.5}
until: 0.2
END
expect 2 'a map of a plane' run plate.yaml --map x.svg
says err 'that of plate is in a plane; --pvd writes it' 'what helps'
expect 0 'frames of a plane' run plate.yaml --final --pvd plate.pvd
expect 0 'a filled map' plot plate_000000.vtu --field u --edges --out plate.svg
# At its middle the membrane under a load of 1 hangs 0.0736713 down.
expect 0 'a static state' solve plate.yaml --csv plate.csv --vtu static.vtu
says plate.csv '^x,y,u$' 'its columns'
[ "$(wc -l <plate.csv)" -eq 170 ] || fail '13 by 13 vertices'
line plate.csv 86 1 0.5 1e-15
line plate.csv 86 2 0.5 1e-15
line plate.csv 86 3 0.0736713 1e-4
grep -a -q 'NumberOfPoints="169" NumberOfCells="144"' static.vtu || fail 'parts of cells'
expect 0 'modes' modes plate.yaml --count 2 --vtu modes.vtu --shapes shapes.csv
says shapes.csv '^x,y,u_mode_1,u_mode_2$' 'their columns'
expect 0 'a mode' plot modes.vtu --field u_mode_2 --out mode.svg
sed 's/y: \[0, 1\]/&, z: [0, 1]/; s/degree=2,cells=6/degree=1,cells=3/; s/sin(pi\*y)/&*sin(pi*z)/' \
  plate.yaml >box.yaml
expect 0 'a box' solve box.yaml --vtu box.vtu
grep -a -q 'NumberOfPoints="64" NumberOfCells="27"' box.vtu || fail 'a mesh of boxes'
expect 0 'its outside' plot box.vtu --out box.svg
expect 2 'a map of a box' run box.yaml --map x.svg
says err 'that of box is in space' 'the reason'

# ---- other commands ----

expect 0 'one part of a run' run breather.yaml --t-end 5 --checkpoint half.state --out half.csv
expect 0 'the other part' run breather.yaml --t-end 10 --resume half.state --out rest.csv
expect 0 'the whole run' run breather.yaml --t-end 10 --out whole.csv
sed '1,2d' rest.csv | cat half.csv - | cmp -s - whole.csv || fail 'a resumed run has its bits'
expect 1 'another method' run breather.yaml --method midpoint --resume half.state --out rest.csv
says err 'verlet there, midpoint here' 'the reason'
expect 0 'digits' run breather.yaml --method galerkin:degree=3 --t-end 1 --verify --columns middle
says out 'halving the step divides the error' 'how errors fall'
expect 2 'stability' stability breather.yaml
says err 'all steps of the density of .breather.yaml. are equal' 'the reason'
expect 2 'a gradient' gradient breather.yaml
says err 'has no Lagrangian of R^n' 'the reason'

expect 2 'a march at once' path lattice.yaml --ends initial --steps 3
says err 'multisymplectic is a march of a field' 'the reason'
expect 2 'a march at several points' sweep lattice.yaml --set w=0.5,0.6 --out x.csv
says err 'multisymplectic is a march of a field' 'the reason'
expect 2 'digits of a march' run lattice.yaml --verify
says err '--verify is for mechanical methods' 'the reason'
expect 2 'a path of first order' path trap.yaml --ends initial --steps 3
says err 'its equations are of first order' 'the reason'

# All of a path at once. On the circle all frequencies are whole numbers, so that values at t = 0
# and t = pi say nothing of the motion between.
cat >circle.yaml <<END
domain: {x: [0, 2*pi]}
space: fourier:modes=1
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2
boundary: periodic
initial: {u: cos(x)}
probes: {ear: u(0)}
until: 1
END
path="path circle.yaml --method galerkin:degree=8 --ends fixed --steps 2 --to 0,0,0"
# u = cos(x) sin(1 - t)/sin(1), and the coefficient of cos(x) is sqrt(pi)
expect 0 'values at two times' $path --t-end 1 --out path.csv
line path.csv 3 3 1.00985019978 1e-9
{ cat circle.yaml; echo 'final: {u: sin(x)/2}'; } >ends.yaml
expect 0 'the end of the scene' path ends.yaml --method galerkin:degree=8 --ends fixed --steps 2 \
  --out path.csv
line path.csv 3 3 1.00985019978 1e-9
line path.csv 3 4 0.50492509989 1e-9
expect 2 'no end' path circle.yaml --method galerkin:degree=8 --ends fixed --steps 2
says err 'or the section final of the scene' 'what is missing'
sed "s/^final.*/final: {u': 1}/" ends.yaml >wrong.yaml
expect 2 'an end of rates' path wrong.yaml --ends fixed --steps 2
says err "the end has the fields, without rates, and no .u'" 'the reason'
sed 's/^final.*/final: {u: 1\/(x - x)}/' ends.yaml >wrong.yaml
expect 2 'an end that is not finite' path wrong.yaml --ends fixed --steps 2
says err 'wrong.yaml:9:12: at the end: 1/(x - x)' 'the reason'
expect 1 'conjugate times' $path --t-end 3.141592653589793
says err 'its ends are conjugate, so that there are many such paths or none' 'the reason'

finish
