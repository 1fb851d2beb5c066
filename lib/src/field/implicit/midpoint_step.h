/* A step of the implicit midpoint rule on shares of a mesh. With q_m = q0 + x it solves
 *
 *     M x - h/2 (p0 - h/2 F) = 0,      F = K q_m - load - J(t_m) + w V_u(q_m) + S (2 x/h),
 *     q1 = q0 + 2 x,      p1 = p0 - h F
 *
 * (docs/methods/midpoint.md). The Jacobian is M + h/2 S + h^2/4 (K + w V_uu). All processes solve
 * together (field/model/on_all.h). The energy of a linear field changes by 2 F.M^-1 r, with what is
 * left of the equation: no factor may be rounded that halves of h do not give exactly.
 *
 * Of Maxwell's fields K q = d^T M_{k+1} B, and B = dA has steps of its own, B1 = B0 + 2 d x. So no
 * rounding grows with A, whose static fields are gradients that grow with time, and F has no charge
 * but where numbers are added to p. */
#ifndef DVI_FIELD_IMPLICIT_MIDPOINT_STEP_H
#define DVI_FIELD_IMPLICIT_MIDPOINT_STEP_H
#include "field/model/on_all.h"
#include "field/step/sweep.h"

/* A state at a time. Values of others' cells are refreshed. */
typedef struct dvi__midpoint_state {
  double t;
  double *q, *p;     /* [cells] the form, and its momentum */
  double *B;         /* [faces] of Maxwell's fields */
  double *delivered; /* [currents] integrals of the signals since the start */
} dvi__midpoint_state;

typedef struct dvi__midpoint_step {
  const dvi_field *field;
  const dvi__sweep *sweep; /* of Maxwell's fields, or NULL */
  double h;
  dvi__on_all solver;
  const dvi__midpoint_state *from;
  double signal[DVI__CURRENTS];      /* at the middle */
  double *x, *middle, *force, *work; /* [unknowns] */
  double *form, *H;                  /* [cells], [faces] of Maxwell's fields */
  double *loss;                      /* [unknowns] the diagonal of S, or NULL without one */
} dvi__midpoint_step;

/* Prepare steps of a length. Maxwell's fields have a sweep, with the weights of all faces. Called
 * on all processes. On failure nothing is owned. */
dvi_status dvi__midpoint_step_create(const dvi_field *field, const dvi__sweep *sweep, double h,
                                     dvi__midpoint_step **made);
void dvi__midpoint_step_destroy(dvi__midpoint_step **made);

/* Make a step. On failure `to` stays as it was, but where processes could not give each other their
 * values, which sets *is_lost. The report is that of the solver. */
dvi_status dvi__midpoint_take(dvi__midpoint_step *step, const dvi__midpoint_state *from,
                              dvi__midpoint_state *to, int *is_lost, dvi__elliptic_report *report);

#endif
