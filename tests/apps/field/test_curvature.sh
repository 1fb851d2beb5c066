#!/bin/sh
# dvi curvature: Gauss and Bonnet, digits, holonomy, fields of directions, refusals.
# Usage: test_curvature.sh DVI
. "$(dirname "$0")/../check.sh"

# quantity FILE NAME VALUE TOLERANCE: require a quantity.
quantity() {
  awk -F, -v name="$2" -v value="$3" -v most="$4" '
    $1 == name { found = 1; d = $2 - value; wrong = d*d > most*most }
    END { exit !found || wrong }' "$1" || { fail "$2 is $3"; grep "^$2," "$1"; }
}

while read -r name euler; do
  expect 0 "$name" curvature "$name" --csv all.csv
  says out '^Gauss-Bonnet: ' "$name: both sides"
  says out 'Spin(2)' "$name: the lift"
  quantity all.csv euler "$euler" 0
  quantity all.csv difference 0 1e-14
  quantity all.csv holonomy_error 0 4e-15
  quantity all.csv lift_error 0 4e-15
done <<'END'
icosphere 2
torus 0
genus-2 -2
disk 1
annulus 0
END

while read -r name deficit; do
  expect 0 "$name" curvature "$name" --csv - --hinges hinges.csv
  quantity out deficit_min "$deficit" 2e-15
  quantity out deficit_max "$deficit" 2e-15
  quantity out holonomy_error 0 4e-15
  quantity out lift_error 0 4e-15
  says hinges.csv '^hinge,vertices,cells,boundary,deficit,turn,lifted$' "$name: the columns"
done <<'END'
cell-600 .128388220475713
simplex-4 2.590307055157262
simplex-5 2.328837092221132
END

expect 0 'a field' curvature icosphere --singular 0=1,5=2 --singular 9=-1 --vtu f.vtu --csv all.csv
quantity all.csv index_error 0 1e-13
quantity all.csv mismatch 0 1e-12
expect 0 'strokes' plot f.vtu --strokes direction --out f.svg
expect 0 'lines' curvature icosphere --symmetry 2 --singular 0=.5,5=.5,9=.5,11=.5
expect 0 'no singularity' curvature torus --vtu t.vtu
expect 2 'no vectors' plot f.vtu --strokes deficit --out f.svg
says err 'has no vectors of this name' 'no vectors'
expect 1 'the sum' curvature icosphere --singular 0=1
says err 'the indices sum to 1, and on this surface they sum to 2' 'the sum'
expect 1 'the vertex' curvature icosphere --singular 0=.5,1=1.5
says err 'index 0.5 at vertex 0 is no multiple' 'the vertex'
says err 'fields of symmetry 2 have such an index' 'its symmetry'
expect 2 'a pair' curvature icosphere --singular 0:1
says err 'as in 12=1' 'a pair'
expect 2 'boxes' curvature box
says err 'kind .rectangle., and triangles, tetrahedra or 4-simplices are needed' 'boxes'
expect 0 'deficits alone' curvature icosphere --vtu d.vtu
says out 'directions: none, because they need indices that sum to chi' 'deficits alone'
expect 2 'two tables' curvature torus --csv - --hinges -
says err 'would be mixed' 'two tables'
finish
