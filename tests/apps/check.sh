# The tests of the command source this file. It counts the assertions that fail. The first argument
# of a test is the dvi binary.
dvi=$1
failures=0
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

# some WORD...: print all words, or every third where DVI_TEST_FEWER is set because memory is
# watched. The words are examples of one kind.
some() {
  [ -n "${DVI_TEST_FEWER:-}" ] || { echo "$@"; return; }
  echo "$@" | tr ' ' '\n' | awk 'NR % 3 == 1' | tr '\n' ' '
}

# expect CODE NAME ARGUMENTS...: run dvi, which must end with this exit code. Its output goes to the
# files out and err.
expect() {
  wanted=$1 name=$2
  shift 2
  code=0
  "$dvi" "$@" >out 2>err || code=$?
  [ "$code" -eq "$wanted" ] || {
    fail "$name: exit code $code instead of $wanted: dvi $*"
    sed 's/^/    /' err
  }
}

# says FILE PATTERN NAME: require a line of the file that matches.
says() {
  grep -q -e "$2" "$1" || { fail "$3: no line with '$2' in $1:"; sed 's/^/    /' "$1" | head -n 5; }
}

# about FILE COLUMN VALUE TOLERANCE: require the number in the last row of a CSV file.
about() {
  awk -F, -v name="$2" -v value="$3" -v tolerance="$4" '
    NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
    { last = $column }
    END { d = last - value; exit !(column && d <= tolerance && d >= -tolerance) }' "$1" ||
    { fail "$2 is $3"; tail -n 1 "$1"; }
}

# refused SCENE NAME EDIT WORDS PLACE: require that an edited scene is refused at a place.
refused() {
  sed "$3" "$1" >"$2.yaml"
  expect 2 "$2" run "$2.yaml"
  says err "^dvi: $2.yaml:$5: " "the place of $2"
  says err "$4" "the reason of $2"
}

# same FILE FILE NAME: require two files with the same bytes.
same() { cmp -s "$1" "$2" || fail "$3: $1 and $2 differ"; }

# no_trace NAME: require that no temporary file was left behind.
no_trace() { for left in *.part-*; do [ ! -e "$left" ] || fail "$1: $left was left behind"; done; }

# part_of FILE: succeed if the temporary file of FILE exists.
part_of() { ls "$1".part-* >/dev/null 2>&1; }

# wait_for_part FILE: wait some seconds at most until the temporary file of FILE exists.
wait_for_part() {
  for _ in $(seq 100); do
    part_of "$1" && return
    sleep 0.1
  done
  fail "no temporary file of $1"
}

# ends CODE NAME: require that the background process ends with this exit code.
ends() {
  code=0
  wait $! || code=$?
  [ "$code" -eq "$1" ] || fail "$2: exit code $code instead of $1"
}

finish() { [ "$failures" -eq 0 ] && echo "all hold" || exit 1; }
