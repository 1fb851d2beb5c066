#!/bin/sh
# What scenes of electromagnetic fields may not say, and what their runs do not take: a sentence
# each, with its place.
# Usage: test_maxwell_errors.sh DVI
. "$(dirname "$0")/check.sh"

solid='mesh: {generator: box, cells: [5, 4, 3], size: [1, 0.8, 0.6]}
field: maxwell
until: 1'
flat='mesh: {generator: staggered, cells: [4, 4]}
field: maxwell
until: 1'
grid='mesh: {generator: box, cells: [8, 8]}
field: maxwell
until: 1
method: yee'

# refuse NAME PLACE WORDS SCENE: require that the scene is refused at this line and column, with
# these words.
refuse() {
  printf '%s\n' "$4" >wrong.yaml
  expect 2 "$1" check wrong.yaml
  says err "^dvi: wrong.yaml:$2: .*$3" "$1"
}

# ---- materials ----

refuse 'a negative permittivity' 4:18 'eps is -1 in cell 0, where a number above 0' "$solid
materials: {eps: -1}"
refuse 'no permeability' 4:17 'mu is 0 in cell 0' "$solid
materials: {mu: 0}"
refuse 'a negative conductivity' 4:26 'sigma is -0.4 in cell 0, where a number of at least' "$solid
materials: {all: {sigma: x - 0.5}}"
refuse 'a permittivity that is no number' 4:18 'eps is inf in cell 0' "$solid
materials: {eps: 1/(x - x)}"
refuse 'a material of waves' 4:13 "no 'rho'; it has eps, mu and sigma" "$solid
materials: {rho: 1}"
refuse 'a part that is none' 4:13 "no part 'core' of cells; it has all$" "$solid
materials: {core: {eps: 2}}"
refuse 'a material of a wall' 4:13 "no part 'left' of cells" "$solid
materials: {left: {eps: 2}}"
refuse 'a part of a grid' 5:13 "a grid has no part 'core' of cells" "$grid
materials: {core: {eps: 2}}
boundary: {cpml: 2}"
refuse 'a negative permittivity on a grid' 5:12 'eps = -0.4375 at (0.0625, ' "$grid
materials: {eps: x - 0.5}
boundary: {cpml: 2}"
refuse 'a negative conductivity on a grid' 5:12 'sigma = -0.4375 at (0.0625, ' "$grid
materials: {sigma: x - 0.5}
boundary: {cpml: 2}"

# ---- walls ----

refuse 'a wall that is none' 4:12 "no part 'lid'; it has all, boundary, left" "$solid
boundary: {lid: pec}"
refuse 'a wall of a grid that is none' 5:29 \
  "no wall 'front'; it has boundary, left, right, bottom and top$" "$grid
boundary: {left: {cpml: 2}, front: pec}"
words='a wall is pec, pmc, absorbing, periodic, {cpml: layers} or {bloch: phase}'
refuse 'another wall' 4:11 "$words" "$solid
boundary: glass"
refuse 'layers without their number' 4:11 "$words" "$solid
boundary: cpml"
refuse 'a wall of waves' 4:19 "$words" "$solid
boundary: {right: fixed}"
refuse 'a slip of cpml' 4:17 "$words" "$solid
boundary: {cpm: 3}"
refuse 'another wall of a side' 5:19 "a wall has no 'depth'; it has cpml and bloch" "$grid
boundary: {left: {depth: 3}}"
refuse 'a wall that repeats nothing' 4:12 "a grid has no wall 'lid'" "$solid
boundary: {lid: periodic}"
refuse 'layers beside sides' 5:11 "as in '{boundary: {cpml: 10}, left: pec}'" "$grid
boundary: {cpml: 2, left: pec}"
refuse 'no layers' 5:18 'cpml is a whole number from 1' "$grid
boundary: {cpml: 0}"
refuse 'layers thicker than the box' 5:11 '8 boxes, and its absorbing layers take 10' "$grid
boundary: {cpml: 5}"
refuse 'two walls in one' 5:18 'stand alone' "$grid
boundary: {left: {cpml: 3, bloch: 1}}"
refuse 'layers on simplices' 4:11 'layers and phases are for .method: yee. on boxes' "$flat
boundary: {cpml: 2}"
refuse 'layers by leapfrog' 4:9 "cpml only 'method: yee' takes, .* take 'absorbing'" "$solid
method: leapfrog
boundary: {cpml: 1}"
refuse 'a phase at one end' 5:11 'repeats itself at one end only' "$grid
boundary: {left: {bloch: 1}, right: pec}"
refuse 'two phases of an axis' 5:30 "the same phase, and 'left' has 1, and 'right' 0.5" "$grid
boundary: {left: {bloch: 1}, right: {bloch: 0.5}}"
refuse 'another phase than that of all' 5:34 "the same phase" "$grid
boundary: {boundary: {bloch: 1}, right: {bloch: 0.5}}"
printf '%s\n' "$grid" 'boundary: {boundary: {bloch: 1}, left: {bloch: 0.5}, right: {bloch: 0.5}}' \
  >phases.yaml
expect 0 'a phase of each axis' check phases.yaml
refuse 'walls that repeat a mesh' 4:11 'this mesh repeats itself by its own axes' "$flat
boundary: periodic"
refuse 'an axis that repeats itself at one end' 5:11 'let left and right be periodic' "$grid
boundary: {left: periodic}"
refuse 'all of it a conductor' 4:11 'all 286 edges are fixed, and nothing is unknown' "$solid
boundary: {all: pec}"
refuse 'a conductor around one box' 5:11 'nothing is unknown' "mesh: {generator: box, cells: [1, 1]}
field: maxwell
polarization: tm
method: yee
boundary: pec"

# ---- the mesh ----

printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n0.5 0.2 0\n0.5 -0.2 0\n3 0 1 2\n3 1 0 3\n' >thin.off
thin='mesh: {file: thin.off, space: 2}
field: maxwell'
refuse 'a negative dual cell' 1:7 'M_1 has the entry -1.05 at edge 0 .*dvi mesh tells how' "$thin"
refuse 'a negative dual edge' 1:7 'waves would grow' "$thin
polarization: tm"
refuse 'no dual cell' 1:7 'M_1 has the entry 0 ' 'mesh: {generator: kuhn, cells: [2, 2, 2]}
field: maxwell'
printf '%s\n' "$thin" 'star: whitney' 'method: leapfrog' 'until: 1' >whitney.yaml
expect 0 'a Whitney star helps' check whitney.yaml
refuse 'four dimensions' 1:7 'in at most 3 coordinates, and this one has 4' \
  'mesh: {generator: box, cells: [2, 2, 2, 2]}
field: maxwell
probes: {ear: {at: [0.1, 0.1, 0.1, 0.1]}}'
refuse 'a polarization in space' 4:15 'in two dimensions, and the mesh has 3' "$solid
polarization: te"
refuse 'another polarization' 4:15 'a polarization is te or tm' "$flat
polarization: left"

for key in size origin grading; do
  refuse "a $key of one axis" 1:$((41 + ${#key})) "$key has a number for each axis .* 2 axes" \
    "mesh: {generator: box, cells: [8, 8], $key: 2}
field: maxwell"
done

for line in 'size: [5, -0.25]' 'size: [5, 0]' 'grading: [3, 0]' 'size: 0'; do
  for generator in box kuhn; do
    refuse "$line of a $generator" '1:[0-9]*' "${line%%:*} is a finite number above 0, and cannot" \
      "mesh: {generator: $generator, cells: [8, 8], $line}
field: maxwell"
  done
done
refuse 'no cells along an axis' 1:32 'cells is a whole number from 1 to' \
  'mesh: {generator: box, cells: [0, 8]}
field: maxwell'
refuse 'no numbers of cells' 1:31 'cells is a list of one to four numbers' \
  'mesh: {generator: box, cells: []}
field: maxwell'
for words in '--cells 0,4' '--cells 4,-1' '--size 0,1' '--grading 0,1' '--size 1,-2'; do
  # shellcheck disable=SC2086 # an option and its value
  expect 2 "$words" mesh box $words
  says err "^dvi: mesh: $words: .* is not above 0$" "$words"
done
printf '%s\n' "$flat" 'method: avi' >avi.yaml
for words in '--fraction 0' '--fraction 1.5' '--fraction -1' '--span 0' '--span -1'; do
  # shellcheck disable=SC2086 # an option and its value
  expect 2 "$words" stability avi.yaml $words
  says err "^dvi: stability: $words: " "$words"
done

# ---- sources ----

refuse 'a dipole outside' 4:19 'the dipole is outside of the mesh' "$solid
sources: {a: {at: [2, 0, 0], moment: [0, 0, t]}}"
refuse 'a dipole outside of a grid' 5:11 'the dipole is at x = 3, outside of the grid' "$grid
sources: {a: {at: [3, 0], moment: [0, t]}}
boundary: {cpml: 2}"
refuse 'two coordinates' 4:19 "a dipole's place has 3 coordinates here" "$solid
sources: {a: {at: [0.5, 0.3], moment: [0, 0, t]}}"
refuse 'one component' 4:39 'a dipole has 2 components here' "$flat
sources: {a: {at: [0.5, 0.3], moment: t}}"
refuse 'a current and a moment' 4:14 'a dipole has a current or a moment' "$flat
sources: {a: {at: [0.5, 0.3], moment: [t, 0], current: [t, 0]}}"
refuse 'a density of one component' 4:24 'a density has 2 components here' "$flat
sources: {a: {density: 1, signal: t}}"
refuse 'a density in time' 4:25 'the time cannot stand in a density' "$flat
sources: {a: {density: [t, 0], signal: t}}"
refuse 'a signal in space' 4:40 'coordinates cannot stand in a function of time' "$flat
sources: {a: {density: [1, 0], signal: x*t}}"
refuse 'no signal' 4:14 'the source has no signal' "$flat
sources: {a: {density: [1, 0]}}"
refuse 'neither place nor density' 4:14 'a source is a dipole' "$flat
sources: {a: {signal: t}}"
refuse 'place and density' 4:14 'a source is a dipole' "$flat
sources: {a: {at: [0.5, 0.5], density: [1, 0], signal: t}}"
refuse 'no names' 4:10 'sources is a mapping' "$flat
sources: 3"
refuse 'a plane wave on simplices' 4:11 'plane waves are for .method: yee. on boxes' "$flat
sources: {a: {wave: [1, 0], from: [0.1, 0.1], to: [0.5, 0.5], signal: sin(t)}}"
refuse 'a plane wave without a box' 5:14 'a plane wave fills a box' "$grid
sources: {a: {wave: [1, 0], signal: sin(t)}}"
refuse 'a plane wave outside' 5:11 'a corner of the wave is at y = 1.6, outside of the grid' "$grid
sources: {a: {wave: [1, 0], from: [0.3, 0.3], to: [0.6, 1.6], signal: sin(t)}}"
refuse 'a plane wave along E' 5:10 'has E along its direction' "$grid
sources: {a: {wave: [1, 0], from: [0.3, 0.3], to: [0.6, 0.6], polarization: [1, 0, 0],
  signal: sin(t)}}"
refuse 'a plane wave to nowhere' 5:10 'needs a direction' "$grid
sources: {a: {wave: [0, 0], from: [0.3, 0.3], to: [0.6, 0.6], signal: sin(t)}}"

# ---- probes ----

refuse 'a probe outside' 4:18 'the probe is outside of the mesh' "$solid
probes: {a: {at: [2, 0, 0]}}"
refuse 'a probe outside of a grid' 5:10 'the probe is at x = 3, outside' "$grid
probes: {a: {at: [3, 0.5]}}
boundary: {cpml: 2}"
refuse 'a probe of two coordinates' 4:18 'a probe has 3 coordinates here' "$solid
probes: {a: {at: [0.2, 0.1]}}"
refuse 'a direction of two coordinates' 4:42 'a direction has 3 coordinates here' "$solid
probes: {a: {at: [0.2, 0.1, 0.1], along: [1, 0]}}"
refuse 'a probe of H' 4:39 'what a probe is of is E or B' "$solid
probes: {a: {at: [0.2, 0.1, 0.1], of: H}}"
refuse 'a probe of nothing' 4:13 'a probe is at a point' "$solid
probes: {a: {of: E}}"
refuse 'a flux through no part' 4:9 'part "lid", which the mesh has not' "$solid
probes: {a: {flux: lid}}"
refuse 'the energy of a wall' 4:9 'part "left", which has no cells' "$solid
probes: {a: {energy: left}}"
refuse 'a flux through a part of a grid' 5:10 "with 'cpml' there is a grid; write 'flux: {" "$grid
probes: {a: {flux: left}}
boundary: {cpml: 2}"
refuse 'a part of a large grid' 5:10 "or 'method: leapfrog', which makes a mesh" \
  'mesh: {generator: box, cells: [600, 600]}
field: maxwell
until: 1
method: yee
probes: {a: {flux: left}}'
refuse 'a probe in a layer' 5:10 "'a_x' lies in .*layers, .* y goes from 0.25 to 0.75" "$grid
probes: {a: {at: [0.5, 0.2]}}
boundary: {cpml: 2}"
refuse 'a flux whose bounds descend' 5:33 'the flux goes from x = 0.6 to 0.3' "$grid
probes: {ear: {at: [0.5, 0.5]}, a: {flux: {from: [0.6, 0.3], to: [0.3, 0.3]}}}
boundary: {cpml: 2}"
refuse 'a flux outside of a grid' 5:10 "a corner of the flux is at x = 1.5, outside" "$grid
probes: {a: {flux: {from: [0.6, 0.3], to: [1.5, 0.3]}}}
boundary: {cpml: 2}"
refuse 'a flux through a layer' 5:10 "'a' lies in absorbing layers, .* x goes from 0 to 0.75" "$grid
probes: {a: {flux: {from: [0.1, 0.3], to: [0.8, 0.5]}}}
boundary: {boundary: {cpml: 2}, left: pec}"
printf '%s\n' "$grid" 'probes: {a: {flux: {from: [0, 0.25], to: [0.75, 0.75]}}}' \
  'boundary: {boundary: {cpml: 2}, left: pec}' >between.yaml
expect 0 'a flux between the layers' check between.yaml
refuse 'two columns of one name' 4:36 "a column 'a_x' already" "$solid
probes: {a: {at: [0.2, 0.1, 0.1]}, a_x: {at: [0.2, 0.1, 0.1], along: [1, 0, 0]}}"
for name in t energy gauss charge divergence growth A_1 p_A_2; do
  refuse "a probe named $name" 4:10 "a column '$name' already" "$solid
probes: {$name: {at: [0.2, 0.1, 0.1], along: [1, 0, 0]}}"
done
refuse 'a probe of a grid named energy' 5:10 "a column 'energy' already" "$grid
probes: {energy: {at: [0.5, 0.5], along: [1, 0]}}
boundary: {cpml: 2}"
printf '%s\n' "$solid" 'probes: {A_loop: {at: [0.2, 0.1, 0.1], along: [1, 0, 0]}}' >loop.yaml
expect 0 'a probe named A_loop' check loop.yaml
refuse 'points of a surface' 4:18 'located among cells that fill their space' \
  'mesh: {generator: icosphere}
field: maxwell
until: 1
probes: {a: {at: [1, 0, 0]}}'

# ---- the start ----

refuse 'A and B' 4:10 'B is that of A; give one of them' "$solid
initial: {A: [0, 0, 0], B: [0, 0, 0]}"
refuse 'a B with a divergence' 4:10 'it has a divergence, passes through an electric wall' "$solid
initial: {B: [x, 0, 0]}"
refuse 'a flux through a closed plane' 4:10 'the whole flux of B through a region that .* be 0$' \
  "$flat
initial: {B: [1]}
boundary: pec"
refuse 'an E of one component' 4:14 'E has 3 components here' "$solid
initial: {E: 1}"
refuse 'the start of a wave' 4:11 "the start of a field has no 'u'; it has E, B and A" "$solid
initial: {u: 1}"
refuse 'a start that is not finite' 4:10 'the start is not finite at (0.00' "$solid
initial: {E: [1/(x - x), 0, 0]}"
refuse 'a grid from A' 5:10 'a grid starts from E and B, not from A' "$grid
initial: {A: [x, 0]}
boundary: {cpml: 2}"

# ---- waves and Maxwell's fields ----

for line in 'source: x' 'potential: u^2' 'solve: {mean: 0}'; do
  section=${line%%:*}
  refuse "$section" 4:$((${#section} + 3)) "'$section' is of 'field: wave'" "$solid
$line"
done
refuse 'sources of a wave' 3:10 "'sources' is of 'field: maxwell'" 'mesh: {generator: disk}
field: wave
sources: {a: {at: [0, 0], moment: 1}}'
refuse 'a polarized wave' 3:15 "'polarization' is of 'field: maxwell'" 'mesh: {generator: disk}
field: wave
polarization: te'
refuse 'friction of a march' 5:10 "marches of fields have no damping" "$flat
method: leapfrog
damping: 0.1"

# ---- steps and methods ----

for fraction in 1 1.5; do
  refuse "a fraction of $fraction" 5:7 "below 1, and is $fraction" "$solid
method: leapfrog
step: {fraction: $fraction}"
done
refuse 'a fraction of 0' 5:18 'fraction must be positive, and is 0' "$solid
method: leapfrog
step: {fraction: 0}"
refuse 'a step of another kind' 5:8 "a step has no 'part'; it has fraction" "$solid
method: leapfrog
step: {part: 0.5}"
refuse 'a step by a word' 5:7 "'auto' is no parameter; a step is a number, or" "$solid
method: leapfrog
step: auto"
refuse 'a list of steps' 5:7 "a step is a number, or '{fraction: 0.5}'" "$solid
method: leapfrog
step: [0.1, 0.2]"
refuse 'a step beyond the bound' 5:7 'the step 0.5 is not below the bound 0.1154.*near (0.8' "$solid
method: leapfrog
step: 0.5"
refuse "yee beyond its bound" 5:7 'the step 0.5 is not below the bound 0.1154.* at (0' "$solid
method: yee
step: 0.5"
refuse 'tents of one step' 5:7 'they have no common step' "$flat
method: tents
step: 0.01"
refuse 'tents over boxes' 4:9 'the mesh has boxes' "$solid
method: tents"
refuse 'tents of a Whitney star' 5:7 'the star is not circumcentric' "$flat
method: tents
star: whitney"
refuse 'own steps of a Whitney star' 5:7 'the star is not diagonal' "$flat
method: avi
star: whitney"
refuse 'yee on simplices' 4:9 'on simplices the same method is called bossavit-kettunen' "$flat
method: yee"
for method in leapfrog:x=1 avi:classes=perhaps tents:seed=-1; do
  refuse "$method" 4:9 'option' "$flat
method: $method"
done
for star in whitney barycentric; do
  refuse "a $star star of yee" 5:7 'yee has no star: leave it out, or take leapfrog' "$grid
star: $star"
  expect 0 "leapfrog in place of yee with a $star star" run wrong.yaml --method leapfrog --h 0.01
  sed 's/yee/leapfrog/' wrong.yaml >star.yaml
  expect 2 "a $star star by yee" run star.yaml --method yee --h 0.01
  says err 'star.yaml:5:7: .*yee has no star' "a $star star by yee"
done
refuse 'a star of a grid' 6:7 'yee has no star' "$grid
boundary: {cpml: 2}
star: whitney"
refuse 'an option of yee' 4:9 'has no options' "$solid
method: yee:x=1"
refuse 'an option of a grid' 3:9 'yee has no options' 'mesh: {generator: box, cells: [8, 8]}
field: maxwell
method: yee:x=1
boundary: {cpml: 2}'
for method in leapfrog verlet; do
  printf '%s\n' "$flat" "method: $method" 'step: 0.01' | sed '/^until/d' >bare.yaml
  expect 2 "no end of $method" run bare.yaml
  says err 'has no section until, so that --t-end is needed' "no end of $method"
done
printf '%s\n' "$flat" 'method: verlet' >bare.yaml
expect 2 'no step' run bare.yaml
says err "bare by verlet needs a step, by --h or in the scene, as in 'step: {fraction" 'no step'
printf '%s\n' "$flat" 'step: 0.01' >bare.yaml
expect 2 'no method' run bare.yaml
says err 'is missing, for example --method leapfrog' 'no method'
expect 2 'a method that is none' run bare.yaml --method fdtd
says err "unknown method 'fdtd'; fields have leapfrog, yee" 'a method that is none'
refuse 'a method that is none' 4:9 "unknown method 'leapfrg'.*(did you mean 'leapfrog'?)" "$flat
method: leapfrg"
printf '%s\n' "$flat" 'method: leapfrog' 'step: 0.01' \
  'sources: {a: {density: [1, 0], signal: log(t - 1)}}' >pole.yaml
expect 1 'a signal that is not finite' check pole.yaml
says err 'pole.yaml:6:40: log(t - 1), .* is not finite, at t = ' 'a signal that is not finite'

# ---- options ----

printf '%s\n' "$solid" 'method: leapfrog' 'step: 0.05' >run.yaml
# no OPTION... WORDS: require that a run does not take the option.
no() {
  words=$1
  shift
  for method in leapfrog yee; do
    expect 2 "$* of $method" run run.yaml --method $method "$@"
    says err "$words" "$* of $method"
  done
}
for option in verify project; do no 'a march of a field' --$option; done
no 'a march of a field' --momenta 1,2
no 'a march of a field' --time-transform arclength
no 'a march of a field' --step-control arclength
no 'a march of a field' --events hits.csv
no 'a march of a field' --alarm energy:1
no 'goes forward' --h 0
no 'goes forward' --h -0.1
no 'goes forward' --t-end -1
no 'finite number' --h nan
no 'whole number' --threads 0
no 'ends in .pvd' --pvd fields.vtu
no 'needs --checkpoint' --checkpoint-every 3
no "no column 'ear'; it has energy" --columns ear
no "column 'energy' is asked for twice" --columns energy,energy
for method in leapfrog yee verlet; do
  expect 0 "the column t of $method" run run.yaml --method $method --h 0.05 --columns t,energy
  says out '^t,energy$' "the column t of $method"
done
refuse 'a column that is none' 5:20 "no column 'loudness'; it has energy, .* and ear" "$flat
probes: {ear: {of: B, at: [0.5, 0.3]}}
report: {columns: [loudness]}"
refuse 'a column of no unknown' 4:20 "no column 'A_999'" "$flat
report: {columns: [A_999]}"
for method in leapfrog yee; do
  expect 1 "a step of $method beyond the bound" run run.yaml --method $method --h 3
  says err 'the step 3 is not below the bound 0.1154.* \(near\|at\) (0' 'the bound and a place'
done
expect 2 'threads of a mechanical method' run run.yaml --method verlet --threads 2
says err 'for marches of fields' 'threads of a mechanical method'
expect 2 'a march of no field' run kepler --method leapfrog
expect 2 'monitors of a march' explain run.yaml --time-transform arclength
says err 'follow no monitor' 'monitors of a march'
expect 2 'more modes than there are' modes run.yaml --count 100000
says err 'take 1 to ' 'more modes than there are'
printf 't,q\n' >series.csv
for i in $(seq 0 99); do echo "$i,$((i % 7))"; done >>series.csv
for band in 1000:2000 1:2000 1000: -1:2; do
  expect 2 "the band $band" spectrum series.csv --band $band
  says err 'no band from .* tell frequencies from 0 to 3.14' "the band $band"
done
sed 's/,.*/,1/; s/^t.*/t,q/' series.csv >constant.csv
expect 1 'constant rows' spectrum constant.csv
printf '%s\n' "$grid" 'boundary: {cpml: 2}' >grid.yaml
for command in modes stability solve explain order bench 'order --method verlet'; do
  # shellcheck disable=SC2086 # the words of a command
  set -- $command
  subcommand=$1
  shift
  expect 2 "$subcommand of a grid" "$subcommand" grid.yaml "$@"
  says err "needs a mesh, and with cpml there is none: take 'absorbing'$" "$subcommand of a grid"
done
expect 2 'a grid by verlet' run grid.yaml --method verlet --h 0.01
says err "cpml only 'method: yee' takes" 'a grid by verlet'
printf '%s\n' "$flat" 'step: 0.01' 'initial: {E: [y, 0]}' >square.yaml
for command in order bench; do
  expect 2 "$command of tents" $command square.yaml --method tents:least=0.5
  says err "^dvi: $command: tents have no common step" "$command of tents"
done
printf '%s\n' 'parameters: {n: 4}' "$flat" 'step: 0.01' | sed 's/4, 4/n, n/' >scaled.yaml
expect 2 'a scale of marches' bench scaled.yaml --method leapfrog --scale n=4,6
says err 'order, and bench without --scale; a mechanical method' 'a scale of marches'
finish
