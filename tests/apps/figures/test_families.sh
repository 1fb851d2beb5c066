#!/bin/sh
# The table of families beside SUNDIALS' codes, for a few problems and short spans.
# Usage: test_families.sh DVI
top=$(cd "$(dirname "$0")/../../.." && pwd)
. "$(dirname "$0")/../check.sh"
families() { DVI=$dvi sh "$top/apps/examples/families.sh" --quick "$@" >out 2>err; }

families --csv rows.csv massless-particle kepler || { fail 'two problems'; cat err; }
header=problem,asked_error,family,method,milliseconds,answer
header=$header,peer,peer_milliseconds,peer_answer,ratio
[ "$(head -n 1 rows.csv)" = $header ] || fail 'the header'
[ "$(awk -F, 'NR > 1 { print $1, $3 }' rows.csv | sort | uniq -c | tr -s ' ' | tr '\n' ';')" = \
  ' 2 kepler composition; 2 kepler galerkin; 2 massless-particle dg; 2 massless-particle dvrk;'\
' 2 massless-particle vprk;' ] || { fail 'each family at both errors'; cat rows.csv; }
# Commas within quotes are part of a method.
sed 's/"[^"]*"/method/' rows.csv | awk -F, '
  NR > 1 { ratio = $8 / $5 }
  NR > 1 && !(NF == 10 && $5 > 0 && $8 > 0 && $6 ~ /^(interpolated|at most)$/ &&
    $7 ~ /^(cvode-adams|arkode|ida)$/ && $10 > 0.99 * ratio - 0.01 && $10 < 1.01 * ratio + 0.01)' |
  grep -q . && { fail 'times, peers and ratios'; cat rows.csv; }
grep -q '"dg:stiffness=1,degree=[345]"' rows.csv || fail 'a method with a comma'
awk -F, 'NR > 1 { rows++; fast += $NF >= 1; twice += $NF >= 2 }
  END { printf "at least as fast: %d of %d; twice as fast: %d of %d\n", fast, rows, twice, rows }' \
  rows.csv >count
grep -q -x -F "$(cat count)" out || { fail 'the count'; cat out; }
[ "$(grep -c '^kepler  *0.00' out)" -eq 4 ] || fail 'rows of the table'
says out '^SUNDIALS [0-9.]* from /' 'the build of SUNDIALS'
code=0
families --csv none.csv keppler || code=$?
[ $code -eq 2 ] || fail 'a problem that it does not have'
says err 'no such problem: keppler' 'which problem'
[ ! -e none.csv ] || fail 'a refused run wrote'
no_trace 'families'
finish
