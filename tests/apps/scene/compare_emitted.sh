#!/bin/sh
# Measures the speed of emitted C: whole trajectories of scenes beside the problems of the
# catalogue, which are written by hand.
# Usage: CC=gcc CFLAGS=-O2 compare_emitted.sh BUILD [ROUNDS [PATTERN]]
# BUILD is a release build. PATTERN chooses among the lines.
build=$(cd "$1" && pwd) || exit 1
rounds=${2:-15} pattern=${3:-.}
top=$(cd "$(dirname "$0")/../../.." && pwd)
compiler=${CC:-cc} flags=${CFLAGS:--O2}
problems=${PROBLEMS:-$build/apps/libproblems.a}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

# compile SOURCE OBJECT: compile as a user does.
compile() {
  # shellcheck disable=SC2086
  "$compiler" -std=gnu11 $flags -I"$top/lib/include" -I"$top/apps/problems" -c "$1" -o "$2"
}

# compare SCENE METHOD H STEPS [NAME=VALUE]: build and run one program for the scene.
compare() {
  echo "$1 $2" | grep -q -e "$pattern" || return 0
  if [ ! -e "$1" ]; then
    "$build/apps/dvi" emit-c "$(find "$top/apps/scenes" -name "$1.yaml")" ${5:+--set "$5"} \
      --name emitted --out emitted.c &&
      compile emitted.c emitted.o &&
      "$compiler" compare.o emitted.o "$problems" -L"$build/lib" -Wl,-rpath,"$build/lib" -ldvi -lm \
      -o "$1" || exit 1
  fi
  "./$1" "$1" "$2" "$3" "$4" "$rounds" ${5:+"$5"} || exit 1
}

"$compiler" --version | head -n 1
compile "$top/tests/apps/scene/compare_emitted.c" compare.o || exit 1
for degree in 2 4 8; do compare kepler galerkin:degree=$degree 0.05 2000; done
compare kepler verlet 0.05 20000
for degree in 2 4 8; do compare outer-solar galerkin:degree=$degree 100 1000; done
compare outer-solar verlet 100 5000
compare fpu verlet 0.005 500 ell=1000
for degree in 2 6; do compare fpu galerkin:degree=$degree 0.005 20 ell=1000; done
compare double-pendulum midpoint 0.02 1000
compare double-pendulum galerkin:degree=4 0.02 1000
