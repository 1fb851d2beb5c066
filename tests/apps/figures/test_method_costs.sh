#!/bin/sh
# The table of docs/methods/README.md counts the evaluations of a step as `dvi bench` does, and
# calls those methods symmetric that say so themselves.  Usage: test_method_costs.sh DVI
top=$(cd "$(dirname "$0")/../../.." && pwd)
. "$(dirname "$0")/../check.sh"
page=$top/docs/methods/README.md

# A line for each row with a measured cost: system, method, evaluations, whether it is symmetric.
awk -F ' [|] ' '/^[|] \[`/ && $6 ~ /^[0-9.]+, [0-9.]+: .*[a-z] [|]$/ {
  method = $1
  gsub(/^[|] \[`|[:`].*/, "", method)
  keys = $6 ~ /`/ ? $6 : ""
  gsub(/^[^`]*`|`[^`]*$/, "", keys)
  words = split($6, word, /[ |]+/)
  print word[words - 1], method (keys == "" ? "" : ":" keys), $6, $5 ~ /^yes/
}' "$page" | sed 's/, [0-9.]*: .* / /' | sort >rows
[ "$(wc -l <rows)" -ge 30 ] || fail "only $(wc -l <rows) rows of the table name their measurement"

cd "$top" || exit 1
# The systems hold no blanks.
# shellcheck disable=SC2046
for system in $(some $(cut -d' ' -f1 "$folder/rows" | uniq)); do
  options=$(sed -n "s/^| $system | \`\(.*\)\` |\$/\1/p" "$page")
  [ -n "$options" ] || { fail "$page: no options for $system"; continue; }
  grep "^$system " "$folder/rows" >"$folder/expected"
  # Neither options nor methods hold blanks.
  # shellcheck disable=SC2046,SC2086
  "$dvi" bench $options $(awk '{ print "--method", $2 }' "$folder/expected") \
    --scale members=1,2 --rounds 1 --csv - >"$folder/csv" 2>"$folder/err" ||
    { fail "bench $options"; cat "$folder/err"; }
  awk -F, '$(NF-10) == 1 { printf $NF < 9.95 ? "%.1f\n" : "%.0f\n", $NF }' "$folder/csv" |
    paste -d' ' "$folder/expected" - >"$folder/found"
  while read -r _ method evaluations symmetric measured; do
    [ "$measured" = "$evaluations" ] ||
      fail "$method on $system: $measured evaluations a step, in the table $evaluations"
    # shellcheck disable=SC2086
    said=$("$dvi" explain ${options% --h*} --method "$method" | grep -c '^method: .*, symmetric$')
    [ "$said" = "$symmetric" ] || fail "$method: symmetric is $said, in the table $symmetric"
  done <"$folder/found"
done
finish
