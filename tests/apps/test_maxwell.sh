#!/bin/sh
# Scenes of electromagnetic fields through the command: all methods, rows, files, interrupted runs,
# modes, stability, spectra. What is refused is in test_maxwell_errors.sh.
# Usage: test_maxwell.sh DVI
. "$(dirname "$0")/check.sh"

# row NAME WIDTH VALUE...: require that the last row of out has these numbers, t first, each within
# WIDTH of the value's size or of 1.
row() {
  name=$1 width=$2
  shift 2
  tail -n 1 out | awk -F, -v wanted="$*" -v width="$width" '
    { count = split(wanted, value, " ")
      wrong = NF != count
      for (i = 1; i <= NF; i++) {
        d = $i - value[i]; size = value[i] < 0 ? -value[i] : value[i]
        if (d < 0) d = -d
        if (!(d <= width * (size > 1 ? size : 1))) wrong = 1
      } }
    END { exit wrong }' || { fail "$name: not $*:"; tail -n 1 out; }
}

# columns FILE LINE NAME: require these columns.
columns() { [ "$(head -n 1 "$1")" = "$2" ] || { fail "$3: columns"; head -n 1 "$1"; }; }

# ---- methods ----

# The start is the lowest mode of the square but for the mesh: Bz = cos(pi x) cos(w t), w = pi.
# Its energy is 1/4, and Ey = sin(pi x) sin(pi t) vanishes at t = 1. The mesh's own frequency is
# 3.132 to 3.138 instead of pi, by which Ey is off by some 0.01.
cat >cavity.yaml <<END
mesh: {generator: staggered, cells: [8, 8]}
field: maxwell
boundary: pec
probes: {ear: {of: B, at: [0.3, 0.4]}, eye: {at: [0.6, 0.7]}}
initial: {B: cos(pi*x)}
method: leapfrog
step: {fraction: 0.5}
until: 1
END
for method in leapfrog bossavit-kettunen avi tents verlet galerkin:degree=2; do
  expect 0 "$method" run cavity.yaml --method $method --final
  columns out t,energy,ear,eye_x,eye_y "$method"
  row "$method" 0.04 1 0.25 -0.588 0 0
done
# The local steps of this one are above those of the others, and so are its errors.
expect 0 'free steps' run cavity.yaml --method avi:classes=no --final
columns out t,energy,ear,eye_x,eye_y 'free steps'
row 'free steps' 0.08 1 0.25 -0.588 0 0
expect 0 'leapfrog' run cavity.yaml --final --out leapfrog.csv
expect 0 'its other name' run cavity.yaml --method bossavit-kettunen --final --out other.csv
same leapfrog.csv other.csv 'two names of one method'
expect 0 'a check' check cavity.yaml
says out 'leapfrog takes its first step' 'a check takes a step'
says out 'verlet and leapfrog are stable below h = 0.0453' 'the longest step'
expect 0 'explained' explain cavity.yaml
says out '188 unknowns on edges, 32 fixed' 'unknowns'

# Yee on boxes and leapfrog on their mesh are one method. No place is on the face of a box, where
# E or B has two values. The moments begin with their third derivative, because the half step of the
# start leaves dt^2/8 times the second one between the two.
cat >box.yaml <<END
mesh: {generator: box, cells: [5, 4, 3], size: [1, 0.8, 0.6]}
field: maxwell
boundary: {right: pec, top: pec}
materials: {eps: 2, mu: 1.5}
sources: {antenna: {at: [0.43, 0.31, 0.22], moment: [0, sin(t)^3, "exp(-((t - 1)/0.15)^2)"]}}
probes: {ear: {of: B, at: [0.31, 0.43, 0.25]}, eye: {at: [0.63, 0.51, 0.3], along: [1, 1, 0]}}
initial: {E: [0, 0, cos(pi*x/2)*cos(pi*y/1.6)]}
method: leapfrog
step: 0.05
until: 2
END
# agree SCENE NAME: require that yee and leapfrog agree to 1e-12, but for the energy, which each has
# at a time of its own. That time's difference is of the order of the step.
agree() {
  expect 0 "$2: leapfrog" run "$1" --final
  tail -n 1 out | cut -d, -f3- >numbers
  expect 0 "$2: yee" run "$1" --method yee --final
  tail -n 1 out | cut -d, -f3- | paste -d, numbers - | awk -F, '
    { for (i = 1; i <= NF / 2; i++) {
        d = $i - $(i + NF / 2); if (!(d*d <= 1e-24 * (1 + $i*$i))) wrong = 1
        if ($i*$i > 1e-6) seen = 1 } }
    END { exit wrong || !seen }' || fail "$2: yee and leapfrog differ"
}
agree box.yaml 'in space'
cat >plane.yaml <<END
mesh: {generator: box, cells: [7, 6], periodic: [1, 0], size: [2, 1], origin: [-1, 0]}
field: maxwell
boundary: {bottom: pec}
sources: {antenna: {at: [0.11, 0.31], moment: [sin(t)^3, t^2*sin(t)]}}
probes: {ear: {of: B, at: [0.31, 0.43]}, eye: {at: [0.63, 0.51]}}
method: leapfrog
step: 0.05
until: 3
END
agree plane.yaml 'in a plane'
sed 's/^field: maxwell/&\npolarization: tm/; s/moment: .*}}/moment: sin(t)^3}}/' plane.yaml >tm.yaml
agree tm.yaml 'across a plane'

# A side has its own wall, and the whole boundary is that of the other sides.
sed 's/^boundary:.*/boundary: {boundary: pec, top: pmc, left: pmc}/' box.yaml >sides.yaml
agree sides.yaml 'walls of sides'
cat >rim.yaml <<END
mesh: {generator: disk, cells: 4}
field: maxwell
boundary: {boundary: pec, rim: pmc}
END
expect 2 'a wall that a stronger one hides' modes rim.yaml
says err "is stronger than that of 'rim'" 'a wall that a stronger one hides'

# The flux through a box needs no layers.
through='{flux: {from: [0.2, 0.2, 0.2], to: [0.8, 0.6, 0.4]}}'
sed "s/^method:.*/method: yee/; s/^probes:.*/probes: {out: $through}/" box.yaml >flux.yaml
expect 0 'a flux through a box' run flux.yaml --final
columns out t,energy,out 'a flux through a box'

# The frames of asynchronous steps and of tents have E and B, and a run tells its events.
cat >frames.yaml <<END
mesh: {generator: annulus, cells: [2, 12]}
field: maxwell
boundary: {outer: pec}
initial: {E: [y, x]}
until: 0.2
END
for method in avi tents; do
  expect 0 "frames of $method" run frames.yaml --method $method --final --pvd frames.pvd
  says err ' events, with steps from ' "events of $method"
  grep -a -q 'Name="B"' frames_000000.vtu || fail "$method: frames have no B"
done

cat >line.yaml <<END
mesh: {generator: interval, cells: 20, size: 4}
field: maxwell
boundary: {left: pec}
sources: {antenna: {at: 1.31, current: sin(t)}}
probes: {ear: {of: B, at: 0.31}, eye: {at: 2.63}}
method: leapfrog
step: 0.1
until: 5
END
expect 0 'on a line' run line.yaml --final
columns out t,energy,ear,eye 'on a line'

# What only the mesh of the boxes has is the mesh's for yee, too: a start by A, and probes of parts.
sed 's/^initial:.*/initial: {A: [sin(pi*y), 0, 0]}/
  s/^boundary:.*/boundary: {right: pec, left: absorbing}/
  s/^probes:.*/probes: {out: {flux: left}, all: {energy: all}}/' box.yaml >parts.yaml
expect 0 'parts, by leapfrog' run parts.yaml --final --out leapfrog.csv
expect 0 'parts, by yee' run parts.yaml --method yee --final --out yee.csv
same leapfrog.csv yee.csv 'parts'
tail -n 1 yee.csv | awk -F, '{ exit !($3 > 1e-3) }' || fail 'the flux through a part'

# A pulse leaves through an absorbing wall, first order, at a right angle: what comes back is below
# 1e-3 of its energy. It passes the probe once.
cat >pulse.yaml <<END
mesh: {generator: interval, cells: 200, size: 4}
field: maxwell
boundary: absorbing
initial: {E: "exp(-((x - 2)/0.2)^2)"}
method: leapfrog
step: {fraction: 0.9}
until: 4
END
expect 0 'a pulse' run pulse.yaml --every 1000
awk -F, 'NR == 2 { start = $2 } END { exit !(start > 0.1 && $2 < 1e-3 * start) }' out ||
  { fail 'an absorbing wall'; cat out; }
sed 's/generator: interval, cells: 200/generator: box, cells: [200]/' pulse.yaml >boxes.yaml
expect 0 'a pulse on boxes' run boxes.yaml --method yee --every 1000
awk -F, 'NR == 2 { start = $2 } END { exit !(start > 0.1 && $2 < 1e-3 * start) }' out ||
  { fail 'an absorbing end'; cat out; }

# Energy that leaves is no error of a method, even if the steps are long.
cat >leaves.yaml <<END
mesh: {generator: box, cells: [8, 8]}
field: maxwell
boundary: absorbing
initial: {B: exp(-40*((x - 0.5)^2 + (y - 0.5)^2))}
method: verlet
step: 0.08
until: 10
END
expect 0 'a damped field' run leaves.yaml --final --columns energy
[ -s err ] && { fail 'a damped field: a warning'; cat err; }

# A start has no imaginary part, whatever the phase.
cat >phase.yaml <<END
mesh: {generator: box, cells: [4, 3]}
field: maxwell
boundary: {left: {bloch: 0}, right: {bloch: 0}, bottom: periodic, top: periodic}
initial: {E: ["1", "1"]}
probes: {a: {of: E, at: [0.9, 0.9]}}
method: yee
step: {fraction: 0.5}
until: 0.1
END
expect 0 'a phase' run phase.yaml --final
says out '^0.1[0-9]*,1[.0-9]*,1[.0-9]*,1[.0-9]*$' 'a phase keeps a constant field'

# Only yee has layers, plane waves and phases, which need no mesh.
cat >open.yaml <<END
mesh: {generator: box, cells: [40, 40], size: [4, 4]}
field: maxwell
boundary: {cpml: 8}
sources: {ray: {wave: [1, 0], from: [1.2, 1.2], to: [2.8, 2.8], signal: "exp(-((t - 1)/0.3)^2)"}}
probes: {inside: {of: B, at: [2.03, 2.07]}, outside: {of: B, at: [3.03, 2.07]},
  out: {flux: {from: [1, 1], to: [3, 3]}}}
method: yee
step: {fraction: 0.7}
until: 6
END
expect 0 'an open grid, checked' check open.yaml
says out 'yee takes its first step' 'an open grid, checked'
says out 'laws of yee over 100 steps' 'the charges of a grid, checked'
expect 0 'an open grid' run open.yaml --every 1
columns out t,energy,inside,outside,out 'an open grid'
# Where E goes to the left of the ray, B is along z with its sign. Nothing leaks along an axis but
# roundings, and at the end the wave has left, but for what the layers return.
awk -F, 'NR > 1 { if ($3 > most) most = $3; if ($4*$4 > leak) leak = $4*$4; last = $3*$3 }
  END { exit !(most > 0.95 && most < 1.05 && leak < 1e-28 && last < 1e-8) }' out ||
  fail 'a plane wave within its box'

# ---- rows, columns, files ----

expect 0 'rows' run box.yaml --every 10
[ "$(wc -l <out)" -eq 6 ] || fail 'five rows'
columns out t,energy,ear_x,ear_y,ear_z,eye 'rows'
expect 0 'the last row' run box.yaml --every 10 --out rows.csv
expect 0 'the last row' run box.yaml --final --out final.csv
tail -n 1 rows.csv >last
tail -n 1 final.csv | cmp -s - last || fail 'the last row does not depend on the others'
for method in leapfrog yee avi; do
  expect 0 "columns of $method" run box.yaml --method $method --final --columns eye,gauss,energy
  columns out t,eye,gauss,energy "columns of $method"
  tail -n 1 out | awk -F, '{ exit !($3*$3 < 1e-26) }' || fail "the charge, by $method"
done
expect 0 'columns of yee' run box.yaml --method yee --final --columns charge,divergence
expect 2 'a column that is none' run box.yaml --columns energy,ear_q
says err "no column 'ear_q' (did you mean 'ear_x'?)" 'the nearest column'
expect 0 'a step that does not divide the span' run box.yaml --h 0.07 --t-end 0.1
row 'the end is met' 1 0.1 0 0 0 0 0
expect 0 'no time at all' run box.yaml --t-end 0
expect 0 'files' run box.yaml --every 20 --pvd lf.pvd --out /dev/null
expect 0 'files of yee' run box.yaml --method yee --every 20 --pvd yee.pvd --out /dev/null
says lf.pvd 'timestep="2".*lf_000002.vtu' 'the list of files'
for name in lf yee; do
  for form in E B; do says ${name}_000002.vtu "Name=\"$form\"" "$name: $form"; done
done
[ ! -e lf_000003.vtu ] || fail 'a file a row'
expect 0 'files of an open grid' run open.yaml --every 50 --pvd open.pvd --out /dev/null
says open_000001.vtu 'Name="B"' 'an open grid: B'
expect 0 'a plot' run box.yaml --final --plot box.svg
says box.svg 'change of the energy' 'a plot of the energy'
says box.svg 'eye' 'a plot of a probe'

# ---- the same bits ----

for method in leapfrog yee avi; do
  expect 0 "$method" run box.yaml --method $method --every 7 --out one.csv
  expect 0 "$method, 2 threads" run box.yaml --method $method --every 7 --threads 2 --out two.csv
  same one.csv two.csv "$method: threads"
done
expect 0 'tents' run cavity.yaml --method tents --out one.csv
expect 0 'tents, 2 threads' run cavity.yaml --method tents --threads 2 --out two.csv
same one.csv two.csv 'tents: threads'

# A run that goes on from a checkpoint repeats the row at which it stood.
resumed() {
  scene=$1 method=$2 cut=$3
  expect 0 "$method: whole" run "$scene" --method "$method" --every 4 --out whole.csv
  expect 0 "$method: first part" run "$scene" --method "$method" --every 4 --t-end "$cut" \
    --checkpoint part.state --out part.csv
  expect 0 "$method: second part" run "$scene" --method "$method" --every 4 --resume part.state \
    --out rest.csv
  { cat part.csv; sed 1,2d rest.csv; } >both.csv
  same whole.csv both.csv "$method: a run in two parts"
}
for method in leapfrog yee; do resumed box.yaml $method 1; done
sed 's/^step:.*/step: 0.05/' open.yaml >steady.yaml
resumed steady.yaml yee 1
# Other steps than 0.05 do not lead to 1 but for roundings, so that where the way is cut there is
# one more row. A fraction of the stable step divides the span, and has to be of the same one.
for pair in cavity.yaml:tents box.yaml:avi box.yaml:avi:classes=no; do
  scene=${pair%%:*} method=${pair#*:}
  expect 0 "$method: whole" run "$scene" --method "$method" --out whole.csv --every 3
  "$dvi" run "$scene" --method "$method" --t-end 0.4 --checkpoint part.state >out 2>err ||
    fail "$method: first part"
  expect 0 "$method: second part" run "$scene" --method "$method" --resume part.state --final \
    --out rest.csv
  tail -n 1 whole.csv >last
  tail -n 1 rest.csv | cmp -s - last || fail "$method: the bits of a run in two parts"
done
expect 0 'a fraction of a shorter span' run open.yaml --t-end 1 --checkpoint part.state --final
expect 1 'is another step' run open.yaml --resume part.state --final
says err 'another step' 'a fraction of a shorter span'
expect 0 'checkpoints on the way' run box.yaml --checkpoint-every 7 --checkpoint part.state --final
expect 0 'the end is reached' run box.yaml --resume part.state --final
expect 1 'the state of another method' run box.yaml --method avi --resume part.state
says err "no section 'avi': another method has saved it" 'the state of another method'
expect 1 'the state of another step' run box.yaml --h 0.04 --resume part.state
says err 'another' 'the state of another step'
sed 's/eps: 2/eps: 3/' box.yaml >other.yaml
expect 1 'the state of another field' run other.yaml --resume part.state
says err 'is of another field: its mesh, materials' 'the state of another field'
expect 1 'no state' run box.yaml --resume rows.csv
says err 'no saved state' 'no state'
head -c 300 part.state >short.state
expect 1 'half a state' run box.yaml --resume short.state
says err 'cut short' 'half a state'
expect 2 'a state past the end' run box.yaml --resume part.state --t-end 1
says err 'past --t-end' 'a state past the end'

# Signals end a run after some steps: the output is complete, and the run can go on to the same
# bits. Where it stood it has one more row.
for signal in INT:130 TERM:143; do
  for method in leapfrog yee; do
    what="$method, $signal"
    "$dvi" run box.yaml --method $method --t-end 1e6 --every 1000 --out cut.csv \
      --checkpoint cut.state 2>err &
    sleep 0.7
    kill -"${signal%:*}" $!
    ends "${signal#*:}" "$what"
    says err 'complete up to there' "$what: it is said"
    no_trace "$what"
    reached=$(tail -n 1 cut.csv | cut -d, -f1)
    end=$(echo "$reached" | awk '{ printf "%.17g", 50 * (int($1 / 50) + 4) }')
    expect 0 "$what: whole" run box.yaml --method $method --t-end "$end" --every 1000 \
      --out whole.csv
    expect 0 "$what: the rest" run box.yaml --method $method --t-end "$end" --every 1000 \
      --resume cut.state --out rest.csv
    { cat cut.csv; sed 1,2d rest.csv; } | awk -F, -v at="$reached" '$1 != at' >both.csv
    awk -F, -v at="$reached" '$1 != at' whole.csv >expected.csv
    same expected.csv both.csv "$what: a run in two parts"
  done
done

# ---- modes, stability, spectra ----

# digits FILE LINE NAME VALUE: require a number of a CSV file to 11 digits.
digits() {
  awk -F, -v line="$2" -v name="$3" -v value="$4" '
    NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
    NR == line + 1 { found = 1; d = $column - value; wrong = !(d*d <= 1e-22 * value*value) }
    END { exit !found || !column || wrong }' "$1" || { fail "$3 $2 is $4"; cat "$1"; }
}
expect 0 'modes' modes cavity.yaml --count 3 --csv - --vtu modes.vtu
digits out 1 omega 3.132012610332
digits out 2 omega 3.138417260339
digits out 3 omega 4.428354888445
says modes.vtu 'mode_3' 'the shapes'
printf '%s\n' 'mesh: {generator: box, cells: [5, 4, 3], size: [1, 0.8, 0.6]}' 'field: maxwell' \
  >hollow.yaml
sed '$a boundary: pec' hollow.yaml >pec.yaml
expect 0 'modes of a box' modes pec.yaml --count 3 --csv -
says err 'left out: 24 of frequency zero' 'static fields of a conductor'
# 2 sin(k h/2)/h with h = 0.2 along each axis, added in squares, of half waves along two axes.
for mode in '1 1 0.8' '2 1 0.6' '3 0.8 0.6'; do
  set -- $mode
  digits out "$1" omega "$(awk -v a="$2" -v b="$3" 'function s(l) { return (10*sin(pi*0.1/l))^2 }
    BEGIN { pi = atan2(0, -1); printf "%.17g", sqrt(s(a) + s(b)) }')"
done
expect 0 'modes of an open box' modes hollow.yaml --count 3
says out 'left out: 119 of frequency zero' 'static fields of a magnetic wall'
expect 2 'more modes than there are' modes cavity.yaml --count 136
says err 'take 1 to 135' 'how many there are'

# Powers of 2 of a step are stable here, and free ratios grow (Fong, Darve and Lew 2008).
expect 0 'stability' stability cavity.yaml --csv - --method avi --method avi:classes=no
columns out method,schedule,period,growth,rate,resolution,result 'stability'
says out '^avi,.*,stable$' 'classes are stable'
expect 0 'free ratios' stability cavity.yaml --csv - --method avi:classes=no --fraction 0.9
says out '^avi:classes=no,.*,grows$' 'free ratios are not'
expect 2 'equal steps' stability cavity.yaml --method leapfrog
says err 'equal steps' 'equal steps'

# The scene's own method is examined, and a run of the same tents ends with the alarm.
cat >tents.yaml <<END
mesh: {generator: interval, cells: [12]}
field: maxwell
boundary: pec
initial: {E: ["x*(1 - x)*sin(7*x)"]}
method: tents:least=0.5,seed=3
until: 3000
END
expect 0 'stability of the own method' stability tents.yaml --csv -
says out '^"tents:least=0.5,seed=3",random tents from .*,grows$' 'random tents'
expect 0 'stability of another method' stability tents.yaml --csv - --method tents --method avi
says out '^tents,equal tents of .*,stable$' 'equal tents'
says out '^avi,equal steps of .*,stable$' 'equal steps'
expect 1 'a run that grows' run tents.yaml --final
says err 'tents: at t = .* the energy is .* times that of the start, above 2' 'the alarm'
sed 's/^method:.*/method: leapfrog/' tents.yaml >leapfrog.yaml
expect 2 'a scene with equal steps' stability leapfrog.yaml
says err 'ask for avi or tents' 'a scene with equal steps'
expect 2 'a fraction of 1' stability cavity.yaml --fraction 1
says err 'above 0 and below 1' 'a fraction of 1'
expect 2 'no field' stability kepler

# Ten oscillations give the frequency of the mesh, 2 asin(dt w/2)/dt with w = 2 sin(pi h/2)/h, to
# roundings.
cat >swing.yaml <<END
mesh: {generator: box, cells: [8, 8]}
field: maxwell
boundary: pec
probes: {ear: {of: B, at: [0.3, 0.4]}}
initial: {B: cos(pi*x)}
method: leapfrog
step: 0.05
until: 20
END
for method in leapfrog yee; do
  expect 0 "a series by $method" run swing.yaml --method $method --out swing.csv
  expect 0 "its spectrum" spectrum swing.csv --columns ear --csv -
  [ "$(wc -l <out)" -eq 2 ] || fail "$method: one line"
  digits out 1 omega 3.124621943649068
done
# ---- what explain says ----

printf '%s\n' 'mesh: {generator: box, cells: [8, 8]}' 'field: maxwell' 'until: 1' 'method: yee' \
  'probes: {rim: {flux: left}}' >told.yaml
expect 0 'an explanation' explain told.yaml
says out '^march: yee with steps of ' 'the name of the method'
says out '^  first run    --t-end 1$' 'a first run without a step'
printf '%s\n' 'mesh: {generator: staggered, cells: [4, 4]}' 'field: maxwell' 'until: 1' \
  'method: tents' 'step: {fraction: 0.5}' >told.yaml
expect 0 'an explanation of tents' explain told.yaml
says out '^  first run    --t-end 1$' 'a first run of tents'
expect 0 'an explanation of a mechanical method' explain told.yaml --method verlet
says out '^  first run    --h 0.0' 'a first run of a mechanical method'
finish
