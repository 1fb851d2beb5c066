/* Interpolations P and the matrices P^T A P, with the same bits for any division.
 *
 * An entry of P^T A P is a sum over unknowns of several processes. Its terms are brought near 1 by
 * powers of two, and rounded to multiples of 2^-38 of the largest one. Sums of up to 2^15 of them
 * are exact, so that PETSc may add them up in any order. */
#ifndef DVI_PETSC_PRODUCT_H
#define DVI_PETSC_PRODUCT_H
#include "operator.h"

/* Rows of an interpolation at the columns of a matrix. */
typedef struct dvi__rows {
  PetscInt own;     /* columns of P that this process owns */
  PetscInt *number; /* [own] theirs, in an order that does not depend on the division */
  PetscInt width;   /* most entries in a row */
  /* [columns of A * width] columns, by which PETSc knows them, or -1, and entries */
  PetscInt *column;
  PetscScalar *weight;
} dvi__rows;

typedef struct dvi__coarser {
  PetscInt total; /* unknowns of all processes. Nothing else is made if they are too many or none */
  dvi__operator A;  /* P^T A P, up to 2^-38 of its scaled entries */
  dvi__operator P;  /* interpolates, [finer rows] by [coarser columns] */
  dvi__operator PT; /* restricts */
} dvi__coarser;

/* Allocate rows without entries, for own columns and a width. On failure they can be cleared. */
PetscErrorCode dvi__rows_allocate(const dvi__operator *A, PetscInt own, PetscInt width,
                                  dvi__rows *made);
PetscErrorCode dvi__rows_clear(dvi__rows *made);

/* Take the rows of ghosts from their owners. */
PetscErrorCode dvi__rows_tell(const dvi__operator *A, dvi__rows *rows);

/* Make P, P^T and P^T A P. `square` [own columns of P] are positive numbers near the diagonal of
 * P^T A P, or NULL where the largest terms tell them. On failure it can be cleared. */
PetscErrorCode dvi__product(const dvi__operator *A, const dvi__rows *rows, const PetscReal *square,
                            dvi__coarser *made);
PetscErrorCode dvi__coarser_clear(dvi__coarser *made);

#endif
