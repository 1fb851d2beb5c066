#!/bin/sh
# Every public header compiles alone, without a warning.
# Usage: headers.sh INCLUDE_DIRECTORY LANGUAGE COMPILER FLAG...
set -u
include=$1 language=$2 compiler=$3
shift 3
rc=0
for header in "$include"/dvi/*.h; do
  [ -e "$header" ] || continue
  echo "#include <${header#"$include"/}>" |
    "$compiler" "$@" -x "$language" -I "$include" -Wall -Wextra -Wpedantic -Werror \
      -fsyntax-only - || rc=1
done
exit $rc
