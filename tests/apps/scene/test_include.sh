#!/bin/sh
# Every command takes a scene with components as if it were written in one file.
# Usage: test_include.sh DVI
. "$(dirname "$0")/../check.sh"

cat >oscillator.yaml <<'END'
parameters: {m: 1, k: 1, start: 1}
coordinates: {x: scalar}
lagrangian: m/2*x'^2 - k/2*x^2
forces: {x: -0.1*x'}
initial: {x: start}
END
cat >parts.yaml <<'END'
include: {a: oscillator.yaml, b: oscillator.yaml}
parameters: {b_k: 3}
lagrangian: -(a_x - b_x)^2
objective: {end: a_x}
method: galerkin:degree=2
step: 0.05
until: 2
sweep: {a_m: [1, 2]}
END
# Terms and parameters stand in the order in which components are read.
cat >whole.yaml <<'END'
parameters: {b_k: 3, a_m: 1, a_k: 1, a_start: 1, b_m: 1, b_start: 1}
coordinates: {a_x: scalar, b_x: scalar}
lagrangian: a_m/2*a_x'^2 - a_k/2*a_x^2 + b_m/2*b_x'^2 - b_k/2*b_x^2 - (a_x - b_x)^2
forces: {a_x: -0.1*a_x', b_x: -0.1*b_x'}
initial: {a_x: a_start, b_x: b_start}
objective: {end: a_x}
method: galerkin:degree=2
step: 0.05
until: 2
sweep: {a_m: [1, 2]}
END

# alike COMMAND OPTIONS..: require the same output for both scenes, but for names and times.
alike() {
  expect 0 "$1 of one file" "$1" whole.yaml $2
  sed 's/whole/parts/g' out >one
  expect 0 "$1 of components" "$1" parts.yaml $2
  same out one "$1"
}
for command in 'run' 'check' 'explain' 'gradient' 'run --set a_k=2' 'run --verify'; do
  # shellcheck disable=SC2046
  alike ${command%% *} "$(echo "$command" | cut -s -d' ' -f2-)"
done
for command in 'sweep --threads 1' emit-c order path; do
  rest=$(echo "$command" | cut -s -d' ' -f2-)
  for scene in whole parts; do
    [ "$command" = path ] && { rest='--ends initial --steps 20'; sed -i '/forces/d' $scene.yaml; }
    [ "$command" = path ] && sed -i '/forces/d' oscillator.yaml
    option=--out
    [ "$command" = order ] && option=--csv
    # shellcheck disable=SC2086
    expect 0 "$command of $scene" ${command%% *} $scene.yaml $rest $option $scene.csv
  done
  case "$command" in order) cut -d, -f1-6 parts.csv >cut && mv cut parts.csv
    cut -d, -f1-6 whole.csv >cut && mv cut whole.csv ;; esac
  sed 's/whole/parts/g' whole.csv >one
  same parts.csv one "$command"
done

# Controls of a component.
cat >motor.yaml <<'END'
coordinates: {x: scalar}
controls: {u: {cost: u^2/2}}
lagrangian: x'^2/2
forces: {x: u}
initial: {x: 0}
END
cat >driven.yaml <<'END'
include: {arm: motor.yaml}
final: {arm_x: 1, arm_x': 0}
method: midpoint
step: 0.1
until: 1
END
expect 0 'a controlled component' control driven.yaml --out u.csv
says out '^cost  *6.0606060606' 'its cost, 6/(1 - 1/N^2)'
says u.csv '^t,arm_x,p_arm_x,arm_u,' 'its columns'
no_trace 'include'
finish
