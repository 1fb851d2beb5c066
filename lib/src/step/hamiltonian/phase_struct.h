/* The struct of an element on phase space, for the files that share it. */
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

/* Largest number of rows of a matrix in the iteration. */
enum { DVI__PHASE_ROWS_MOST = 16, DVI__PHASE_COORDINATES_MOST = 16 };

/* Numbers of the iteration (phase_iteration.c). Rows of numbers at the stages have `lanes` numbers,
 * of which those behind the stages are 0. Matrices are those of the guess. */
typedef struct dvi__phase_iteration {
  int lanes, is_frozen, count; /* count of iterations */
  double *numbers;             /* storage of all arrays */
  double *a;                   /* [d][lanes] columns of a */
  double *a_moment;            /* [k][d][lanes] columns of a_ij P_l(c_j) */
  double *moment;              /* [k][lanes] b_i P_l(c_i) */
  double *legendre;            /* [k][lanes] P_l(c_i) */
  double *W, *D;               /* [2n][lanes] and [2n] unknowns */
  double *multipliers;         /* [m][1+k] unknowns, as in x */
  /* residuals and corrections; those of the multipliers are [m][k] and [m] */
  double *of_W, *of_D, *of_moment, *of_end;
  double *gradient, *field;           /* [m][2n][lanes] phi_z and X_phi at the stages */
  double *moved;                      /* [m][k][2n][lanes] A X_phi P_l */
  double *slope;                      /* [entries][lanes] */
  double *end_gradient, *end_field;   /* [m][2n] */
  double *end_slope;                  /* [entries] */
  double *base, *there;               /* [2n][lanes] */
  int entries, *entry, *row, *column; /* entries of joint for two components of z */
  double *moments, *end;              /* [m*k][m*k] and [m][m], inverses by rows */
  double *multiplier;                 /* [m*(1+k)] */
} dvi__phase_iteration;

struct dvi__phase_element {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, m, d, k;
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST], b[DVI__STAGES_MOST], c[DVI__STAGES_MOST];
  double legendre[DVI__STAGES_MOST][DVI__STAGES_MOST + 1];        /* P_l(c_i) at [i][l] */
  double ratio, continuation[DVI__STAGES_MOST][DVI__STAGES_MOST]; /* of steps with that ratio */
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
  dvi__phase_iteration iteration;
};

/* Return the unknowns of one component of z. */
static inline const double *dvi__phase_row(const dvi__phase_element *f, const double *x,
                                           int component)
{
  return x + component * (f->d + 1);
}

/* Return h lambda' of a constraint, followed by the coefficients of h Lambda. */
static inline const double *dvi__phase_multipliers(const dvi__phase_element *f, const double *x,
                                                   int constraint)
{
  return x + 2 * f->n * (f->d + 1) + constraint * (f->k + 1);
}

/* Return the gradients of the constraints at a stage, or at the end. */
static inline double *dvi__phase_gradients(const dvi__phase_element *f, int stage)
{
  return f->phi_z + (size_t)stage * (size_t)f->system->constraint->gradients.start[f->m];
}

/* Set the points at the unknowns x. */
void dvi__phase_points(dvi__phase_element *phase, const double *x);

/* Write stage i, or the end i = d, with the multipliers there to point and weight. */
void dvi__phase_take(const dvi__phase_element *phase, const double *multipliers, int i);

/* Set F, phi and the gradients at the points, with X_phi times the multipliers of the end in field,
 * and phi of the end in weight. */
dvi_status dvi__phase_fields(dvi__phase_element *phase, const double *multipliers);

/* Set slope at the points. Gradients there are those of the last residual. */
dvi_status dvi__phase_slopes(dvi__phase_element *phase, const double *multipliers);

/* Take the matrices of the iteration at the point of the last residual. DVI_NOT_CONVERGED if they
 * cannot be inverted. */
dvi_status dvi__phase_freeze(dvi__phase_element *phase);

/* Replace the residuals of the iteration by corrections (phase_correction.c). */
void dvi__phase_correct(dvi__phase_element *phase);

/* Make the iteration of an element that has one. */
dvi_status dvi__phase_iteration_create(dvi__phase_element *phase);
void dvi__phase_iteration_clear(dvi__phase_iteration *iteration);

/* Make joint and pattern, and all indices into them. */
dvi_status dvi__phase_element_lay_out(dvi__phase_element *phase);
void dvi__phase_element_clear_layout(dvi__phase_element *phase);

#endif
