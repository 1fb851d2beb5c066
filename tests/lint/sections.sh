#!/bin/sh
# Every section of scenes has its row in docs/scenes.md, with the line of the registry, and no other
# has one.  Usage: sections.sh TOP
set -u
lint=$(cd "$(dirname "$0")" && pwd)
cd "$1" || exit 1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

rows=lib/src/scene/sections/sections.def
awk -f "$lint/sections.awk" $rows >"$work/rows"
[ -s "$work/rows" ] || { echo "no rows in $rows"; exit 1; }
awk -F '\t' '{
  line = $2 == "REFUSED" ? "refused: " $4 : $4
  print "| `" $1 "` | " line " | " ($2 == "REQUIRED" ? "yes " : "") "|"
}' "$work/rows" | LC_ALL=C sort >"$work/said"
sed -n '/^| section | what it holds | needed |$/,/^$/p' docs/scenes.md | sed 1,2d | grep '^|' |
  LC_ALL=C sort >"$work/listed"
{
  LC_ALL=C comm -23 "$work/said" "$work/listed" | sed 's/^/docs\/scenes.md lacks: /'
  LC_ALL=C comm -13 "$work/said" "$work/listed" | sed 's/^/docs\/scenes.md has what no row says: /'
} >"$work/breaches"
cat "$work/breaches"
[ ! -s "$work/breaches" ]
