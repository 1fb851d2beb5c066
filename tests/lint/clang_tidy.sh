#!/bin/sh
# clang-tidy over the library, the command, the problems and the examples; the checks are in .clang-tidy.
# Usage: clang_tidy.sh TOP BUILD CLANG_TIDY
set -u
cd "$1" || exit 1
build=$2 tool=$3 log=$2/clang-tidy.log

# tidy OPTION... <FILES: one file a run, because the analyzer of version 14 carries va_lists over from one file to the next.
tidy() { xargs -n 1 -P 2 "$tool" -p "$build" --quiet --warnings-as-errors='*' "$@" 2>&1; }

{
  find lib/src/core apps -name '*.c' | tidy
  find lib/src -name '*.c' ! -path 'lib/src/core/*' ! -path 'lib/src/text/*' ! -path 'lib/src/expr/*' ! -path 'lib/src/scene/*' |
    tidy --extra-arg=-include --extra-arg="$1/tests/lint/analyzer.h" --extra-arg=-Wno-unused-value
  find lib/src/text lib/src/expr lib/src/scene -name '*.c' |
    tidy --extra-arg=-include --extra-arg="$1/tests/lint/analyzer_scene.h" --extra-arg=-Wno-unused-value
} | grep -v ' warnings\? .*generated\.$\|^Suppressed \|^Use -header-filter' >"$log"
if grep -q 'error:\|warning:' "$log"; then cat "$log"; exit 1; fi
