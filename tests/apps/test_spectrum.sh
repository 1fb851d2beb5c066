#!/bin/sh
# dvi spectrum: lines of columns, bands, times, refusals.  Usage: test_spectrum.sh DVI
. "$(dirname "$0")/check.sh"

# near FILE ROW FIELD VALUE TOLERANCE: require a number of a CSV file, row 1 below the header.
near() {
  awk -F, -v row="$2" -v field="$3" -v value="$4" -v most="$5" '
    NR == row + 1 { found = 1; d = $field - value; wrong = d*d > most*most }
    END { exit !found || wrong }' "$1" || { fail "row $2, field $3 is $4"; cat "$1"; }
}

# Friction 0.2 at the frequency 1, driven at 2: sqrt(0.99) with the decay 0.1, and 2 without one.
# galerkin:degree=4 has an error below 1e-9.
expect 0 'a run' run damped-driven --method galerkin:degree=4 --h 0.1 --t-end 60 --out driven.csv
expect 0 'two columns' spectrum driven.csv --columns q,p_q --csv lines.csv
says out '^Spectrum of driven.csv: 601 samples from t = 0 to 60 of q, p_q$' 'the heading'
says out '^2 lines leave' 'the residual'
says lines.csv '^index,omega,decay,Q,amplitude,error,amplitude_q,phase_q,amplitude_p_q,phase_p_q$' \
  'the columns'
near lines.csv 1 2 0.99498743710662 1e-8
near lines.csv 1 3 0.1 1e-8
near lines.csv 1 4 4.9749371855331 1e-6
near lines.csv 2 2 2 1e-9
says out '^ *1  *0.99498[0-9]*  *0.1  *4.97494 ' 'a decay that is resolved'
says out '^ *2  *2  *0.330409 ' 'no decay of an undamped line, and no Q'
expect 0 'a band' spectrum driven.csv --columns q --band 1.5:3 --csv -
near out 1 2 2 1e-9
[ "$(wc -l <out)" -eq 2 ] || fail 'a band: one line'
says err '^1 line leaves' 'a table for people goes to the other stream'
expect 0 'half a band' spectrum driven.csv --columns q --band :1.5 --csv -
near out 1 2 0.99498743710662 1e-8
expect 0 'the strongest line' spectrum driven.csv --columns q --count 1 --csv -
near out 1 2 0.99498743710662 1e-8
says err '; the strongest are shown$' 'that there are more lines'
expect 0 'from a time on' spectrum driven.csv --columns q --from 30 --csv later.csv
says out 'from t = 30 to 60' 'the time'
near later.csv 2 2 2 1e-9
"$dvi" spectrum - --columns q --csv - <driven.csv >out 2>err || fail 'standard input'
near out 2 2 2 1e-9
expect 0 'all columns' spectrum driven.csv
says out 'of q, p_q, energy, energy_balance$' 'all columns but t'

# A run that ends between two rows.
expect 0 'a run' run damped-driven --method galerkin:degree=4 --h 0.1 --t-end 60.04 --out odd.csv
expect 0 'a row too many' spectrum odd.csv --columns q
says out '601 samples from t = 0 to 60 ' 'the last row is left out'

# The frequencies of a membrane are those of its modes, w = (2/h) asin(h omega/2). Lines as dense as
# here, 53 in a time of 40, have 9 digits.
cat >drum.yaml <<END
mesh: {generator: staggered, cells: [8, 8]}
field: wave
boundary: fixed
initial: {u: exp(-30*((x - 0.3)^2 + (y - 0.4)^2))}
probes: {ear: {at: [0.25, 0.3]}, eye: {at: [0.6, 0.7]}}
method: verlet
step: 0.02
until: 40
END
expect 0 'a drum' run drum.yaml --every 2 --out drum.csv
expect 0 'its spectrum' spectrum drum.csv --columns ear,eye --band 4:8 --csv -
cp out lines.csv
expect 0 'its modes' modes drum.yaml --count 3 --csv -
paste -d, lines.csv out | awk -F, '
  NR > 1 { x = 0.01*$NF; w = 100*atan2(x, sqrt(1 - x*x)); d = $2 - w; wrong += d*d > 1e-16 }
  END { exit wrong || NR != 4 }' || { fail 'lines are modes'; cat lines.csv out; }

expect 0 'help' spectrum --help
says out '--band LO:HI' 'the options'
expect 2 'no file' spectrum
expect 1 'nothing to read' spectrum nowhere.csv
expect 2 'no column' spectrum driven.csv --columns enrgy
says err "spectrum: 'driven.csv' has no column 'enrgy' (did you mean 'energy'?)" 'nearest column'
expect 2 'an empty name' spectrum driven.csv --columns q,
expect 2 'no band' spectrum driven.csv --band 3
says err 'two angular frequencies' 'what a band is'
expect 2 'an inverted band' spectrum driven.csv --band 3:2
expect 2 'a band beyond the samples' spectrum driven.csv --band 3:90
says err '0.1 apart tell frequencies from 0 to 31.4159' 'the highest frequency'
expect 2 'a tolerance' spectrum driven.csv --tolerance 2
expect 2 'a late time' spectrum driven.csv --from 59.95
says err 'has 1 row from there on: too few' 'how many rows are left'
sed 5d driven.csv >gap.csv
expect 2 'a gap' spectrum gap.csv --columns q
says err 'from t = 0 to 0.1, but from 0.2' 'where the gap is'
sed '7s/.*/0.5,,,,/' driven.csv >hole.csv
expect 2 'a hole' spectrum hole.csv --columns q
says err "line 7 has no number in column 'q'" 'where the hole is'
printf 'a,b\n1,2\n' >timeless.csv
expect 2 'no times' spectrum timeless.csv
says err "no column 't'" 'no times'
printf 't,a\n' >short.csv
for row in 0 1 2 3 4 5 6 7; do echo "$row,3"; done >>short.csv
expect 1 'a constant' spectrum short.csv
says err 'constant, 3' 'a constant'
: >empty.csv
expect 2 'an empty file' spectrum empty.csv
no_trace 'spectrum'
finish
