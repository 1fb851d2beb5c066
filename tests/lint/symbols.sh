#!/bin/sh
# The shared library exports exactly the functions that its public headers declare; the static one defines no global name outside
# dvi_ and dvi__.  Usage: symbols.sh SHARED STATIC HEADER...
set -u
shared=$1 static=$2
shift 2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
rc=0

nm -D --defined-only "$shared" | awk 'NF == 3 { print $3 }' | sort -u >"$work/exported"
# Comments are cut out; what is left before an opening parenthesis at a prototype's start is its name.
cat "$@" | awk '
  { text = text " " $0 "\n" }
  END {
    while ((start = index(text, "/*")) > 0) {
      rest = substr(text, start + 2)
      text = substr(text, 1, start - 1) substr(rest, index(rest, "*/") + 2)
    }
    count = split(text, line, "\n")
    for (i = 1; i <= count; i++)
      if (line[i] ~ /^ (const |unsigned )*[a-z][a-z_]* \**dvi_[a-z_0-9]+\(/) {
        name = line[i]
        sub(/\(.*/, "", name)
        sub(/.*[ *]/, "", name)
        print name
      }
  }' | sort -u >"$work/declared"

[ -s "$work/declared" ] || { echo "no declarations found in $*"; rc=1; }
comm -23 "$work/exported" "$work/declared" | sed 's/^/exported, but in no public header: /' >"$work/report"
comm -13 "$work/exported" "$work/declared" | sed 's/^/declared, but not exported: /' >>"$work/report"
# clang gives the choice between the versions of a function, even of a static one, a global name.
nm -g --defined-only "$static" 2>/dev/null | awk 'NF == 3 && $3 !~ /^dvi_/ && $3 !~ /\.resolver$/ { print "global name without the prefix: " $3 }' >>"$work/report"
nm -D --defined-only "$shared" | awk 'NF == 3 && $3 ~ /^dvi__/ { print "internal name is exported: " $3 }' >>"$work/report"
if [ -s "$work/report" ]; then cat "$work/report"; rc=1; fi
exit $rc
