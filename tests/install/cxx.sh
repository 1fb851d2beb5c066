#!/bin/sh
# C++20 programs use the library. Each public header compiles alone, and all functions that it
# declares link. The programs of the pages and the examples print the same as in C.
# Usage: cxx.sh TOP BUILD CXX_COMPILER
set -u
top=$1 build=$2 compiler=$3
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
rc=0
fail() { echo "$*"; rc=1; }
case $compiler in
*NOTFOUND | '') fail "no C++ compiler: install one (on Debian: g++)"; exit 1 ;;
esac

# translate SOURCE NAME FLAG...: build the program $work/NAME.
translate() {
  source=$1 program=$work/$2
  shift 2
  "$compiler" -std=c++20 -Wall -Wextra -Wpedantic -Werror "$@" -I "$top/lib/include" -x c++ \
    "$source" -x none -o "$program" \
    -L "$build/lib" -ldvi -ldvi-scene -ldvi-study -lm -Wl,-rpath,"$build/lib"
}

for header in "$top"/lib/include/dvi/*.h; do
  name=$(basename "$header" .h)
  {
    echo "#include <${header#"$top/lib/include/"}>"
    echo "typedef void (*function)();"
    echo "static const function functions[] = {nullptr"
    awk -f "$top/tests/lint/declared.awk" "$header" | sed 's/.*/, reinterpret_cast<function>(\&&)/'
    echo "};"
    echo "const unsigned long count = sizeof functions / sizeof *functions;"
    echo "int main() { return functions[count - 1] == functions[0] && count > 1; }"
  } >"$work/$name.cc"
  translate "$work/$name.cc" "header_$name" -Wno-cast-function-type || {
    fail "$name.h: does not compile or link as C++20"
    continue
  }
  "$work/header_$name" || fail "$name.h: the program does not run"
done

# Members that a designated initialiser leaves out are 0, as the examples intend.
for example in "$top"/apps/examples/*.c; do
  name=$(basename "$example" .c)
  translate "$example" "$name" -Wno-missing-field-initializers || {
    fail "apps/examples/$name.c: no C++20 program"
    continue
  }
  "$work/$name" >"$work/$name.cxx" || fail "apps/examples/$name.c: fails as C++20"
  "$build/apps/$name" >"$work/$name.c11" || fail "apps/examples/$name.c: fails as C"
  cmp -s "$work/$name.cxx" "$work/$name.c11" || {
    fail "apps/examples/$name.c: prints something else as C++20"
    diff "$work/$name.cxx" "$work/$name.c11"
  }
done

# The programs of the README and of docs/shapes.md are examples, as lint/docs checks. The guide has
# a program of its own.
awk '$0 == "```c" { inside = 1; next } /^```$/ { inside = 0 } inside' "$top/docs/guide.md" \
  >"$work/guide.c"
if translate "$work/guide.c" guide -Wno-missing-field-initializers; then
  "$work/guide" >"$work/guide.out" || fail "docs/guide.md: its program fails as C++20"
else
  fail "docs/guide.md: no C++20 program"
fi
exit $rc
