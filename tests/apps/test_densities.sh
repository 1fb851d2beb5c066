#!/bin/sh
# Scenes of fields with densities in the commands: run, explain, solve, modes, order, sweep; files,
# refusals.
# Usage: test_densities.sh DVI
. "$(dirname "$0")/check.sh"

cat >pulse.yaml <<END
parameters: {c: 1}
domain: {x: [0, 2*pi]}
space: fem:degree=2,cells=30
fields: {u: scalar}
density: u'^2/2 - d(u,x)^2/2 - c*(1 - cos(u))
boundary: periodic
initial: {u: 1.5 + 0.5*cos(x), u': 0.3*sin(x)}
probes: {ear: u(0), mean: {integral: u/(2*pi)}}
method: verlet
step: {fraction: 0.5}
until: 4
sweep: {c: [0, 1]}
END

expect 0 'a run' run pulse.yaml --final
says out '^t,energy,ear,mean$' 'energy and probes are the columns'
about out ear -1.4451 1e-3
expect 0 'a plot' run pulse.yaml --out rows.csv --plot pulse.svg
says pulse.svg 'ear' 'probes are drawn'
expect 0 'an explanation' explain pulse.yaml
says out 'kinetic of 1 summand, quadratic of 2 summands, potential of 1 summand' 'the parts'
says out '60 functions' 'the space'
says out 'verlet is stable below h = 0.0' 'the longest step'
expect 0 'a check' check pulse.yaml
expect 0 'orders' order pulse.yaml --method midpoint --t-end 0.5
says out 'claimed order 2, fitted .*: ok' 'the order'
expect 0 'a sweep' sweep pulse.yaml --out sweep.csv
says sweep.csv '^c,status,steps,t,energy,ear,mean,energy_error$' 'a sweep has no coordinates'
# without a potential the mean moves uniformly, here not at all
awk -F, '$1 == 0 { d = $7 - 1.5 } END { exit d*d > 1e-20 }' sweep.csv || fail 'the mean is 1.5'
expect 0 'modes' modes pulse.yaml --count 3 --csv -
about out eigenvalue 2 1e-4
expect 2 'C' emit-c pulse.yaml --out -
says err 'is a field, which C files do not have' 'the reason'
expect 2 'no method' run pulse.yaml --method leapfrog
sed '/^method/d' pulse.yaml >none.yaml
expect 2 'no method' run none.yaml
says err 'for example --method verlet' 'a method is named'

cat >kink.yaml <<END
domain: {x: [0, 8]}
space: fem:degree=3,cells=20
fields: {u: scalar}
density: -d(u,x)^2/2 - (u^2 - 1)^2/4
boundary: {left: fixed, right: {fixed: 1}}
initial: {u: tanh(x/2)}
probes: {half: {integral: "d(u,x)^2/2 + (u^2 - 1)^2/4"}}
END
expect 0 'a static state' solve kink.yaml --csv kink.csv
says out 'half  *0.47140' 'half of a kink has the energy sqrt(2)/3'
says kink.csv '^x,u$' 'the columns of a static state'
expect 2 'a static state moves' run kink.yaml --method verlet --h 0.1 --t-end 1
says err 'dvi solve finds its static state' 'the command that does'

sed "s/density: /&u'^2\/2 /" kink.yaml >moving.yaml
expect 0 'modes of a kink' modes moving.yaml --static --count 1 --csv - --shapes shapes.csv
about out eigenvalue 1.5 1e-3
says shapes.csv '^x,u$' 'the shape'

cat >drum.yaml <<END
mesh: {generator: disk, cells: 8}
space: fem:degree=2
fields: {u: scalar}
density: u'^2/2 - dot(grad(u),grad(u))/2 + u
boundary: {rim: fixed}
method: verlet
step: {fraction: 0.5}
until: 1
report: {every: 20}
END
expect 0 'a static state on a mesh' solve drum.yaml --vtu drum.vtu
says drum.vtu 'Name="u"' 'its values'
expect 0 'frames' run drum.yaml --pvd drum.pvd
says drum.pvd 'drum_000001.vtu' 'the second frame'
expect 0 'modes on a mesh' modes drum.yaml --count 1 --csv - --vtu modes.vtu
about out eigenvalue 5.8 1e-2
expect 2 'a state of waves' modes pulse.yaml --near

# the oscillator's energies n + 1/2
cat >well.yaml <<END
domain: {x: [-8, 8]}
space: fem:degree=3,cells=40
schroedinger: {potential: x^2/2}
boundary: fixed
END
expect 0 'energies' modes well.yaml --count 3 --csv - --shapes states.csv
about out eigenvalue 2.5 1e-5
says states.csv '^x,psi_re_mode_1,psi_im_mode_1,.psi.^2_mode_1,psi_re_mode_2' 'the states'

cat >plane.yaml <<END
domain: {x: [0, 2*pi]}
space: fourier:modes=4
schroedinger: {interaction: 1.5}
boundary: periodic
initial: {psi: "[0.7*cos(2*x), 0.7*sin(2*x)]"}
probes: {re: {of: re(psi), at: 0}, norm: {integral: "dot(psi,psi)"}}
step: 0.05
until: 2
END
expect 0 'a plane wave' run plane.yaml --method vprk:nodes=3 --final
about out re 0.4810315032818 1e-6
about out norm 3.0787608005180 1e-10
expect 2 'a method is needed' run plane.yaml
says err 'for example --method vprk' 'a method for one-forms'

# ---- densities with a wrong sign ----

sed "s/^density.*/density: u'^2\/2 + d(u,x)^2\/2/; s/^step.*/step: 0.01/; s/^sweep.*//" \
  pulse.yaml >wrong.yaml
expect 0 'a field that grows' run wrong.yaml --method midpoint --h 0.01 --t-end 0.1 --final
says err 'run: the energy is not bounded from below: the least omega^2 .* is -' 'a warning'
expect 0 'a field that grows' check wrong.yaml --method midpoint
says err 'check: the energy is not bounded from below' 'a warning'
says out "potential 'quadratic' is not bounded from below: its least omega^2 is -" 'the fact'
sed "s/^density.*/density: (-u'^2 - d(u,x)^2)\/2/; s/^step.*/step: 0.01/; s/^sweep.*//" \
  pulse.yaml >kinetic.yaml
expect 0 'a negative mass' check kinetic.yaml --method midpoint
says err 'check: the energy is not bounded from below.*is a sign of the density wrong' 'a warning'
expect 0 'a negative mass' run kinetic.yaml --method verlet --final
says err 'is a sign of the density wrong' 'a warning'
! grep -q 'try --h' err || fail 'no step helps a field that grows'
# Higgs: a potential may hold what grows.
sed "s/^density.*/density: u'^2\/2 - d(u,x)^2\/2 + u^2\/2 - u^4\/4/; s/^sweep.*//" \
  pulse.yaml >wells.yaml
expect 0 'wells' run wells.yaml --final
[ ! -s err ] || fail 'a field between wells needs no warning'
expect 0 'wells' explain wells.yaml
says out 'its least omega^2 is -1, whose mode grows as exp(1 t)' 'the fact'

# ---- lumped masses and ends that move ----

cat >two.yaml <<END
domain: {x: [0, 1]}
space: fem:degree=2,cells=10,lumped=yes
fields: {u: scalar, v: scalar}
density: u'^2/2 + v'^2/2 - d(u,x)^2/2 - (d(v,x) + u)^2/2
boundary: {left: {u: {fixed: sin(t)}, v: free}}
method: verlet
step: 0.001
until: 0.01
END
expect 0 'an end that moves beside one that is free' run two.yaml --final

# ---- without a method ----

sed '/^method/d' two.yaml >bare.yaml
expect 0 'a field alone' explain bare.yaml
says out '^density: kinetic of 2 summands' 'what was found'
says err 'with --method, or a section method in the scene' 'what else there is'
sed 's/^step/method: vprk\nstep/; s/modes=4/modes=160/' plane.yaml >many.yaml
expect 2 'vprk with many modes' run many.yaml --t-end 0.1
says err 'split:order=4, gauss:stages=2 and midpoint take fields of any size' 'what takes them'

finish
