#!/bin/sh
# Installs the build into a temporary folder, moves it, and uses it as a stranger would.
# Usage: install.sh BUILD SOURCE CMAKE C_COMPILER VERSION
# SOURCE is the folder that holds consumer/.
set -eu
build=$1 source=$2 cmake=$3 compiler=$4 version=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
say() { echo "install test: $*"; }
fail() { say "$*"; exit 1; }

"$cmake" --install "$build" --prefix "$work/first" >"$work/log" || { cat "$work/log"; exit 1; }
# An installation that works only where it was put first is broken.
prefix=$work/prefix
mv "$work/first" "$prefix"
config=$(find "$prefix" -name dviConfig.cmake)
pc=$(find "$prefix" -name dvi.pc)
if [ -z "$config" ] || [ -z "$pc" ]; then fail "no dviConfig.cmake or no dvi.pc"; fi
if grep -q "$work/first" "$config" "$pc"; then fail "the package files name the first prefix"; fi

say "SUNDIALS, loaded on demand"
helper=$(find "$prefix" -name 'libdvi-sundials.so.?.?')
[ -n "$helper" ] || fail "the library that loads SUNDIALS is not there"
orbit() { "$prefix/bin/dvi" run kepler --h 0.1 --t-end 1 --method "$1" >"$work/log" 2>&1; }
mv "$helper" "$helper.away"
orbit galerkin || {
  cat "$work/log"
  fail "a run without SUNDIALS asks for it"
}
if orbit galerkin:solver=kinsol ||
  ! grep -q 'SUNDIALS cannot be loaded: libdvi-sundials' "$work/log"; then
  cat "$work/log"
  fail "no sentence on a SUNDIALS that cannot be loaded"
fi
mv "$helper.away" "$helper"

[ -s "$prefix/share/doc/dvi/docs/pictures/cart.svg" ] || fail "the pages are not there"
sh "$source/installed.sh" "$prefix" "$version" "$compiler" "$cmake"
say "all is well"
