#!/bin/sh
# From a bare Debian (12 or later) or Ubuntu (24.04 or later) to a built, run and tested libdvi:
#   sh cmake/bootstrap.sh demo    build, and study the Kepler problem and a pendulum in space
#   sh cmake/bootstrap.sh test    build, and run all tests that a user needs to trust the build
#   sh cmake/bootstrap.sh site    make an HTML site of the pages, with search, in build/site/html
#   sh cmake/bootstrap.sh lint    install more tools, run every gate, and all tests under sanitizers
#   sh cmake/bootstrap.sh long    run for hours: full studies, the analyzer on all sources, fuzzing
# Missing packages are installed by apt-get, with sudo if needed. With CI=true in the environment
# compiler warnings are errors.
set -eu

packages="gcc g++ libc6-dev make cmake pkg-config libsundials-dev libsuitesparse-dev liblapack-dev
  libarpack2-dev libyaml-dev libhdf5-dev check gnuplot-nox
  python3-dev python3-cffi python3-numpy python3-h5py python3-setuptools python3-pytest"
# The pages' Python and the notebooks need these.
test_packages="python3-matplotlib python3-scipy python3-sympy"
site_packages="python3 mkdocs"
lint_packages="$site_packages clang clang-tidy clang-format cppcheck doxygen valgrind libc6-dbg
  libclang-rt-dev esbuild"

usage() {
  cat >&2 <<'END'
usage: sh cmake/bootstrap.sh demo|test|site|lint|long
  demo   build, and run three studies; plots go to build/demo/
  test   build, and run the tests
  site   make an HTML site of the pages, with search, in build/site/html
  lint   run every gate, and the tests in a build with sanitizers
  long   run what continuous integration leaves out because it takes too long
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
    dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q ' installed$' ||
      printf '%s ' "$package"
  done
}

explain_by_hand() {
  cat >&2 <<END
bootstrap: this system is neither Debian 12 or later nor Ubuntu 24.04 or later: please install what
is needed yourself: a C11 compiler, make, CMake 3.22 or later, pkg-config, SUNDIALS 6.4 to 7 with
KLU, SuiteSparse, LAPACK, ARPACK, libyaml, HDF5, Check, gnuplot and, for a test, a C++ compiler;
for lint also clang, clang-tidy, clang-format, cppcheck, Doxygen and valgrind. On Debian these
packages are called
  $packages
  $test_packages
  $lint_packages
Then:  cmake --preset release && cmake --build --preset release
       ctest --preset release -LE "lint|long"
END
  exit 1
}

# install_packages [MORE]: install those of the packages, and of MORE, that are missing.
install_packages() {
  if ! known_system || ! command -v apt-get >/dev/null; then explain_by_hand; fi
  # The lists are meant to be split into words, here and below.
  # shellcheck disable=SC2086
  wanted=$(missing $packages ${1:-})
  [ -n "$wanted" ] || return 0
  root=
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      refuse "not root, and there is no sudo." \
        "As root, run: apt-get install --no-install-recommends $wanted"
    root=sudo
  fi
  say "installing: $wanted"
  log=$(mktemp)
  # shellcheck disable=SC2086
  if ! { $root apt-get update -qq &&
    $root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $wanted
  } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    refuse "apt-get failed, see above"
  fi
  rm -f "$log"
}

# Installs a browser for the test of the pages of dvi view where there is a package of it, as on
# Debian. Without it the test is skipped.
install_browser() {
  browser=chromium-headless-shell
  if apt-cache show $browser >/dev/null 2>&1; then install_packages $browser; fi
}

# Installs SLEPc where there is PETSc. Without it dvi finds no modes on several processes, and their
# tests are skipped.
install_slepc() {
  if pkg-config --exists PETSc && apt-cache show slepc-dev >/dev/null 2>&1; then
    install_packages slepc-dev
  fi
}

# Prints the option for the component that is linked to PETSc and MPI: it is built, and tested with
# four processes, where they are. libsundials-dev of Debian brings them along. Nothing installs them
# for its sake.
petsc_option() {
  if pkg-config --exists PETSc && command -v mpirun >/dev/null; then
    echo -DDVI_PETSC=ON
  else
    say "PETSc or mpirun is not installed: the tests with MPI are skipped" >&2
    echo -DDVI_PETSC=OFF
  fi
}

# build PRESET [OPTION...]: configure and build; output only if it fails, or if there are warnings.
# Messages of progress, which nobody sees, would start one more process for each source.
build() {
  preset=$1
  shift
  werror=OFF
  [ "${CI:-}" != true ] || werror=ON
  say "building: $preset"
  mkdir -p build
  if ! {
    cmake --preset "$preset" -DDVI_WERROR=$werror -DCMAKE_RULE_MESSAGES=OFF "$@" &&
      cmake --build --preset "$preset" -j "$cores"
  } >"build/$preset.log" 2>&1; then
    tail -n 60 "build/$preset.log" >&2
    refuse "the build failed; the whole output is in build/$preset.log"
  fi
  grep -A 4 'warning:' "build/$preset.log" || true
}

# One test more than there are cores: some wait for the disk.
run_tests() {
  preset=$1
  shift
  say "testing: $preset"
  ctest --preset "$preset" -j $((cores + 1)) "$@"
}

demo() {
  install_packages
  build release
  dvi=build/release/apps/dvi
  mkdir -p build/demo
  say "order study of a planet's orbit: the error against the step," \
    "the measured order against the claimed one"
  $dvi order kepler --method galerkin:degree=1 --method galerkin:degree=2 \
    --method galerkin:degree=3 --method galerkin:degree=4 --plot build/demo/order.svg
  say "speed against error, beside three codes of SUNDIALS"
  $dvi bench kepler --method verlet --method galerkin:degree=2 --method galerkin:degree=4 \
    --method galerkin:degree=8 --against cvode,arkode,ida --plot build/demo/bench.svg
  say "a pendulum that turns in space: error of the energy," \
    "and distance of its attitude from the rotations"
  $dvi order pendulum-3d --t-end 1 --h 0.02 --levels 5 --judge runs \
    --plot build/demo/rotations.svg --axes h:error --axes h:energy_error --axes h:distance \
    --method lie-verlet \
    --method lie-rk:scheme=explicit-midpoint --method lie-rk:scheme=implicit-midpoint \
    --method lie-rk:scheme=crouch-grossman --method lie-rk:scheme=munthe-kaas \
    --method lie-galerkin:degree=2
  for plot in build/demo/order.svg build/demo/bench.svg build/demo/rotations.svg; do
    [ -s $plot ] || refuse "$plot was not written"
  done
  cat <<END

All orders are as claimed. Three pictures to look at:
  build/demo/order.svg      halve the step, and the error falls by 2, 4, 6 or 8 powers of two,
                            as theory says
  build/demo/bench.svg      what an error costs, beside CVODE, ARKODE and IDA
  build/demo/rotations.svg  the methods on rotations keep the attitude a rotation; a plain midpoint
                            rule does not

What to try next:
  $dvi list problems
  $dvi run pendulum --method galerkin:degree=2 --h 0.1 --t-end 20 --final --plot pendulum.svg
  $dvi init cart.yaml  # a scene of your own: the Lagrangian as on paper; docs/cookbook.md has more
END
}

# Runs the gates and valgrind on the build that users get, then all tests by clang with sanitizers.
lint() {
  install_packages "$lint_packages"
  install_browser
  status=0
  install_slepc
  build lint "$(petsc_option)"
  run_tests lint || status=1
  build asan
  # The texts are the same in every run: `long` tries more of them.
  DVI_FUZZ_SECONDS=${DVI_FUZZ_SECONDS:-10} run_tests asan || status=1
  [ $status -eq 0 ] || refuse "a gate failed, see above"
}

long() {
  install_packages "$lint_packages"
  status=0
  build lint
  run_tests release -L long || status=1
  DVI_ANALYZE=all run_tests lint -R lint/clang_tidy || status=1
  build asan
  DVI_FUZZ_SECONDS=300 run_tests asan -R fuzz || status=1
  [ $status -eq 0 ] || refuse "a study failed, see above"
}

site() {
  install_packages "$site_packages"
  mkdir -p build/site
  python3 cmake/site.py build/site || refuse "the site could not be made, see above"
  say "open build/site/html/index.html; the search needs a server, such as" \
    "python3 -m http.server -d build/site/html"
}

[ $# -eq 1 ] || usage
cd "$(dirname "$0")/.."
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
case $1 in
  demo) demo ;;
  test)
    install_packages "$test_packages"
    install_slepc
    build release "$(petsc_option)"
    run_tests release -LE "lint|long"
    ;;
  site) site ;;
  lint) lint ;;
  long) long ;;
  *) usage ;;
esac
say "$1: done"
