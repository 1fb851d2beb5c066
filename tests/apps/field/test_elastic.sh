#!/bin/sh
# Elastic solids in the commands: run, order, explain, modes, output, refusals.
# Usage: test_elastic.sh DVI
. "$(dirname "$0")/../check.sh"

cat >block.yaml <<END
# a free block, graded along x, that turns and stretches
mesh: {generator: kuhn, cells: [2, 2, 2], size: [1, 1, 1], grading: 2}
field: elastic
materials: {all: {law: neo-hookean, lambda: 1, mu: 1, rho: 1}}
initial: {u: "[0, 0, 0]", u': "[0.2*y, -0.1*z, 0.15*x*z]"}
probes:
  tip: {of: x, at: [1, 1, 1]}
  left: {of: kinetic}
  mises: {of: von_mises, at: [0.5, 0.5, 0.4]}
method: avi
step: {fraction: 0.5}
until: 1
END
expect 0 'a march' run block.yaml
says out '^t,energy,momentum_x,.*,angular_z,tip_x,tip_y,tip_z,left,mises$' 'momenta and probes'
expect 0 'equal steps' run block.yaml --method verlet --final --columns kinetic,stored,load,growth
says out '^t,kinetic,stored,load,growth$' 'what marches observe'
expect 0 'digits' run block.yaml --method galerkin:degree=4 --h 0.1 --final \
  --columns tip_x,tip_y,tip_z
says out '^1,1.12124089.*,0.88080845.*,1.07901422' 'the digits of another program'
expect 0 'an order' order block.yaml --t-end 0.2 --method avi --method verlet
says out '^avi: claimed order 2, fitted [12]\.[0-9]* .*: ok' 'avi has order 2'
says out '^verlet: claimed order 2, fitted [12]\.[0-9]* .*: ok' 'verlet has order 2'
expect 0 'modes' modes block.yaml --count 2 --vtu modes.vtu
says out '^left out: 6 of frequency zero$' 'motions of the whole block'
says modes.vtu 'Name="mode_2" NumberOfComponents="3"' 'shapes'
expect 0 'what a march costs' explain block.yaml
says out '^solid: 81 unknown displacements, 0 given; mass 1,' 'the solid'
says out '^cost: .* evaluations of cells' 'cells against those of equal steps'

# Steps of several lengths can be in resonance with vibrations, which shows before a run.
sed 's/grading: 2/grading: 3.5/' block.yaml >graded.yaml
expect 0 'stable steps' stability graded.yaml
says out '^  avi  *3 classes of steps, .* 1\.000000000 .*  stable$' 'no growth'
expect 0 'steps by class' explain graded.yaml
says out '^ *step  *cells  evaluations in a unit of time$' 'classes'
says out '^ *0.0175439  *24  1368$' 'the shortest steps'
says out '^ *0.0701754  *24  342$' 'the longest ones'
expect 0 'a resonance' stability graded.yaml --fraction 0.9 --method avi --method avi:classes=no
says out '^  avi  *3 classes of steps, .* 1\.036976866 .*  grows$' 'growth in classes'
says out '^  avi:classes=no .* without a common period .*  grows$' 'growth of free steps'
expect 2 'equal steps' stability block.yaml --method verlet
says err 'verlet has equal steps, which are stable below their bound' 'why not'
expect 0 'laws' check block.yaml
says out '^laws of avi .* momentum .*, angular .*, energy .*(bounded)$' 'momenta stay'

# Nodes stand where they are, in files of marches and of mechanical methods alike.
expect 0 'frames of a march' run block.yaml --final --pvd march.pvd
expect 0 'frames of a method' run block.yaml --method midpoint --h 0.1 --final --pvd state.pvd
for file in march_000000.vtu state_000000.vtu; do
  says $file 'NumberOfPoints="27" NumberOfCells="48"' 'nodes and cells'
  says $file 'Name="stress" NumberOfComponents="9"' 'stresses'
  says $file 'Name="von_mises" NumberOfComponents="1"' "von Mises' stresses"
  says $file 'Name="velocity" NumberOfComponents="3"' 'velocities'
done
expect 0 'a picture' plot march_000000.vtu --field von_mises --out block.svg

# A run that is cut in two has the same bits.
expect 0 'a whole run' run block.yaml --h 0.04 --final --out whole.csv
expect 0 'a first half' run block.yaml --h 0.04 --t-end 0.4 --final --out half.csv \
  --checkpoint half.state
expect 0 'a second half' run block.yaml --h 0.04 --final --out rest.csv --resume half.state
cmp -s whole.csv rest.csv || fail 'a resumed run differs'

cat >drop.yaml <<END
# a block that falls on a floor
mesh: {generator: kuhn, cells: [2, 2, 2], origin: [0, 0, 0.1]}
field: elastic
materials: {all: {law: svk, young: 100, poisson: 0.3}}
initial: {u': [0.5, 0, -2]}
loads: {gravity: [0, 0, -9.81]}
obstacles:
  floor: {plane: {point: [0, 0, 0], normal: [0, 0, 1]}, restitution: 0.5, friction: 0.2}
method: avi
step: {fraction: 0.4}
until: 0.2
report: {every: 1000, columns: [hits, energy, momentum_z]}
END
expect 0 'a fall' run drop.yaml --final
says out '^0.2[^,]*,[1-9]' 'hits'

# Of parts that lie in each other the last material counts, for gravity, too: masses 3/2 and 1/2.
cat >two.msh <<END
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$PhysicalNames
2
2 1 "core"
2 2 "rim"
\$EndPhysicalNames
\$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
\$EndNodes
\$Elements
2
1 2 2 1 1 1 2 3
2 2 2 2 1 1 3 4
\$EndElements
END
cat >two.yaml <<END
mesh: {file: two.msh}
field: elastic
materials: {all: {law: svk, lambda: 1, mu: 1}, core: {law: linear, young: 1, poisson: 0, rho: 3}}
initial: {u: [0, 2]}
loads: {gravity: [0, -1]}
probes: {of_core: {of: load, part: core}, of_all: {of: load}}
method: verlet
step: {fraction: 0.5}
until: 0.1
END
expect 0 'two materials' run two.yaml --columns of_core,of_all
says out '^0,3,4$' 'their weights'
sed 's/all: {law: svk, lambda: 1, mu: 1}, //' two.yaml >part.yaml
expect 2 'a cell without a material' run part.yaml
says err '^dvi: part.yaml:3:12: .*triangle .* has no material' 'the cell'

# Two tetrahedra with a common edge have the motions of one body, and turn about the edge.
cat >edge.msh <<END
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$Nodes
6
1 0 0 0
2 0 0 1
3 1 0 0
4 0 1 0
5 -1 0 0
6 0 -1 0
\$EndNodes
\$Elements
2
1 4 2 1 1 1 2 3 4
2 4 2 1 1 1 2 5 6
\$EndElements
END
cat >edge.yaml <<END
mesh: {file: edge.msh}
field: elastic
materials: {all: {law: svk, young: 10, poisson: 0.3}}
method: avi
step: {fraction: 0.5}
until: 1
END
expect 0 'modes of a hinge' modes edge.yaml --count 4
says out '^left out: 6 of frequency zero$' 'motions of one body'
says out '^ *1  *-\{0,1\}[0-9.]*e-1[0-9]  *[0-9]' 'a turn about the edge'
says out '^ *2  *15.3846' 'the lowest vibration'

# What is given agrees with the rest of a scene.
cat >press.yaml <<END
mesh: {generator: kuhn, cells: [2, 2]}
field: elastic
materials: {all: {law: svk, young: 10, poisson: 0.3}}
boundary: {bottom: {fixed: {y: -t}}}
obstacles: {floor: {plane: {point: [0, -0.1], normal: [0, 1]}, restitution: 0}}
method: avi
step: 0.01
until: 0.3
END
expect 1 'a node that is driven into a floor' run press.yaml
says err 'avi: at t = 0.1[0-9]*: .* moves vertex 0 into the obstacle "floor": let it stop' 'where'
expect 1 'the same by a mechanical method' run press.yaml --method moreau-jean
says err 'moreau-jean: step 1[01] .* moves vertex 0 into the obstacle "floor"' 'where'
sed 's/-t}}}/"-min(t, 0.1)"}}}/' press.yaml >stop.yaml
expect 0 'a node that stops on a floor' run stop.yaml
sed 's/y: -t/x: 0/; s/^method:/initial: {u: "[0.1*y, 0]", u'"'"': [1, 0]}\n&/' \
  press.yaml >shear.yaml
expect 0 'a start that agrees with its boundary' check shear.yaml
sed 's/0.1\*y/0.1 + y/' shear.yaml >torn.yaml
expect 2 'a start that tears nodes apart' check torn.yaml
says err '^dvi: torn.yaml:6:15: the start moves node 0 by 0.1 along x, .* gives 0;' 'the node'
sed 's/^boundary:.*/boundary: {bottom: fixed}\nloads: {bottom: {traction: [1, 0]}}/' \
  press.yaml >idle.yaml
expect 2 'a load on what is held' check idle.yaml
says err '^dvi: idle.yaml:5:8: .*part "bottom" does nothing, .* all displacements' 'the load'

# Slips have their remedies.
slip() { # NAME SED-COMMAND WORDS: what a slip in drop.yaml is told
  sed "$2" drop.yaml >slip.yaml
  expect 2 "$1" check slip.yaml
  says err "$3" "$1"
}
slip 'gravity' 's/gravity/gravitty/' "slip.yaml:6:9: a load is 'gravity', .*mean gravity?"
slip 'a force on a side' 's/{gravity.*/{left: {force: [0, 0, 1]}}/' "'left' has no volume"
slip 'a law' 's/svk/neohookean/' 'a law is linear, svk, .*; did you mean neo-hookean?'
slip 'a probe' 's/^method/probes: {c: {of: stres, at: [0, 0, 0.1]}}\n&/' 'did you mean stress?'
slip 'gravity in a plane' 's/-9.81/0, -9.81/' 'gravity has 3 coordinates here, not 4'

# The scenes that are shipped. The bar has its own frequency of 1.4.
scenes=$(dirname "$0")/../../../apps/scenes/solids
expect 0 'a block that bounces' run "$scenes/bouncing-block.yaml" --final
says out '^1,0\.2[0-9.]*,.*,1[0-9][0-9],0\.96' 'hits, and how far it slides'
expect 0 'a bar that is shaken' run "$scenes/shaken-bar.yaml" --final
says out '^10,.*,-\{0,1\}0.0' 'its end'

# What there is not is refused.
expect 2 'another march' run block.yaml --method leapfrog
says err 'solids have avi and verlet' 'which marches there are'
expect 2 'an option' run block.yaml --method avi:speed=2
says err 'speed' 'the option'
expect 1 'a step beyond its bound' run block.yaml --h 3
says err 'the least bound is' 'the bound'
sed 's/step: .*/step: 3/' block.yaml >long.yaml
expect 2 'a step of the scene' run long.yaml
says err '^dvi: long.yaml:11:7: .* the least bound is' 'its place'
expect 2 'a map' run block.yaml --map x.svg
says err 'is a solid' 'no map of space'
expect 2 'a method without a fast part' run block.yaml --method imex --h 0.05
says err "write 'method: imex' there" 'what helps'
sed 's/^method: .*/method: imex/' block.yaml >imex.yaml
expect 0 'a fast part' run imex.yaml --h 0.05 --final --columns tip_x
says out '^1,1.12' 'the motion'
expect 2 'a static state' solve block.yaml
says err 'not for solids' 'no static state'
expect 2 'a C program' emit-c block.yaml --out block.c
says err 'is a field' 'no C program'
finish
