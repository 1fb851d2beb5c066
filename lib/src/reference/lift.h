/* Systems with factors for SUNDIALS' codes: rotations as quaternions, directions and angles as
 * vectors of any length.
 *
 * The lifted coordinates kappa are four numbers of a rotation (the stored nine are
 * R(kappa/|kappa|)), of a direction or an angle the stored ones times any length, and the numbers
 * of R^n themselves. Their equations,
 *     kappa' = kappa (0, Omega)/2  (quaternions),  |kappa| v  (directions),  omega kappa turned by 90 degrees  (angles),  v  (R^n),
 * are homogeneous in kappa, and all else depends on kappa/|kappa| alone: so the constraint |kappa|
 * = 1 is part of the equations, and what errors make of the length is in no result. With y' = T(y)
 * v, the Lagrangian of the stored coordinates and its covector C = dL/dy':
 *     p = T^t C,      p' = T^t L_y + (dT/dt)^t C,
 * for a direction with T = I - q q^t:  p' = L_q - q (q.L_q) - (v.C) q - (q.C) v.
 * All this is written here anew: nothing is shared with the charts of the methods. */
#ifndef DVI_REFERENCE_LIFT_H
#define DVI_REFERENCE_LIFT_H
#include "reference/run.h"

/* A point of a run, and its derivatives. */
typedef struct dvi__lift {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int size;         /* of kappa */
  double *y, *rate; /* [nq] the stored coordinates and their rate */
  double *L_y, *C;  /* [nq] */
} dvi__lift;

dvi_status dvi__lift_create(dvi__reference_run *run, dvi__lift *lift);
void dvi__lift_clear(dvi__lift *lift);

/* kappa [size] of q [nq], and back: q = y(kappa). */
void dvi__lift_up(const dvi__lift *lift, const double *q, double *kappa);
void dvi__lift_down(const dvi__lift *lift, const double *kappa, double *q);

/* At t, kappa and v [nv]: kappa's rate [size], p's rate [nv], and the p [nv] that v has; what it
 * has of v along a direction, which must be 0, is added to that along it. */
dvi_status dvi__lift_equations(dvi__lift *lift, double t, const double *kappa, const double *v,
                               double *kappa_rate, double *p_rate, double *p_of_v);

/* p [nv] without what errors make it have along directions. */
void dvi__lift_tangent(const dvi__lift *lift, const double *q, double *p);

#endif
