/* The inside of an element on phase space, for phase.c and phase_pattern.c. */
#ifndef DVI_ACTION_PHASE_STRUCT_H
#define DVI_ACTION_PHASE_STRUCT_H
#include "step/onestep/collocation.h"
#include "step/hamiltonian/phase.h"
#include "system/dynamics/constrained_hamiltonian.h"

/* Where a function's second derivatives go in the derivative of its field (F_p, -F_q): for each
 * entry of F_qq, F_qp and F_pp the entry of `joint`; F_qp goes to two places. */
typedef struct dvi__vector_field_places {
  int *qq, *qp_in_p, *qp_in_q, *pp;
} dvi__vector_field_places;

struct dvi__phase {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, m, d, k;
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST], b[DVI__STAGES_MOST], c[DVI__STAGES_MOST];
  double legendre[DVI__STAGES_MOST][DVI__STAGES_MOST + 1]; /* P_l(c_i) at [i][l] */
  /* One row and column for each component of z and each constraint; the Jacobian has a block for
   * each entry. */
  dvi__pattern joint, pattern;
  dvi__vector_field_places of_H, of_phi;
  /* [entries of joint] of a constraint's row or column: the entry of its gradient; else -1 */
  int *gradient;
  /* The step. */
  double t0, h;
  const double *q0, *p0;
  double *kick;    /* [2n] h X_phi lambda/2 at the start */
  double *impulse; /* [m] h lambda there */
  /* At the stages, component by component: [2n*d], but for t [d] and phi [m*d]. */
  double *t, *Z, *F, *phi;
  double *H_qq, *H_qp, *H_pp; /* [entries*d] */
  /* [entries of the gradients * (d+1)]: at each stage, at the end */
  double *phi_z;
  double *phi_qq, *phi_qp, *phi_pp; /* [entries] at one point */
  /* [entries of joint * (d+1)] of h X_H + h X_phi Lambda at each stage, of X_phi (h lambda') at the
   * end */
  double *slope;
  double *point, *end, *field, *weight; /* [2n], [2n], [2n], [m] */
};

/* Make joint, pattern, and all that says where something goes. */
dvi_status dvi__phase_lay_out(dvi__phase *phase);
void dvi__phase_clear_layout(dvi__phase *phase);

#endif
