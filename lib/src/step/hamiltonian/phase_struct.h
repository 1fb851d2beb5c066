/* The struct of an element on phase space, for phase_element.c and phase_pattern.c. */
#ifndef DVI_STEP_HAMILTONIAN_PHASE_STRUCT_H
#define DVI_STEP_HAMILTONIAN_PHASE_STRUCT_H
#include "step/onestep/collocation.h"
#include "step/hamiltonian/phase_element.h"
#include "system/dynamics/constrained_hamiltonian.h"

/* Positions of a function's second derivatives in the derivative of its vector field (F_p, -F_q).
 * Each entry of F_qq, F_qp and F_pp has the index of its entry in `joint`. An entry of F_qp has two
 * such indices. */
typedef struct dvi__vector_field_places {
  int *qq, *qp_in_p, *qp_in_q, *pp;
} dvi__vector_field_places;

struct dvi__phase_element {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, m, d, k;
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST], b[DVI__STAGES_MOST], c[DVI__STAGES_MOST];
  double legendre[DVI__STAGES_MOST][DVI__STAGES_MOST + 1]; /* P_l(c_i) at [i][l] */
  /* joint has a row and a column for each component of z and each constraint, and the Jacobian has
   * a block for each entry of joint */
  dvi__pattern joint, pattern;
  dvi__vector_field_places of_H, of_phi;
  /* [entries of joint] index in the gradient for the row or column of a constraint, else -1 */
  int *gradient;
  /* The current step. */
  double t0, h;
  const double *q0, *p0;
  double *kick;    /* [2n] h X_phi lambda/2 at the start */
  double *impulse; /* [m] h lambda at the start */
  /* Values at the stages, component by component [2n*d], except t [d] and phi [m*d]. */
  double *t, *Z, *F, *phi;
  double *H_qq, *H_qp, *H_pp; /* [entries*d] */
  /* [entries of the gradients * (d+1)] values at each stage and at the end */
  double *phi_z;
  double *phi_qq, *phi_qp, *phi_pp; /* [entries] values at one point */
  /* [entries of joint * (d+1)] derivatives of h X_H + h X_phi Lambda at each stage, and of X_phi (h
   * lambda') at the end */
  double *slope;
  double *point, *end, *field, *weight; /* [2n], [2n], [2n], [m] */
};

/* Make joint and pattern, and all indices into them. */
dvi_status dvi__phase_element_lay_out(dvi__phase_element *phase);
void dvi__phase_element_clear_layout(dvi__phase_element *phase);

#endif
