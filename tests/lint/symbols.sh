#!/bin/sh
# The shared library exports exactly the functions that its public headers declare, in a named
# version node, and internal names in the node DVI_PRIVATE alone; the static one defines no global
# name outside dvi_ and dvi__.
# Usage: symbols.sh SHARED STATIC HEADER...
set -u
shared=$1 static=$2
shift 2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
rc=0

nm -D --with-symbol-versions --defined-only "$shared" |
  awk 'NF == 3 && $2 != "A" { print $3 }' >"$work/versioned"
sed 's/@.*//' "$work/versioned" | grep -v '^dvi__' | sort -u >"$work/exported"
awk -f "$(dirname "$0")/declared.awk" "$@" | sort -u >"$work/declared"

[ -s "$work/declared" ] || { echo "no declarations found in $*"; rc=1; }
comm -23 "$work/exported" "$work/declared" |
  sed 's/^/exported, but in no public header: /' >"$work/report"
comm -13 "$work/exported" "$work/declared" |
  sed 's/^/declared, but not exported: /' >>"$work/report"
# clang gives the choice between the versions of a function, even of a static one, a global name.
nm -g --defined-only "$static" 2>/dev/null |
  awk 'NF == 3 && $3 !~ /^dvi_/ && $3 !~ /\.resolver$/ { print $3 }' |
  sed 's/^/global name without the prefix: /' >>"$work/report"
grep '^dvi__' "$work/versioned" | grep -v '@@DVI_PRIVATE$' |
  sed 's/^/internal name is exported: /' >>"$work/report"
grep '^dvi_[^_]' "$work/versioned" | grep -v '@@DVI_' |
  sed 's/^/exported without a version node: /' >>"$work/report"
if [ -s "$work/report" ]; then cat "$work/report"; rc=1; fi
exit $rc
