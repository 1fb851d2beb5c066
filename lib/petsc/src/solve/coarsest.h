/* The coarsest level: all processes hold Cholesky's factor of the whole matrix. */
#ifndef DVI_PETSC_COARSEST_H
#define DVI_PETSC_COARSEST_H
#include "operator.h"

enum { DVI__COARSEST = 200 /* most unknowns */ };

typedef struct dvi__coarsest {
  const dvi__operator *A;
  PetscInt total;
  PetscMPIInt *counts, *offsets; /* [processes] of unknowns */
  PetscInt *order;               /* [total] by PETSc's numbers, that by the unknowns' numbers */
  PetscInt first;                /* own unknown of PETSc's */
  PetscScalar *factor, *x, *all; /* [total*total] lower triangle by rows, [total], [total] */
} dvi__coarsest;

/* Make it. Where a pivot is only rounding, the unknown is left out of the solution, as one of each
 * component without a fixed value is. On failure it can be cleared. */
PetscErrorCode dvi__coarsest_create(const dvi__operator *A, dvi__coarsest *made);
PetscErrorCode dvi__coarsest_solve(dvi__coarsest *c, const PetscScalar *b, PetscScalar *x);
PetscErrorCode dvi__coarsest_clear(dvi__coarsest *made);

#endif
