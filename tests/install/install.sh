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

<<<<<<< HEAD
configure() {
  "$cmake" -S "$source/consumer" -B "$work/$1" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_C_COMPILER="$compiler" -DDVI_WANTED="$2" >"$work/log" 2>&1
}

say "find_package(dvi $version)"
configure cmake "$version" || { cat "$work/log"; fail "the package was not found"; }
"$cmake" --build "$work/cmake" >"$work/log" 2>&1 || {
  cat "$work/log"
  fail "the consumer does not build"
}
for form in shared static; do
  [ "$("$work/cmake/$form")" = "$version" ] || fail "$form: the consumer does not run"
done

say "find_package(dvi 99) must fail"
if configure wrong 99; then fail "version 99 was found"; fi
grep -q "version: $version" "$work/log" || {
  cat "$work/log"
  fail "refused, but not for the version"
}

say "pkg-config"
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
[ "$(pkg-config --modversion dvi)" = "$version" ] || fail "pkg-config gives another version"
if pkg-config --exists 'dvi >= 99'; then fail "pkg-config has version 99"; fi
# The words of pkg-config are meant to be split.
# shellcheck disable=SC2046
"$compiler" -std=c11 "$source/consumer/main.c" -o "$work/plain" $(pkg-config --cflags --libs dvi) \
  -Wl,-rpath,"$(pkg-config --variable=libdir dvi)"
"$work/plain" >"$work/log" || fail "the program that pkg-config built does not run"
# shellcheck disable=SC2046
"$compiler" -std=c11 "$source/consumer/main.c" -o "$work/plain_static" $(pkg-config --cflags dvi) \
  "$(pkg-config --variable=libdir dvi)/libdvi.a" \
  $(pkg-config --static --libs-only-l dvi | sed 's/-ldvi\( \|$\)//')
"$work/plain_static" >"$work/log" || fail "the program with the static library does not run"

say "the command"
"$prefix/bin/dvi" --help >"$work/log" || { cat "$work/log"; fail "dvi --help does not work"; }
"$prefix/bin/dvi" list methods >"$work/log" || { cat "$work/log"; fail "dvi list does not work"; }

if [ -n "$(find "$prefix" -name dvi_hdf5.so)" ]; then
  "$prefix/bin/dvi" run kepler --method verlet --h 0.1 --t-end 1 --out "$work/rows.h5" \
    2>"$work/log" || { cat "$work/log"; fail "the installed command writes no HDF5"; }
fi

=======
>>>>>>> c5f15b26d843cd2efe4f0e5570e57b2d8db7f899
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
