/* Polynomials by their values at nodes, with derivatives of any order. */
#ifndef DVI_FIELD_SPACE_LAGRANGE_H
#define DVI_FIELD_SPACE_LAGRANGE_H
#include "field/space/kind.h"

/* Nodes, rounded to double, and the weights 1 / prod_j (mark[k] - mark[j]). */
typedef struct dvi__lagrange {
  int count;
  long double *mark, *weight; /* [count] */
} dvi__lagrange;

/* Make the polynomials of degree count - 1 with nodes that ascend in [0,1], or NULL without memory,
 * and release them. */
dvi__lagrange *dvi__lagrange_create(int count, const long double *mark);
void dvi__lagrange_destroy(void *basis);

/* Give derivatives of all polynomials [count] at s. */
void dvi__lagrange_evaluate(const dvi__lagrange *basis, int order, double s, double *value);

/* What fem, legendre and chebyshev have in common: polynomials of a degree on each of the cells of
 * a line, with nodes in [0,1]. Lumped ones take the nodes, with their weights, as quadrature. */
dvi_status dvi__line_interpolate(int degree, const long double *mark, dvi__line *line);
dvi_status dvi__line_lump(int degree, const long double *weight, dvi__line *line);
void dvi__line_polynomials(const dvi__line *line, int order, int64_t cell, double s, double *value);

#endif
