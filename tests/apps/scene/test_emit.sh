#!/bin/sh
# dvi emit-c: C files compile without a warning, and their runs are the scenes', digit for digit.
# Usage: test_emit.sh DVI
top=$(cd "$(dirname "$0")/../../.." && pwd)
. "$(dirname "$0")/../check.sh"
libraries=$(cd "$(dirname "$dvi")/../lib" && pwd)
expect 0 'a scene' init swinging-cart.yaml

expect 0 'a C file' emit-c swinging-cart.yaml --set l=0.7 --out cart.c
says cart.c '^dvi_status swinging_cart_create(dvi_system \*\*system)' 'the name'
expect 0 'standard output' emit-c swinging-cart.yaml --set l=0.7 --out -
same out cart.c 'standard output has what the file has'
expect 0 'a name' emit-c swinging-cart.yaml --name other --out other.c
says other.c '^const double other_q\[2\]' 'the start'

cat >drop.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - 9.81*x
events:
  ground: {zero: x, direction: falling, stop: yes}
  top: {zero: "x'"}
initial: {x: 1, x': 1}
method: galerkin:degree=2
step: 0.1
until: 3
END

cat >pits.yaml <<'END'
coordinates: {"u[3,2]": scalar}
lagrangian: >-
  sum(i, sum(j, u[i,j]'^2/2 - max(u[i,j], 0)^2 - if(u[i,j] < -0.5 and i > 1, u[i,j]^2, 0)
  - floor(u[i,j])^0*(u[if(i < 3, i + 1, 1),j] - u[i,j])^2))
initial: {"u[i,j]": sin(3*i + j)}
method: verlet
step: 0.1
until: 3
END

cat >air.yaml <<'END'
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 - x^2*y^2
forces: {x: 0.1*sin(t) - y}
dissipation: 0.1*x'^4 + 0.2*x^2*y'^2
initial: {x: 1, y: 0.3, x': 0.2}
method: galerkin:degree=2
step: 0.1
until: 3
END

cat >rod.yaml <<'END'
coordinates: {x: scalar, y: scalar, z: scalar}
lagrangian: (x'^2 + y'^2 + z'^2)/2 - 9.81*y
forces: {x: -0.1*x'}
constraints: {rod: "((x - 0.3*sin(2*t))^2 + y^2 - 1)/2", slope: z - x}
initial: {x: 0.6, y: -0.8, z: 0.6, x': 0.6, z': 0.6}
method: galerkin:degree=2
step: 0.02
until: 2
END

cat >plate.yaml <<'END'
coordinates: {x: scalar, y: scalar, a: scalar}
lagrangian: (x'^2 + y'^2)/2 + a'^2/4
forces: {x: -0.1*x'}
nonholonomic: {blade: sin(a)*(x' - 0.3*cos(2*t)) - cos(a)*y'}
initial: {x: 0, y: 0, a: 0, x': 1, a': 1.5}
method: nonholonomic
step: 0.02
until: 2
END

cat >shaken.yaml <<'END'
coordinates: {x: scalar}
kinetic: x'^2/2
potentials: {spring: x^2/2}
noise: {temperature: 1, friction: 0.2, functions: {spring: 0.3*cos(x), push: 0.2*x}, seed: 7}
initial: {x: 1}
method: langevin:scheme=ovio,degree=2
step: 0.1
until: 2
END

cat >welded.yaml <<'END'
include: {a: drop.yaml, b: air.yaml}
constraints: {port: a_x - b_y - 0.7}
initial: {a_x: 1, a_x': 0}
method: galerkin:degree=2
step: 0.02
until: 2
END

# The warnings that users turn on. One instruction set alone compiles sooner.
compiler=${CC:-cc}
flags='-std=c11 -O2 -Wall -Wextra -Wconversion -Wpedantic -Werror -DDVI_LANES='

# compiles SCENE OPTIONS..: build a program, which writes the last state to the file `compiled`.
compiles() {
  scene=$1
  shift
  expect 0 "$scene as C" emit-c "$scene" "$@" --out scene.c
  # shellcheck disable=SC2086
  "$compiler" $flags -DDVI_MAIN -I"$top/lib/include" scene.c -o scene "$libraries/libdvi.so" -lm ||
    fail "$scene does not compile"
  LD_LIBRARY_PATH=$libraries ./scene >compiled || fail "$scene does not run as C"
}

# Succeeds if the numbers of the first file (t, q and p) stand in this order in a row of the second
# one, in which there may be others.
# shellcheck disable=SC2016
in_turn='NR == 1 { count = split($0, number) }
  FNR == 2 {
    for (i = k = 1; i <= NF && k <= count; i++) k += $i "" == number[k] ""
    exit k <= count
  }'

# A program without a sanitizer does not run with a library that has one.
if command -v "$compiler" >/dev/null &&
  ! grep -q '__[at]san_init\|__ubsan_handle' "$libraries/libdvi.so"; then
  cp "$top"/apps/scenes/*.yaml "$top"/apps/scenes/*/*.yaml .
  for each in drop pits air rod plate shaken welded snakeboard damped-driven kepler oscillator \
    driven-pendulum double-pendulum guiding-centre circle-dirac magnetic-pair elastica fpu \
    vortices free-body spherical-double-pendulum satellite; do
    compiles $each.yaml
    expect 0 "$each" run $each.yaml --final
    awk -F, "$in_turn" compiled out ||
      fail "the run of $each as C is another one: $(cat compiled) and $(sed -n 2p out)"
  done
fi

# Refused commands leave existing files alone.
echo mine >kept.c
expect 2 'no C name' emit-c swinging-cart.yaml --name 1st --out kept.c
says err 'no name in C' 'the reason'
expect 2 'an unknown parameter' emit-c swinging-cart.yaml --set ll=1 --out kept.c
cp "$top/apps/scenes/kepler.yaml" .
sed 's/^method:.*/method: prolongation-collocation/' kepler.yaml >series.yaml
expect 2 'Taylor coefficients' emit-c series.yaml --out kept.c
says err "the scene's method needs Taylor coefficients, and C files have none" 'the reason'
expect 2 'a problem of the catalogue' emit-c kepler --out kept.c
expect 1 'no scene' emit-c none.yaml --out kept.c
[ "$(cat kept.c)" = mine ] || fail 'the file was overwritten'
expect 2 'over the scene' emit-c swinging-cart.yaml --out ./swinging-cart.yaml
expect 2 'no file' emit-c swinging-cart.yaml
no_trace 'emit-c'
finish
