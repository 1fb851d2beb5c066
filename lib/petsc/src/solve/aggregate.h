/* Aggregates of the unknowns of a matrix for multigrid. They depend on the matrix and on the
 * numbers of its columns, and not on the processes that hold it. */
#ifndef DVI_PETSC_AGGREGATE_H
#define DVI_PETSC_AGGREGATE_H
#include "operator.h"

typedef struct dvi__aggregates {
  PetscInt own;      /* aggregates whose roots this process owns, in the order of these */
  PetscInt total;    /* of all processes */
  PetscInt *index;   /* [columns] PETSc's number of the aggregate, or -1 of unknowns without one */
  PetscInt *root;    /* [own] rows */
  PetscReal *square; /* [columns] entries of the diagonal */
} dvi__aggregates;

/* Let each unknown with strong couplings join one of the roots, no two of which have a strong
 * neighbour in common. Unknowns without strong couplings join none. On failure it can be cleared.
 * Source: Bell, Dalton and Olson 2012, sec. 3.2. */
PetscErrorCode dvi__aggregate(const dvi__operator *A, dvi__aggregates *made);
PetscErrorCode dvi__aggregates_clear(dvi__aggregates *made);

#endif
