#!/bin/sh
# Make manual pages and the completions of bash and zsh from what dvi prints for --help, which is
# made from the tables of its options.
# Usage: from_help.sh DVI OUT     writes OUT/man1/*.1, OUT/bash/dvi and OUT/zsh/_dvi
set -eu
here=$(cd "$(dirname "$0")" && pwd)
dvi=$1 out=$2
rm -rf "$out/man1" "$out/bash" "$out/zsh"
mkdir -p "$out/man1" "$out/bash" "$out/zsh"
: >"$out/helps"
version=$("$dvi" --version | cut -d ' ' -f 2)
commands=$("$dvi" --help |
  awk '/^Commands:/ { rows = 1; next } !NF { rows = 0 } rows { print $1 }')

page() { awk -v name="$1" -v version="$version" -f "$here/manual.awk" >"$out/man1/$1.1"; }

"$dvi" --help | page dvi
for command in $commands; do
  "$dvi" "$command" --help >"$out/help"
  page "dvi-$command" <"$out/help"
  cat "$out/help" >>"$out/helps"
done
awk -v shell=bash -f "$here/completions.awk" "$out/helps" >"$out/bash/dvi"
awk -v shell=zsh -f "$here/completions.awk" "$out/helps" >"$out/zsh/_dvi"
rm "$out/help" "$out/helps"
