#!/bin/sh
# From a bare Debian (12 or later) or Ubuntu (24.04 or later) to a built, run and tested libdvi:
#   sh cmake/bootstrap.sh demo    build, then studies of the Kepler problem and of a pendulum that turns in space
#   sh cmake/bootstrap.sh test    build, then all tests that a user needs to trust the build
#   sh cmake/bootstrap.sh lint    install more tools, then sanitizers, valgrind, clang, clang-tidy, cppcheck, Doxygen, layout
# Missing packages are installed by apt-get, with sudo if needed.  With CI=true in the environment compiler warnings are errors.
set -eu

packages="gcc g++ libc6-dev make cmake pkg-config libsundials-dev libsuitesparse-dev liblapack-dev libyaml-dev check gnuplot-nox"
lint_packages="clang clang-tidy clang-format cppcheck doxygen valgrind libc6-dbg libclang-rt-dev libgsl-dev"

usage() {
  cat >&2 <<'END'
usage: sh cmake/bootstrap.sh demo|test|lint
  demo   build, and run three studies; plots go to build/demo/
  test   build, and run the tests
  lint   build with sanitizers and with clang, and run every gate
END
  exit 2
}

say() { printf '== %s\n' "$*"; }
refuse() { printf 'bootstrap: %s\n' "$*" >&2; exit 1; }

# Succeeds on a system whose packages are recent enough.
known_system() {
  [ -r /etc/os-release ] || return 1
  # shellcheck disable=SC1091
  . /etc/os-release
  case ${ID:-}:${VERSION_ID:-unstable} in
    debian:unstable) return 0 ;;
    debian:*) [ "${VERSION_ID%%.*}" -ge 12 ] ;;
    ubuntu:*) [ "${VERSION_ID%%.*}" -ge 24 ] ;;
    *) return 1 ;;
  esac
}

# Prints those of the named packages that are not installed.
missing() {
  for package; do
    dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q ' installed$' || printf '%s ' "$package"
  done
}

explain_by_hand() {
  cat >&2 <<END
bootstrap: this system is neither Debian 12 or later nor Ubuntu 24.04 or later: please install what is needed yourself:
  a C11 compiler, make, CMake 3.22 or later, pkg-config, SUNDIALS 6.4 to 7 with KLU, SuiteSparse, LAPACK, libyaml, Check,
  gnuplot and, for a test, a C++ compiler; for lint also clang, clang-tidy, clang-format, cppcheck, Doxygen, valgrind and GSL.
On Debian these packages are called
  $packages
  $lint_packages
Then:  cmake --preset release && cmake --build --preset release && ctest --preset release -LE "lint|long"
END
  exit 1
}

# install_packages [MORE]: what is missing of the packages, and of MORE.
install_packages() {
  if ! known_system || ! command -v apt-get >/dev/null; then explain_by_hand; fi
  # The lists are meant to be split into words, here and below.
  # shellcheck disable=SC2086
  wanted=$(missing $packages ${1:-})
  [ -n "$wanted" ] || return 0
  root=
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || refuse "not root, and there is no sudo. As root, run: apt-get install --no-install-recommends $wanted"
    root=sudo
  fi
  say "installing: $wanted"
  log=$(mktemp)
  # shellcheck disable=SC2086
  if ! { $root apt-get update -qq &&
    $root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $wanted; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    refuse "apt-get failed, see above"
  fi
  rm -f "$log"
}

# build PRESET [OPTION...]: configure and build; output only if it fails, or if there are warnings.
build() {
  preset=$1
  shift
  werror=OFF
  [ "${CI:-}" != true ] || werror=ON
  say "building: $preset"
  mkdir -p build
  if ! { cmake --preset "$preset" -DDVI_WERROR=$werror "$@" && cmake --build --preset "$preset" -j "$cores"; } >"build/$preset.log" 2>&1; then
    tail -n 60 "build/$preset.log" >&2
    refuse "the build failed; the whole output is in build/$preset.log"
  fi
  grep -A 4 'warning:' "build/$preset.log" || true
}

run_tests() {
  preset=$1
  shift
  say "testing: $preset"
  ctest --preset "$preset" -j "$cores" "$@"
}

demo() {
  install_packages
  build release
  dvi=build/release/apps/dvi
  mkdir -p build/demo
  say "order study: error against step, measured order against claimed order"
  $dvi order kepler --method galerkin:degree=1 --method galerkin:degree=2 --method galerkin:degree=3 --method galerkin:degree=4 \
    --plot build/demo/order.svg
  say "speed against error"
  $dvi bench kepler --method verlet --method galerkin:degree=2 --method galerkin:degree=4 --method galerkin:degree=8 \
    --against cvode,arkode,ida --plot build/demo/bench.svg
  say "a body that turns: energy and distance from SO(3) against step, time against energy"
  # It ends with 3: the motion is chaotic, and not every order is decided.
  $dvi order pendulum-3d --t-end 10 --h 0.04 --levels 5 --judge runs --csv build/demo/rotations.csv --plot build/demo/rotations.svg \
    --axes h:energy_error --axes h:distance --axes energy_error:cpu_seconds --method lie-verlet:solve=exp --method lie-verlet:solve=cayley \
    --method lie-rk:scheme=explicit-midpoint --method lie-rk:scheme=implicit-midpoint --method lie-rk:scheme=crouch-grossman \
    --method lie-rk:scheme=munthe-kaas --method lie-galerkin:degree=2 || [ $? -eq 3 ]
  for plot in build/demo/order.svg build/demo/bench.svg build/demo/rotations.svg; do
    [ -s $plot ] || refuse "$plot was not written"
    say "plot: $plot"
  done
}

lint() {
  install_packages "$lint_packages"
  status=0
  build asan
  run_tests asan || status=1
  build lint
  run_tests lint || status=1
  [ $status -eq 0 ] || refuse "a gate failed, see above"
}

[ $# -eq 1 ] || usage
cd "$(dirname "$0")/.."
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
case $1 in
  demo) demo ;;
  test)
    install_packages
    build release
    run_tests release -LE "lint|long"
    ;;
  lint) lint ;;
  *) usage ;;
esac
say "$1: done"
