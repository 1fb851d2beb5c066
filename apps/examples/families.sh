#!/bin/sh
# Every family of methods beside the best of SUNDIALS' CVODE (Adams), ARKODE and IDA, in
# milliseconds to an error of 1e-6 and of 1e-9. A family is represented by the fastest of a few
# degrees or orders. Spans are long, so that the creation of an integrator, 0.1 ms, does not count.
# Usage: sh apps/examples/families.sh [--quick] [--csv FILE] [PROBLEM...]
#   --quick    short spans, rough errors, one round
#   --csv      write the table to FILE (families.csv)
#   PROBLEM    only these problems
# DVI in the environment is the command (build/release/apps/dvi).
set -eu
dvi=${DVI:-build/release/apps/dvi}
quick='' file=families.csv
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=1 ;;
    --csv) file=${2:?families.sh: --csv needs a file}; shift ;;
    --*) echo "families.sh: unknown option $1" >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done

# PROBLEM | END | SETTINGS | FAMILIES AND METHODS
table() {
  cat <<'END'
oscillator | 1000 | | galerkin composition hamiltonian
pendulum | 200 | | galerkin composition hamiltonian hp sem shooting prolongation-collocation
kepler | 1256.637061435917 | | galerkin composition
henon-heiles | 200 | | galerkin composition hamiltonian
double-pendulum | 20 | | galerkin hamiltonian
driven-pendulum | 50 | | galerkin hamiltonian
damped-driven | 100 | | galerkin composition
magnetic-bottle | 100 | | galerkin composition
outer-solar | 500000 | | galerkin composition
fpu | 200 | | galerkin composition
toda | 100 | | galerkin composition
figure-eight | 100 | | galerkin composition
stiff-pendulum | 2 | | galerkin multiscale
oscillators | 10 | | galerkin composition imex trig
massless-particle | 100 | gauge=singular | vprk dvrk dg
lotka-volterra | 20 | gauge=singular | vprk dvrk dg
lotka-volterra-4d | 10 | | vprk
vortices | 10 | | vprk dg
tokamak | 200000 | | vprk
circle-dirac | 20 | | dg-phase
magnetic-pair | 20 | | dg-phase
elastica | 20 | | hamiltonian
free-body | 100 | | lie-galerkin composition euler-poincare
pendulum-3d | 10 | | lie-galerkin composition lie-rk
heavy-top | 1 | | lie-galerkin composition
kovalevskaya | 20 | | lie-galerkin composition
spherical-double-pendulum | 3 | | lie-galerkin sphere-galerkin
spherical-chain | 20 | | lie-galerkin composition sphere-galerkin
two-body | 20 | | lie-galerkin composition
satellite | 10 | | lie-galerkin
knife-edge | 20 | | nonholonomic
sleigh | 20 | | nonholonomic
rolling-disk | 50 | | nonholonomic
spherical-constrained | 20 | | galerkin:degree=4 galerkin:degree=6
slider-crank | 2 | | galerkin
andrews | 0.03 | | galerkin:degree=3 galerkin:degree=4 galerkin:degree=6
END
}

# members FAMILY: print --method for the methods of a family, or for one method.
members() {
  case $1 in
    galerkin) set -- galerkin:degree= 4 6 8 12 ;;
    composition) set -- composition:order= 6 8 ;;
    hamiltonian) set -- hamiltonian:degree= 4 6 8 ;;
    sem) set -- sem:degree= 4 6 ;;
    prolongation-collocation) set -- prolongation-collocation:derivatives= 6 8 ;;
    lie-rk) set -- lie-rk:scheme= munthe-kaas ;;
    imex | nonholonomic) set -- "composition:base=$1,order=" 6 8 ;;
    hp) set -- hp:degree= 4 6 8 ;;
    lie-galerkin | sphere-galerkin | euler-poincare) set -- "$1:degree=" 4 6 8 ;;
    vprk | dvrk) set -- "$1:nodes=" 4 5 6 ;;
    dg) set -- dg:stiffness=1,degree= 3 4 5 ;;
    dg-phase) set -- dg-phase:degree= 3 4 5 ;;
    shooting)
      set -- shooting:onestep= butcher6,quadrature=lobatto cooper-verner,quadrature=lobatto \
        taylor,stages=10,quadrature=gauss-hermite
      ;;
    multiscale) set -- multiscale:fast=0:1,omega=100,degree= 2 4 ;;
    trig) set -- trig:filter= hochbruck-lubich gautschi ;;
    *) set -- "$1" '' ;;
  esac
  start=$1
  shift
  for value; do printf ' --method %s%s' "$start" "$value"; done
}

# measure PROBLEM END SETTINGS FAMILIES: print the rows of dvi bench --at.
measure() {
  options="--t-end $2 --rounds 3 --at 1e-6,1e-9"
  [ -z "$quick" ] || options="--rounds 1 --at 1e-3,1e-4"
  for setting in $3; do options="$options --set $setting"; done
  for family in $4; do options="$options$(members "$family")"; done
  # The lists are meant to be split into words.
  # shellcheck disable=SC2086
  "$dvi" bench "$1" $options --against cvode,arkode,ida --at-csv - 2>"$folder/errors" || {
    cat "$folder/errors" >&2
    return 1
  }
}

# compare: from the rows of one problem, print those of families and the best peer as CSV. Methods
# hold commas, and are in quotes.
compare() {
  awk '
    function put(name, family,   key) {
      key = asked SUBSEP family
      if (answer == "not reached" || (key in best && best[key] <= seconds)) return
      best[key] = seconds
      method[key] = name
      bound[key] = answer
    }
    function cost(key) {
      return key in best ? sprintf("%.4g,%s", best[key], bound[key]) : ",not reached"
    }
    NR > 1 {
      quoted = split($0, part, "\"")
      name = part[2]
      if (quoted > 1) sub(/"[^"]*"/, "quoted")
      split($0, field, ",")
      if (quoted == 1) name = field[4]
      asked = field[1]; problem = field[2]; seconds = field[5] * 1000; answer = field[8]
      family = name
      sub(/:.*/, "", family)
      if (match(name, /base=[a-z]*/)) family = substr(name, RSTART + 5, RLENGTH - 5)
      if (family ~ /^(cvode|arkode|ida)/) family = "peer"
      else if (!((asked, family) in row)) {
        row[asked, family] = 1
        order[++rows] = asked SUBSEP family
      }
      put(name, family)
    }
    END {
      for (k = 1; k <= rows; k++) {
        split(order[k], of, SUBSEP)
        mine = order[k]; peer = of[1] SUBSEP "peer"
        ratio = mine in best && peer in best ? sprintf("%.2f", best[peer] / best[mine]) : ""
        printf "%s,%g,%s,\"%s\",%s,%s,%s,%s\n", problem, of[1], of[2], method[mine], cost(mine),
          method[peer], cost(peer), ratio
      }
    }'
}

# show: print the CSV as a table, and count. What does not reach an error loses, whatever its time.
show() {
  awk -F '"' '
    function cell(time, answer) {
      if (answer == "not reached") return answer
      return (answer == "at most" ? "<= " : "") time
    }
    NR == 1 {
      layout = "%-26s %-6s %-48s %12s  %-12s %12s %7s\n"
      printf layout, "problem", "error", "method", "milliseconds", "best peer", "milliseconds",
        "ratio"
    }
    NR > 1 {
      split($1, left, ",")
      split($3, right, ",")
      printf layout, left[1], left[2], $2 == "" ? left[3] : $2, cell(right[2], right[3]), right[4],
        cell(right[5], right[6]), right[7]
      rows++
      if (right[3] == "not reached") next
      alone = right[6] == "not reached"
      fast += alone || right[7] >= 1
      twice += alone || right[7] >= 2
    }
    END { printf "at least as fast: %d of %d; twice as fast: %d of %d\n", fast, rows, twice, rows }'
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
head=problem,asked_error,family,method,milliseconds,answer,peer,peer_milliseconds,peer_answer,ratio
echo "$head" >"$folder/rows"
table | sed 's/ *| */|/g' >"$folder/table"
wanted=" $* " failed=0
while IFS='|' read -r problem end settings families; do
  case $wanted in "  " | *" $problem "*) ;; *) continue ;; esac
  measure "$problem" "$end" "$settings" "$families" >"$folder/measured" || { failed=1; continue; }
  compare <"$folder/measured" >>"$folder/rows"
done <"$folder/table"
[ "$(wc -l <"$folder/rows")" -gt 1 ] || { echo "families.sh: no such problem: $*" >&2; exit 2; }
show <"$folder/rows"
sed -n '/^SUNDIALS/p' "$folder/errors" | tail -n 1
cp "$folder/rows" "$file"
exit $failed
