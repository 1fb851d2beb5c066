#!/bin/sh
# Each section of a scene is used or refused: each form of a scene with each method, and each
# section that the method takes. A change of a section must change the output.
# Usage: test_scene_sections.sh DVI
. "$(dirname "$0")/../check.sh"

plan() {
  cat <<'END'
title: first
parameters: {k: 2}
step: 0.1
until: 0.5
report: {every: 1}
sweep: {k: [1, 2]}
END
}
common() {
  plan
  cat <<'END'
coordinates: {x: scalar, y: scalar}
definitions: {r2: x^2 + y^2}
symmetries: {turn: {x: -y, y: x}}
invariants: {size: r2}
events: {pass: {zero: y + 0.1}}
END
}
{ common; cat <<'END'
kinetic: (x'^2 + 2*y'^2)/2
potentials: {spring: k*r2/2, well: x^4/4}
initial: {x: 1, y: 0, x': -0.3, y': -1}
END
} >separable.yaml
sed 's/potentials: .*/potentials: {fast: {spring: k*r2\/2}, slow: {well: x^4\/4}}/' separable.yaml \
  >fast.yaml
{ common; cat <<'END'
lagrangian: x'^2/2 + (1 + x^2)*y'^2/2 - k*r2/2
initial: {x: 1, y: 0, x': -0.3, y': -1}
END
} >general.yaml
{ common; cat <<'END'
one_form: {x: y}
hamiltonian: k*r2/2
initial: {x: 1, y: 0.3}
END
} >oneform.yaml
{ common; cat <<'END'
hamiltonian: (p(x)^2 + p(y)^2)/2 + k*y
constraints: {circle: r2 - 1, tangent: x*p(x) + y*p(y)}
initial: {x: 1, y: 0, p(x): 0, p(y): -0.5}
END
} >dirac.yaml
{ plan; cat <<'END'
coordinates: {R: rotation}
definitions: {tip: "R[3,1]"}
symmetries: {turn: {omega(R): "transpose(R)*[0, 0, 1]"}}
invariants: {size: tip^2}
events: {pass: {zero: tip + 0.1}}
lagrangian: (omega(R)[1]^2 + 1.5*omega(R)[2]^2 + 2*omega(R)[3]^2)/2 - k*tip
initial: {R: "turn([1, 0, 0], 1)", omega(R): [0.3, 2, -0.5]}
END
} >rotation.yaml
sed 's/^\(lagrangian: \)\(.*\) - k.tip/\1k*\2/' rotation.yaml >body.yaml
{ plan; cat <<'END'
coordinates: {u: direction}
definitions: {tip: "u[3]"}
symmetries: {turn: {u: "cross([0, 0, 1], u)"}}
invariants: {size: tip^2}
events: {pass: {zero: tip + 0.1}}
lagrangian: dot(u', u')/2 - k*tip
initial: {u: [1, 0, 0], u': [0, -0.3, -1]}
END
} >direction.yaml
# Machines: forms with the sections of forces, constraints, joints, contacts and noise.
planar() {
  plan
  cat <<'END'
coordinates: {x: scalar, y: scalar, a: scalar}
kinetic: (x'^2 + 2*y'^2 + 0.5*a'^2)/2
potentials: {spring: k*y, twist: a^2/2}
END
}
{ planar; cat <<'END'
constraints: {circle: x^2 + y^2 - 1}
forces: {a: sin(t) - a}
initial: {x: 1, y: 0, a: 0, y': -1}
END
} >rod.yaml
{ planar; cat <<'END'
constraints: {circle: x^2 + y^2 - 1}
forces: {a: sin(t) - a'}
dissipation: (x'^2 + y'^2)/10
initial: {x: 1, y: 0, a: 0, y': -1}
END
} >driven.yaml
{ planar; cat <<'END'
damping: 0.1
forces: {a: sin(t)}
initial: {x: 1, y: 0, a: 0, y': -1}
END
} >damped.yaml
{ planar; cat <<'END'
nonholonomic: {blade: sin(a)*x' - cos(a)*y'}
forces: {a: sin(t)}
initial: {x: 1, y: 0, a: 0, x': -1}
END
} >blade.yaml
{ planar; cat <<'END'
contacts: {wall: {gap: y + 0.3, restitution: 0.8}}
initial: {x: 1, y: 0, a: 0, y': -1}
END
} >walled.yaml
{ planar; cat <<'END'
contacts: {wall: {gap: y + 0.3, restitution: 0.8, friction: 0.3, tangent: x'}}
initial: {x: 1, y: 0, a: 0, y': -1, x': 0.5}
END
} >sliding.yaml
{ planar; cat <<'END'
noise: {temperature: 0.5, friction: 1, seed: 7}
initial: {x: 1, y: 0, a: 0, y': -1}
END
} >noisy.yaml
{ plan; cat <<'END'
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 + k*x*y' - (x^2 + y^2)/2
initial: {x: 1, y: 0, y': -1}
END
} >magnetic.yaml
{ plan; cat <<'END'
coordinates: {B: motion}
lagrangian: k*dot(B.x', B.x')/2 + dot(omega(B), omega(B))/20 - B.x[3]
joints: {pin: {ball: [ground, B], at: [0, 0, 0]}}
initial: {B.R: "turn([0, 1, 0], 1)", B.x: "[0.5, 0, 0]", omega(B): [0, 0, 1], B.x': [0, 0.5, 0]}
END
} >joined.yaml
{ cat joined.yaml; echo 'forces: {omega(B): "[0, 0.1, sin(t)]"}'; } >turned.yaml
sed -i "/^initial/s/, omega.*/}/" joined.yaml turned.yaml
# Each line holds a form, a section, and a change of the section by sed. Flat forms have coordinates
# x and y.
machines='rod driven damped blade walled sliding noisy magnetic joined turned'
# A short run takes a part of the forms, and no controls with bounds, which take minutes.
short=${DVI_TEST_FEWER:+yes}
[ -z "$short" ] || machines=
forms="separable fast general oneform dirac rotation body direction $machines"
cat >changes <<'END'
all parameters s/k: 2/k: 3/
flat coordinates s/{x: scalar, y: scalar}/{y: scalar, x: scalar}/
flat definitions s/r2: x^2/r2: 2*x^2/
flat symmetries s/x: -y/x: -2*y/
all symmetries s/turn:/twist:/
all invariants s/size: /size: 2*/
all events s/+ 0.1}/+ 50}/
all events s/0.1}/0.1, direction: rising}/
all events s/0.1}/0.1, stop: yes}/
all step s/step: 0.1/step: 0.05/
all until s/until: 0.5/until: 0.4/
all report s/every: 1/every: 2/
all report s/every: 1/columns: [turn, energy]/
fast potentials s/spring: k/spring: 2*k/
fast potentials s/well: x^4/well: 2*x^4/
fast initial s/x': -0.3/x': 0/
turning coordinates s/\bR\b/S/g
turning definitions s/3,1/3,2/
turning symmetries s/0, 0, 1]"/0, 0, 2]"/
turning lagrangian s/1.5/1.6/
turning initial s/0.3/0.2/
turning initial s/, 1)/, 1.1)/
direction coordinates s/\bu\b/w/g
direction definitions s/3\]"/2]"/
direction symmetries s/0, 0, 1/0, 0, 2/
direction lagrangian s/u')\/2/u')/
direction initial s/-0.3/-0.2/
separable kinetic s/2\*y'^2/3*y'^2/
separable potentials s/well: x^4/well: 2*x^4/
separable initial s/x': -0.3/x': 0/
separable initial s/y': -1/p(x): 1, p(y): -2/;s/x': -0.3, //
general lagrangian s/1 + x^2/2 + x^2/
general initial s/x': -0.3/x': 0/
oneform one_form s/x: y}/x: 2*y}/
oneform hamiltonian s/k\*r2/k*(x + r2)/
oneform initial s/y: 0.3/y: 0.2/
dirac hamiltonian s/k\*y/2*k*y/
dirac constraints s/r2 - 1/x^2 + 2*y^2 - 1/;s/x\*p(x) + y/x*p(x) + 2*y/
dirac initial s/p(y): -0.5/p(y): -0.4/
rod constraints s/x^2 + y^2 - 1/x^2 + 2*y^2 - 1/
rod constraints s/circle: .*}/circle: x - 1, level: a}/
rod forces s/sin(t) - a/sin(t)/
rod potentials s/spring: k/spring: 2*k/
driven constraints s/x^2 + y^2 - 1/x^2 + 2*y^2 - 1/
driven forces s/sin(t) - a'/sin(t)/
driven dissipation s/10/5/
damped damping s/0.1/0.2/
damped forces s/sin(t)/2*sin(t)/
blade nonholonomic s/sin(a)/sin(2*a)/
blade forces s/sin(t)/2*sin(t)/
walled contacts s/0.3/0.2/
walled contacts s/restitution: 0.8/restitution: 0.5/
sliding contacts s/y + 0.3/y + 0.2/
sliding contacts s/restitution: 0.8/restitution: 0.5/
sliding contacts s/friction: 0.3/friction: 0.1/
sliding contacts s/tangent: x'/tangent: x' + a'/
noisy noise s/temperature: 0.5/temperature: 0.4/
noisy noise s/friction: 1/friction: 2/
noisy noise s/seed: 7/seed: 8/
noisy noise s/seed: 7/seed: 7, stream: 3/
noisy noise s/seed: 7/seed: 7, functions: {shake: x}/
magnetic lagrangian s/x\*y'/2*x*y'/
joined joints s/ball: \(.*\)}}/distance: \1, to: [0.5, 0, 0]}}/
joined joints s/at: \[0, 0, 0\]/at: [0.1, 0, 0]/
joined initial s/, 1)/, 1.1)/
turned forces s/0.1, sin/0.2, sin/
turned forces s/sin(t)/cos(t)/
turned joints s/at: \[0, 0, 0\]/at: [0.1, 0, 0]/
machine step s/step: 0.1/step: 0.05/
machine until s/until: 0.5/until: 0.4/
machine parameters s/k: 2/k: 3/
END
while read -r form section change; do
  for scene in $forms; do
    case " $machines " in *" $scene "*)
      [ "$form" = machine ] || [ "$form" = "$scene" ] || continue ;;
    esac
    case "$form:$scene" in
    machine:*) case " $machines " in *" $scene "*) ;; *) continue ;; esac ;;
    flat:rotation | flat:body | flat:direction) continue ;;
    all:* | flat:* | turning:rotation | turning:body | "$scene:$scene") ;;
    *) continue ;;
    esac
    sed "$change" $scene.yaml >"$scene-$section-$((changes += 1)).yaml"
    cmp -s $scene.yaml "$scene-$section-$changes.yaml" && fail "$scene: '$change' changes nothing"
  done
done <changes

# show SCENE METHOD: print the whole output of a run, without the sections that $without names.
without=
show() {
  sed "/^${without:-none}:/d" "$1" >tried.yaml
  "$dvi" run tried.yaml --method "$2" 2>&1
}

# used SCENE METHOD: require that the method uses the scene and all its sections. On manifold
# coordinates these methods have no path on which to look for events.
used() {
  without=
  case "$1:$2" in
    rotation:lie-rk | body:lie-rk | direction:lie-rk) without=events ;;
    rotation:comp* | body:comp* | direction:comp*) without=events ;;
  esac
  show "$1.yaml" "$2" >base
  for changed in $(some "$1"-*.yaml); do
    case "$changed" in *"-$without-"*) continue ;; esac
    show "$changed" "$2" >shown
    [ -s shown ] || fail "$2: $changed: neither rows nor a reason"
    cmp -s base shown && fail "$2: the change in $changed does not show"
  done
  { cat "$1.yaml"; echo "method: $2"; } | sed "/^${without:-none}:/d" >tried.yaml
  "$dvi" run tried.yaml >shown 2>&1
  same shown base "$2: the scene's own method"
  expect 0 "$2: a sweep over $1" sweep tried.yaml --threads 1 --out sweep.csv
  [ "$(cut -d, -f1,2 sweep.csv | tr '\n' ' ')" = 'k,status 1,DVI_OK 2,DVI_OK ' ] ||
    fail "$2: the section sweep of $1"
}

# The number of refusals is asserted below: a method that refused more than it must would be tried
# on less. Every method takes a form (multiscale once it is told what is fast), or refuses it by a
# sentence that names those that do.
refused=0
"$dvi" list methods --csv - | tail -n +2 | cut -d, -f1 |
  sed 's/^multiscale$/multiscale:fast=0,omega=5/' >methods
echo composition:order=4,base=midpoint >>methods
for scene in $forms; do
  taken=
  while read -r method; do
    if "$dvi" check $scene.yaml --method "$method" >out 2>err; then
      taken="$taken $method"
      says out "^$scene: first$" "$method: the title of $scene"
      used $scene "$method"
    else
      refused=$((refused + 1))
      expect 2 "$method refuses $scene" run $scene.yaml --method "$method"
      says err 'methods for this system: [a-z]\| can$\| takes both$' \
        "$method: what to take for $scene"
    fi
  done <methods
  echo "$scene:$taken"
  case "$scene:$taken " in
  fast:*' imex respa mollified trig '* | rotation:*' lie-galerkin lie-verlet lie-rk '*) ;;
  body:*' lie-galerkin lie-verlet lie-rk euler-poincare '*) ;;
  direction:*' lie-galerkin lie-verlet lie-rk sphere-galerkin '*) ;;
  fast:* | rotation:* | body:* | direction:*) fail "a method does not take $scene" ;;
  *:' ') fail "no method takes $scene" ;;
  esac
done
[ -n "$short" ] || [ $refused -eq 505 ] || fail "$refused of 612 pairs are refused, not 505"

# Controls, their ends and objectives are those of dvi control and dvi gradient.
{ plan; cat <<'END'
coordinates: {x: scalar, y: scalar}
controls: {u: {cost: u^2/2, within: [-40, 40]}}
lagrangian: (x'^2 + y'^2 - k*x^2 - x*y)/2
forces: {x: u - 0.1*x'}
initial: {x: 1, y: 0}
final: {x: 0, x': 0}
objective: {end: x, integral: y^2}
method: midpoint
END
} >controlled.yaml
[ -z "$short" ] || sed -i 's/, within: .*/}}/' controlled.yaml
for change in 'control s/u^2.2/u^2/' 'control s/-40, 40/-22, 22/' \
  'control s/final: {x: 0/final: {x: 0.2/' \
  "control s/, x': 0}/}/" 'control s/u - 0.1/u - 0.2/' 'control s/u - /2*u - /' \
  'gradient s/end: x/end: y/' 'gradient s/integral: y/integral: x/'; do
  case $short$change in yes*-40*) continue ;; esac
  sed "${change#* }" controlled.yaml >changed.yaml
  cmp -s controlled.yaml changed.yaml && fail "'$change' changes nothing"
  expect 0 "$change: before" "${change%% *}" controlled.yaml
  sed 1d out >base
  expect 0 "$change" "${change%% *}" changed.yaml
  sed 1d out >shown
  cmp -s base shown && fail "the change '$change' does not show"
done

# Sections that no scene may have, or not beside others.
for pair in 'contacts: {x: 1}|a contact is' 'lagrangian: x'"'"'^2|one of these' \
  'hamiltonian: x|no hamiltonian' 'one_form: {x: y}|one of these' \
  'constraints: {a: x, b: y}|holonomic constraints' 'friction: 1|has no .friction.'; do
  { cat separable.yaml; echo "${pair%%|*}"; } >odd.yaml
  expect 2 "${pair%%|*}" run odd.yaml --method sem
  says err "${pair#*|}" "why not ${pair%%|*}"
done
no_trace 'sections'
finish
