#!/bin/sh
# The rooms of the library and of the command include each other in no circle, no folder has more
# than 30 files at one level, and docs/CONTRIBUTING.md shows the rooms as they are. The public
# headers are flat on purpose, one for each object of the library, and may be 45.
# Usage: rooms.sh [--update] [TOP]
# With --update it draws the rooms anew in docs/CONTRIBUTING.md.
set -u
lint=$(cd "$(dirname "$0")" && pwd)
update=no
if [ "${1:-}" = --update ]; then update=yes; shift; fi
cd "${1:-$lint/../..}" || exit 1
page=docs/CONTRIBUTING.md rc=0
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

draw() { find "$1" -name '*.[ch]' -exec awk -v root="$1" -f "$lint/rooms.awk" {} +; }

for tree in lib/src/ apps/; do
  printf '%s\n\n' "$tree"
  if ! draw $tree >"$work/levels"; then grep circle "$work/levels" >&2; exit 1; fi
  sed 's/^/    /; s/ *$//' "$work/levels"
  echo
done >"$work/drawing" || exit 1

for folder in $(find lib apps tests cmake docs -type d ! -path docs/pictures); do
  count=$(find "$folder" -maxdepth 1 -type f | wc -l)
  most=30
  if [ "$folder" = lib/include/dvi ]; then most=45; fi
  if [ "$count" -gt $most ]; then
    echo "$folder has $count files at one level, $most at most: move some into a folder below it"
    rc=1
  fi
done

# The page with the drawing between its two comments.
awk -v drawing="$work/drawing" '
  /^<!-- rooms: end -->$/ { inside = 0; ended = 1 }
  !inside { print }
  /^<!-- rooms: begin/ {
    inside = begun = 1
    print ""
    while ((getline line < drawing) > 0) print line
  }
  END { exit !(begun && ended) }' $page >"$work/page" || {
  echo "$page: write the comments <!-- rooms: begin .. --> and <!-- rooms: end -->"
  exit 1
}
if [ $update = yes ]; then
  cp "$work/page" $page
elif ! cmp -s "$work/page" $page; then
  echo "$page does not show the rooms as they are; draw them by: sh tests/lint/rooms.sh --update"
  diff $page "$work/page"
  rc=1
fi
exit $rc
