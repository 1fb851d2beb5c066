#!/bin/sh
# Plots: names are text and never commands, and a picture is whole or not there.
# Usage: test_plot_safety.sh DVI
. "$(dirname "$0")/check.sh"

printf 't,a,b\n0,1,2\n1,3,5\n2,4,7\n' >cells.csv

# A picture escapes the characters that XML reserves, and shows a blank for a character that no line
# can hold.
as_xml() { printf '%s' "$1" | tr '\n\t\001' '   ' | sed 's/&/\&amp;/g; s/</\&lt;/g'; }
shows() { grep -qF "$(as_xml "$2")<" "$1" || fail "$3: the picture does not show $2"; }
unharmed() { [ ! -e run ] || fail "$1: a command was run"; rm -f run; }

# All characters that mean something to gnuplot, to shells or to printf. There is no comma, because
# names of columns have none.
# shellcheck disable=SC2016,SC1003
{
hostile='`touch run` $(touch run) "; system "touch run" # '\''; !touch run @run '\
'%s %g $HOME \042 \140 \ {/Bold x}_a^b ~a &amp; <svg> | < > * \'
expect 0 'a title' plot cells.csv --axes a --title "$hostile" --out title.svg
shows title.svg "$hostile" 'a title'
unharmed 'a title'
# Digits behind a character are none of its number.
for digit in 0 1 2 3 4 5 6 7 8 9; do
  text=$(printf '! " # $ %% & ( ) * + - . / : ; < = > ? @ [ \\ ] ^ _ { | } ~' |
    sed "s/ /$digit/g")$digit
  expect 0 "digits $digit" plot cells.csv --axes a --title "$text" --out digits.svg
  shows digits.svg "$text" "digits $digit"
done
broken=$(printf 'one`touch run`\n!touch run\n@run\ttwo\001three')
expect 0 'a title of lines' plot cells.csv --axes a --title "$broken" --out lines.svg
shows lines.svg "$broken" 'a title of lines'
unharmed 'a title of lines'

for text in '`touch run`' '"; system "touch run' "';!touch run;'" \
            "''';system('touch run')#" '@run' '{/Bold a}_x^y' '%s%n' '$HOME' '\' \
            '\140touch run\140' '|touch run' '<touch run' '*a?[b]' '#' 'a~b'; do
  printf 't,%s,b\n0,1,2\n1,2,5\n2,4,7\n' "$text" >named.csv
  expect 0 "column $text" plot named.csv --axes "$text,b" --out named.svg
  shows named.svg "$text" "column $text"
  expect 0 "column $text on an axis" plot named.csv --axes "$text:b" --out axis.svg
  shows axis.svg "$text" "column $text on an axis"
  file=$(printf '%s' "$text" | tr / _)
  cp named.csv "$file.csv" && rm -f "$file.svg"
  expect 0 "files $file" plot "./$file.csv" --axes b --out "./$file.svg"
  shows "./$file.svg" "$file.csv" "a file $file"
  expect 0 "a bare file $file" plot "$file.csv" --axes b --out "$file.svg"
  [ "$(find . -name '*.svg' -newer named.csv | wc -l)" -le 3 ] ||
    fail "a file $file: one picture, of its name"
  rm -f "$file.csv" "$file.svg"
  unharmed "name $text"
done

# The name of a scene, its coordinates and its method, which has a file's name here.
mkdir 'a`touch run`'
cat >scene.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2
initial: {x: 1}
method: verlet
step: 0.1
until: 2
END
cp scene.yaml 'a`touch run`/`touch run`.yaml'
expect 0 'a scene' run 'a`touch run`/`touch run`.yaml' --final --plot scene.svg
shows scene.svg '`touch run`' 'a scene'
unharmed 'a scene'
printf 'order 2\nc 0 2/3\na\na 2/3\nb 1/4 3/4\n' >'`touch run`'
expect 0 'a method' order oscillator --method 'shooting:tableau=`touch run`,quadrature=trapezoid' \
  --h 0.1 --levels 4 --t-end 2 --plot order.svg
shows order.svg 'tableau=`touch run`,quadrature=trapezoid' 'a method'
unharmed 'a method'

}
# Start-up files of gnuplot are programs, too.
echo 'system "touch run"' >.gnuplot
HOME=. GNUPLOT_LIB=. expect 0 'a start-up file' plot cells.csv --axes a --out started.svg
unharmed 'a start-up file'
rm .gnuplot

# Without the picture: exit code 1, a reason, and the old picture.
lost() {
  [ "$code" -eq 1 ] || fail "$1: exit code $code instead of 1"
  says err "$2" "$1: the reason"
  same old.svg kept.svg "$1: the old picture"
  no_trace "$1"
}
expect 0 'an old picture' plot cells.csv --axes a --out old.svg
cp old.svg kept.svg

code=0
PATH=/nowhere "$dvi" plot cells.csv --axes b --out old.svg >out 2>err || code=$?
lost 'without gnuplot' "no plot in 'old.svg': gnuplot cannot be started (No such file or directory)"
code=0
run_it() { "$dvi" run kepler --method verlet --t-end 5 --final --out rows.csv --plot old.svg; }
PATH=/nowhere run_it >out 2>err || code=$?
lost 'a run without gnuplot' 'install the package gnuplot-nox'
[ -s rows.csv ] || fail 'a run without gnuplot: the rows are there'
code=0
PATH=/nowhere "$dvi" order kepler --method verlet --levels 2 --plot old.svg >out 2>err || code=$?
lost 'an order study without gnuplot' 'install the package gnuplot-nox'

mkdir bad
for script in 'exit 3' 'echo "<svg>"; exit 1' 'kill -9 $$' ':'; do
  printf '#!/bin/sh\n%s\n' "$script" >bad/gnuplot
  chmod +x bad/gnuplot
  code=0
  PATH=$PWD/bad:$PATH "$dvi" plot cells.csv --axes b --out old.svg >out 2>err || code=$?
  lost "a gnuplot that does '$script'" "no plot in 'old.svg': gnuplot failed"
done

# A disk that is full, by a limit of 8 blocks of 512 bytes, and a device that takes nothing.
code=0
(trap '' XFSZ; ulimit -f 8; exec "$dvi" plot cells.csv --axes b --out old.svg) >out 2>err || code=$?
lost 'a full disk' "cannot write '.*old.svg': "
ln -s /dev/full full.svg
expect 1 'a full device' plot cells.csv --axes b --out full.svg
says err "cannot write '/dev/full': " 'a full device: the reason'
expect 1 'nothing to draw' plot cells.csv --axes t:b --log --out full.svg
finish
