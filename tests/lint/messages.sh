#!/bin/sh
# docs/scene-errors.md has every sentence of the reader of scenes, and no other. An entry is a
# bullet that begins with a sentence in backquotes, in which <..> stands for a value that a format
# fills in.
# Usage: messages.sh TOP
set -u
lint=$(cd "$(dirname "$0")" && pwd)
cd "$1" || exit 1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

sources=$(find lib/src/text lib/src/expr lib/src/scene -name '*.[ch]' \
  ! -path 'lib/src/scene/emit/*' | LC_ALL=C sort)
# The registry of sections holds examples, and reasons why some sections are refused.
awk -f "$lint/sections.awk" lib/src/scene/sections/sections.def |
  awk -F '\t' '{ printf "\"%s\" x\n", $2 == "REFUSED" ? $4 : $3 }' >"$work/registry.c"
# shellcheck disable=SC2086
awk -f "$lint/messages.awk" $sources "$work/registry.c" | LC_ALL=C sort -u >"$work/said"
sed -n 's/^ *- ``\(.*\)``.*/\1/p; t; s/^ *- `\([^`]*\)`.*/\1/p' docs/scene-errors.md |
  sed 's/<[^>]*>/<>/g; s/\(<>\)*<>/<>/g; s/^ *//; s/ *$//' |
  LC_ALL=C sort >"$work/listed"
[ -s "$work/said" ] || { echo "no sentences in the sources"; exit 1; }
LC_ALL=C uniq -d "$work/listed" | sed 's/^/docs\/scene-errors.md has twice: /' >"$work/breaches"
LC_ALL=C sort -u "$work/listed" >"$work/once"
LC_ALL=C comm -23 "$work/said" "$work/once" |
  sed 's/^/docs\/scene-errors.md lacks: /' >>"$work/breaches"
LC_ALL=C comm -13 "$work/said" "$work/once" |
  sed 's/^/docs\/scene-errors.md has a sentence that no source says: /' >>"$work/breaches"
cat "$work/breaches"
[ ! -s "$work/breaches" ]
