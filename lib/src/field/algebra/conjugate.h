/* Conjugate gradients for symmetric matrices that are positive definite, or semidefinite with a
 * right side in their range. */
#ifndef DVI_FIELD_ALGEBRA_CONJUGATE_H
#define DVI_FIELD_ALGEBRA_CONJUGATE_H
#include <dvi/matrix.h>

/* A matrix that is known by its products. */
typedef struct dvi__products {
  int64_t size;
  /* Set y to A x. */
  dvi_status (*times)(void *of, const double *x, double *y);
  /* Set z to P^-1 r with a positive definite P near A. NULL for the identity. */
  void (*precondition)(void *of, const double *r, double *z);
  void *of;
  double *work;    /* [5*size] numbers to work with. NULL to have them allocated */
  double roundoff; /* size of the right side's roundoff: a residual that is no larger counts as 0 */
} dvi__products;

/* What an iteration took. */
typedef struct dvi__iteration_report {
  int iterations;
  double residual; /* |b - A x| / |b| at the end */
} dvi__iteration_report;

/* Solve A x = b from x = 0 until the residual is below `tolerance` |b|, or as small as roundoff
 * lets it be. `report` may be NULL.
 *
 * DVI_SINGULAR if A is not positive on the way, DVI_NOT_CONVERGED if the residual stays above
 * 1e-6 |b|, DVI_NO_MEMORY. */
dvi_status dvi__conjugate_gradients(const dvi__products *A, double tolerance, const double *b,
                                    double *x, dvi__iteration_report *report);

/* Set z to P^-1 r with Gauss and Seidel's symmetric P = (D + L) D^-1 (D + L^T) of a symmetric
 * matrix with columns in ascending order and a positive diagonal. */
void dvi__gauss_seidel(const dvi_matrix *A, const double *r, double *z);

/* Give the products with such a matrix, which stays the caller's, preconditioned by it. */
dvi__products dvi__products_of(const dvi_matrix *A);

#endif
