#!/bin/sh
# dvi order: columns, judges, levels, verdicts.  Usage: test_order.sh DVI
. "$(dirname "$0")/check.sh"
header='method,problem,h,steps,error,slope,energy_error,cpu_seconds,residuals,jacobians'
header=$header,factorizations

expect 0 'two methods' order kepler --method galerkin:degree=2 --method verlet --csv - \
  --plot order.svg
[ "$(head -n 1 out)" = "$header" ] || fail 'header'
says err 'judge at t = 10: exact solution, error' 'the exact judge and its error'
says err 'claimed order 4, fitted [34]\.[0-9]* .*ok' 'verdict on degree 2'
says err 'claimed order 2, fitted [12]\.[0-9]* .*ok' 'verdict on verlet'
for method in galerkin:degree=2 verlet; do
  [ "$(grep -c "^$method,kepler," out)" -ge 5 ] || fail "five levels of $method"
done
awk -F, 'NF != 11' out | grep -q . && fail 'every row has 11 fields'
grep -qi 'nan\|inf' out && fail 'every field is a number or empty'
# Slopes from the table, not from the verdict: the last two levels of degree 2 show order 4.
awk -F, '
  $1 == "galerkin:degree=2" { if (e) s = log(e / $5) / log(h / $3); e = $5; h = $3 }
  END { exit !(s > 3.8 && s < 4.2) }' out ||
  fail 'the table shows order 4'
if command -v gnuplot >/dev/null; then says order.svg '</svg>' 'the plot is whole'; fi

# Any two columns can be drawn against each other, one panel each. Slopes stand only beside the
# error.
expect 0 'axes' order free-body --method lie-rk --method lie-galerkin --levels 4 --csv axes.csv \
  --plot axes.svg \
  --axes h:energy_error --axes h:distance --axes error:cpu_seconds
if command -v gnuplot >/dev/null; then
  for title in 'energy_error against h: free-body' 'distance against h: free-body' \
    'cpu_seconds against error: free-body'; do
    says axes.svg "$title" "the panel $title"
  done
  [ "$(grep -c '<text>lie-galerkin<' axes.svg)" -eq 3 ] || fail 'each panel names the methods'
  grep -q 'claimed orders' axes.svg && fail 'no slopes where there is no error against h'
  says order.svg 'claimed orders' 'the slopes beside the error'
fi
for bad in h h: :h h:errors hh:error method:error error:problem h:distance; do
  expect 2 "axes $bad" order kepler --method verlet --plot a.svg --axes "$bad"
done
expect 2 'axes of a wrong name' order kepler --method verlet --plot a.svg --axes h:eror
says err "no column 'eror' (did you mean 'error'?)" 'the nearest column'
expect 2 'axes without a plot' order kepler --method verlet --axes h:error

expect 0 'for people' order pendulum --method midpoint --csv order.csv
says out 'judge at t' 'the judge is named'
says out 'ok$' 'the verdict is printed'
says order.csv '^midpoint,pendulum,' 'the file has the rows'
expect 0 'commas are quoted' order kepler --method galerkin:degree=2,quadrature=lobatto --csv -
says out '^"galerkin:degree=2,quadrature=lobatto",kepler,' 'quoted specification'

# With another span the stored digits are not for it, and the better one of IDA and two runs judges,
# with its own error.
expect 0 'rotations' order free-body --method lie-galerkin --method lie-verlet --csv -
says out '^method,.*,factorizations,distance$' 'one column more, the distance'
awk -F, 'NR > 1 && !($NF < 1e-13) { bad = 1 } END { exit bad }' out ||
  fail 'every distance is rounding'
expect 0 'IDA judges rotations' order kovalevskaya --method lie-galerkin:degree=2 --judge ida
expect 0 'runs judge rotations' order pendulum-3d --method lie-verlet --t-end 2 --judge runs
says out 'two runs of lie-galerkin' 'the runs are named'
expect 0 'IDA judges' order henon-heiles --method verlet --t-end 3 --judge ida
says out 'judge at t = 3: IDA.*error [0-9.]*e-' 'IDA and its error'
expect 0 'the better one judges' order henon-heiles --method verlet --t-end 3
says out \
  'judge at t = 3: two runs of galerkin, .*(IDA, of error .*, is .* away), error [0-9.]*e-1[4-9]' \
  'the runs and their witness'
expect 0 'runs judge' order henon-heiles --method galerkin:degree=3 --t-end 3 --judge runs
says out 'judge at t = 3: two runs of galerkin, degree 16 in .*, error [0-9.]*e-1[4-9]' \
  'the runs and their error'
expect 2 'no exact judge' order henon-heiles --method verlet --judge exact
expect 2 'no such judge' order henon-heiles --method verlet --judge none
# Stored digits exist at one end time only, so the study is not lengthened.
expect 0 'stored digits judge' order kepler --method galerkin:degree=2 --judge stored
says out 'judge at t = 10: stored' 'the digits'

# Too few levels decide nothing, and that is not success.
expect 3 'three levels' order kepler --method verlet --levels 3
says out 'not decided' 'three levels do not decide'
says out 'levels' 'the remedy is named'
# Steps much too large are not asymptotic: the order is missed or not decided, never confirmed.
expect 3 'coarse steps' order kepler --method verlet --h 0.3 --ratio 1.1 --levels 6 --csv order.csv
says order.csv '^verlet,kepler,' 'the table is written although the check failed'
# Lobatto's error approaches its order from above: the coarse levels are left out of the fit, by
# their slopes alone.
expect 0 'a slope that settles late' order kepler --method galerkin:degree=4,quadrature=lobatto \
  --csv settle.csv
says out 'fitted 8.[01]' 'the settled part is fitted'
[ "$(wc -l <settle.csv)" -eq 13 ] || fail 'twelve levels of a high order'
expect 0 'a window at the fine end' order pendulum --method galerkin:degree=5
grep -q 'to levels 1 to' out && fail 'the coarse levels of pendulum are left out'
# Between steps that are too large and roundoff a high order has no room: single steps in more
# digits decide it.
expect 0 'order 16' order kepler --method galerkin:degree=8
says out '^galerkin:degree=8, single steps from 5 points to t = 10, in quadruple precision' \
  'the table of single steps'
says out 'claimed order 16, fitted 1[56]\.[0-9]* to single steps .*: ok' 'order 16'
near='with h = .* own steps are [0-9.]*e-1[5-9] from these'
says out "judge of the steps: extrapolation, error .*e-3[01]; $near" 'both halves of the proof'
awk '
  /in quadruple precision/ { on = 1 }
  on && NF == 3 && $1 ~ /^[0-9]/ { e = $2 + 0; last = $3 }
  END { exit !(e < 1e-27 && last > 15.8 && last < 16.2) }' out ||
  fail 'the smallest steps show order 16'
# Single steps decide, too, where a slope looks settled too early: here higher terms count down to
# the floor.
expect 0 'no miss' order pythagorean --method galerkin:degree=5,quadrature=lobatto
says out 'fitted 10\.[0-9]* to single steps\|fitted 9\.9[0-9]* to single steps' 'order 10'
says out 'the span to t = 1.5 does not show it: .*slope 9\.[4-6]' 'what the span shows'
# The command says that a method has no single steps, and how to proceed.
expect 3 'order 12 on a group' order free-body --method lie-galerkin:degree=8 --judge exact
says out 'no single steps in quadruple precision: they are there for galerkin' 'why there are none'
# The search for levels ends.
expect 3 'steps without number' order kepler --method verlet --set e=0.999
says out ' 131072 ' 'the search ends at 2^17 steps'
says out ' 4194304 ' 'the levels end at 2^22 steps'
# All levels below the floor.
expect 3 'below the floor' order oscillator --method composition:order=8 --h 0.001 --levels 5

# More steps than there can be are refused, not cut down to what can be.
expect 2 'a tiny step' order kepler --method verlet --h 1e-9
says err '16777216 are possible' 'how many steps can be'

# A signal while the plot is drawn, here by a program that takes long, leaves no temporary file.
mkdir slow
printf '#!/bin/sh\nexec sleep 3\n' >slow/gnuplot
chmod +x slow/gnuplot
for signal in TERM:143 HUP:129; do
  PATH=$PWD/slow:$PATH "$dvi" order kepler --method verlet --levels 4 --plot drawn.svg >out 2>err &
  wait_for_part drawn.svg
  kill -"${signal%:*}" $!
  ends "${signal#*:}" "$signal"
  no_trace "$signal"
done

echo old >old.csv
expect 2 'bad method among good ones' order kepler --method verlet --method nothing --csv old.csv
[ "$(cat old.csv)" = old ] || fail 'a refused study leaves the old file'
expect 1 'no folder' order kepler --method verlet --csv nowhere/a.csv
if [ -w /dev/full ]; then
  expect 1 'full device' order kepler --method verlet --csv /dev/full
  code=0
  "$dvi" order kepler --method verlet --csv - >/dev/full 2>err || code=$?
  [ "$code" -eq 1 ] || fail "full device: exit code $code"
fi
no_trace 'order'
finish

# A Fourier field of 399 unknowns has no Hessian, which CVODE's Adams methods do without.
cat >waves.yaml <<END
domain: {x: [0, 20]}
space: fourier:modes=199
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))
boundary: {x: periodic}
initial: {u: "exp(-(x-10)^2)"}
step: 0.01
until: 0.5
END
expect 0 'an independent judge' order waves.yaml --method verlet --judge ida
says out 'fitted 2.00 .*: ok' 'the order'
says out "CVODE's Adams methods, run at two tolerances" 'the judge'
