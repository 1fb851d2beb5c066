/* Cells of reference over which a monitor has equal integrals (equidistribution, de Boor 1974). The
 * integral is that of the midpoint rule on a fine grid, and linear between its points. The grid is
 * made twice as fine until the integral settles, so that narrow peaks count. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

/* Points of the grid a cell at least, of the first grid at least, and of the last one at most. */
enum { FINE = 64, FIRST = 1 << 14, LAST = 1 << 20 };

/* The integral has settled if it changes by no more than this part of it. */
static const double settled = 1e-4;

static dvi_status monitor(const dvi_moving_terms *terms, const dvi_moving *m, int count, double *x,
                          double *value)
{
  for (int i = 0; i < count; i++) x[i] = m->from + m->volume * (i + 0.5) / count;
  const int returned = terms->monitor(count, x, value, terms->user);
  if (returned != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "moving: the monitor returned %d", returned);
  for (int i = 0; i < count; i++)
    if (!(value[i] > 0 && isfinite(value[i])))
      return dvi__fail(DVI_NOT_FINITE,
                       "moving: the monitor is %g at x = %.6g, but it must be positive and finite",
                       value[i], x[i]);
  return DVI_OK;
}

/* Place the nodes where the integral of the monitor is a multiple of a share of the whole. */
static void place(dvi_moving *m, int count, const double *value)
{
  double whole = 0, sum = 0;
  for (int i = 0; i < count; i++) whole += value[i];
  for (int i = 0, k = 1; i < count; i++) {
    for (; k < m->cells && sum + value[i] >= whole * k / m->cells; k++)
      m->node[k] = m->from + m->volume / count * (i + (whole * k / m->cells - sum) / value[i]);
    sum += value[i];
  }
}

/* Sample the monitor on a grid in the place of the last one, and give its mean. */
static dvi_status sample(const dvi_moving_terms *terms, const dvi_moving *m, int count, double **x,
                         double *mean)
{
  dvi__release(*x);
  *x = DVI_NEW(double, 2 * (size_t)count);
  if (*x == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for a monitor");
  DVI_TRY(monitor(terms, m, count, *x, *x + count));
  *mean = 0;
  for (int i = 0; i < count; i++) *mean += (*x)[count + i] / count;
  return DVI_OK;
}

dvi_status dvi__moving_grade(const dvi_moving_terms *terms, dvi_moving *m)
{
  int count = FINE * m->cells < FIRST ? FIRST : FINE * m->cells;
  double *x = NULL, mean = 0, finer = 0;
  dvi_status status = sample(terms, m, count, &x, &mean);
  while (status == DVI_OK && count <= LAST / 2) {
    count *= 2;
    status = sample(terms, m, count, &x, &finer);
    if (status == DVI_OK && fabs(finer - mean) <= settled * finer) break;
    mean = finer;
  }
  if (status == DVI_OK) place(m, count, x + count);
  dvi__release(x);
  return status;
}
