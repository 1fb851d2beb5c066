#!/bin/sh
# dvi plot: grids and their fields as pictures.  Usage: test_picture.sh DVI
. "$(dirname "$0")/check.sh"

# draw WHAT ARGUMENTS: draw without a word of gnuplot's.
draw() {
  what=$1
  shift
  expect 0 "$what" plot "$@" --out picture.svg
  [ ! -s err ] || { fail "$what: gnuplot is not silent"; cat err; }
}

# curves: the number of plots in the picture.
curves() { grep -c 'id="gnuplot_plot_' picture.svg; }

cat >drum.yaml <<END
mesh: {generator: disk, cells: 6}
field: wave
boundary: {rim: fixed}
source: 1
END
expect 0 'modes' modes drum.yaml --count 3 --vtu modes.vtu
draw 'the first field' modes.vtu
[ "$(grep -c '<image' picture.svg)" -eq 1 ] || fail 'one map'
says picture.svg '>mode_1<' 'the field is the title'
draw 'all fields' modes.vtu --field mode_1 --field mode_2 --field mode_3
[ "$(grep -c '<image' picture.svg)" -eq 3 ] || fail 'three maps'
says picture.svg '>mode_3<' 'each panel has its name'
draw 'edges, too' modes.vtu --edges --title Drum
[ "$(curves)" -eq 2 ] || fail 'a map and edges'
says picture.svg '>Drum<' 'a title'

expect 0 'a mesh' mesh staggered --cells 4,4 --write mesh.vtu
draw 'a mesh' mesh.vtu
grep -q '<image' picture.svg && fail 'a flat mesh has no map'
[ "$(curves)" -eq 1 ] || fail 'edges alone'
draw 'duals' mesh.vtu --duals
[ "$(curves)" -eq 2 ] || fail 'no dual is negative'
draw 'from a side' mesh.vtu --view 20,40
cat >flat.off <<END
OFF
3 1 0
0 0 0
1 0 0
0.2 0.2 0
3 0 1 2
END
expect 0 'an obtuse triangle' mesh flat.off --write flat.vtu
draw 'negative duals' flat.vtu --duals
[ "$(curves)" -eq 3 ] || fail 'two dual edges are positive, and one is negative'
for shape in icosphere ball cylinder bcc-torus; do
  expect 0 "$shape" mesh $shape --write shape.vtu
  draw "$shape" shape.vtu
done
expect 0 'boxes' mesh box --cells 2,3,2 --write shape.vtu
draw 'boxes' shape.vtu

cat >cavity.yaml <<END
mesh: {generator: staggered}
field: maxwell
boundary: pec
END
expect 0 'vectors' modes cavity.yaml --count 1 --vtu cavity.vtu
draw 'a component' cavity.vtu --field mode_x --field mode_y
says picture.svg '>mode_y<' 'a component has a name'
expect 2 'no component' plot cavity.vtu --field mode_w --out x.svg
says err "among 3, of which 'mode' is the first" 'the components'

cat >string.yaml <<END
mesh: {generator: interval, cells: 16}
field: wave
boundary: fixed
END
expect 0 'a string' modes string.yaml --count 2 --vtu string.vtu
draw 'curves' string.vtu --field mode_1 --field mode_2
[ "$(curves)" -eq 2 ] || fail 'two curves'
expect 0 'a line' mesh interval --write line.vtu
expect 1 'nothing of a line' plot line.vtu --out x.svg

expect 2 'another field' plot modes.vtu --field mode_4 --out x.svg
says err "no field 'mode_4' among 3, of which 'mode_1' is the first" 'how many there are'
says err "(did you mean 'mode_1'?)" 'the nearest field'
expect 2 'no fields' plot mesh.vtu --field u --out x.svg
says err 'has no fields' 'no fields'
expect 2 'one angle' plot mesh.vtu --view 30 --out x.svg
expect 2 'seen along its plane' plot mesh.vtu --view 30,0 --out x.svg
says err 'another --view' 'seen along its plane'
expect 2 'duals of boxes' plot shape.vtu --duals --out x.svg
expect 2 'axes of a grid' plot mesh.vtu --axes x:y --out x.svg
printf 't,a\n0,1\n1,2\n' >rows.csv
expect 2 'a field of columns' plot rows.csv --axes a --field a --out x.svg
expect 1 'no file' plot nothing.vtu --out x.svg
: >empty.vtu
expect 1 'an empty file' plot empty.vtu --out x.svg
size=$(($(wc -c <modes.vtu) - 60)) # what is behind the arrays is not needed
cut=7
while [ $cut -lt "$size" ]; do
  head -c $cut modes.vtu >cut.vtu
  "$dvi" plot cut.vtu --out x.svg 2>err
  [ $? -eq 1 ] || fail "a file of $cut bytes"
  says err 'cut.vtu' 'the file is named'
  cut=$((cut + size / 40))
done
sed 's/NumberOfCells="[0-9]*"/NumberOfCells="900000000"/' modes.vtu >claims.vtu
expect 1 'a claim of many cells' plot claims.vtu --out x.svg
[ ! -e x.svg ] || fail 'a picture without a reason'
finish
