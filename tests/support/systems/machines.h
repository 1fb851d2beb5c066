/* Machines of bodies in joints. Each joint of dvi/joint.h is in one of them. */
#ifndef TESTS_SUPPORT_MACHINES_H
#define TESTS_SUPPORT_MACHINES_H
#include <dvi/joint.h>

#include "support/systems/bodies.h"

typedef enum machine_kind {
  BALL_PENDULUM,   /* pendulum-3d as a rigid motion with a ball */
  HINGE_PENDULUM,  /* J = .11 about the hinge, m g l = 2.943, from 2 radians */
  CARDAN_SHAFT,    /* a body on a hinge, and another on a universal joint of the first */
  SWING_ON_SLIDER, /* a body that slides on the ground, and a pendulum on a ball of it */
  PUCK,            /* a body on a slanted plane, tied to a point by a distance */
  WELDED,          /* two bodies welded to one, on a ball */
  FREE_PAIR,       /* two bodies in a ball, without weight */
  CONE,            /* two directions at a constant angle, with weights */
  MACHINES
} machine_kind;

typedef struct machine {
  body body;
  dvi_joints *joints;
  double span; /* in which nothing turns by half a turn */
} machine;

void make_machine(machine_kind kind, machine *made);
void destroy_machine(machine *made);

#endif
