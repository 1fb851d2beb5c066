#!/bin/sh
# The program of the pages of dvi view is the bundle of its sources, byte by byte. Skipped without
# npm, its registry, and the version of esbuild that made the bundle.  Usage: view_bundle.sh TOP
set -u
view=$1/apps/view/page
version=0.17.0
command -v npm >/dev/null || { echo 'skipped: no npm'; exit 77; }
command -v esbuild >/dev/null || { echo 'skipped: no esbuild'; exit 77; }
[ "$(esbuild --version)" = $version ] || { echo "skipped: esbuild is not $version"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
if ! sh "$view/bundle.sh" "$work/program.js" 2>"$work/log"; then
  cat "$work/log"
  if grep -q 'npm ERR! code E\(AI_AGAIN\|NOTFOUND\|TIMEDOUT\|CONNREFUSED\)' "$work/log"; then
    echo 'skipped: npm finds no registry'
    exit 77
  fi
  exit 1
fi
cmp "$work/program.js" "$view/bundle/program.js" || {
  echo 'bundle/program.js is not made of its sources: run sh apps/view/page/bundle.sh'
  exit 1
}
