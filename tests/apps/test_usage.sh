#!/bin/sh
# Wrong command lines end with 2 and a message that helps; help and lists end with 0.
# Usage: test_usage.sh DVI
. "$(dirname "$0")/check.sh"

expect 2 'no command'
expect 0 'help' --help
says out 'dvi run kepler' 'help has examples'
expect 0 'version' --version
says out 'SUNDIALS [0-9]' 'version names SUNDIALS'
for command in list explain run order bench; do
  expect 0 "help of $command" "$command" --help
  says out "  dvi $command " "help of $command has examples"
  expect 2 "$command without operand" "$command"
done

for word in --version --help -h help; do expect 2 "$word and more" "$word" x; done
expect 0 'short help' -h
for command in 'list methods' 'explain kepler' 'run kepler --method verlet' \
  'order kepler --method verlet' 'bench kepler'; do
  # shellcheck disable=SC2086
  expect 2 "-h after $command" $command -h 0.1
  says err '\-\-help explains' "-h after $command: where help is"
  [ -s out ] && fail "-h after $command prints no help"
done
expect 2 '-h of run' run -h 0.1
says err '\-\-h sets the step' '-h of run: what was meant'

expect 2 'unknown command' rnu
says err "did you mean 'run'" 'nearest command'
expect 2 'unknown option' run kepler --method verlet --tend 5
says err "did you mean '--t-end'" 'nearest option'
while read -r typed meant; do
  expect 2 "--$typed" run kepler --method verlet "--$typed" 5
  says err "unknown option '--$typed' (did you mean '--$meant'?)" \
    "--$typed: the option that is meant"
  expect 2 "--$typed=5" run kepler --method verlet "--$typed=5"
  says err "unknown option '--$typed' (did you mean '--$meant'?)" \
    "--$typed=5: the option that is meant"
done <<'END'
step h
dt h
until t-end
end t-end
output out
END
expect 2 'a step where there is none' list methods --step 1
grep -q 'did you mean' err && fail 'no option is suggested that the command lacks'
expect 2 'list of one' list method
says err "did you mean 'methods'" 'nearest list'
expect 2 'unknown column' run kepler --method verlet --columns enrgy
says err "did you mean 'energy'" 'nearest column'
expect 2 'a column far from all' run kepler --method verlet --columns temperature
says err "no column 'temperature'; it has x, y, .*, laplace_y$" 'all columns'
expect 2 'a column far from a body' run two-body --method lie-verlet --columns temperature
says err "it has R11_1, .* and 44 others$" 'some columns, and how many more'
expect 2 'unknown invariant' run kepler --method verlet --alarm enrgy=1
says err "did you mean 'energy'" 'nearest invariant'
expect 2 'a method of no name near' run kepler --method foo
says err "galerkin, verlet, .*, $("$dvi" list methods --csv - | tail -n 1 | cut -d, -f1)$" \
  'all methods'
expect 2 'short option' run kepler -m verlet
expect 2 'unknown problem' run keppler --method verlet
says err "did you mean 'kepler'" 'nearest problem'
expect 2 'keys behind a blank' run kepler --method 'galerkin degree=2'
says err "did you mean 'galerkin:degree=2'" 'keys behind a blank'
: >beside.yaml
expect 2 'a scene without its ending' run beside --method verlet
says err "did you mean 'beside.yaml'" 'a scene without its ending'
expect 1 'no such scene' run nowhere.yaml
says err "cannot read 'nowhere.yaml': No such file" 'no such scene'
expect 2 'unknown method' run kepler --method verlett
says err "did you mean 'verlet'" 'nearest method'
expect 2 'unknown key' run kepler --method galerkin:degre=4
says err "did you mean 'degree'" 'nearest key'
expect 2 'unknown parameter' run kepler --method verlet --set ee=0.5
expect 2 'parameter out of range' run kepler --method verlet --set e=1.5
expect 2 'setting that is no pair' run kepler --method verlet --set e
expect 2 'parameter twice' run kepler --method verlet --set e=0.5 --set e=0.6
says err 'e is set twice' 'which parameter is set twice'
expect 0 'two parameters' explain fpu --method verlet --set ell=4 --set omega=10
says out 'omega=10' 'both parameters are set'
expect 2 'no method' run kepler --h 0.1
expect 2 'two operands' run kepler toda --method verlet
expect 2 'option twice' run kepler --method verlet --h 0.1 --h 0.2
expect 2 'option without value' run kepler --method verlet --h
expect 2 'option as value' run kepler --h --method verlet
expect 2 'flag with value' run kepler --method verlet --final=yes
for bad in 0.1x '' nan inf 1e999 abc; do
  expect 2 "h is '$bad'" run kepler --method verlet --h "$bad"
done
for bad in 0 -1 1.5 99999999999999999999 x '' +2 ' 2' '2 ' 02; do
  expect 2 "every is '$bad'" run kepler --method verlet --every "$bad"
  expect 2 "levels are '$bad'" order kepler --method verlet --levels "$bad"
  expect 2 "degree is '$bad'" run kepler --method "galerkin:degree=$bad" --t-end 1
done
expect 2 'every and final' run kepler --method verlet --every 2 --final
says err '--final leaves out' 'why every and final do not go together'
expect 2 'parameter beyond its range' run fpu --method verlet --set omega=1e300
says err 'above 1e+50, the most that is taken' 'the true reason'
expect 2 'parameter below its range' run kepler --method verlet --set e=-0.5
says err 'below 0, the least that is taken' 'the end of the range'
expect 2 'parameter that is no number' run kepler --method verlet --set e=nan
says err 'no finite number' 'no number'

# Files that would overwrite each other, and plots whose ending names another format.
ln -s a.svg link.svg
expect 2 'out and checkpoint' run kepler --method verlet --out a --checkpoint ./a
says err '--out a and --checkpoint ./a are the same file' 'both are named'
echo old >there.csv
ln -s there.csv another.csv
expect 2 'files that are there' run kepler --method verlet --out there.csv --checkpoint another.csv
[ "$(cat there.csv)" = old ] || fail 'a refused command leaves the old file'
expect 2 'out and plot' run kepler --method verlet --out a.svg --plot "$PWD/a.svg"
expect 2 'checkpoint and plot, by a link' run kepler --method verlet --checkpoint a.svg \
  --plot link.svg
expect 2 'resume and out' run kepler --method verlet --resume a --out a
expect 2 'resume and plot' run kepler --method verlet --resume a.svg --plot a.svg
expect 2 'checkpoint on standard output' run kepler --method verlet --checkpoint -
for command in order bench; do
  expect 2 "$command: csv and plot" "$command" kepler --method verlet --csv a.svg --plot ./a.svg
  says err 'the same file' "$command: both are named"
done
for command in run order bench; do
  for name in - x.png svg x.svg.gz; do
    expect 2 "$command: plot $name" "$command" kepler --method verlet --plot "$name"
    says err "ends in .svg" "$command: what a plot is"
  done
done
for name in a a.svg x.png ./-; do
  [ ! -e "$name" ] || fail "$name was written by a refused command"
done
expect 2 'h zero' run kepler --method verlet --h 0
expect 2 'h against t-end' run kepler --method verlet --h -0.1 --t-end 5
expect 2 'nodes below degree' run kepler --method galerkin:degree=4,nodes=2
expect 2 'verlet on a general Lagrangian' run double-pendulum --method verlet
expect 2 'checkpoint-every alone' run kepler --method verlet --checkpoint-every 5
expect 2 'order without method' order kepler
expect 2 'checkpoint-every without a number' run kepler --method verlet --checkpoint a \
  --checkpoint-every +5
expect 2 'too many levels' order kepler --method verlet --levels 1000
expect 2 'ratio one' order kepler --method verlet --ratio 1
for peers in cvodes ida, ,ida ida,,arkode , cvode,cvode-adams ida,ida; do
  expect 2 "peers $peers" bench kepler --against "$peers"
done
says err 'ida twice' 'which peer is named twice'
expect 2 'list what' list integrators
expect 2 'list two' list methods verlet
says err 'one word (methods, problems, or the name of one) is enough' 'how to list one'
expect 0 'one method' list verlet
[ "$(grep -c '^[a-z]' out)" -eq 1 ] || fail 'one method, and no other'
says out '^verlet ' 'the method'
expect 0 'one problem' list kepler
says out '^ *e .*only places the start' 'its parameters'
expect 2 'no list of one as csv' list kepler --csv -

expect 0 'methods' list methods
says out '^galerkin ' 'methods has galerkin'
says out ' degree ' 'methods has keys'
expect 0 'methods as csv' list methods --csv -
says out '^method,summary,source,keys$' 'header of methods'
expect 0 'problems as csv' list problems --csv problems.csv
says problems.csv '^kepler,' 'problems has kepler'
says problems.csv 'e=0.6' 'problems has defaults'
expect 0 'problems' list problems
says out '^ *e .*only places the start' 'what only places the start'
grep -q '^ *omega .*only places the start' out && fail 'what belongs to the system'
expect 0 'explain' explain kepler --method galerkin:degree=4
says out 'order 8' 'explain says the order'
says out 'e=0.6' 'explain says the parameters'
expect 0 'explain with setting' explain kepler --method verlet --set e=0.25
says out 'e=0.25' 'explain says what was set'

# More steps than can be counted are refused before the first one, in all commands that take h and
# t-end; the step that is recommended is then taken.
for command in 'run kepler --method verlet' \
  'sweep kepler --method verlet --set e=0.1,0.2 --out many.csv' \
               'resonance oscillators --method imex --sweep omega=1:10 --csv many.csv' \
               'run kepler --method sem' \
               'run kepler --method verlet --plot many.svg --checkpoint many.state'; do
  for ends in '--h 1e-12 --t-end 1e9' '--h -1e-12 --t-end -1e9'; do
    # shellcheck disable=SC2086
    expect 2 "many steps: $command $ends" $command $ends
    says err '1e+21 steps' "many steps: $command"
    [ -s out ] && fail "many steps: $command $ends writes something"
    [ -z "$(find . -name 'many.*')" ] || fail "many steps: $command $ends leaves a file"
  done
done
expect 2 'many steps of a study' order kepler --method verlet --h 1e-12 --t-end 1e9 --csv many.csv
expect 2 'many steps of a range' resonance oscillators --method imex --sweep h=1e-12:1 --t-end 1e9
expect 2 'many steps to a far end' sweep kepler --method verlet --set e=0.1,0.2 --t-end 1e30 \
  --out many.csv
expect 2 'many steps' run kepler --method verlet --h 1e-12 --t-end 1e9
says err \
  'dvi: run: --t-end 1e+09 is 1e+21 steps of 1e-12 away, and at most 2^53 (9e15) can be counted' \
  'many steps'
h=$(sed 's/.*give an --h of \([^ ]*\).*/\1/' err)
"$dvi" run kepler --method verlet --h "$h" --t-end 1e9 >out 2>err &
sleep 1
kill -INT $!
ends 130 "a run of $h"
says out '^0,0.4' "a run of $h begins"

if [ -w /dev/full ]; then
  for line in '--help' '--version' 'list methods' 'explain kepler --method verlet'; do
    code=0
    # shellcheck disable=SC2086
    "$dvi" $line >/dev/full 2>err || code=$?
    [ "$code" -eq 1 ] || fail "full device: dvi $line ends with $code"
    says err 'standard output' 'full device is named'
  done
fi
finish
