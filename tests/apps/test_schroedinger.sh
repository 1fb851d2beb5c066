#!/bin/sh
# Schroedinger's equation in the commands: steps that keep the norm, stationary and ground states.
# Usage: test_schroedinger.sh DVI
. "$(dirname "$0")/check.sh"

cat >plane.yaml <<END
domain: {x: [0, 2*pi]}
space: fourier:modes=4
schroedinger: {interaction: 1.5}
boundary: periodic
initial: {psi: "[0.7*cos(2*x), 0.7*sin(2*x)]"}
probes: {re: {of: re(psi), at: 0}}
method: midpoint
step: 0.05
until: 2
END
expect 0 'a plane wave' run plane.yaml --final
says out '^t,norm,energy,position_x,momentum_x,re$' 'what is measured'
# 0.7 cos(w t), with (2/dt) tan(w dt/2) = 2 + beta a^2 cos^2(w dt/2), of dt = 0.05
about out re 0.4731988818658 1e-12
about out norm 3.0787608005180 1e-13
about out momentum_x 6.1575216010360 1e-12
expect 0 'parts of the energy' run plane.yaml --columns kinetic --final
# 0.7 cos(2.735 t)
expect 0 'four stages' run plane.yaml --final --method gauss:stages=4
about out re 0.4810315032818 1e-12
expect 0 'orders' order plane.yaml --t-end 0.5
says out 'midpoint: claimed order 2, fitted 2.00 .*: ok' 'order 2'
expect 0 'orders' order plane.yaml --t-end 0.5 --method gauss:stages=2
says out 'claimed order 4, fitted [34].[09]. .*: ok' 'order 4'
cat >shaken.yaml <<END
domain: {x: [-15, 15]}
space: fourier:modes=40
schroedinger: {potential: x^2/2 - 0.3*x*sin(0.7*t)}
boundary: periodic
initial: {psi: "[exp(-x^2/2)/pi^0.25, 0]"}
method: split:order=4
step: 0.02
until: 10
END
expect 0 'a judge of many modes' order shaken.yaml --t-end 0.5 --levels 4
says out 'claimed order 4, fitted 4.00 .*: ok' 'the order of splitting'
says out 'judge at t = 0.5: two runs of gauss, stages 6' 'marches judge marches'
expect 2 'digits of a march' run shaken.yaml --verify
says err 'run: --verify is .* with those of --h at half the step' 'what to do instead'
expect 0 'a check' check plane.yaml
says out 'norm [0-9.]*e' 'the norm is measured'
expect 0 'a method of one-forms' run plane.yaml --method dg --final
says err 'dg does not keep the norm' 'a warning'
expect 0 'a method that keeps the norm' run plane.yaml --method vprk --final
if grep -q norm err; then fail 'no warning'; fi
sed 's/^probes.*/probes: {size: {integral: "dot(psi,psi)"}}/' plane.yaml >size.yaml
for method in vprk vprk:nodes=3,tableau=lobatto-iiie vprk:projection=post; do
  expect 0 "the norm by $method" run size.yaml --method $method --final --columns size
  about out size 3.0787608005180 1e-13
  expect 0 "a check of $method" check size.yaml --method $method
  if grep -q norm err; then fail "a warning of $method"; fi
done
expect 0 'a check of a method that loses the norm' check size.yaml --method dg
says err 'check: dg does not keep the norm' 'the warning of a check'
expect 2 'a check of verlet' check size.yaml --method verlet
says err 'verlet: the system declares a one-form' 'why verlet is refused'
expect 2 'phases at points' run plane.yaml --method split
says err 'points=2K+1' 'how many points there must be'
sed 's/^method.*/method: split:order=4/' plane.yaml >split.yaml
expect 0 'a scene that splits' run split.yaml --final
about out re 0.4810315032818 1e-12
sed 's/^method.*/method: split:order=3/' plane.yaml >odd.yaml
expect 2 'an odd order' run odd.yaml
says err '^dvi: odd.yaml:7:9: .*an even number from 2 to 6' 'the orders that there are'
sed 's/^domain.*/domain: {x: [0, 1]}/;s/fourier:modes=4/fem:cells=9/
  s/^boundary.*/boundary: {left: {robin: 2}}/;/^initial/d' plane.yaml >robin.yaml
expect 2 'a boundary with data' run robin.yaml
says err '^dvi: robin.yaml:4:11: .*psi = 0 on the boundary' 'the boundary that there may be'
expect 2 'a step of waves' run plane.yaml --method verlet
says err 'verlet does not keep the norm of the wave function; midpoint, gauss:stages=2' 'what does'
[ "$(wc -l <err)" -eq 1 ] || fail 'one sentence on verlet'
sed 's/fourier:modes=4/fourier:modes=200/;s/, points=[^,]*//' plane.yaml >fine.yaml
expect 2 'vprk of many modes' run fine.yaml --method vprk
says err 'vprk needs the Hessian' 'what it needs'
[ "$(wc -l <err)" -eq 1 ] || fail 'one sentence on vprk'
expect 2 'verlet of many modes' run fine.yaml --method verlet
says err 'midpoint, gauss:stages=2 and split:order=4 do$' 'without vprk'
expect 2 'a static state' modes plane.yaml --static
says err '^dvi: modes: --static is not for schroedinger' 'why not'
expect 2 'states near a number' modes plane.yaml --near 1
says err '^dvi: modes: --near is not for schroedinger' 'why not'
sed 's/psi: .*}/psi: [0, 0]}/' plane.yaml >empty.yaml
expect 0 'a wave function of zero' solve empty.yaml
says err "'solve: ground'" 'a hint'
expect 2 'paths of polynomials' run plane.yaml --method galerkin:degree=3,quadrature=lobatto
says err 'lobatto does not keep the norm of the wave function; midpoint, gauss:stages=2' 'what does'

cat >mathieu.yaml <<END
domain: {x: [0, 2*pi]}
space: fourier:modes=12
schroedinger: {potential: cos(2*x)}
boundary: periodic
END
expect 0 'stationary states' modes mathieu.yaml --count 3 --csv - --shapes shapes.csv
# half of Mathieu's characteristic values
about out eigenvalue 0.9295540362572 1e-12
says out '^2,-0.05512440849' 'each state is there once'
says shapes.csv '^x,psi_re_mode_1,psi_im_mode_1' 'their shapes'

cat >noise.yaml <<END
domain: {x: [0, 2*pi]}
space: fourier:modes=16,points=33
schroedinger: {interaction: 4}
boundary: periodic
initial: {psi: "[1, 0]"}
method: split
step: 0.0236
until: 0.1
END
expect 0 'steps beyond the bound of a wave' run noise.yaml --final
says err 'beyond the bound 0.0231 of the density at t = 0; noise may grow' 'a warning'
expect 0 'an explanation' explain noise.yaml
says out 'beyond the bound 0.0231 of the start' 'the bound'
expect 0 'shorter steps' run noise.yaml --final --h 0.023
if grep -q bound err; then fail 'a warning of steps below the bound'; fi

cat >trap.yaml <<END
parameters: {beta: 10}
domain: {x: [-10, 10]}
space: fourier:modes=63
schroedinger: {potential: x^2/2, interaction: beta}
boundary: periodic
probes: {width: {integral: "x^2*dot(psi,psi)"}}
solve: ground
END
expect 0 'a ground state' solve trap.yaml --csv state.csv
says out '^mu  *3.1072430894' 'the chemical potential'
says out '^energy  *1.9471272150' 'the energy'
says out '^width ' 'the probes'
says state.csv '^x,psi_re,psi_im,.psi.^2$' 'its values'
expect 0 'more of it' solve trap.yaml --set beta=100
says out '^mu  *14.13428708' 'the chemical potential'
sed 's/beta: 10/beta: 5/;s/ground/{ground: 2}/' trap.yaml >two.yaml
expect 0 'another norm' solve two.yaml
says out '^mu  *3.1072430894' 'the same state but for its size'
cat >wells.yaml <<END
domain: {x: [-7, 7]}
space: fem:degree=6,cells=30
schroedinger: {potential: (x^2-4)^2/8, interaction: -0.1}
boundary: {left: fixed, right: fixed}
solve: ground
END
expect 0 'a state that attraction has moved to one side' solve wells.yaml
says out '^mu  *0.87371925' 'the chemical potential of one side'
says out '^branch  *of less energy .* a saddle beyond 0.91' 'the branch'
cat >plate.yaml <<END
domain: {x: [0, 8]}
space: fem:degree=6,cells=20
schroedinger: {potential: x^2/2, interaction: 50, radial: 2}
boundary: {right: fixed}
solve: ground
END
expect 0 'a ground state that is round' solve plate.yaml
says out '^mu  *4.143005' 'the chemical potential in a plane'
says out '^energy  *2.896031' 'the energy in a plane'
sed 's/interaction: 50/interaction: -6/' plate.yaml >dense.yaml
expect 1 'a collapse' solve dense.yaml
says err 'in two dimensions there is no ground state with' 'the reason'
sed 's/radial: 2/radial: 4/' plate.yaml >four.yaml
expect 2 'four dimensions' solve four.yaml
says err '^dvi: four.yaml:3:59: .*radial is the dimension 2 or 3' 'the dimensions that there are'
sed 's/right: fixed/right: {robin: 1}/' plate.yaml >flux.yaml
expect 2 'a flux' solve flux.yaml
says err '^dvi: flux.yaml:4:11: ' 'the place'

# ---- exact digits, and those of independent programs ----

# modes NAME DOMAIN SPACE BOUNDARY POTENTIAL ENERGY...: check the lowest energies to 2e-12.
modes() {
  name=$1 tolerance=2e-12
  printf 'domain: {x: %s}\nspace: %s\nboundary: %s\nschroedinger: {potential: "%s"}\n' \
    "$2" "$3" "$4" "$5" >modes.yaml
  shift 5
  expect 0 "$name" modes modes.yaml --count $# --csv all.csv
  line=1
  for energy; do
    line=$((line + 1))
    sed -n "1p;${line}p" all.csv >one.csv
    about one.csv eigenvalue "$energy" "$tolerance"
  done
}
ends='{left: fixed, right: fixed}'
modes "Mathieu's equation" '[0, 2*pi]' fourier:modes=16 periodic 'cos(2*x)' \
  -.2275693020538 -.0551244084961 .9295540362572
modes 'a double well' '[-8, 8]' fem:degree=8,cells=48 "$ends" '(x^2-4)^2/8' \
  .900406747310 .948252691166
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "eigenvalue") c = i }
         { e[NR] = $c } END { exit !((d = e[3] - e[2] - .04784594386) < 6e-12 && d > -6e-12) }' \
  all.csv || fail 'the splitting of a double well'
modes 'a wide double well' '[-9, 9]' fem:degree=8,cells=48 "$ends" '(x^2-9)^2/18' \
  .970130862374 .970238245927
modes 'a soft Coulomb potential' '[-90, 90]' fem:degree=8,cells=150 "$ends" '-1/sqrt(x^2+2)' \
  -.5 -.232903337378 -.13382885914
modes 'a softer one' '[-60, 60]' fem:degree=8,cells=180 "$ends" '-1/sqrt(x^2+1)' \
  -.669777138214 -.274891348768
modes "Poeschl and Teller's potential" '[-30, 30]' fem:degree=8,cells=160 "$ends" '-6/cosh(x)^2' \
  -4.5 -2 -.5

# Energies of elements of degree k have order 2k.
for degree in 1 2 3; do
  : >errors
  for cells in 32 64 128; do
    printf 'domain: {x: [-8, 8]}\nspace: fem:degree=%s,cells=%s\nboundary: %s\n' \
      "$degree" "$cells" "$ends" >elements.yaml
    printf 'schroedinger: {potential: x^2/2}\n' >>elements.yaml
    expect 0 "degree $degree, $cells cells" modes elements.yaml --count 1 --csv one.csv
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "eigenvalue") c = i }
             NR == 2 { printf "%.17g\n", $c - 0.5 }' one.csv >>errors
  done
  awk -v order=$((2 * degree)) '
    NR > 1 { slope = log(before / $1) / log(2); bad += slope < order - .15 || slope > order + .15 }
    { before = $1 } END { exit bad > 0 }' errors || fail "the order of degree $degree"
done

# ground NAME MU ENERGY: check 12 digits of both, and that the virial sum is of roundings.
ground() {
  expect 0 "$1" solve ground.yaml
  says out "^mu  *$2\$" "mu of $1"
  says out "^energy  *$3\$" "the energy of $1"
  awk '$1 == "virial" { exit !($2 < 1e-12 && $2 > -1e-12) }' out || fail "the virial sum of $1"
}
for beta in 10 100 400; do
  cat >ground.yaml <<END
domain: {x: [-12, 12]}
space: fem:degree=8,cells=40
schroedinger: {potential: x^2/2, interaction: $beta}
boundary: $ends
probes: {virial: {integral: "dot(d(psi,x),d(psi,x)) - x^2*dot(psi,psi) + $beta/2*dot(psi,psi)^2"}}
solve: ground
END
  case $beta in
  10) ground 'a condensate' 3.10724308943 1.94712721505 ;;
  100) ground 'a larger one' 14.1342870866 8.50852675622 ;;
  400) ground 'the largest one' 35.5774608892 21.3600696961 ;;
  esac
done
cat >ground.yaml <<END
domain: {x: [-8, 8], y: [-8, 8]}
space: fourier:modes=24
schroedinger: {potential: (x^2+y^2)/2, interaction: 50}
boundary: periodic
solve: ground
END
ground 'a condensate in a plane' '4.1430059264[0-9]*' '2.89603185[0-9]*'
cat >ground.yaml <<END
domain: {x: [0, 8]}
space: fem:degree=8,cells=20
schroedinger: {potential: x^2/2, interaction: 50, radial: 2}
boundary: {right: fixed}
solve: ground
END
ground 'a condensate along a radius' '4.1430059264[0-9]*' '2.89603185[0-9]*'

# The solitons of 2 sech x (Satsuma and Yajima 1974) at t = 0.8, after their peak.
cat >solitons.yaml <<END
domain: {x: [-20, 20]}
space: fourier:modes=256,points=513
schroedinger: {interaction: -1}
boundary: periodic
initial: {psi: "[2/cosh(x), 0]"}
probes:
  square:
    integral:
      "(re(psi) - 4*(cos(0.4)*cosh(3*x) + 3*cos(3.6)*cosh(x))/
      (cosh(4*x) + 4*cosh(2*x) + 3*cos(3.2)))^2 +
      (im(psi) - 4*(sin(0.4)*cosh(3*x) + 3*sin(3.6)*cosh(x))/
      (cosh(4*x) + 4*cosh(2*x) + 3*cos(3.2)))^2"
method: split
step: 0.004
until: 0.8
END
solitons() {
  expect 0 "solitons by $1" run solitons.yaml --method "$1" --h "$2" --columns norm,energy,square
  about out norm 8 3e-13
  awk -F, -v expected="$3" 'NR == 2 { bad = $3 + 28 / 3 > 1e-11 || $3 + 28 / 3 < -1e-11 }
    { square = $4 } END { error = sqrt(square) / expected
    exit bad || error < .995 || error > 1.005 }' out ||
    { fail "the error of $1 with steps of $2"; tail -n 1 out; }
}
solitons split 0.004 2.82e-3
solitons split 0.002 7.07e-4
solitons split 0.001 1.77e-4
solitons midpoint 0.004 2.26e-3
solitons midpoint 0.002 5.66e-4
solitons split:order=4 0.004 8.94e-5
solitons split:order=4 0.002 5.80e-6

finish
