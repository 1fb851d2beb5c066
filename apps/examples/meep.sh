#!/bin/sh
# The speed of Yee's method beside Meep (GPL, a program that Debian has as "meep"; nothing of it is
# linked). Both march an empty box that repeats itself, with N^3 cells, on one core.
# Usage: sh apps/examples/meep.sh [N]     from the top of the tree, after a build
set -eu
cells=${1:-160}
command -v meep >/dev/null || { echo "meep.sh: install the package meep" >&2; exit 1; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
build/release/apps/yee_cost "$cells"
cat >"$folder/box.ctl" <<END
(set! geometry-lattice (make lattice (size $cells $cells $cells)))
(set! resolution 1)
(set! k-point (vector3 0 0 0))
(set! ensure-periodicity true)
(set! eps-averaging? false)
(set! sources (list (make source (src (make gaussian-src (frequency 0.05) (fwidth 0.02)))
                      (component Ez) (center 0 0 0))))
(run-until 100)
END
(cd "$folder" && OMP_NUM_THREADS=1 meep box.ctl) | awk -v cells="$cells" '
  /s\/step/ {
    for (i = 1; i < NF; i++) if ($(i + 1) == "s/step") step = $i
    if (least == 0 || step < least) least = step
  }
  END { printf "meep,%.0f Mcell/s in its best interval\n", cells ^ 3 / least / 1e6 }'
