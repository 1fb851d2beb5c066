#!/bin/sh
# Tests of an installed package, as a user meets it: programs build by CMake and by pkg-config and
# run, the command runs, with SUNDIALS, too, its scenes are there, and the pages lead somewhere. It
# needs a C compiler, CMake and pkg-config, and nothing of a build.
# Usage: installed.sh PREFIX [VERSION [C_COMPILER [CMAKE]]]     for example installed.sh /usr
set -eu
prefix=${1:?usage: installed.sh PREFIX [VERSION [C_COMPILER [CMAKE]]]}
version=${2:-$("$prefix/bin/dvi" --version | cut -d ' ' -f 2)}
compiler=${3:-cc} cmake=${4:-cmake}
source=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
say() { echo "installed: $*"; }
fail() { [ ! -e "$work/log" ] || cat "$work/log"; say "$*"; exit 1; }
# Run a command, whose output is shown if it fails.
quietly() { "$@" >"$work/log" 2>&1; }

configure() {
  quietly "$cmake" -S "$source/consumer" -B "$work/$1" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_C_COMPILER="$compiler" -DDVI_WANTED="$2"
}

say "find_package(dvi $version)"
configure cmake "$version" || fail "the package was not found"
quietly "$cmake" --build "$work/cmake" || fail "the consumer does not build"
for form in shared static; do
  [ "$("$work/cmake/$form")" = "$version" ] || fail "$form: the consumer does not run"
done
quietly "$work/cmake/study" || fail "the consumer of studies does not run"

say "find_package(dvi 99) must fail"
if configure wrong 99; then fail "version 99 was found"; fi
grep -q "version: $version" "$work/log" || fail "refused, but not for the version"

say "pkg-config"
pc=$(find "$prefix" -name dvi.pc)
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
[ "$(pkg-config --modversion dvi)" = "$version" ] || fail "pkg-config gives another version"
if pkg-config --exists 'dvi >= 99'; then fail "pkg-config has version 99"; fi
# The words of pkg-config are meant to be split.
# shellcheck disable=SC2046
quietly "$compiler" -std=c11 "$source/consumer/main.c" -o "$work/plain" \
  $(pkg-config --cflags --libs dvi) -Wl,-rpath,"$(pkg-config --variable=libdir dvi)" ||
  fail "no program by pkg-config"
quietly "$work/plain" || fail "the program that pkg-config built does not run"
# shellcheck disable=SC2046
quietly "$compiler" -std=c11 "$source/consumer/study.c" -o "$work/study" \
  $(pkg-config --cflags --libs dvi-study) -Wl,-rpath,"$(pkg-config --variable=libdir dvi)" ||
  fail "no program with studies by pkg-config"
quietly "$work/study" || fail "the program with studies does not run"
# shellcheck disable=SC2046
quietly "$compiler" -std=c11 "$source/consumer/main.c" -o "$work/plain_static" \
  $(pkg-config --cflags dvi) "$(pkg-config --variable=libdir dvi)/libdvi.a" \
  $(pkg-config --static --libs-only-l dvi | sed 's/-ldvi\( \|$\)//') ||
  fail "no program by pkg-config with the static library"
quietly "$work/plain_static" || fail "the program with the static library does not run"

say "the command"
dvi=$prefix/bin/dvi
quietly "$dvi" --help || fail "dvi --help does not work"
quietly "$dvi" list methods || fail "dvi list does not work"
quietly "$dvi" run kepler --h 0.1 --t-end 1 --method galerkin || fail "dvi run does not work"
quietly "$dvi" run kepler --h 0.1 --t-end 1 --method galerkin:solver=kinsol ||
  fail "SUNDIALS does not work"
quietly "$dvi" order kepler --method verlet --levels 4 || fail "dvi order does not work"

if [ -n "$(find "$prefix"/lib* -name dvi_hdf5.so)" ]; then
  quietly "$dvi" run kepler --method verlet --h 0.1 --t-end 1 --out "$work/rows.h5" ||
    fail "the command writes no HDF5"
fi

say "scenes, manual pages and completions"
quietly "$dvi" check "$prefix/share/dvi/scenes/kepler.yaml" ||
  fail "an installed scene does not run"
commands=$("$dvi" --help |
  awk '/^Commands:/ { rows = 1; next } !NF { rows = 0 } rows { print $1 }')
for page in dvi $(echo "$commands" | sed 's/^/dvi-/'); do
  [ -s "$prefix/share/man/man1/$page.1" ] || [ -s "$prefix/share/man/man1/$page.1.gz" ] ||
    fail "no manual page $page(1)"
done
quietly bash -c ". '$prefix/share/bash-completion/completions/dvi'" ||
  fail "bash does not read its completions"
zsh=$(find "$prefix/share/zsh" -name _dvi)
for command in $commands; do
  grep -q "^ *'$command:" "$zsh" || fail "zsh does not complete dvi $command"
  grep -q "^  $command)" "$prefix/share/bash-completion/completions/dvi" ||
    fail "bash does not complete dvi $command"
done

# Distributions may leave the pages out of an installed system.
pages=$prefix/share/doc/dvi
if [ -e "$pages/docs" ]; then
  say "pages"
  find "$pages" -name '*.md' | while read -r page; do
    grep -o ']([^)# ]*' "$page" | sed 's/..//' | grep -v -e '^$' -e '^[a-z]*:' |
      while read -r link; do
      [ -e "$(dirname "$page")/$link" ] || echo "${page#"$pages"/}: $link"
    done
  done >"$work/log"
  [ ! -s "$work/log" ] || fail "links of the pages lead nowhere"
fi
say "all is well"
