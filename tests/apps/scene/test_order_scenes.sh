#!/bin/sh
# dvi order and dvi bench on scenes as a new user writes them. The default judge decides orders to
# 16. Where an order is not decided the sentence names a remedy that works.
# Usage: test_order_scenes.sh DVI
. "$(dirname "$0")/../check.sh"

# name, then the scene's lines without method, step and end, which follow.
scene() { cat >"$1.yaml" && printf 'method: %s\nstep: %s\nuntil: %s\n' "$2" "$3" "$4" >>"$1.yaml"; }

scene driven galerkin:degree=4 0.05 50 <<'E1'
parameters: {w: 1.3, F: 0.4}
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2 - x^4/4 + F*x*cos(w*t)
initial: {x: 1}
E1
scene double galerkin:degree=3 0.02 20 <<'E1'
parameters: {m1: 1, m2: 0.7, l1: 1, l2: 0.8, g: 9.81}
coordinates: {a: scalar, b: scalar}
definitions:
  upper: [l1*sin(a), -l1*cos(a)]
  lower: upper + [l2*sin(b), -l2*cos(b)]
lagrangian: m1/2*dot(upper', upper') + m2/2*dot(lower', lower') - g*(m1*upper[2] + m2*lower[2])
initial: {a: 1.2, b: 0.5}
E1
scene cart galerkin:degree=4 0.02 20 <<'E1'
parameters: {m: 0.2, M: 1, l: 0.5, g: 9.81}
coordinates: {x: scalar, theta: scalar}
definitions:
  bob: [x + l*sin(theta), -l*cos(theta)]
lagrangian: M/2*x'^2 + m/2*dot(bob', bob') - m*g*bob[2]
initial: {x: 0, theta: 1}
E1
scene spring composition:order=8 0.02 10 <<'E1'
parameters: {m: 1, k: 40, l: 1, g: 9.81}
coordinates: {r: "vector(2)"}
lagrangian: m/2*dot(r', r') - k/2*(norm(r) - l)^2 - m*g*r[2]
initial: {r: "[0.8, -0.9]"}
E1
scene three galerkin:degree=5 0.01 10 <<'E1'
parameters: {m: [1, 0.3, 0.2]}
coordinates: {"x[3]": vector(2)}
lagrangian: sum(i, m[i]/2*dot(x[i]', x[i]')) + sum(i<j, m[i]*m[j]/norm(x[i] - x[j]))
initial: {x: "[[0, 0], [1, 0], [-1.8, 0]]", x': "[[0, -0.05], [0, 1], [0, -0.7]]"}
E1
scene chain galerkin:degree=5 0.1 40 <<'E1'
parameters: {N: 8, b: 0.5}
coordinates: {"x[N]": scalar}
kinetic: sum(i, x[i]'^2)/2
potentials:
  inner: sum(i=1..N-1, (x[i+1] - x[i])^2/2 + b*(x[i+1] - x[i])^4/4)
  walls: (x[1]^2 + x[N]^2)/2
initial: {"x[i]": sin(pi*i/(N + 1))}
E1
scene form vprk:nodes=3 0.05 20 <<'E1'
coordinates: {u: scalar, v: scalar}
one_form: {u: log(v)/(2*u), v: -log(u)/(2*v)}
hamiltonian: u - log(u) + v - 2*log(v)
initial: {u: 1.5, v: 1}
E1
scene wells hamiltonian:degree=4 0.05 20 <<'E1'
coordinates: {x: scalar, y: scalar}
hamiltonian: (p(x)^2 + p(y)^2)/2 + x^2/2 + y^2*(1 + x)/2
initial: {x: 0.5, y: 0.3, p(x): 0.1, p(y): 0}
E1
scene top lie-galerkin:degree=3 0.01 2 <<'E1'
parameters: {m: 2, g: 9.81, c: [0.3, 0.2, 0], J: [[0.0267, 0, 0], [0, 0.06, 0], [0, 0, 0.0867]]}
coordinates: {R: rotation}
definitions: {centre: R*c}
lagrangian: m/2*dot(centre', centre') + dot(omega(R), J*omega(R))/2 - m*g*centre[3]
initial: {R: "turn([1, 0, 0], 2)", omega(R): "[0, 1, 3]"}
E1

# The scene's own method, and the best judge, by themselves; IDA, less exact by far, remains beside
# it.
for which in $(some driven double cart spring three chain form wells top); do
  expect 0 "the order of $which" order $which.yaml
  says out ': ok$' "the verdict on $name"
  says out 'judge at t = .*two runs of .*(IDA, of error .*away), error [0-9.]*e-1[3-7]' \
    "the judge of $which"
  expect 0 "a bench of $which" bench $which.yaml --rounds 1 --levels 2
  says out "^$(sed -n 's/^method: //p' $which.yaml)\$" "the own method of $which"
done
# Without a method of its own a scene gets a selection, a one-form and a Hamiltonian, too.
for which in form wells; do
  sed '/^method/d' $which.yaml >bare.yaml
  expect 2 "no method: $which" order bare.yaml
  expect 0 "a selection for $which" bench bare.yaml --rounds 1 --levels 2
  [ "$(grep -c '^  setting' out)" -ge 2 ] || fail "two methods at least for $which"
done
expect 0 'a selection for a one-form of the catalogue' bench lotka-volterra --rounds 1 --levels 2

# Starts in which a momentum or a constraint is exactly 0, which a change of the last place breaks.
scene rest vprk:nodes=2 0.1 10 <<'E1'
coordinates: {q: scalar, v: scalar}
lagrangian: v*q' - (v^2 + q^2)/2
initial: {q: 1, v: 0}
E1
scene bowl dg-phase:degree=2 0.1 10 <<'E1'
coordinates: {x: scalar, y: scalar, z: scalar}
hamiltonian: (p(x)^2 + p(y)^2 + p(z)^2)/2 + z
constraints:
  on_the_sphere: (x^2 + y^2 + z^2 - 1)/2
  along_it: x*p(x) + y*p(y) + z*p(z)
initial: {x: 0.8, y: 0, z: -0.6, p(x): 0, p(y): 0.3, p(z): 0}
E1
for which in rest bowl; do
  expect 0 "an order from zeros: $which" order $which.yaml
  says out 'claimed order [24], fitted .*: ok$' "its order: $which"
  expect 0 "a bench from zeros: $which" bench $which.yaml --rounds 1 --levels 2
done

# Orders to 16: single steps.
for degree in 6 8; do
  for which in $(some driven cart three); do
    expect 0 "order $((2 * degree)) of $which" order $which.yaml --method galerkin:degree=$degree
    says out "claimed order $((2 * degree)), fitted .* to single steps .*: ok" \
      "order $((2 * degree)) of $which is that of single steps"
  done
done
expect 0 'order 14, Lobatto' order double.yaml --method galerkin:degree=7,quadrature=lobatto
expect 0 'order 13, Radau' order driven.yaml --method galerkin:degree=7,quadrature=radau-left
# A force with a kink: the method has no order 8 there, and no verdict claims it.
sed 's/x^4\/4/abs(x)^3/' driven.yaml >kink.yaml
expect 3 'a kink' order kink.yaml
says out 'single steps have the order 8.0.*is the Lagrangian smooth all along' \
  'why single steps do not decide it'

# What follows repeats what is above with other words: not where memory is watched.
[ -z "${DVI_TEST_FEWER:-}" ] || { finish; exit; }

# Remedies, followed.
expect 3 'a slope that looks settled' order form.yaml --method vprk:nodes=4
says out 'no single steps in quadruple precision: they are there for galerkin' \
  'why not by single steps'
says out 'try a shorter span, --t-end 2.5' 'its remedy'
expect 0 'followed' order form.yaml --method vprk:nodes=4 --t-end 2.5
expect 3 'an order that no span shows' order form.yaml --method vprk:nodes=6
says out 'try a method of a lower one' 'its remedy'
expect 0 'followed' order form.yaml --method vprk:nodes=3
expect 3 'steps too large' order spring.yaml --method verlet --h 1 --ratio 1.1
says out 'steps are too large: .* above 1 % of the solution .*; leave --h to the search' \
  'its cause and remedy'
expect 0 'followed' order spring.yaml --method verlet
expect 3 'below the floor' order spring.yaml --h 0.0005 --levels 5
says out 'have errors below .*, ten times the judge.s own error; leave --h and --judge' \
  'its cause and remedy'
expect 0 'followed' order spring.yaml --levels 5
expect 3 "IDA's error" order driven.yaml --judge ida --h 0.02 --levels 5 \
  --method composition:order=8
says out 'have errors below .*e-1., ten times the judge.s own error; leave --h and --judge' \
  'its cause and remedy'
expect 0 'followed' order driven.yaml --method composition:order=8
expect 3 'three levels' order driven.yaml --levels 3
says out '3 levels are too few, 4 are needed; ask for --levels 6' 'its cause and remedy'
expect 0 'followed' order driven.yaml --levels 6
expect 3 'steps that are chosen' order spring.yaml --method sem:degree=3
says out 'the method chooses its steps.* galerkin of this degree' 'its remedy'
expect 0 'followed' order spring.yaml --method galerkin:degree=3
no_trace 'order of scenes'
finish
