/* A step of the implicit midpoint rule on shares of a mesh. With q_m = q0 + x it solves
 *
 *     M x - h/2 (p0 - h/2 F) = 0,      F = K q_m - load - J(t_m) + w V_u(q_m) + S (2 x/h),
 *     q1 = q0 + 2 x,      p1 = p0 - h F
 *
 * (docs/methods/midpoint.md). The Jacobian is M + h/2 S + h^2/4 (K + w V_uu). All processes solve
 * together (field/model/on_all.h). The energy of a linear field changes by 2 F.M^-1 r, with what is
 * left of the equation. Only factors that halves of h give exactly have it vanish on the mean. */
#ifndef DVI_FIELD_IMPLICIT_MIDPOINT_STEP_H
#define DVI_FIELD_IMPLICIT_MIDPOINT_STEP_H
#include "field/model/on_all.h"

typedef struct dvi__midpoint_step {
  const dvi_field *field;
  double h;
  dvi__on_all solver;
  const double *q, *p;               /* [cells] the start */
  double signal[DVI__CURRENTS];      /* at the middle */
  double *x, *middle, *force, *work; /* [unknowns] */
  double *loss;                      /* [unknowns] the diagonal of S, or NULL without one */
} dvi__midpoint_step;

/* A state at a time, of cells. */
typedef struct dvi__midpoint_state {
  double t;
  double *q, *p;     /* [cells] the form, and its momentum. Those of others are refreshed */
  double *delivered; /* [currents] integrals of the signals since the start */
} dvi__midpoint_state;

/* Prepare steps of a length. Called on all processes. On failure nothing is owned. */
dvi_status dvi__midpoint_step_create(const dvi_field *field, double h, dvi__midpoint_step **made);
void dvi__midpoint_step_destroy(dvi__midpoint_step **made);

/* Make a step. On failure `to` stays as it was, but where processes could not give each other their
 * values, which sets *is_lost. The report is that of the solver. */
dvi_status dvi__midpoint_take(dvi__midpoint_step *step, const dvi__midpoint_state *from,
                              dvi__midpoint_state *to, int *is_lost, dvi__elliptic_report *report);

#endif
