#!/bin/sh
# dvi gradient and dvi fit: derivatives against differences, results, refusals.
# Usage: test_gradient.sh DVI
. "$(dirname "$0")/check.sh"

cat >throw.yaml <<'E1'
parameters: {m: 0.4, g: 9.81, drag: 0.02, speed: 20, angle: 0.8, weight: m*g, none: [1, 2]}
coordinates: {x: scalar, y: scalar}
kinetic: m*(x'^2 + y'^2)/2
potentials: {weight: weight*y}
dissipation: drag*(x'^2 + y'^2)^(3/2)/3
initial: {x: 0, y: 1.5, x': speed*cos(angle), y': speed*sin(angle)}
objective: {end: (x - 30)^2 + y^2, integral: "drag*(x'^2 + y'^2)"}
method: galerkin:degree=2
step: 0.1
until: 2.5
E1
sed -i 's/potentials: {weight:/potentials: {height:/; s/, none: .*/}/' throw.yaml

# field NAME COLUMN: the number of a row of out.
field() {
  awk -F, -v name="$1" -v column="$2" '$1 == name { print $column }' out
}
# objective SETTING: the objective with this setting.
objective() {
  "$dvi" gradient throw.yaml --set "$1" | awk -F, '$1 == "objective" { print $2 }'
}
expect 0 'a gradient' gradient throw.yaml
[ "$(cut -d, -f1 out | tr '\n' ' ')" = 'name objective x y p_x p_y m g drag speed angle ' ] ||
  fail 'rows are the start and the parameters that are not made of others'
cp out gradient.csv
for name in m drag speed; do
  cp gradient.csv out
  value=$(field $name 2)
  near=$(awk "BEGIN { printf \"%.17g\", $value * 1.0001 }")
  far=$(awk "BEGIN { printf \"%.17g\", $value * 0.9999 }")
  awk -v d="$(field $name 3)" -v a="$(objective $name="$near")" -v b="$(objective $name="$far")" \
    -v x="$value" 'BEGIN { n = (a - b) / (2e-4 * x); exit !((d - n)^2 < 1e-10 * n^2) }' ||
    fail "the derivative by $name is that of differences"
done
expect 0 'tangents' gradient throw.yaml --tangent --method verlet --h 0.05 --out tangent.csv
[ "$(head -n 1 tangent.csv)" = name,value,x,y,p_x,p_y ] || fail 'columns of tangents'
awk -F, '$1 == "x" { exit !(($3 - 1)^2 + $4^2 + $5^2 + $6^2 < 1e-28) }' tangent.csv ||
  fail 'a throw from elsewhere ends elsewhere'
expect 0 'the run that they belong to' run throw.yaml --method verlet --h 0.05 --final
end=$(sed -n 2p tangent.csv | cut -d, -f3)
[ "$(tail -n 1 out | cut -d, -f2)" = "$end" ] || fail 'the end is that of dvi run'

grep -v objective throw.yaml >plain.yaml
expect 2 'no objective' gradient plain.yaml
says err 'no section objective' 'what is missing'
expect 0 'tangents need none' gradient plain.yaml --tangent
expect 2 'a composition' gradient throw.yaml --method composition:order=4
says err 'no discrete action' 'why'
expect 2 'a step that is no step' gradient throw.yaml --h=-1
expect 2 'a problem of the catalogue' gradient pendulum

# Fits.
expect 0 'a run to be found again' run throw.yaml --every 3 --columns x,y --set drag=0.03 \
  --set speed=22 --out data.csv
expect 0 'a fit' fit throw.yaml --to data.csv --vary drag=0:1 --vary speed --vary y
awk -F, '$1 == "drag" { exit !(($2 - 0.03)^2 < 1e-16) }' out || fail 'the drag is found'
awk -F, '$1 == "speed" { exit !(($2 - 22)^2 < 1e-12) }' out || fail 'the speed is found'
awk -F, '$1 == "y" { exit !(($2 - 1.5)^2 < 1e-12) }' out || fail 'the start is found'
says err '20 numbers, 3 varied' 'what was fitted'
expect 0 'a bound' fit throw.yaml --to data.csv --vary drag=0:0.025 --vary speed
grep -q '^drag,0.025000000000000001,$' out || fail 'the bound, without an error'
expect 0 'columns' fit throw.yaml --to data.csv --columns x --vary drag
expect 1 'what the data do not tell' fit throw.yaml --to data.csv --vary drag --vary m --vary speed
says err 'do not determine' 'why'

# Files that make no sense, with their lines.
refuses() { # WORDS TEXT
  printf "$2" >bad.csv
  expect 2 "$1" fit throw.yaml --to bad.csv --vary drag
  says err "$1" 'the line and the reason'
}
refuses "line 3: 'b' is no number" 't,x\n0,1\n1,b\n'
refuses "line 3 does not have the header's 2 fields" 't,x\n0,1\n1\n'
refuses 'line 3: the time 0 does not come after 0' 't,x\n0,1\n0,1\n'
refuses 'line 2: the time -1 comes before the start' 't,x\n-1,1\n'
refuses "line 1: column 'z' is no coordinate" 't,x,z\n0,1,2\n'
refuses "line 1: two columns 'x'" 't,x,x\n0,1,2\n'
refuses "line 1: there is no column 't'" 'x\n1\n'
refuses 'is empty' ''
refuses 'has no rows' 't,x\n'
expect 1 'no file' fit throw.yaml --to nowhere.csv --vary drag
expect 2 'a column that is not there' fit throw.yaml --to data.csv --columns p_x --vary drag
expect 2 'no such parameter' fit throw.yaml --to data.csv --vary dragg
says err 'no such coordinate' 'why'
expect 2 'a made parameter' fit throw.yaml --to data.csv --vary weight
expect 2 'crossed bounds' fit throw.yaml --to data.csv --vary drag=1:0
says err 'the smaller one first' 'why'
expect 2 'a start beyond the bounds' fit throw.yaml --to data.csv --vary drag=1:2
says err 'not within the bounds' 'why'
expect 2 'twice' fit throw.yaml --to data.csv --vary drag --vary drag
expect 2 'nothing to vary' fit throw.yaml --to data.csv
expect 2 'no data' fit throw.yaml --vary drag
finish
