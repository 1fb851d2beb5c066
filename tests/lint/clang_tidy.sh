#!/bin/sh
# clang-tidy over the library, the command, the problems and the examples; the checks are in .clang-tidy.
# Usage: clang_tidy.sh TOP BUILD CLANG_TIDY
set -u
cd "$1" || exit 1
find lib apps -name '*.c' -print0 | xargs -0 -n 4 -P 2 "$3" -p "$2" --quiet --warnings-as-errors='*' 2>&1 |
  grep -v ' warnings\? generated\.$\|^Suppressed \|^Use -header-filter' >"$2/clang-tidy.log"
if grep -q 'error:\|warning:' "$2/clang-tidy.log"; then cat "$2/clang-tidy.log"; exit 1; fi
