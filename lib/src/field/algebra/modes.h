/* Eigenvalues of sparse symmetric pencils K x = lambda M x by ARPACK. */
#ifndef DVI_FIELD_ALGEBRA_MODES_H
#define DVI_FIELD_ALGEBRA_MODES_H
#include "field/algebra/definite.h"

/* A pencil of a mesh in `dimension` dimensions. M is positive definite. */
typedef struct dvi__pencil {
  const dvi_matrix *K, *M;
  int dimension;
  /* Project x onto an invariant subspace, in which all modes are looked for by Lanczos' method.
   * NULL for the whole space. */
  dvi_status (*project)(void *of, double *x);
  /* Add to z the part of a preconditioner of K + s M for the residual that lies in the kernel of K.
   * NULL if there is none. */
  void (*add_kernel)(void *of, double s, const double *residual, double *z);
  void *of;
} dvi__pencil;

/* Compute the `count` eigenvalues nearest to `shift`, ascending, and their vectors [count][rows],
 * which are orthonormal, x.M x = 1. K - shift M is regular. A negative shift of a semidefinite K,
 * and 0 of a definite one, make it positive definite, and take less time and memory. `vector` may
 * be NULL.
 *
 * DVI_BAD_SIZE, DVI_SINGULAR, DVI_NOT_CONVERGED, DVI_NO_MEMORY. */
dvi_status dvi__modes_near(const dvi__pencil *pencil, double shift, int count, double *eigenvalue,
                           double *vector);

/* Find the first of `count` of n ascending numbers that are the nearest to a shift. */
int dvi__first_of_nearest(int n, const double *value, int count, double shift);

#endif
