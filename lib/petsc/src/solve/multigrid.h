/* A multigrid preconditioner of which every piece has the same bits for any division: levels of
 * smoothed aggregation, Chebyshev's smoothers with a fixed number of products, and a coarsest level
 * that each process solves by itself. */
#ifndef DVI_PETSC_MULTIGRID_H
#define DVI_PETSC_MULTIGRID_H
#include <petscksp.h>

#include "coarsen.h"

typedef struct dvi__multigrid dvi__multigrid;

/* Make the levels of a positive definite, or semidefinite, operator, which stays. */
PetscErrorCode dvi__multigrid_create(dvi__operator *A, dvi__multigrid **made);
PetscErrorCode dvi__multigrid_destroy(dvi__multigrid **made);

/* Let a preconditioner be one cycle through the levels, which stay as long as it. */
PetscErrorCode dvi__multigrid_use(dvi__multigrid *m, PC pc);

/* Let a solver be Chebyshev's polynomial with the diagonal, for eigenvalues of D^-1 A from a tenth
 * of their bound on, without a look at norms. */
PetscErrorCode dvi__set_smoother(Mat shown, PetscReal bound, int products, KSP ksp);

/* Return how many levels there are, and the unknowns of all processes on level k, 0 the finest. */
int dvi__multigrid_levels(const dvi__multigrid *m);
PetscInt dvi__multigrid_unknowns(const dvi__multigrid *m, int k);

#endif
