#!/bin/sh
# Machines in scenes against digits on which two independent codes agree (closed forms, or quadruple
# precision). Where there is a choice, the digits were computed in other coordinates.
# Usage: test_scene_digits.sh DVI
. "$(dirname "$0")/../check.sh"

# digits SCENE TOLERANCE COLUMN=NUMBER...: run to the end, and compare columns of the last row.
# $options stands behind the scene.
options=
digits() {
  scene=$1 tolerance=$2 columns='' numbers=''
  shift 2
  for pair; do columns=$columns,${pair%%=*} numbers=$numbers,${pair#*=}; done
  # The options are meant to be split into words.
  # shellcheck disable=SC2086
  expect 0 "$scene" run "$scene" $options --final --columns "${columns#,}"
  tail -n 1 out | awk -F, -v numbers="$numbers" -v tolerance="$tolerance" '{
    split(numbers, wanted, ",")
    for (i = 2; i <= NF; i++) {
      off = $i - wanted[i]
      if (!(off < tolerance && off > -tolerance)) { print "column", i, "is off by", off; bad = 1 }
    }
    exit bad
  }' >off || fail "$scene: $(cat off)"
}

# ---- constraints ----

cat >rod.yaml <<'END'
coordinates: {q: vector(3)}
lagrangian: dot(q', q')/2 - 9.81*q[3]
constraints: {rod: "(dot(q, q) - 1)/2"}
initial: {q: "[sin(1), 0, -cos(1)]", q': "[cos(1)/2, 2, sin(1)/2]"}
method: galerkin:degree=6
step: 0.02
until: 2
END
digits rod.yaml 2e-14 q_x=.3160694015792743 q_y=.6893547174071988 q_z=-.6518360276739546
digits rod.yaml 1e-9 lambda_rod=12.83280305331

# The same in directions, whose null space is known.
cat >direction.yaml <<'END'
coordinates: {q: direction}
lagrangian: dot(q', q')/2 - 9.81*q[3]
initial: {q: "[sin(1), 0, -cos(1)]", q': "[cos(1)/2, 2, sin(1)/2]"}
method: sphere-galerkin:degree=4
step: 0.02
until: 2
END
digits direction.yaml 5e-14 q_x=.3160694015792743 q_y=.6893547174071988 q_z=-.6518360276739546

# The problem double-pendulum by positions of its masses, with its digits in angles.
cat >double.yaml <<'END'
coordinates: {u: vector(2), w: vector(2)}
lagrangian: dot(u', u')/2 + dot(w', w') - 9.80665*(u[2] + 2*w[2])
constraints: {upper: "(dot(u, u) - 4)/2", lower: "(dot(w - u, w - u) - 9)/2"}
initial:
  u: 2*[sin(pi/4), -cos(pi/4)]
  w: "[2*sin(pi/4) + 3, -2*cos(pi/4)]"
  w': [0, 3*pi/8]
method: galerkin:degree=6
step: 0.01
until: 1
END
digits double.yaml 2e-14 u_x=1.153760332420596 u_y=-1.6336575820326351 \
  w_x=2.2660173097004273 w_y=-4.4198529119569985

# The problem pendulum-3d as a free body that a ball joint holds.
cat >pendulum.yaml <<'END'
coordinates: {B: motion}
lagrangian: >-
  (dot(B.x', B.x') + 0.04*omega(B)[1]^2 + 0.19*omega(B)[2]^2 + 0.17*omega(B)[3]^2)/2
  + 9.81*B.x[3]
joints: {pivot: {ball: [ground, B], at: [0, 0, 0]}}
initial:
  B.R: turn([0, 0, 1], 0)
  B.x: [0, 0, 0.3]
  B.x': 0.3*[4.14, -4.14, 0]
  omega(B): [4.14, 4.14, 4.14]
method: lie-galerkin:degree=3
step: 0.002
until: 1
END
digits pendulum.yaml 2e-13 omega_B_x=-6.751473860336227 omega_B_y=.14843467324872966 \
  omega_B_z=3.3623156063965176

# ---- forces ----

cat >drag.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 + cos(x)
forces: {x: -0.3*x'^3 - 0.1*x'*cos(x)^2 + 0.4*cos(1.3*t)}
initial: {x: 1.5, x': 0}
method: galerkin:degree=5
step: 0.1
until: 10
END
digits drag.yaml 2e-13 x=-.567065166612010 p_x=.434877768607500
cat >driven.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2
forces: {x: 0.5*sin(2*t)}
dissipation: 0.1*x'^2
initial: {x: 1}
method: galerkin:degree=5
step: 0.1
until: 10
END
digits driven.yaml 2e-14 x=-.563319120058319 p_x=-.00257422329188763

# ---- rows on velocities ----

options='--method composition:order=8 --h 0.02 --t-end 5'
digits knife-edge 5e-13 x=-.164760454880628 y=4.37793499400330
digits sleigh 5e-13 x=1.53649000186223 y=6.91084804198453
options='--method composition:order=8 --h 0.02 --t-end 4'
digits snakeboard 5e-13 x=.302254052893502 a=-.0751500218104086
options='--method composition:order=8 --h 0.02 --t-end 7'
# The disk goes round a circle of radius R spin/turn.
digits rolling-disk 5e-13 x=-2.10525559848071 y=1.74318777980877

# ---- holonomic constraints ----

options='--method galerkin:degree=6 --h 0.01 --t-end 3'
digits three-cranks 2e-14 a=-.086440107700034 c=-.086440107700034
options='--method galerkin:degree=6 --h 0.01 --t-end 2'
digits spherical-constrained 5e-15 x=.316069401579274 y=.689354717407199 \
  z=-.651836027673955
finish
