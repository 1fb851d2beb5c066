/* The next coarser matrix of smoothed aggregation, with the same bits for any division. */
#ifndef DVI_PETSC_COARSEN_H
#define DVI_PETSC_COARSEN_H
#include "product.h"

/* Return a bound of the eigenvalues of D^-1 A, where D is the diagonal of A. */
PetscErrorCode dvi__bound_of_jacobi(const dvi__operator *A, PetscReal *bound);

/* Make it. On failure it can be cleared. */
PetscErrorCode dvi__coarsen(const dvi__operator *A, PetscReal bound, dvi__coarser *made);

#endif
