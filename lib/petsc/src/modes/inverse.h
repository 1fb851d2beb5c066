/* Solutions of symmetric equations of all processes: by a factor (MUMPS), or by conjugate gradients
 * with a multigrid method. */
#ifndef DVI_PETSC_INVERSE_H
#define DVI_PETSC_INVERSE_H
#include <dvi/status.h>
#include <petscksp.h>

#include "world.h"

/* What multigrid methods need for forms of degree 1 (Hiptmair and Xu 2007): the incidence of edges
 * and vertices, and the forms of the constant vector fields along the axes. */
typedef struct dvi__edges {
  Mat d;
  Vec constant[3]; /* NULL for axes that there are not */
} dvi__edges;

typedef struct dvi__inverse {
  KSP ksp;
  const char *solver; /* "mumps", or the multigrid method */
  int is_iterated;
  int64_t solutions, iterations;
} dvi__inverse;

/* Which equations. */
typedef struct dvi__equations {
  Mat matrix;
  int is_definite;         /* positive */
  int is_large;            /* iterate if it is definite and can be */
  const dvi__edges *edges; /* of forms of degree 1, NULL for functions */
} dvi__equations;

/* Prepare an inverse. All processes call it. The matrix is shared with PETSc's count.
 *
 * DVI_UNSUPPORTED if this PETSc has no solver for these equations, DVI_SOLVER_FAILED. */
dvi_status dvi__inverse_create(const dvi__equations *equations, dvi__inverse *inverse);
void dvi__inverse_clear(dvi__inverse *inverse);

/* Solve for x. PETSC_ERR_CONV_FAILED if the matrix is singular, or iterations do not converge. */
PetscErrorCode dvi__inverse_apply(dvi__inverse *inverse, Vec b, Vec x);

#endif
