# Sourced by the tests of the command: counts what does not hold.  $1 of the test is the dvi binary.
dvi=$1
# On Debian 13 UCX, which comes along with SUNDIALS, takes SIGHUP for its own debugging; this leaves the signal to the tests.
export UCX_DEBUG_SIGNO=0
failures=0
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

# some WORD...: all of them. Where memory is watched, and DVI_TEST_FEWER is set, every third: these are more examples of one kind.
some() {
  [ -n "${DVI_TEST_FEWER:-}" ] || { echo "$@"; return; }
  echo "$@" | tr ' ' '\n' | awk 'NR % 3 == 1' | tr '\n' ' '
}

# expect CODE NAME ARGUMENTS...: run dvi; its output stands in files out and err.
expect() {
  wanted=$1 name=$2
  shift 2
  code=0
  "$dvi" "$@" >out 2>err || code=$?
  [ "$code" -eq "$wanted" ] || { fail "$name: exit code $code instead of $wanted: dvi $*"; sed 's/^/    /' err; }
}

# says FILE PATTERN NAME: the file has a line that matches.
says() { grep -q -e "$2" "$1" || { fail "$3: no line with '$2' in $1:"; sed 's/^/    /' "$1" | head -n 5; }; }

# same FILE FILE NAME
same() { cmp -s "$1" "$2" || fail "$3: $1 and $2 differ"; }

# no_trace NAME: no temporary file was left behind.
no_trace() { for left in *.part-*; do [ ! -e "$left" ] || fail "$1: $left was left behind"; done; }

# part_of FILE: its temporary file is there.
part_of() { ls "$1".part-* >/dev/null 2>&1; }

# wait_for_part FILE: until its temporary file is there, some seconds at most.
wait_for_part() {
  for _ in $(seq 100); do
    part_of "$1" && return
    sleep 0.1
  done
  fail "no temporary file of $1"
}

# ends CODE NAME: the background process ends with that exit code.
ends() {
  code=0
  wait $! || code=$?
  [ "$code" -eq "$1" ] || fail "$2: exit code $code instead of $1"
}

finish() { [ "$failures" -eq 0 ] && echo "all hold" || exit 1; }
