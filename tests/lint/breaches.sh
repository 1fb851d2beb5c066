#!/bin/sh
# A gate that cannot fail is no gate: each gate must see every breach planted here, and must pass
# the clean tree before it.
# Usage: breaches.sh LINT_FOLDER C_COMPILER
set -u
lint=$1 compiler=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
rc=0

clean() {
  rm -rf "${work:?}"/* "$work/.ci"
  cd "$work" || exit 1
  for room in core num group space system solve step/element method/element diagnostics reference \
    text expr scene scene/sections; do
    mkdir -p lib/src/$room
  done
  mkdir -p lib/include/dvi apps/cli apps/problems apps/examples tests/method/element docs/methods
  mkdir -p docs/fields cmake .ci lib/petsc/src
  printf '/** One. */\nint dvi_one(int a);\n' >lib/include/dvi/one.h
  printf '#include <dvi/one.h>\n\nint dvi_one(int a)\n{\n  return a;\n}\n' >lib/src/core/one.c
  printf '#include <dvi/one.h>\n' >lib/src/method/element/leap.c
  printf '/* .cite = "Euler1744" */\n' >>lib/src/method/element/leap.c
  printf '#include <dvi/one.h>\n' >apps/main.c
  touch tests/method/element/test_leap.c docs/methods/leap.md CMakeLists.txt
  echo '| [leap](leap.md) | all | 2 | yes | yes | 1 |' >docs/methods/README.md
  printf '@book{Euler1744,\n}\n' >docs/references.bib
  printf 'int main(void)\n{\n  return 0;\n}\n' >apps/examples/pendulum.c
  {
    echo '# One'
    echo '```c'
    cat apps/examples/pendulum.c
    echo '```'
    echo 'See [the guide](docs/guide.md#two-words), Euler1744.'
  } >README.md
  for program in shapes:shapes fields/waves:drum fields/forms:hole fields/maxwell:cavity \
    fields/multiscale:rapid_rod fields/moving:kink fields/multisymplectic:breather \
    fields/schroedinger:tunnel fields/densities:collision; do
    example=apps/examples/${program#*:}.c
    cp apps/examples/pendulum.c "$example"
    { echo '# A page'; echo '```c'; cat "$example"; echo '```'; } >"docs/${program%:*}.md"
  done
  printf 'int told = refuse("there is no \047%%s\047\\n", "a name"); /* "not this" */\n' \
    >lib/src/scene/one.c
  printf '# Errors\n\n- `there is no \047<name>\047`\n  A slip.\n  - `a name`\n  - `a step`\n' \
    >docs/scene-errors.md
  printf 'SECTION(step, REQUIRED, "a step", "how far")\n' >lib/src/scene/sections/sections.def
  printf '| section | what it holds | needed |\n|---|---|---|\n| `step` | how far | yes |\n' \
    >docs/scenes.md
  printf '# Two words\n```c\n#include <dvi/one.h>\nint two(void);\n```\n' >docs/guide.md
  printf '<!-- rooms: begin -->\n<!-- rooms: end -->\n' >docs/CONTRIBUTING.md
  sh "$lint/rooms.sh" --update "$work"
}

# The gates, called by name.
# shellcheck disable=SC2317
layers() { sh "$lint/sources.sh" "$work" "$lint/layers.awk" leap; }
rooms() { sh "$lint/rooms.sh" "$work"; }
text() { sh "$lint/text.sh" "$work"; }
documented() { awk -f "$lint/documented.awk" lib/include/dvi/*.h; }
docs() { sh "$lint/docs.sh" "$work" "$compiler"; }
methods() { sh "$lint/methods.sh" "$work" leap; }
messages() { sh "$lint/messages.sh" "$work"; }
sections() { sh "$lint/sections.sh" "$work"; }
markdown() { sh "$lint/markdown.sh" "$work"; }
headers() { sh "$lint/headers.sh" "$work/lib/include" c "$compiler" -std=c11; }
symbols() {
  echo 'DVI_1 { global: dvi_*; stray; local: *; };' >one.map
  "$compiler" -shared -fPIC -I lib/include lib/src/core/*.c -Wl,--version-script=one.map \
    -o libone.so && "$compiler" -c -I lib/include lib/src/core/one.c -o one.o &&
    rm -f libone.a && ar rc libone.a one.o &&
    sh "$lint/symbols.sh" libone.so libone.a lib/include/dvi/*.h
}

passes() { "$1" >log 2>&1 || { echo "$1: the clean tree does not pass"; cat log; rc=1; }; }

# sees GATE FILE TEXT: with TEXT appended to FILE of the clean tree, GATE fails.
sees() {
  clean
  printf '%b\n' "$3" >>"$2"
  if "$1" >log 2>&1; then echo "$1 does not see: $3 in $2"; rc=1; fi
}

clean
for gate in layers rooms text documented methods messages sections docs headers symbols; do
  passes $gate
done

sees layers lib/src/core/one.c '#include "num/linear.h"'
sees layers lib/src/core/one.c '#include <mpi.h>'
sees layers apps/cli/one.c '#include <dvi/petsc.h>'
sees layers lib/petsc/src/one.c '#include "field/mesh/mesh.h"'
sees layers lib/src/num/one.c '#include "system/system.h"'
sees layers lib/src/solve/one.c '#include "system/system.h"'
sees layers lib/src/solve/one.c '#include "step/element/action.h"'
sees layers lib/src/method/element/two.c '#include "method/element/leap.h"'
sees layers lib/src/reference/one.c '#include "solve/nonlinear.h"'
sees layers lib/src/step/element/one.c '#include "step/split/modes.h"'
sees layers lib/src/method/element/one.c '#include "integrator/event.h"'
sees layers lib/src/diagnostics/one.c '#include "method/method.h"'
sees layers lib/src/core/one.c '#include "local.h"'
sees layers lib/src/method/element/leap.c '#include <kinsol/kinsol.h>'
sees layers lib/src/solve/one.c '#include <klu.h>'
sees layers lib/src/num/one.c '#include <sundials/sundials_types.h>'
sees layers lib/src/num/one.c 'printf("x");'
sees layers lib/src/num/one.c 'x = malloc(3);'
sees layers lib/src/scene/one.c 'x = malloc(3);'
sees layers lib/src/num/one.c 'WIDE static void add(int n)\n{\n}\nFUSED static int *add(int n)'
sees layers lib/src/expr/one.c '#include "scene/text/tree.h"'
sees layers lib/src/text/one.c '#include "expr/graph.h"'
sees layers lib/src/num/one.c 'free(x);'
sees layers lib/src/num/one.c 'x = strtod(text, NULL);'
sees layers apps/main.c 'x = atof(text);'
sees layers apps/main.c 'x = setlocale(LC_ALL, "");'
sees layers lib/src/scene/one.c 'x = vsnprintf(text, 3, format, arguments);'
sees layers lib/include/dvi/one.h '#include <stdio.h>'
sees layers lib/include/dvi/one.h '#include "core/status.h"'
sees layers lib/include/dvi/one.h 'int dvi__two(int a);'
sees layers apps/main.c '#include "core/status.h"'
sees layers apps/examples/one.c '#include <kinsol/kinsol.h>'
sees layers apps/cli/one.c '#include "plot/plot.h"'
sees layers apps/problems/one.c 'dvi__release(x);'
sees rooms lib/src/num/one.c '#include "core/one.h"'
sees text lib/src/core/one.c 'int\ta;'
sees text lib/src/core/one.c 'int a; '
sees text lib/src/core/one.c '/* TO''DO: finish */'
sees text lib/src/core/one.c '/* caf\0303\0251 */'
sees text lib/src/core/long.c \
  "int f(void)\n{\n$(awk 'BEGIN { for (i = 0; i < 60; i++) printf "  g();\\n" }')}"
sees text lib/src/core/long.c "$(awk 'BEGIN { for (i = 0; i < 601; i++) printf "int a%d;\\n", i }')"
long=$(printf '# %0100d' 0)
for file in tests/one.sh tests/one.awk cmake/one.cmake CMakeLists.txt apps/CMakeLists.txt \
  .ci/run; do
  sees text $file "$long"
done
sees documented lib/include/dvi/one.h '\nint dvi_two(int a);'
sees documented lib/include/dvi/one.h '\ntypedef struct dvi_two { int a; } dvi_two;'
sees methods docs/methods/other.md 'a page without a method'
sees messages lib/src/scene/one.c 'int two = refuse("there are %d of them");'
sees messages docs/scene-errors.md '- `there is no <name>`'
sees messages docs/scene-errors.md '- `a name`'
sees messages lib/src/scene/sections/sections.def 'REFUSED_SECTION(dash, "no dashes")'
sees sections lib/src/scene/sections/sections.def \
  'SECTION(dash, OPTIONAL, NULL, "a "\n        "dash")'
sees sections docs/scenes.md '| `dash` | a dash | |'
sees docs README.md '[nowhere](docs/nowhere.md)'
sees docs README.md '[no heading](docs/guide.md#three-words)'
sees docs README.md 'Nobody1900 says so.'
sees docs apps/examples/pendulum.c 'int other;'
sees docs docs/shapes.md '```c\nint other;\n```'
sees docs docs/guide.md '```c\nint unfinished\n```'
sees headers lib/include/dvi/one.h 'size_t dvi_size(void);'
sees symbols lib/src/core/one.c 'int dvi_two;'
sees symbols lib/src/core/one.c 'int stray;'
sees symbols lib/include/dvi/one.h 'int dvi_promised(int a);'

# A line of 101 columns is seen in prose, in a formula, in C, in YAML and in commands. It is allowed
# in a table, in output, and for a single link.
clean
passes markdown
long=$(awk 'BEGIN { while (i++ < 50) printf "a "; print "b" }')
for text in "$long" "    $long" "- $long" '```c\n'"$long"'\n```' '```yaml\n'"$long"'\n```' \
  '```sh\n'"$long"'\n```' '```console\na\n```\n'"$long"; do
  for page in README.md docs/methods/leap.md; do sees markdown $page "$text"; done
done
for text in "| $long |" '```console\n'"$long"'\n```' "- [$long](docs/guide.md)."; do
  clean
  printf '%b\n' "$text" >>README.md
  passes markdown
done

for file in lib/src/method/element/leap.c tests/method/element/test_leap.c docs/methods/leap.md \
  docs/methods/README.md docs/references.bib; do
  clean
  rm $file
  if methods >log 2>&1; then echo "methods does not see that $file is missing"; rc=1; fi
done
clean
echo '| [leap](leap.md) | all | 2 | yes | yes | |' >docs/methods/README.md
if methods >log 2>&1; then echo "methods does not see an empty cell of the table"; rc=1; fi

# refuses GATE WORDS: GATE fails, and says WORDS.
refuses() {
  if "$1" >log 2>&1 || ! grep -q "$2" log; then echo "$1 does not say: $2"; rc=1; fi
}

clean
echo '#include "num/one.h"' >>lib/src/core/one.c
refuses rooms 'sh tests/lint/rooms.sh --update'
echo '#include "core/one.h"' >lib/src/num/one.c
refuses rooms 'in a circle: core -> num -> core'
clean
for i in $(seq 31); do touch "lib/src/core/file_$i.c"; done
refuses rooms 'lib/src/core has 32 files'

# The metadata of this tree, with one file that is out of step.
metadata_of_this_tree() {
  clean
  for part in CITATION.cff REUSE.toml LICENSE LICENSES debian packaging; do
    cp -R "$lint/../../$part" .
  done
  cp "$lint/../../lib/include/dvi/version.h" lib/include/dvi
}
metadata_of_this_tree
sh "$lint/metadata.sh" . || { echo 'metadata does not pass this tree'; rc=1; }
for file in CITATION.cff REUSE.toml LICENSES/BSD-3-Clause.txt debian/changelog \
  packaging/spack/libdvi/package.py packaging/spack/py_dvi/package.py \
  packaging/conda/libdvi/meta.yaml packaging/conda/python/meta.yaml; do
  metadata_of_this_tree
  sed 's/0\.1\.0/9.9.9/; s/BSD/MIT/' "$lint/../../$file" >$file
  if sh "$lint/metadata.sh" . >log 2>&1; then echo "metadata does not see $file"; rc=1; fi
done
exit $rc
