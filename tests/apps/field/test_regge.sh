#!/bin/sh
# dvi regge: digits, stationary lengths, files of lengths, universes, refusals.
# Usage: test_regge.sh DVI
. "$(dirname "$0")/../check.sh"

# quantity FILE NAME VALUE TOLERANCE: require a quantity.
quantity() {
  awk -F, -v name="$2" -v value="$3" -v most="$4" '
    $1 == name { found = 1; d = $2 - value; wrong = d*d > most*most }
    END { exit !found || wrong }' "$1" || { fail "$2 is $3"; grep "^$2," "$1"; }
}

while read -r name hinges deficit action; do
  expect 0 "$name" regge "$name"
  says out '^quantity,value$' "$name: the columns"
  quantity out hinges "$hinges" 0
  quantity out deficit_min "$deficit" 1e-14
  quantity out deficit_max "$deficit" 1e-14
  quantity out action "$action" 2e-12
  quantity out schlaefli 0 1e-14
done <<'END'
cell-600 720 .128388220475713 92.439518742513
simplex-4 10 2.590307055157262 25.903070551573
simplex-5 20 2.328837092221132 20.168320831390
cell-16 24 1.359347637816487 32.624343307596
cross-5 80 1.010721020568315 35.012403198044
END

expect 0 'Lambda' regge simplex-4 --lambda 2 --csv lambda.csv
quantity lambda.csv action 24.724559249595 1e-12

# A closed complex with Lambda has its size: l^2 = S/(3 Lambda V) of unit edges.
expect 0 'stationary lengths' regge cell-16 --lambda 1 --solve --write lengths.csv
quantity out length_min 2.4015044443306 1e-12
quantity out length_max 2.4015044443306 1e-12
quantity out gradient_max 0 1e-13
quantity out null_directions 0 0
says lengths.csv '^from,to,length$' 'the columns of lengths'
expect 0 'lengths of a file' regge cell-16 --lambda 1 --lengths lengths.csv
quantity out gradient_max 0 1e-13

# A ball whose inner lengths are disturbed is flat again, and its inner vertices are free.
expect 0 'its lengths' regge ball --cells 2 --write flat.csv
awk -F, 'NR == 1 || $1 == 0 { if (NR > 1) $3 *= 1 + .01*(NR % 3); print $1 "," $2 "," $3 }' \
  flat.csv >curved.csv
expect 0 'a curved ball' regge ball --cells 2 --lengths curved.csv
awk -F, '$1 == "deficit_max" { exit !($2 > .01) }' out || fail 'the ball is curved'
expect 0 'a flat ball' regge ball --cells 2 --lengths curved.csv --solve
quantity out deficit_max 0 1e-12
quantity out deficit_min 0 1e-12
quantity out null_directions 39 0

expect 0 'a universe' regge cell-600 --lambda 3 --evolve 4 --strut 0.25 --csv universe.csv
says universe.csv '^t,length,radius,de_sitter,constraint$' 'the columns of a universe'
about universe.csv length 1.0268721333834841 0.01
about universe.csv de_sitter 1.5430806348152437 1e-12
expect 1 'a universe with an end' regge cell-600 --lambda 3 --euclidean --evolve 40
says out '^0,0.66012428' 'its rows'
says err 'the universe ends there' 'its end'
awk -F, 'NR > 1 && $1 > 1.58 && $4 != "" { wrong = 1 } END { exit wrong || $1 < 1.58 }' out ||
  fail 'a sphere has no radius behind its pole'

printf 'from,to,length\n0,1,9\n' >long.csv
expect 1 'no triangle' regge simplex-4 --lengths long.csv
says err 'triangle 0 (vertices 0 1 2) does not exist with the lengths 9 (0 1)' 'the triangle'
printf 'from,to,length\n0,9,1\n' >none.csv
expect 2 'no edge' regge simplex-4 --lengths none.csv
says err 'line 2: no edge joins the vertices 0 and 9' 'the edge'
printf 'from,to,length\n0,4,1\n4,0,1.1\n' >twice.csv
expect 2 'one edge twice' regge simplex-4 --lengths twice.csv
says err 'lines 2 and 3 are of one edge' 'both lines'
expect 2 'no mesh' regge cell-700
says err "did you mean 'cell-600'" 'the nearest name'
expect 2 'a surface' regge icosphere
says err 'tetrahedra or 4-simplices are needed' 'surfaces'
expect 2 'two ways' regge cell-600 --lambda 3 --evolve 2 --solve
expect 2 'nothing to evolve' regge cell-600 --euclidean
expect 2 'no layers' regge cell-600 --strut 0.1
expect 1 'no solution' regge cell-16 --solve
says err 'only S = 0 is stationary' 'the reason'
finish
