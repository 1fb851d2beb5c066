/* Vectors of PETSc whose numbers do not depend on how many processes hold them, or on the BLAS:
 * products and norms are exact sums of rounded products, rounded once, and each number of a sum of
 * vectors is computed by itself. What PETSc makes of them by these operations, as its iterations
 * do, has the same bits for any division. */
#ifndef DVI_PETSC_VECTOR_H
#define DVI_PETSC_VECTOR_H
#include <petscvec.h>

#include "num/accumulator.h"

/* Make a vector of `rows` numbers on this process. Its duplicates are such vectors, too. */
PetscErrorCode dvi__vector_create(MPI_Comm comm, PetscInt rows, Vec *vector);

/* Give the sum of all processes' sums, rounded once. */
PetscErrorCode dvi__sum_of_world(MPI_Comm comm, dvi__accumulator *sum, PetscScalar *value);

#endif
