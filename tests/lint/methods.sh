#!/bin/sh
# Each method has a source, a test, a page in docs/methods or in a folder there, a row of the table
# in docs/methods/README.md that links to the page and has no empty cell, and an entry of the
# bibliography, and each page of a method has its line in methods.def.
# Usage: methods.sh TOP NAME...
set -u
cd "$1" || exit 1
shift
rc=0
need() {
  [ -e "$1" ] || { echo "missing: $1 (its method is in lib/src/method/methods.def)"; rc=1; }
}
[ $# -gt 0 ] || { echo "no METHOD(name) line in lib/src/method/methods.def"; exit 1; }
for name; do
  source=$(find lib/src/method -name "$name.c")
  [ -n "$source" ] || {
    echo "missing: lib/src/method/*/$name.c (its method is in lib/src/method/methods.def)"
    rc=1
    continue
  }
  folder=$(dirname "${source#lib/src/}")
  need "tests/$folder/test_$name.c"
  # a page may stand in a folder, as its source does
  page=$name.md
  [ -e "docs/methods/$page" ] || page=${folder#method/}/$name.md
  [ -e "docs/methods/$page" ] || page=$name.md
  need "docs/methods/$page"
  # method, systems, order, symplectic, symmetric, cost
  awk -F ' *[|] *' -v link="]($page)" '
    /^[|]/ && index($2, link) && NF == 8 {
      filled = 1
      for (i = 2; i <= 7; i++) if ($i == "") filled = 0
      if (filled) found = 1
    }
    END { exit !found }' docs/methods/README.md 2>/dev/null ||
    { echo "docs/methods/README.md: no row of the table with six cells links to $page"; rc=1; }
  cite=$(sed -n 's/.*\.cite = "\([^"]*\)".*/\1/p' "$source")
  if [ -z "$cite" ]; then
    echo "$source: no .cite"; rc=1
  elif ! grep -q "^@[a-z]*{$cite," docs/references.bib 2>/dev/null; then
    echo "docs/references.bib: no entry $cite (cited by $name)"; rc=1
  fi
done
for page in docs/methods/*.md docs/methods/*/*.md; do
  page=$(basename "$page" .md)
  case " README index * $* " in
    *" $page "*) ;;
    *) echo "docs/methods/$page.md: no METHOD($page) in methods.def"; rc=1 ;;
  esac
done
exit $rc
