#!/bin/sh
# Runs clang-tidy over the library, the command, the problems and the examples, with the checks of
# .clang-tidy. It looks at a source if the source, a header of ours that it includes or the checks
# have changed since the commit that the file `analyzed` beside this script names, and if they have
# not passed in this build folder since. Without history, or without that commit in it, it looks at
# every source. With DVI_ANALYZE=record it writes the commit into that file if all sources pass and
# none differs from the commit, for then all sources have passed; to be committed. DVI_ANALYZE=all
# does the same, and looks at every source (`sh cmake/bootstrap.sh long` does that).
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

find lib/src apps -name '*.c' | LC_ALL=C sort >"$work/sources"
[ -s "$work/sources" ] || { echo "no sources"; exit 1; }

# Each line of $work/parts names a source and its headers.
xargs "$compiler" -MM -MG -I lib/include -I lib/src -I apps -I apps/problems <"$work/sources" \
  2>"$work/errors" |
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

# $work/changed lists the files that changed since all sources last passed. It does not exist
# without history.
base=$(cat tests/lint/analyzed)
git merge-base --is-ancestor "$base" HEAD 2>/dev/null || base=
case ${DVI_ANALYZE:-} in
  all) base=; rm -f "$build"/analyzed/* ;;
esac
if [ -n "$base" ]; then
  { git diff --name-only "$base"; git ls-files --others --exclude-standard; } >"$work/changed"
fi

# is_changed FILE...: succeed if one of the files changed, or the checks did.
is_changed() {
  [ -n "$base" ] || return 0
  printf '%s\n' .clang-tidy tests/lint/analyzer.h tests/lint/analyzer_scene.h \
    tests/lint/clang_tidy.sh "$@" |
    grep -q -x -F -f "$work/changed"
}

checks=$({ "$tool" --version; cat .clang-tidy tests/lint/analyzer*.h "$0"; } | cksum)
while read -r parts; do
  # The list is meant to be split into words.
  # shellcheck disable=SC2086
  key=$({ echo "$checks $parts"; cat $parts 2>/dev/null; } | cksum | tr -c '0-9\n' '-')
  [ ! -e "$build/analyzed/$key" ] || continue
  # shellcheck disable=SC2086
  is_changed $parts || continue
  echo "$key ${parts%% *}"
done <"$work/parts" >"$work/todo"

echo "clang-tidy looks at $(wc -l <"$work/todo") of $(wc -l <"$work/sources") sources"
if [ -s "$work/todo" ]; then
  xargs -n 2 -P "$cores" sh "$0" --one tidy "$top" "$build" "$tool" <"$work/todo" || rc=1
fi
case ${DVI_ANALYZE:-} in
  all | record)
    if [ $rc -eq 0 ] && git diff --quiet HEAD -- lib apps .clang-tidy tests/lint; then
      git rev-parse HEAD >tests/lint/analyzed
      echo "tests/lint/analyzed names this commit now; please commit it"
    fi
    ;;
esac
exit $rc
