/* Trial functions in long double, from tables that are computed once. */
#ifndef DVI_SPACE_BASIS_H
#define DVI_SPACE_BASIS_H
#include <dvi/basis.h>

/* The largest count of trial functions on one interval. */
#define DVI__TRIAL_MAX (DVI_DEGREE_MAX + 1)

/* A basis of one degree. A nodal basis has its nodes at mark[k] / scale. Modal bases do not use the
 * other fields.
 *
 * Equispaced functions rise by 2^degree from one node to the next, which amplifies a node's
 * roundoff. With scale = degree their marks are whole numbers. */
typedef struct dvi__space {
  dvi_basis basis;
  int degree;
  long double scale;
  long double mark[DVI__TRIAL_MAX];
  long double weight[DVI__TRIAL_MAX]; /* barycentric, 1 / prod_j (mark[k] - mark[j]) */
} dvi__space;

/* Compute the tables of a basis. basis and degree must be valid. */
void dvi__space_init(dvi__space *space, dvi_basis basis, int degree);

int dvi__basis_is_nodal(dvi_basis basis);

/* Compute value[k] = phi_k(tau) and derivative[k] = phi_k'(tau), k = 0..degree. Either may be
 * NULL. */
void dvi__space_evaluate(const dvi__space *space, long double tau, long double *value,
                         long double *derivative);

#endif
