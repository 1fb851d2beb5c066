#!/bin/sh
# Bundles the program of the pages, apps/view/page/*.js and the three.js that package-lock.json
# names, to one file, that of bundle/ by default.  Usage: bundle.sh [FILE.js]
# It needs npm and esbuild 0.17. The same sources give the same bytes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here"/*.js "$here"/package.json "$here"/package-lock.json "$work"
(
  cd "$work"
  npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1 || { cat npm.log >&2; exit 1; }
  cmp -s node_modules/three/LICENSE "$here/../../../LICENSES/three.js.txt" || {
    echo "bundle.sh: LICENSES/three.js.txt is not the licence of this three.js" >&2
    exit 1
  }
  esbuild main.js --bundle --minify --format=iife --target=es2020 --charset=ascii \
    --legal-comments=none --log-level=warning --outfile=bundle.js \
    --banner:js="/*! three.js
$(cat node_modules/three/LICENSE)
*/"
)
if grep -qi '</script' "$work/bundle.js"; then
  echo "bundle.sh: the bundle has an end tag, which would end it within a page" >&2
  exit 1
fi
cp "$work/bundle.js" "${1:-$here/bundle/program.js}"
