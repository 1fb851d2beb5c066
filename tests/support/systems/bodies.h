/* Systems with factors: rotations, directions, angles, and a product of all of them whose mass
 * couples the factors. */
#ifndef TESTS_SUPPORT_BODIES_H
#define TESTS_SUPPORT_BODIES_H
#include <dvi/integrator.h>

enum { BODY_Q = 24, BODY_V = 13 };

typedef enum body_kind {
  FREE_BODY,   /* J = (3, 2, 1.5), no potential */
  PENDULUM_3D, /* J = (.13, .28, .17), centre of mass (0, 0, .3) below the pivot */
  HEAVY_TOP,   /* about 150 radians per unit of time about the axis e2 */
  FREE_MOTION, /* a body on SE(3) whose centre of mass is not its origin, without potential */
  MOTION,      /* that body, tied by springs */
  DIRECTIONS,  /* a spherical double pendulum */
  ANGLE,       /* a pendulum on the circle */
  PRODUCT,     /* two directions, a motion and an angle, with masses between them */
  BODIES
} body_kind;

/* A system and a start. Invariant 1 is the momentum of turns about the vertical. ANGLE, MOTION and
 * PRODUCT lack it. */
typedef struct body {
  const char *name;
  dvi_system *system;
  const dvi_factor *factors;
  int factor_count, nq, nv;
  double q[BODY_Q], v[BODY_V];
} body;

void make_body(body_kind kind, body *model);
void destroy_body(body *model);

/* A chain of directions with springs between neighbours, and weights. It must not move in
 * memory. */
typedef struct direction_chain {
  int links;
  int *start, *row; /* the pattern of the potential's Hessian */
  dvi_system *system;
  double *q, *v; /* [3*links] */
} direction_chain;

void make_direction_chain(int links, direction_chain *linked);
void destroy_direction_chain(direction_chain *linked);

/* Creates an integrator, and starts it at the body's start. */
dvi_integrator *body_integrator(const body *model, const char *method);

/* Measures how far one step is from symplectic: the largest change of the form dp ^ dq, in the
 * letters of dvi/system.h, over pairs of differenced directions of unit size in units of the
 * momentum. On SO(3) it is dPi1.eta2 - dPi2.eta1 - Pi.(eta1 x eta2), with R^T dR = eta^. */
double symplectic_defect(const body *model, const char *method, double h);

#endif
