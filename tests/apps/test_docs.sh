#!/bin/sh
# The commands in the pages run, and print the words that the pages show. Numbers are not compared,
# because last digits and times differ.
# Usage: test_docs.sh DVI With DVI_TEST_FEWER, where memory is watched, some commands are left out:
# those that measure times, those that take 20 000 steps or more, and those that repeat runs in a
# loop of the shell.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/check.sh"
top=$here/../..
PATH=$(dirname "$dvi"):$PATH
export PATH

# split PAGE: write the commands of its console fences to command.N, and the output shown below each
# to shown.N. Write a scene that begins with "# NAME.yaml: " to that file.
split() {
  rm -f command.* shown.*
  awk '$0 == "```yaml" { scene = 1; next }
       /^```$/ { scene = 0 }
       scene == 1 {
         scene = 0
         if ($2 ~ /^[a-z-]+\.yaml:$/) {
           scene = 2
           file = substr($2, 1, length($2) - 1)
           printf "" > file
         }
       }
       scene == 2 { print > file }
       $0 == "```console" { inside = 1; next }
       /^```$/ { inside = 0 }
       inside && /^\$ / {
         n++
         print substr($0, 3) > ("command." n)
         printf "" > ("shown." n)
         next
       }
       inside { print > ("shown." n) }' "$1"
}

# Processor, compiler and the build of SUNDIALS are those of the machine; the clock decides which
# settings lie on a frontier.
words() {
  sed -e 's/^\(processor\): .*/\1/; s/^\(compiler\): .*/\1/; s/^\(SUNDIALS\) .*/\1/' \
    -e '/^its sum of vectors takes/d' \
    -e 's/  at most  /  interpolated  /' \
    -e 's/-\{0,1\}[0-9][0-9.]*\(e[-+]\{0,1\}[0-9][0-9]*\)\{0,1\}/N/g; s/  */ /g; s/ $//' "$1"
}

# Prints the words in a picture: titles and labels.
words_in() { sed -n 's/.*<tspan[^>]*>\(.*\)<\/tspan>.*/\1/p' "$1" >texts; words texts | sort -u; }

# pictures PAGE: require that its commands drew the pictures that it shows, with the same words. A
# picture must be small.
pictures() {
  for picture in $(grep -o '](\(\.\./\)*pictures/[a-z-]*\.svg)' "$top/$1" |
    sed 's/.*\(pictures.*\))/\1/'); do
    drawn=$(basename "$picture") kept=$top/docs/$picture
    [ -s "$drawn" ] || { fail "$1: no command draws $drawn"; continue; }
    words_in "$drawn" >drawn.words
    words_in "$kept" >kept.words
    cmp -s drawn.words kept.words || {
      fail "$1: $picture is not what its command draws"
      diff kept.words drawn.words | sed 's/^/    /'
    }
    [ "$(wc -c <"$kept")" -le 60000 ] || fail "$picture is larger than 60 kB"
  done
}

# left_out FILE: tell whether a short run leaves out this command, or the one whose table it reads.
left_out() {
  [ -n "${DVI_TEST_FEWER:-}" ] || return 1
  grep -q '^dvi bench\|^dvi resonance\|^for \|--every [0-9]\{5\}\|--t-end [0-9]\{5\}' "$1" &&
    return 0
  table=$(sed -n 's/^awk .* \([a-z-]*\.csv\)$/\1/p' "$1")
  [ -n "$table" ] && [ ! -e "$table" ]
}

# replay N: run command N of the page and compare its words.
replay() {
  sh "command.$1" >printed 2>&1
  words printed >printed.words
  words "shown.$1" >shown.words
  cmp -s printed.words shown.words || {
    fail "$page: $(cat "command.$1")"
    diff shown.words printed.words | sed 's/^/    /'
  }
}

# A short run leaves out the pages on machines.
machines="docs/control.md docs/sensitivities.md
  $(cd "$top" && find docs/mechanics -name '*.md' | sort)"
[ -z "${DVI_TEST_FEWER:-}" ] || machines=

commands=0
for page in README.md docs/tutorial.md docs/command.md docs/limits.md docs/guide.md \
  docs/theory.md docs/problems.md \
  docs/trust.md docs/adaptive.md docs/oscillations.md docs/shooting-studies.md docs/paths.md \
  docs/scenes.md $machines docs/cookbook.md docs/scene-errors.md \
  $(cd "$top" && find docs/methods docs/fields docs/tools -name '*.md' | sort); do
  split "$top/$page"
  n=1
  whole=1
  while [ -e command.$n ]; do
    commands=$((commands + 1))
    if left_out command.$n; then whole=0; else replay "$n"; fi
    n=$((n + 1))
  done
  [ $whole -eq 0 ] || pictures "$page"
done
[ "$commands" -ge 20 ] || fail "only $commands commands were found in the pages"
finish
