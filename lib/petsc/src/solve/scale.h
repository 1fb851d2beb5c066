/* The scale of a linear equation. In the course of a solution its right-hand side is divided by a
 * power of two near the size of the solution: squares of small numbers vanish, those of large ones
 * overflow, and PETSc's minimal residuals compare with numbers of their own. Otherwise no bit of
 * the solution depends on it. */
#ifndef DVI_PETSC_SCALE_H
#define DVI_PETSC_SCALE_H
#include <petscksp.h>

#include "operator.h"

typedef struct dvi__scale {
  MPI_Comm comm;
  PetscInt own;
  PetscScalar *diagonal; /* [own] of A */
  PetscReal factor;      /* by which norms of the right-hand side are too small, otherwise 1 */
} dvi__scale;

/* Prepare for equations of A, whose unknowns have one number each or several, those of one after
 * the other. All zero before. */
PetscErrorCode dvi__scale_create(const dvi__operator *A, dvi__scale *scale);
PetscErrorCode dvi__scale_clear(dvi__scale *scale);

/* Let a solver have right-hand sides near the diagonal's size. */
PetscErrorCode dvi__scale_use(dvi__scale *scale, KSP ksp);

#endif
