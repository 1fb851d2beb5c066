/* The largest eigenvalue lambda of a symmetric operator from the tridiagonal matrix T of Lanczos'
 * method, whose largest eigenvalue theta is a Ritz value.
 *
 * theta is not above lambda, and from a start at random below lambda (1 - epsilon) with a
 * probability of at most
 *
 *     1.648 sqrt(n) exp(-sqrt(epsilon) (2 m - 1))
 *
 * after m steps, whatever the spectrum is (Kuczynski and Wozniakowski 1992, sec. 4). A small
 * residual would not do: it tells of some eigenvalue, which may be the second one. A very small one
 * does, because the start has a part in every eigenvector. */
#ifndef DVI_FIELD_ALGEBRA_RITZ_H
#define DVI_FIELD_ALGEBRA_RITZ_H
#include <stdint.h>

enum { DVI__RITZ_STEPS = 450 };

/* T after some steps, A q_j = beta_j q_{j-1} + alpha_j q_j + beta_{j+1} q_{j+1}. */
typedef struct dvi__ritz {
  int steps;
  double alpha[DVI__RITZ_STEPS], beta[DVI__RITZ_STEPS + 1]; /* beta[0] is 0 */
} dvi__ritz;

/* Tell if T suffices for an operator of n unknowns, whose eigenvalues are positive and not above
 * another bound, which may be infinite. Then `bound` is not below lambda, and at most a thousandth
 * above it, but for a probability of 1e-8. */
int dvi__ritz_suffices(const dvi__ritz *T, int64_t n, double other, double *bound);

#endif
