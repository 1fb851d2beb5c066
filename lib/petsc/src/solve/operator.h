/* Sparse matrices of which each process holds the rows of its unknowns. A row is multiplied entry
 * by entry in the order of the columns' numbers, which are those of the whole mesh: products have
 * the same bits for any division. */
#ifndef DVI_PETSC_OPERATOR_H
#define DVI_PETSC_OPERATOR_H
#include <dvi/matrix.h>
#include <dvi/mesh.h>
#include <petscmat.h>

typedef struct dvi__operator {
  MPI_Comm comm;
  PetscInt rows, own, columns; /* rows, columns of this process, and those and the ghosts' */
  PetscInt *start, *column;    /* [rows+1], and columns here: own ones, and ghosts behind them */
  PetscScalar *value;
  PetscInt *number; /* [columns] in an order that does not depend on the division */
  PetscInt *index;  /* [columns] by which PETSc knows them */
  PetscScalar *x;   /* [columns] room */
  PetscSF forest;   /* roots are the owners' columns, leaves the ghosts */
} dvi__operator;

/* Unknowns of a share: cells of a degree, ascending. */
typedef struct dvi__unknowns {
  const dvi_mesh *share;
  int degree;
  int64_t count;
  const int *cell; /* [count] */
} dvi__unknowns;

/* Make the operator of a matrix of a share's unknowns, as dvi_field_matrix gives it. Rows and
 * columns that this process owns keep their order. On failure it can be cleared. */
PetscErrorCode dvi__operator_of_share(MPI_Comm comm, const dvi__unknowns *unknowns,
                                      const dvi_matrix *A, dvi__operator *made);

/* Give the unknowns [count] their columns in such an operator, own ones first, and their number. */
PetscErrorCode dvi__place_unknowns(MPI_Comm comm, const dvi__unknowns *unknowns, PetscInt *place,
                                   PetscInt *own);

/* Make the operator of an assembled matrix. `number` [own columns] is theirs. */
PetscErrorCode dvi__operator_of_matrix(MPI_Comm comm, Mat A, const PetscInt *number,
                                       dvi__operator *made);

PetscErrorCode dvi__operator_clear(dvi__operator *made);

/* Fill the ghosts of an array [columns]. */
PetscErrorCode dvi__operator_refresh(const dvi__operator *A, MPI_Datatype type, void *values);

/* Set y [rows] to A x, whose own numbers are x [own]. */
PetscErrorCode dvi__operator_multiply(const dvi__operator *A, const PetscScalar *x, PetscScalar *y);

/* Give the entry of a row at a column, or 0. */
PetscScalar dvi__operator_entry(const dvi__operator *A, PetscInt row, PetscInt column);

/* Show a square, symmetric operator to PETSc, for as long as it exists. MatCreateVecs of it gives
 * vectors as of dvi__vector_create. */
PetscErrorCode dvi__operator_show(dvi__operator *A, Mat *shown);

#endif
