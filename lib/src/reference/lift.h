/* Systems with factors for SUNDIALS' codes: rotations as quaternions, directions and angles as
 * vectors of any length.
 *
 * The lifted coordinates kappa are four numbers of a rotation (the stored nine are
 * R(kappa/|kappa|)), the stored numbers of a direction or an angle times any length, and the
 * numbers of R^n themselves. Their equations are
 *     kappa' = kappa (0, Omega)/2                  (quaternions),
 *     kappa' = |kappa| v                           (directions),
 *     kappa' = omega kappa turned by 90 degrees    (angles),
 *     kappa' = v                                   (R^n).
 * They are homogeneous in kappa, and all else depends on kappa/|kappa| alone. So the constraint
 * |kappa| = 1 is part of the equations, and errors of the length enter no result. With y' = T(y) v,
 * the Lagrangian of the stored coordinates and its covector C = dL/dy' the momentum obeys
 *     p = T^t C,      p' = T^t L_y + (dT/dt)^t C,
 * and for a direction with T = I - q q^t
 *     p' = L_q - q (q.L_q) - (v.C) q - (q.C) v.
 * This code is independent, and shares nothing with the charts of the methods. */
#ifndef DVI_REFERENCE_LIFT_H
#define DVI_REFERENCE_LIFT_H
#include "reference/run.h"

/* A point of a run, and its derivatives. */
typedef struct dvi__lift {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int size;         /* size of kappa */
  double *y, *rate; /* [nq] the stored coordinates and their rate */
  double *L_y, *C;  /* [nq] */
} dvi__lift;

dvi_status dvi__lift_create(dvi__reference_run *run, dvi__lift *lift);
void dvi__lift_clear(dvi__lift *lift);

/* Compute kappa [size] of q [nq], and back q = y(kappa). */
void dvi__lift_up(const dvi__lift *lift, const double *q, double *kappa);
void dvi__lift_down(const dvi__lift *lift, const double *kappa, double *q);

/* Evaluate kappa's rate [size], p's rate [nv], and the momentum p [nv] of v at t, kappa and v [nv].
 * The part of v along a direction, which must be 0, is added to the part of p along that
 * direction. */
dvi_status dvi__lift_equations(dvi__lift *lift, double t, const double *kappa, const double *v,
                               double *kappa_rate, double *p_rate, double *p_of_v);

/* Compute w = T^t a [nv], tangential to directions, of a covector a [nq] at the point of the last
 * equations, and subtract from kappa's rate the part of a velocity w [nv], which is linear. */
void dvi__lift_pull(const dvi__lift *lift, const double *a, double *w);
void dvi__lift_slow(const dvi__lift *lift, const double *kappa, const double *w,
                    double *kappa_rate);

/* Remove the part of p [nv] along directions, which comes from errors. */
void dvi__lift_tangent(const dvi__lift *lift, const double *q, double *p);

#endif
