#!/bin/sh
# Runs clang-tidy over the library, the command, the problems and the examples, with the checks of
# .clang-tidy. A source that has passed is not looked at again until it, a header of ours that it
# includes, the checks or the tool change. The key of a source is a checksum of all these. Keys
# that have passed stand in the build folder, and in the file `analyzed` beside this script.
# With DVI_ANALYZE=record the keys of all sources are written into that file if all of them pass, to
# be committed. DVI_ANALYZE=all looks at every source before that (`sh cmake/bootstrap.sh long` does
# so).
# Usage: clang_tidy.sh TOP BUILD CLANG_TIDY C_COMPILER
set -u

# tidy TOP BUILD CLANG_TIDY KEY FILE: look at one file, and leave its key if it passes, else print
# the messages. Each file gets a run of its own, because the analyzer of version 14 carries va_lists
# over from one file to the next.
tidy() {
  top=$1 build=$2 tool=$3 key=$4 file=$5
  cd "$top" || exit 1
  header=
  case $file in
    lib/src/text/* | lib/src/expr/* | lib/src/scene/*) header=analyzer_scene.h ;;
    lib/src/core/* | apps/*) ;;
    lib/*) header=analyzer.h ;;
  esac
  set -- --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-double-promotion
  [ -z "$header" ] ||
    set -- "$@" --extra-arg=-include --extra-arg="$top/tests/lint/$header" \
      --extra-arg=-Wno-unused-value
  set -- -p "$build" --quiet --warnings-as-errors='*' "$@" "$file"
  if said=$("$tool" "$@" 2>&1); then
    touch "$build/analyzed/$key"
    return
  fi
  printf '%s\n' "$said" | grep -v ' warnings\? .*generated\.$\|^Suppressed \|^Use -header-filter'
  return 1
}

if [ "$1" = --one ]; then shift; "$@"; exit $?; fi

cd "$1" || exit 1
top=$1 build=$2 tool=$3 compiler=$4
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
mkdir -p "$build/analyzed"
rc=0

# Sources for PETSc, and the one for SLEPc, are left out where they are not built.
grep -q '/lib/petsc/' "$build/compile_commands.json" && petsc=kept || petsc='*/petsc/*'
slepc='*/modes/eigen.c'
grep -q '/modes/eigen\.c"' "$build/compile_commands.json" && slepc=kept
find lib apps -name '*.c' ! -path "$petsc" ! -path "$slepc" | LC_ALL=C sort >"$work/sources"
[ -s "$work/sources" ] || { echo "no sources"; exit 1; }

# Each line of $work/parts names a source and its headers.
xargs "$compiler" -MM -MG -I lib/include -I lib/petsc/include -I lib/petsc/src -I lib/src \
  -I apps -I apps/problems \
  <"$work/sources" 2>"$work/errors" |
  awk '{ rule = rule " " $0 }
    !/\\$/ {
      gsub(/\\/, "", rule)
      sub(/^ *[^ ]*: */, "", rule)
      gsub(/  +/, " ", rule)
      print rule
      rule = ""
    }' |
  LC_ALL=C sort >"$work/parts"
[ "$(wc -l <"$work/parts")" -eq "$(wc -l <"$work/sources")" ] || {
  cat "$work/errors"
  echo "some sources have no list of headers"
  exit 1
}

if [ "${DVI_ANALYZE:-}" = all ]; then
  rm -f "$build"/analyzed/*
  passed=/dev/null
else
  passed=tests/lint/analyzed
fi

checks=$({
  "$tool" --version | grep -o 'version [0-9.]*'
  cat .clang-tidy tests/lint/analyzer*.h "$0"
} | cksum)
while read -r parts; do
  # The list is meant to be split into words.
  # shellcheck disable=SC2086
  key=$({ echo "$checks $parts"; cat $parts 2>/dev/null; } | cksum | tr -c '0-9\n' '-')
  echo "$key ${parts%% *}"
done <"$work/parts" >"$work/keys"
LC_ALL=C grep -v -x -F -f "$passed" "$work/keys" | while read -r key file; do
  [ -e "$build/analyzed/$key" ] || echo "$key $file"
done >"$work/todo"

echo "clang-tidy looks at $(wc -l <"$work/todo") of $(wc -l <"$work/sources") sources"
if [ -s "$work/todo" ]; then
  xargs -n 2 -P "$cores" sh "$0" --one tidy "$top" "$build" "$tool" <"$work/todo" || rc=1
fi
case ${DVI_ANALYZE:-} in
  all | record)
    if [ $rc -eq 0 ]; then
      cp "$work/keys" tests/lint/analyzed
      echo "tests/lint/analyzed has the keys of all sources now; please commit it"
    fi
    ;;
esac
exit $rc
