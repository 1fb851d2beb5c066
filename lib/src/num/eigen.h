/* The real eigen-structure of a full matrix. */
#ifndef DVI_NUM_EIGEN_H
#define DVI_NUM_EIGEN_H
#include <dvi/status.h>

/* Find T = X D X^{-1} with real X. D is diagonal but for 2 x 2 blocks [[a, b], [-b, a]] of the
 * pairs a +- ib, b > 0.
 *
 * T, X and inverse are [n*n] by columns, real_part and imaginary_part [n]. The number of a pair
 * with b > 0 stands first. DVI_SINGULAR if T has no full set of eigenvectors, DVI_NO_MEMORY. */
dvi_status dvi__eigen(int n, const double *T, double *real_part, double *imaginary_part, double *X,
                      double *inverse);

/* Give the eigenvalues of a full matrix T, column j at T + j*lead, which is overwritten. Unless it
 * is NULL, `last` [n] gets the sizes of the last components of the eigenvectors of length 1.
 * DVI_NOT_FINITE, at which LAPACK would end the program, DVI_SINGULAR if the iteration did not
 * converge, DVI_NO_MEMORY. */
dvi_status dvi__eigenvalues(int n, double *T, int lead, double *real_part, double *imaginary_part,
                            double *last);

/* Solve K X = M X diag(lambda) with X^T M X = 1 for symmetric K and positive definite M, both [n*n]
 * by columns. lambda [n] is ascending. DVI_SINGULAR if M, the mass, is not positive definite,
 * DVI_NO_MEMORY. */
dvi_status dvi__eigen_symmetric(int n, const double *K, const double *M, double *lambda, double *X);

/* Give the ascending eigenvalues of a symmetric A [n*n], which is overwritten. work [8*n]. Returns
 * 0 if the iteration did not converge. */
int dvi__symmetric_eigenvalues(int n, double *A, double *lambda, double *work);

/* Count the negative eigenvalues of a full matrix H, column j at H + j*lead. H is the projection of
 * a larger matrix onto n orthonormal vectors. Only eigenvalues that are settled to a tenth of their
 * size count. `next` is the length of the part of H's last column beyond the n vectors (Saad 2011,
 * prop. 6.8). H is overwritten. work [n*(n+6)]. */
int dvi__negative_ritz_values(int n, double *H, int lead, double next, double *work);

/* Tell whether a symmetric A [n*n], whose lower triangle is overwritten, is positive definite. */
int dvi__is_positive_definite(int n, double *A);

#endif
