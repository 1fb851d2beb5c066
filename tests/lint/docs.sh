#!/bin/sh
# Checks the pages: links lead to files and headings, the bibliography has all cited sources, the
# programs of the README, of docs/shapes.md and of pages in docs/fields are the examples that they
# name, and the guide's program compiles.
# Usage: docs.sh TOP C_COMPILER
set -u
cd "$1" || exit 1
compiler=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
rc=0
breach() { echo "$*"; rc=1; }

# fences LANGUAGE PAGE: print the lines of all fences of a language.
fences() {
  awk -v fence="\`\`\`$1" '$0 == fence { inside = 1; next } /^```$/ { inside = 0 } inside' "$2"
}

# anchors PAGE: print the anchors of the page's headings.
anchors() {
  awk '
    /^```/ { code = !code }
    !code && /^#+ / {
      sub(/^#+ /, "")
      $0 = tolower($0)
      gsub(/[^a-z0-9 _-]/, "")
      gsub(/ /, "-")
      print
    }' "$1"
}

links() {
  awk '/^```/ { code = !code } !code' "$1" | grep -o '](\([^)]*\))' | sed 's/^](//; s/)$//'
}

for page in *.md docs/*.md docs/*/*.md; do
  [ -e "$page" ] || continue
  folder=$(dirname "$page")
  for link in $(links "$page"); do
    case $link in http://* | https://* | mailto:*) continue ;; esac
    path=${link%%#*}
    target=$page
    [ -z "$path" ] || target=$folder/$path
    [ -e "$target" ] || { breach "$page: the link to $link leads nowhere"; continue; }
    case $link in
    *#*) anchors "$target" | grep -q -x -e "${link#*#}" ||
      breach "$page: $target has no heading for #${link#*#}" ;;
    esac
  done
  for key in $(grep -o '\<[A-Z][A-Za-z]*[12][0-9][0-9][0-9]\>' "$page" | sort -u); do
    grep -q "^@[a-z]*{$key," docs/references.bib || breach "$page: no $key in docs/references.bib"
  done
done

fences c README.md >"$work/readme.c"
cmp -s "$work/readme.c" apps/examples/pendulum.c ||
  breach "README.md: its program is not apps/examples/pendulum.c"
for program in shapes:shapes fields/waves:drum fields/forms:hole fields/maxwell:cavity \
  fields/densities:collision fields/multiscale:rapid_rod fields/moving:kink \
  fields/multisymplectic:breather fields/schroedinger:tunnel; do
  page=docs/${program%:*}.md
  example=apps/examples/${program#*:}.c
  fences c "$page" >"$work/program.c"
  cmp -s "$work/program.c" "$example" || breach "$page: its program is not $example"
done
fences c docs/guide.md >"$work/guide.c"
"$compiler" -std=c11 -Wall -Wextra -Wpedantic -Werror -I lib/include -fsyntax-only \
  "$work/guide.c" || breach "docs/guide.md: its program does not compile"
exit $rc
