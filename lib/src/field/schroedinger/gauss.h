/* A step of Gauss collocation, for its two files. */
#ifndef DVI_FIELD_SCHROEDINGER_GAUSS_H
#define DVI_FIELD_SCHROEDINGER_GAUSS_H
#include "field/schroedinger/shifted.h"
#include "field/schroedinger/steps.h"
#include "solve/krylov.h"

struct dvi__gauss {
  const dvi_schroedinger *s;
  int stages;
  double h, node[DVI__STAGES_MAX], A[DVI__STAGES_MAX][DVI__STAGES_MAX], d[DVI__STAGES_MAX];
  /* What rounding has taken from A and d. With it b_i a_ij + b_j a_ji = b_i b_j for b = A^T d,
   * which keeps quadratic invariants, holds to 1e-30. */
  double A_rest[DVI__STAGES_MAX][DVI__STAGES_MAX], d_rest[DVI__STAGES_MAX];
  double complex lambda[DVI__STAGES_MAX], X[DVI__STAGES_MAX][DVI__STAGES_MAX],
      inverse[DVI__STAGES_MAX][DVI__STAGES_MAX];
  dvi__shifted *solver;
  dvi__krylov *newton; /* NULL if the factors hold all of H */
  dvi__schroedinger_room room;
  double *V;                  /* [stages][points] if it depends on time */
  double *Z, *R, *mixed, *HZ; /* [stages][2*free] */
  double *stage;              /* [2*free] */
  double *psi;                /* [stages][2*points] where the Jacobian is, with an interaction */
  const double *z;            /* [2*free] at the start of the step */
};

/* Make Newton's method, unless it cannot be needed. DVI_NO_MEMORY. */
dvi_status dvi__gauss_create_newton(dvi__gauss *g);

/* Find Z of a step from z at t. DVI_NOT_CONVERGED. */
dvi_status dvi__gauss_solve_stages(dvi__gauss *g, double t, const double *z);

#endif
