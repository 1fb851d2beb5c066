/* Polynomials by their values at nodes.
 *
 * The barycentric form of the first kind is phi_k = weight[k] prod_{j != k} (s - mark[j]). The
 * product without one factor is that of the factors before and behind it, each a Taylor series in
 * the distance from s, cut off behind the derivative that is asked for. Nothing is divided, so that
 * s may be a node. dvi/basis.h has values and first derivatives of lower degrees only. */
#include "field/space/lagrange.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

dvi__lagrange *dvi__lagrange_create(int count, const long double *mark)
{
  dvi__lagrange *basis = DVI_NEW(dvi__lagrange, 1);
  if (basis == NULL) return NULL;
  *basis = (dvi__lagrange){
      .count = count, .mark = DVI_NEW(long double, count), .weight = DVI_NEW(long double, count)};
  if (basis->mark == NULL || basis->weight == NULL) {
    dvi__lagrange_destroy(basis);
    return NULL;
  }
  for (int k = 0; k < count; k++) basis->mark[k] = (long double)(double)mark[k];
  for (int k = 0; k < count; k++) {
    long double product = 1;
    for (int j = 0; j < count; j++)
      if (j != k) product *= basis->mark[k] - basis->mark[j];
    basis->weight[k] = 1 / product;
  }
  return basis;
}

void dvi__lagrange_destroy(void *basis)
{
  dvi__lagrange *b = basis;
  if (b == NULL) return;
  dvi__release(b->mark);
  dvi__release(b->weight);
  dvi__release(b);
}

/* Multiply a series by (a + t). */
static void multiply_series(int order, const long double *series, long double a,
                            long double *product)
{
  for (int i = order; i > 0; i--) product[i] = series[i] * a + series[i - 1];
  product[0] = series[0] * a;
}

static long double coefficient_of_product(int order, const long double *a, const long double *b)
{
  long double sum = 0;
  for (int i = 0; i <= order; i++) sum += a[i] * b[order - i];
  return sum;
}

/* Compute the Taylor coefficients of all functions at s, without their weights. */
static void expand(const dvi__lagrange *basis, int order, long double s, long double *coefficient)
{
  const int last = basis->count - 1;
  long double before[DVI__LOCALS_MOST][DVI__ORDER_MOST + 1], behind[DVI__ORDER_MOST + 1] = {1};
  memset(before[0], 0, sizeof before[0]);
  before[0][0] = 1;
  for (int k = 0; k < last; k++)
    multiply_series(order, before[k], s - basis->mark[k], before[k + 1]);
  for (int k = last; k >= 0; k--) {
    coefficient[k] = coefficient_of_product(order, before[k], behind);
    multiply_series(order, behind, s - basis->mark[k], behind);
  }
}

/* Replace the largest value by what makes the sum of derivatives zero. */
static void balance(int count, long double *value)
{
  long double sum = 0;
  int largest = 0;
  for (int k = 1; k < count; k++)
    if (fabsl(value[k]) > fabsl(value[largest])) largest = k;
  for (int k = 0; k < count; k++) sum += k == largest ? 0 : value[k];
  value[largest] = -sum;
}

void dvi__lagrange_evaluate(const dvi__lagrange *basis, int order, double s, double *value)
{
  long double exact[DVI__LOCALS_MOST], factorial = 1;
  for (int i = 2; i <= order; i++) factorial *= (long double)i;
  expand(basis, order, (long double)s, exact);
  for (int k = 0; k < basis->count; k++) exact[k] *= factorial * basis->weight[k];
  if (order > 0) balance(basis->count, exact);
  for (int k = 0; k < basis->count; k++) {
    value[k] = (double)exact[k];
    /* Exact ones make the values at nodes coefficients. */
    if (order == 0 && basis->mark[k] == (long double)s) value[k] = 1;
  }
}

/* ---- lines ---- */

dvi_status dvi__line_interpolate(int degree, const long double *mark, dvi__line *line)
{
  line->degree = degree;
  line->locals = degree + 1;
  line->stride = degree;
  line->functions = line->cells * degree + (line->periodic ? 0 : 1);
  line->own = dvi__lagrange_create(degree + 1, mark);
  line->mark = DVI_NEW(double, degree + 1);
  if (line->own == NULL || line->mark == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %d nodes", degree + 1);
  for (int k = 0; k <= degree; k++) line->mark[k] = (double)mark[k];
  return DVI_OK;
}

dvi_status dvi__line_lump(int degree, const long double *weight, dvi__line *line)
{
  line->is_nodal = 1;
  line->cell_points = degree + 1;
  line->place = dvi__duplicate(line->mark, (size_t)degree + 1, sizeof *line->place);
  line->weight = DVI_NEW(double, degree + 1);
  if (line->place == NULL || line->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %d points", degree + 1);
  for (int k = 0; k <= degree; k++) line->weight[k] = (double)weight[k];
  return DVI_OK;
}

void dvi__line_polynomials(const dvi__line *line, int order, int64_t cell, double s, double *value)
{
  (void)cell;
  dvi__lagrange_evaluate(line->own, order, s, value);
}
