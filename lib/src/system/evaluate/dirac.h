/* Hamiltonians with constraints phi(q,p) = 0 of second class, or without any: their motion, and their parts at one point.
 *
 *     q' = H_p + phi_p^T lambda,   p' = -H_q - phi_q^T lambda,   sum_b {phi_a, phi_b} lambda_b = -{phi_a, H}.
 *
 * Source: Dirac 1964; Kraus, Yoshimura and Peng (talk). */
#ifndef DVI_SYSTEM_DIRAC_H
#define DVI_SYSTEM_DIRAC_H
#include "system/evaluate/evaluator.h"
#include "system/term/term.h"

/* The function phi(q,p).w of q and p, w fixed. */
typedef struct dvi__weighted {
  dvi__lagrangian_term term; /* its `user` is this struct, which must not move */
  const dvi__constraint_term *constraint;
  const double *w;     /* [m] */
  double *phi, *phi_z; /* [m]; in the order of the gradients' pattern */
} dvi__weighted;

dvi_status dvi__weighted_open(const dvi_system *system, dvi__weighted *weighted);
void dvi__weighted_close(dvi__weighted *weighted);

/* What an evaluator has beside the rest. */
typedef struct dvi__dirac {
  dvi__weighted weighted;
  double *bracket, *multiplier; /* [m*m], [m] */
  double *field, *pushed;       /* [2n] of H and of one constraint */
} dvi__dirac;

dvi_status dvi__dirac_create(const dvi_system *system, dvi__dirac **dirac);
void dvi__dirac_destroy(dvi__dirac **dirac);

/* The terms of a system. */
dvi_status dvi__constraint_copy(const dvi_constraint *given, int n, dvi__constraint_term **term);
void dvi__constraint_clear(dvi__constraint_term **term);

/* phi [m], and its gradients in the order of their pattern, at one point. */
dvi_status dvi__constraint_value(dvi__evaluator *e, const double *q, const double *p, double *phi);
dvi_status dvi__constraint_gradients(dvi__evaluator *e, const double *q, const double *p, double *phi_z);

/* The Hessian of phi.w, w [m], in the order of the weighted term's patterns. */
dvi_status dvi__constraint_hessian(dvi__evaluator *e, const double *q, const double *p, const double *w, double *qq, double *qp,
                                   double *pp);

/* z [2n] += factor (phi_p^T w, -phi_q^T w). */
void dvi__constraint_push(const dvi__constraint_term *c, const double *phi_z, const double *w, double factor, double *z);

/* The motion at a point, with constraints or without: q' and p' [n] each, the multiplier [m] if it is not NULL. DVI_SINGULAR where the bracket matrix is. */
dvi_status dvi__dirac_motion(dvi__evaluator *e, double t, const double *q, const double *p, double *qdot, double *pdot,
                             double *multiplier);

/* The largest |phi_a(q,p)|, and what it is measured by; DVI_BAD_ARGUMENT unless it is 0 up to rounding. */
dvi_status dvi__dirac_distance(dvi__evaluator *e, const double *q, const double *p, double *distance);
dvi_status dvi__dirac_size(dvi__evaluator *e, const double *q, const double *p, double *size);
dvi_status dvi__dirac_constraint(dvi__evaluator *e, const double *q, const double *p);

/* On which side of the points where the bracket matrix is singular a point lies, as dvi__two_form_side tells it of a one-form. */
dvi_status dvi__dirac_side(dvi__evaluator *e, const double *q, const double *p, int *side);

/* Move z = (q, p) [2n] onto phi = 0 along the fields (phi_p, -phi_q) of the constraints. */
dvi_status dvi__dirac_project(dvi__evaluator *e, double *z);

#endif
