#!/bin/sh
# Measures by gcov how much of lib/src the tests of a release build cover: for each room the lines
# that run, and the branches that are taken at least once. Long runs take a tenth of their steps.
# Usage: sh tests/lint/coverage.sh [SOURCE [BUILD]]
# SOURCE is the tree (default this one), BUILD the folder of the build (default build/coverage).
set -eu
lint=$(cd "$(dirname "$0")" && pwd)
top=$(cd "${1:-$lint/../..}" && pwd)
build=${2:-$top/build/coverage}
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
mkdir -p "$build"
build=$(cd "$build" && pwd)

cmake -S "$top" -B "$build" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS="-O1 -DNDEBUG --coverage" \
  -DDVI_TEST_TIMEOUT_FACTOR=10 >"$build/configure.log"
cmake --build "$build" -j "$cores" >"$build/build.log" 2>&1 || {
  tail -n 40 "$build/build.log"
  exit 1
}
find "$build" -name '*.gcda' -delete
failed=0
DVI_TEST_FEWER=1 ctest --test-dir "$build" -LE "lint|long" -j "$cores" >"$build/tests.log" 2>&1 ||
  failed=1
tail -n 12 "$build/tests.log" | sed -n '/tests passed/,$p'

# One call, so that gcov adds up what a header does in all sources that include it.
find "$build/lib" -name '*.gcno' -exec gcov --branch-probabilities --no-output {} + \
  >"$build/gcov.log" 2>/dev/null
awk -v root="$top/lib/src/" -f "$lint/coverage.awk" "$build/gcov.log"
exit $failed
