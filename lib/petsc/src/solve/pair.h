/* Equations of pairs (field/model/elliptic.h), whose Jacobian is symmetric and indefinite. Minimal
 * residuals (Paige and Saunders 1975) solve them, with one multigrid cycle of A for each of the two
 * numbers. For eigenvalues 1 + k of A beside M those of the preconditioned Jacobian are
 *
 *     +- |k + cosine + i sine| / (1 + k),
 *
 * whose sizes are between the cosine of half the angle and 1, whatever the mesh is (Mardal, Nilssen
 * and Staff 2007, with the eigenvectors of the stages as in Butcher 1976). */
#ifndef DVI_PETSC_PAIR_H
#define DVI_PETSC_PAIR_H
#include "field/model/elliptic.h"
#include "multigrid.h"

typedef struct dvi__pair {
  const dvi__operator *A;
  PetscScalar *mass, *diagonal; /* [own] M, and that of A */
  PetscScalar cosine, sine;
  PetscReal scale; /* a power of two: the right-hand side in the course of a solution is that much
                    * larger */
  Mat shown;
  PC cycle; /* for one of the numbers */
  Vec in, out;
} dvi__pair;

/* Prepare for equations whose unknowns have the `place` in A. All zero before. On failure it can be
 * cleared. */
PetscErrorCode dvi__pair_create(dvi__operator *A, dvi__multigrid *multigrid,
                                const dvi__elliptic *equations, const PetscInt *place,
                                dvi__pair *pair);
PetscErrorCode dvi__pair_clear(dvi__pair *pair);

/* Set y [2*own] to the Jacobian times x, with the diagonal D [2*own]. */
PetscErrorCode dvi__pair_multiply(const dvi__pair *pair, const PetscScalar *D, const PetscScalar *x,
                                  PetscScalar *y);

/* Let a solver of such equations be preconditioned, and have right-hand sides near 1: PETSc's
 * minimal residuals compare with numbers of their own. */
PetscErrorCode dvi__pair_use(dvi__pair *pair, KSP ksp);

#endif
