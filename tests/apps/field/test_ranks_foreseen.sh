#!/bin/sh
# dvi explain tells and foresees the shares of processes, and dvi bench --scale ranks= predicts the
# steps of more of them. Skipped where dvi has no module for processes.
# Usage: test_ranks_foreseen.sh DVI
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../check.sh"
. "$here/ranks_setup.sh"

if [ ! -e "$(dirname "$dvi")/dvi_petsc.so" ]; then
  said=$("$dvi" bench wave.yaml --scale ranks=1,2 2>&1) && fail "ranks without a module: $said"
  [ $failures -eq 0 ] || exit 1
  echo "DVI_PETSC is OFF: no tests with MPI"
  exit 77
fi

# explained N SCENE OPTION...: N processes explain who owns what, in shares.csv. All cells have an
# owner, and what the steps are counted to receive is what is foreseen of them.
explained() {
  count=$1
  shift
  mpirun -np "$count" "$dvi" explain "$@" --csv shares.csv >out.txt 2>err ||
    fail "explain $*: $(cat err out.txt)"
  awk -F, -v count="$count" 'NR > 1 { cells += $3; messages += $6; bytes += $7
      wrong += !($3 > 0 && $4 > 0 && $5 > 0 && $6 > 0 && $7 > 0 && $7 % 8 == 0) }
    END { print bytes " bytes in " messages " messages"; exit NR != count + 1 || wrong }' \
    shares.csv >sum.txt || fail "explain $*: $(cat shares.csv)"
  says out.txt "$(cat sum.txt) together\$" "explain $*"
  says out.txt "^counted in .*$(cat sum.txt)" "explain $*"
}
explained 3 torus.yaml
grep -q '^shares: 324 cells among 3 processes by [a-z]*, 10[0-9] to 1[0-9]* each' out.txt ||
  fail "explain: $(cat out.txt)"
# There are so few unknowns that no level is coarser, and an iteration has a product alone.
explained 3 wave.yaml --method midpoint --h 0.05
says out.txt '^counted in the first step: [1-9].* corrections of [1-9]' midpoint
# PETSc 3.22 has a sum of its own in each.
says out.txt '^counted in an iteration: .*, [23] sums, 1 gatherings$' midpoint
# The components of three axes are exchanged one after the other.
explained 2 bar.yaml --method verlet
says out.txt ' 6 messages together$' verlet
explained 2 bar.yaml
says out.txt '^counted in a step of [0-9.e-]*: 1 exchanges' avi
# Blocks are foreseen to the last byte, for steps that go together, too.
explained 2 deep.yaml
says out.txt '^3 steps together: all processes receive E and B of 3 planes' deep.yaml
"$dvi" explain deep.yaml --ranks 2 --csv foreseen.csv >out.txt || fail "blocks are not foreseen"
same shares.csv foreseen.csv "two slabs, steps together"
bytes=$(awk -F, 'NR == 2 { printf "%d", $7 / 3 }' shares.csv)
# 4 slabs of the 9 boxes would be too thin, and so y is divided, too.
explained 4 grid.yaml
"$dvi" explain grid.yaml --ranks 4 --csv foreseen.csv >out.txt || fail "blocks are not foreseen"
same shares.csv foreseen.csv "four blocks"

# A step is measured on processes that dvi starts, and predicted for more of them.
"$dvi" bench torus.yaml --scale ranks=1,2,8,32,...,300 --rounds 1 --steps 2 --csv scale.csv \
  >out.txt || fail "bench: no scaling"
for words in '^Ranks that share torus.yaml' '^triad .* of 1 process' \
  '^  network: .*shared memory' '^  fit: .*the largest deviation is' '^What breaks first'; do
  grep -q "$words" out.txt || fail "bench: no '$words' in: $(cat out.txt)"
done
header=scaling,problem,ranks,rank_cells,step_seconds,efficiency,exchange,messages,bytes
header=$header,measured_seconds,measured_efficiency,oversubscribed,measured_lower
header=$header,measured_upper,cells
[ "$(head -n 1 scale.csv)" = $header ] || fail "bench: $(head -n 1 scale.csv)"
# One rank waits for nobody, and what was measured stands in its rows alone.
awk -F, 'NR == 1 { next }
  { measured = $3 == 1 || ($3 == 2 && $1 == "strong")
    if (!($5 > 0 && $6 > 0 && $7 >= 0 && $7 < 1)) bad++
    if (($7 == 0) != ($3 == 1) || ($10 != "") != measured) bad++
    if ($15 != ($1 == "weak" ? 324 * $3 : 324)) bad++ }
  END { exit !(NR == 13 && !bad) }' scale.csv || fail "bench: $(cat scale.csv)"
# Blocks of a grid, of which no more are predicted than there can be. What two of them receive in a
# step is what was counted above.
"$dvi" bench deep.yaml --scale ranks=1,2,16,1024 --rounds 1 --steps 3 --csv slabs.csv \
  >out.txt || fail "bench: no scaling of grids"
says out.txt '^Ranks that share deep.yaml, by yee' 'a grid'
says out.txt '^  more ranks than the grid has blocks for' 'a grid'
awk -F, -v bytes="$bytes" '$1 == "strong" { rows++; if ($3 == 2 && $9 != bytes) bad++ }
  END { exit !(rows == 3 && !bad) }' slabs.csv || fail "a grid: $bytes bytes, and $(cat slabs.csv)"
"$dvi" bench bar.yaml --scale ranks=1,2 >out.txt 2>&1 && fail "steps of avi are timed"
says out.txt '^dvi: bench: .* steps of solids by verlet.*not those of avi' 'avi'

# What makes no sense is refused before processes start.
for option in '--scale ranks=1,2 --latency 0' '--scale ranks=1,2 --bandwidth nan' \
  '--scale ranks=2,1' '--scale ranks=1,2 --method avi' '--scale ranks=1,2 --at 1e-6' \
  '--latency 1e-6' '--scale threads=1,2 --weak n'; do
  # shellcheck disable=SC2086
  "$dvi" bench torus.yaml $option >out.txt 2>&1
  [ $? -eq 2 ] || fail "bench $option: $(cat out.txt)"
done

# One process foresees as many cells, which all have an owner.
"$dvi" explain torus.yaml --ranks 3 --csv foreseen.csv >out.txt || fail "explain --ranks fails"
awk -F, 'NR > 1 { cells += $3; wrong += !($4 > 0 && $5 == 2 && $6 == 2 && $7 % 8 == 0) }
  END { exit !(NR == 4 && cells == 324 && !wrong) }' foreseen.csv ||
  fail "explain --ranks: $(cat foreseen.csv)"
"$dvi" explain kepler --method verlet --ranks 3 >out.txt 2>&1
[ $? -eq 2 ] || fail "explain --ranks takes kepler: $(cat out.txt)"
"$dvi" explain torus.yaml --method midpoint --ranks 3 >out.txt 2>&1
says out.txt '^a product .* unknowns of others on edges once' 'midpoint for Maxwell'
"$dvi" explain wave.yaml --method galerkin --ranks 3 >out.txt 2>&1
says out.txt '^an iteration of minimal residuals .* of 568 bytes' galerkin
"$dvi" explain torus.yaml --method galerkin --ranks 3 >out.txt 2>&1
[ $? -eq 2 ] || fail "explain --ranks takes galerkin for Maxwell: $(cat out.txt)"
"$dvi" explain bar.yaml --method avi:classes=no --ranks 3 --csv foreseen.csv >out.txt 2>&1 ||
  fail "explain --ranks by avi:classes=no: $(cat out.txt)"
says out.txt '^events: processes tell each other' 'avi:classes=no'
awk -F, 'NR > 1 { cells += $3 } END { exit !(NR == 4 && cells == 192) }' foreseen.csv ||
  fail "explain --ranks by avi:classes=no: $(cat foreseen.csv)"
"$dvi" explain grid.yaml --ranks 5 >out.txt 2>&1
[ $? -ne 0 ] || fail "explain --ranks cuts 9 boxes among 5: $(cat out.txt)"
exit $((failures > 0))
