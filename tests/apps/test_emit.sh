#!/bin/sh
# dvi emit-c: the C file compiles without a warning, and its run is the scene's, digit for digit.  Usage: test_emit.sh DVI
top=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/check.sh"
libraries=$(cd "$(dirname "$dvi")/../lib" && pwd)
expect 0 'a scene' init swinging-cart.yaml

expect 0 'a C file' emit-c swinging-cart.yaml --set l=0.7 --out cart.c
says cart.c '^dvi_status swinging_cart_create(dvi_system \*\*system)' 'the name'
expect 0 'standard output' emit-c swinging-cart.yaml --set l=0.7 --out -
same out cart.c 'standard output has what the file has'
expect 0 'a name' emit-c swinging-cart.yaml --name other --out other.c
says other.c '^const double other_q\[2\]' 'the start'

cat >main.c <<'END'
#include <dvi/dvi.h>
#include <stdio.h>
dvi_status swinging_cart_create(dvi_system **system);
extern const double swinging_cart_q[2], swinging_cart_p[2];
int main(void)
{
  dvi_system *system;
  dvi_integrator *integrator;
  if (swinging_cart_create(&system) != DVI_OK || dvi_integrator_create(system, "galerkin:degree=2", &integrator) != DVI_OK) return 1;
  if (dvi_integrator_start(integrator, 0, swinging_cart_q, swinging_cart_p) != DVI_OK) return 1;
  for (int i = 0; i < 1000; i++)
    if (dvi_integrator_step(integrator, 0.02) != DVI_OK) return 1;
  for (int i = 0; i < 2; i++) printf("%.17g,", dvi_integrator_q(integrator)[i]);
  for (int i = 0; i < 2; i++) printf("%.17g%s", dvi_integrator_p(integrator)[i], i == 0 ? "," : "\n");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return 0;
}
END
# A program without a sanitizer does not run with a library that has one.
compiler=${CC:-cc}
# gcc 12 takes a table of pointers for uninitialised where the function that gets it, a constant, does not look at it.
warnings='-Wall -Wextra -Wpedantic -Werror -Wno-maybe-uninitialized'
if command -v "$compiler" >/dev/null; then
  # shellcheck disable=SC2086
  "$compiler" -std=c11 -O2 $warnings -I"$top/lib/include" -c cart.c || fail 'it does not compile'
  if ! grep -q '__[at]san_init\|__ubsan_handle' "$libraries/libdvi.so"; then
    "$compiler" -std=c11 -I"$top/lib/include" main.c cart.o -o cart "$libraries/libdvi.so" -lm && LD_LIBRARY_PATH=$libraries ./cart >compiled || fail 'it does not run'
    expect 0 'the scene' run swinging-cart.yaml --set l=0.7 --final
    [ "$(cat compiled)" = "$(sed -n 2p out | cut -d, -f2-5)" ] || fail "its run is another one: $(cat compiled) and $(sed -n 2p out)"
  fi
fi

# What is refused, and what was there stays.
echo mine >kept.c
expect 2 'no C name' emit-c swinging-cart.yaml --name 1st --out kept.c
says err 'no name in C' 'the reason'
expect 2 'an unknown parameter' emit-c swinging-cart.yaml --set ll=1 --out kept.c
expect 2 'a problem of the catalogue' emit-c kepler --out kept.c
expect 1 'no scene' emit-c none.yaml --out kept.c
[ "$(cat kept.c)" = mine ] || fail 'the file was overwritten'
expect 2 'over the scene' emit-c swinging-cart.yaml --out ./swinging-cart.yaml
expect 2 'no file' emit-c swinging-cart.yaml
no_trace 'emit-c'
finish
