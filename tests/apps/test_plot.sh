#!/bin/sh
# dvi plot: columns of a CSV file as curves.  Usage: test_plot.sh DVI
. "$(dirname "$0")/check.sh"

expect 0 'a run' run kepler --method galerkin:degree=2 --h 0.1 --t-end 12 --out orbit.csv

curves() { grep -c 'id="gnuplot_plot_' "$1"; }

expect 0 'an orbit' plot orbit.csv --axes x:y --equal --out orbit.svg
[ "$(curves orbit.svg)" -eq 1 ] || fail 'an orbit: one curve'
says orbit.svg '>orbit.csv<' 'an orbit'
expect 0 'two panels' plot orbit.csv --axes x,y --axes x:energy --title Kepler --out panels.svg
[ "$(curves panels.svg)" -eq 3 ] || fail 'two panels: three curves'
says panels.svg '>Kepler<' 'two panels'
says panels.svg '>energy<' 'two panels'
[ ! -s err ] || fail 'two panels: gnuplot is not silent'
"$dvi" plot - --axes x:y --dots --out dots.svg <orbit.csv || fail 'standard input'
[ "$(wc -c <dots.svg)" -gt "$(wc -c <orbit.svg)" ] || fail 'dots: one for each row'

# Words in cells, gaps, a curve that stays at one number, and no final newline.
printf 'name,t,a,b\nup,0,1,2\ndown,1,1,\nup,2,1,4' >cells.csv
expect 2 'no SVG' plot cells.csv --axes a --out cells.png
says err '^dvi: plot: --out cells.png: plots are SVG files' 'the option that was given'
expect 0 'cells' plot cells.csv --axes a --axes b --out cells.svg
[ ! -s err ] || fail 'cells: gnuplot is not silent'
expect 0 'logarithms' plot cells.csv --axes a:b --log --out log.svg

expect 2 'no axes' plot orbit.csv --out x.svg
says err '\-\-axes X:Y is missing' 'no axes'
expect 2 'no file' plot orbit.csv --axes x:y
says err '\-\-out FILE.svg is missing' 'no file'
expect 2 'no column' plot orbit.csv --axes x:z --out x.svg
says err "no column 'z'; it has t,x,y" 'no column'
expect 2 'nearest column' plot orbit.csv --axes t:enrgy --out x.svg
says err "no column 'enrgy' (did you mean 'energy'?)" 'nearest column'
expect 2 'half a pair' plot orbit.csv --axes x: --out x.svg
says err 'wants columns' 'half a pair'
expect 2 'no SVG' plot orbit.csv --axes x:y --out x.png
expect 1 'nothing to read' plot nowhere.csv --axes x:y --out x.svg
: >empty.csv
expect 2 'an empty file' plot empty.csv --axes x:y --out x.svg
says err 'is empty' 'an empty file'
printf '\0\0t,a\n1,2\n' >nul.csv
expect 2 'a file that is no text' plot nul.csv --axes a --out x.svg
[ ! -e x.svg ] || fail 'a picture without a reason'
no_trace 'plot'
finish
