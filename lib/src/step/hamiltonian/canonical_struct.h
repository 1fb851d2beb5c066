/* The struct of a step by a discrete Hamiltonian, for canonical.c and canonical_iteration.c. */
#ifndef DVI_STEP_HAMILTONIAN_CANONICAL_STRUCT_H
#define DVI_STEP_HAMILTONIAN_CANONICAL_STRUCT_H
#include "step/hamiltonian/canonical.h"
#include "step/joint.h"
#include "space/basis.h"

/* Fixed-point iteration of a step with as many points as degrees. Rows of numbers at the points are
 * padded to `lanes` in the tables, whose columns stand one after the other. */
typedef struct dvi__canonical_iteration {
  int lanes;
  double *a, *adjoint;         /* [r*lanes] coefficients of q and of p */
  double *path;                /* [r*lanes] Y of slopes q' at the points */
  double *dq, *dp;             /* [n*r] increments at the points */
  double *sum;                 /* [n*r] work */
  double *q0, *p0;             /* [n*r] the start, at each point */
  double *of_q, *of_p;         /* [n*r] one over the units */
  double *weight_q, *weight_p; /* [n*r] of changes */
} dvi__canonical_iteration;

struct dvi__canonical {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, s, r, m; /* coordinates, degree, points, unknowns of a coordinate */
  dvi__space space;
  dvi_rule rule;
  /* psi_k, psi_k - psi_k(1) and psi_k' at the points */
  double psi[DVI__CANONICAL_POINTS][DVI__CANONICAL_DEGREE],
      bar[DVI__CANONICAL_POINTS][DVI__CANONICAL_DEGREE],
      slope[DVI__CANONICAL_POINTS][DVI__CANONICAL_DEGREE];
  /* psi_k(1); the coefficients of q(tau) = tau */
  double end[DVI__CANONICAL_DEGREE], line[DVI__CANONICAL_DEGREE];
  /* coefficients from values at the points tau_k */
  double tau[DVI__CANONICAL_DEGREE], fit[DVI__CANONICAL_DEGREE * DVI__CANONICAL_DEGREE];
  double ratio, shift[DVI__CANONICAL_DEGREE][DVI__CANONICAL_DEGREE],
      /* maps a step's unknowns to those of the next, `ratio` times as long */
      shift_p[DVI__CANONICAL_POINTS][DVI__CANONICAL_POINTS];
  double c[DVI__CANONICAL_POINTS], b[DVI__CANONICAL_POINTS];
  dvi__pattern joint, pattern; /* joint is the pattern of one block, pattern that of the Jacobian */
  dvi__joint_entry *block;     /* [entries of joint] */
  /* The current step. */
  double t0, h;
  const double *q0, *p0, *unit;
  /* Values at the points, component by component [n*r]. */
  double *t, *Q, *P, *H_q, *H_p, *H_qq, *H_qp, *H_pp;
  dvi__canonical_iteration iteration;
};

/* Give the count of the numbers at the points, rounded up to whole blocks of 4. */
static inline int dvi__canonical_room(const dvi__canonical *c)
{
  return (c->n * c->r + 3) / 4 * 4;
}

/* Set Q and P at the unknowns x. */
void dvi__canonical_points(dvi__canonical *canonical, const double *x);

/* Make the iteration of a step that has one. */
dvi_status dvi__canonical_iteration_create(dvi__canonical *canonical);
void dvi__canonical_iteration_clear(dvi__canonical_iteration *iteration);

#endif
