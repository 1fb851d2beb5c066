#!/bin/sh
# Each scene of apps/scenes has right derivatives, and moves as the problem of the catalogue with
# its name. The catalogue has no controls and no solids: those of apps/scenes/control are solved by
# test_control.sh, and those of apps/scenes/solids run by field/test_elastic.sh.
# Usage: test_scenes.sh DVI
set -u
dvi=$1
here=$(cd "$(dirname "$0")" && pwd)
rc=0
fail() { echo "$1"; rc=1; }

value_of() { sed -n "s/^$1: *//p" "$2"; }

count=0
# Where memory is watched every third scene is enough.
[ -z "${DVI_TEST_FEWER:-}" ] || stride=3
for scene in "$here"/../../../apps/scenes/*.yaml "$here"/../../../apps/scenes/*/*.yaml; do
  count=$((count + 1))
  [ $((count % ${stride:-1})) -eq 0 ] || continue
  name=$(basename "$scene" .yaml)
  case $(basename "$(dirname "$scene")") in control | solids) continue ;; esac
  method=$(value_of method "$scene") h=$(value_of step "$scene")
  "$dvi" check "$scene" >/dev/null || fail "dvi check $name: exit code $?"
  end=$(awk "BEGIN { print 3 * $h }")
  mine=$("$dvi" run "$scene" --t-end "$end" --final 2>&1 | tail -n 1)
  theirs=$("$dvi" run "$name" --method "$method" --h "$h" --t-end "$end" --final 2>&1 | tail -n 1)
  # Three steps make a few roundings each, of states of size 1 and of the unknowns.
  printf '%s\n%s\n' "$mine" "$theirs" | awk -F, -v name="$name" '
    NR == 1 { fields = split($0, mine, ",") }
    NR == 2 {
      if (fields < 4 || NF < 4) { print name ": no row: " $0; exit 1 }
      for (i = 1; i <= fields && i <= NF; i++) {
        difference = mine[i] - $i; if (difference < 0) difference = -difference
        size = $i < 0 ? -$i : $i; if (size < 1) size = 1
        if (!(difference <= 3e-13 * size)) {
          print name ": column " i ": " mine[i] " is not " $i
          exit 1
        }
      }
    }' || rc=1
done
[ $count -ge 31 ] || fail "only $count scenes"
exit $rc
