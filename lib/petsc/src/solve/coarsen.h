/* The next coarser matrix of smoothed aggregation, with the same bits for any division. */
#ifndef DVI_PETSC_COARSEN_H
#define DVI_PETSC_COARSEN_H
#include "operator.h"

typedef struct dvi__coarser {
  PetscInt total; /* unknowns of all processes. Nothing else is made if they are too many or none */
  dvi__operator A;  /* P^T A P, up to 2^-38 of its scaled entries */
  dvi__operator P;  /* interpolates, [finer rows] by [coarser columns] */
  dvi__operator PT; /* restricts */
} dvi__coarser;

/* Return a bound of the eigenvalues of D^-1 A, where D is the diagonal of A. */
PetscErrorCode dvi__bound_of_jacobi(const dvi__operator *A, PetscReal *bound);

/* Make it. On failure it can be cleared. */
PetscErrorCode dvi__coarsen(const dvi__operator *A, PetscReal bound, dvi__coarser *made);
PetscErrorCode dvi__coarser_clear(dvi__coarser *made);

#endif
