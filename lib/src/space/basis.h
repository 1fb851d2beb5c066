/* Trial functions in long double, from tables that are made once. */
#ifndef DVI_SPACE_BASIS_H
#define DVI_SPACE_BASIS_H
#include <dvi/basis.h>

/* Trial functions on one interval have at most this count. */
#define DVI__TRIAL_MAX (DVI_DEGREE_MAX + 1)

/* A basis of one degree. A nodal basis has its nodes at mark[k] / scale; modal ones leave the rest
 * alone.
 *
 * Equispaced functions rise by 2^degree from one node to the next, so that a node's roundoff is
 * felt: with scale = degree their marks are whole numbers. */
typedef struct dvi__space {
  dvi_basis basis;
  int degree;
  long double scale;
  long double mark[DVI__TRIAL_MAX];
  long double weight[DVI__TRIAL_MAX]; /* barycentric, 1 / prod_j (mark[k] - mark[j]) */
} dvi__space;

/* basis and degree must be valid. */
void dvi__space_init(dvi__space *space, dvi_basis basis, int degree);

int dvi__basis_is_nodal(dvi_basis basis);

/* value[k] = phi_k(tau), derivative[k] = phi_k'(tau), k = 0..degree; either may be NULL. */
void dvi__space_evaluate(const dvi__space *space, long double tau, long double *value,
                         long double *derivative);

#endif
