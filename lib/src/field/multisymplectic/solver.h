/* Linear equations with the matrix of a step. */
#ifndef DVI_FIELD_MULTISYMPLECTIC_SOLVER_H
#define DVI_FIELD_MULTISYMPLECTIC_SOLVER_H
#include <dvi/matrix.h>

#include "num/linear.h"

/* A factor, or conjugate gradients for large symmetric matrices on three axes. */
typedef struct dvi__lattice_solver {
  dvi__linear *factor; /* NULL for conjugate gradients */
  dvi_matrix rows;     /* the matrix for these, with a start of its own */
  int64_t *start;
  double *values; /* [entries] of the pattern */
  double *work;   /* [6*unknowns] */
  double tolerance;
} dvi__lattice_solver;

/* Prepare for matrices with a pattern, which is shared. `is_exact` if a solution shall have all of
 * its digits, and not be the step of an iteration. On failure the solver may own things. */
typedef struct dvi__lattice_solver_terms {
  const dvi__pattern *pattern;
  int axes, is_symmetric, is_exact;
} dvi__lattice_solver_terms;
dvi_status dvi__lattice_solver_make(const dvi__lattice_solver_terms *terms,
                                    dvi__lattice_solver *solver);
void dvi__lattice_solver_clear(dvi__lattice_solver *solver);

/* Take new values, those of `values`. DVI_SINGULAR. */
dvi_status dvi__lattice_solver_renew(dvi__lattice_solver *solver);

/* Replace b [unknowns] by the solution. */
dvi_status dvi__lattice_solver_solve(dvi__lattice_solver *solver, double *b);

#endif
