/* Cells of reference over which a monitor has equal integrals (equidistribution, de Boor 1974). The
 * integral is that of the midpoint rule on a fine grid, and linear between its points. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

enum { FINE = 64 }; /* points of the grid a cell */

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

dvi_status dvi__moving_grade(const dvi_moving_terms *terms, dvi_moving *m)
{
  const int count = FINE * m->cells;
  double *x = DVI_NEW(double, 2 * (size_t)count);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for a monitor");
  double *value = x + count;
  const dvi_status status = monitor(terms, m, count, x, value);
  if (status == DVI_OK) place(m, count, value);
  dvi__release(x);
  return status;
}
