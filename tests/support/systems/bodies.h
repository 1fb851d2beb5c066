/* Systems with factors: bodies that turn, directions, angles, and a product of all of them whose
 * mass couples factors. */
#ifndef TESTS_SUPPORT_BODIES_H
#define TESTS_SUPPORT_BODIES_H
#include <dvi/integrator.h>

enum { BODY_Q = 20, BODY_V = 13 };

/* free_body: J = (3, 2, 1.5), no potential. pendulum_3d: J = (.13, .28, .17), its centre of mass
 * below the pivot at (0, 0, .3). heavy_top: about 150 radians per unit of time about the axis e2.
 * free_motion, motion: a body on SE(3) whose centre of mass is not its origin; without potential,
 * and tied by springs. directions: a spherical double pendulum. angle: a pendulum on the circle.
 * product: two directions, a motion, an angle, with masses between them. */
typedef enum body_kind {
  FREE_BODY,
  PENDULUM_3D,
  HEAVY_TOP,
  FREE_MOTION,
  MOTION,
  DIRECTIONS,
  ANGLE,
  PRODUCT,
  BODIES
} body_kind;

/* A system and a start; all but the product know their momentum of turns about the vertical as
 * invariant 1, where it is one (not angle and motion). */
typedef struct body {
  const char *name;
  dvi_system *system;
  const dvi_factor *factors;
  int factor_count, nq, nv;
  double q[BODY_Q], v[BODY_V];
} body;

void make_body(body_kind kind, body *of);
void destroy_body(body *of);

/* A chain of directions with springs between neighbours, and weights; must not move in memory. */
typedef struct chain {
  int links, *start, *row; /* and the potential's pattern */
  dvi_system *system;
  double *q, *v; /* [3*links] */
} chain;

void make_linked_chain(int links, chain *of);
void destroy_chain(chain *of);

/* An integrator at the start. */
dvi_integrator *body_integrator(const body *of, const char *method);

/* How far one step is from symplectic: the largest change of the form dp ^ dq, in the letters of
 * dvi/system.h, over pairs of differenced directions of unit size in units of the momentum. On
 * SO(3) it is dPi1.eta2 - dPi2.eta1 - Pi.(eta1 x eta2), R^T dR = eta^. */
double symplectic_defect(const body *of, const char *method, double h);

#endif
