#!/bin/sh
# The manual pages and the completions that are made from --help have all options, and bash
# completes with them.
# Usage: test_completions.sh DVI
from_help=$(cd "$(dirname "$0")/../../../cmake" && pwd)/from_help.sh
. "$(dirname "$0")/../check.sh"

sh "$from_help" "$dvi" . || fail 'the files are made'
# Words of completions call dvi by this name.
ln -s "$dvi" dvi
cat >complete.bash <<'END'
. ./bash/dvi
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_dvi
printf '%s\n' "${COMPREPLY[@]}"
END

# completes WANTED NAME WORD...: require that the last word is completed to exactly these words.
completes() {
  wanted=$1 name=$2
  shift 2
  found=$(PATH=$PWD:$PATH bash complete.bash "$@" | sort | tr '\n' ' ')
  [ "$found" = "$wanted " ] || fail "$name: '$found' instead of '$wanted '"
}

rows() { awk -v title="$1:" '$0 == title { on = 1; next } !NF { on = 0 } on { print $1 }'; }

commands=$("$dvi" --help | rows Commands)
completes "$(echo "$commands --help --version" | tr ' ' '\n' | sort | tr '\n' ' ' | sed 's/ $//')" \
  'all commands' ./dvi ''
for command in $commands; do
  options=$("$dvi" "$command" --help | rows Options)
  [ -n "$options" ] || fail "$command: no options"
  completes "$(echo "$options" | sort | tr '\n' ' ' | sed 's/ $//')" "options of $command" \
    ./dvi "$command" --
  [ "$(sed -n 's/\\-/-/g; s/^\.B \(--[^ ]*\).*/\1/p' "man1/dvi-$command.1")" = "$options" ] ||
    fail "dvi-$command.1: other options"
  zsh_options=$(sed -n "/^  $command)/,/;;/s/^ *'\**\(--[^[]*\)\[.*/\1/p" zsh/_dvi)
  [ "$zsh_options" = "$options" ] || fail "zsh: other options of $command: $zsh_options"
done
touch scene.yaml other.txt
completes 'kepler' 'a problem' ./dvi run kep
completes 'scene.yaml' 'a scene' ./dvi run sce
completes 'verlet' 'a method' ./dvi run kepler --method verl
completes 'other.txt' 'a file' ./dvi run kepler --out oth
completes 'other.txt' 'rows of a run' ./dvi view oth
completes 'kepler' 'a problem to view' ./dvi view kep
completes 'other.txt' 'a page' ./dvi view kepler --out oth
completes 'scene.yaml' 'the scene of rows' ./dvi view rows.csv --scene sce
completes 'methods' 'a list' ./dvi list met

for line in '.SH SYNOPSIS' 'dvi plot FILE.csv|FILE.h5 --axes' '.SH EXAMPLES'; do
  sed 's/\\-/-/g' man1/dvi-plot.1 | grep -q -e "^$line" || fail "dvi-plot.1: no line '$line'"
done
if command -v zsh >/dev/null; then zsh -n zsh/_dvi || fail 'zsh reads its completions'; fi
finish
