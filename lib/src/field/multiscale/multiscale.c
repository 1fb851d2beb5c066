#include "field/multiscale/multiscale.h"

#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multiscale/cell.h"
#include "field/multiscale/sample.h"

enum { LOCALS = DVI__MULTISCALE_LOCALS };

void dvi__multiscale_clear(dvi__multiscale *multiscale)
{
  for (int d = 0; d < 2; d++) dvi__fine_axis_clear(&multiscale->axis[d]);
  dvi__release(multiscale->value);
  *multiscale = (dvi__multiscale){0};
}

dvi_status dvi__multiscale_check_size(const dvi__multiscale_terms *t)
{
  const double nodes = (t->fine + 1.) * (t->fine + 1.) * LOCALS * t->cells[0] * t->cells[1];
  if (nodes < INT_MAX) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "%s: %d x %d cells with %d x %d fine ones each are too many",
                   t->coefficient.name, t->cells[0], t->cells[1], t->fine, t->fine);
}

static dvi_status find_functions(const dvi__multiscale_terms *terms, dvi__multiscale *m, double *a)
{
  if (m->value == NULL || a == NULL)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory for the functions of %d x %d cells",
                     terms->coefficient.name, terms->cells[0], terms->cells[1]);
  DVI_TRY(dvi__coefficient_of_cells(m->axis, &terms->coefficient, a, &m->defect));
  return dvi__cells_solve(terms, m->axis, a, m->value);
}

static dvi_status divide(const dvi__multiscale_terms *t, dvi__multiscale *m)
{
  for (int d = 0; d < 2; d++)
    DVI_TRY(
        dvi__fine_axis_create(t->node[d], t->cells[d], t->fine, t->is_periodic[d], &m->axis[d]));
  return DVI_OK;
}

dvi_status dvi__multiscale_create(const dvi__multiscale_terms *terms, dvi__multiscale *multiscale)
{
  *multiscale = (dvi__multiscale){0};
  DVI_TRY(dvi__multiscale_check_size(terms));
  dvi_status status = divide(terms, multiscale);
  if (status == DVI_OK) {
    const size_t cells = (size_t)terms->cells[0] * (size_t)terms->cells[1];
    const size_t fine = (size_t)terms->fine;
    double *a = DVI_NEW(double, cells *fine *fine);
    multiscale->value = DVI_NEW(double, cells *LOCALS *(fine + 1) * (fine + 1));
    status = find_functions(terms, multiscale, a);
    dvi__release(a);
  }
  if (status != DVI_OK) dvi__multiscale_clear(multiscale);
  return status;
}

/* ---- rows ---- */

/* Set weight [2] of the ends of a part in the linear interpolation of a value or of its slope. */
static void interpolate(const dvi__fine_axis *axis, int order, int part, double place,
                        double *weight)
{
  const double slope = 1 / dvi__fine_axis_length(axis, part);
  weight[0] = order == 0 ? 1 - place : -slope;
  weight[1] = order == 0 ? place : slope;
}

/* Put an entry into a row with ascending columns. Two corners of a cell may be one function. */
static int put(int column, double value, int count, int *columns, double *values)
{
  int at = 0;
  while (at < count && columns[at] < column) at++;
  if (at < count && columns[at] == column) {
    values[at] += value;
    return count;
  }
  for (int i = count; i > at; i--) {
    columns[i] = columns[i - 1];
    values[i] = values[i - 1];
  }
  columns[at] = column;
  values[at] = value;
  return count + 1;
}

int dvi__multiscale_row(const dvi__multiscale *multiscale, const int *order, const int *part,
                        const double *place, int *column, double *value)
{
  const dvi__fine_axis *axis = multiscale->axis;
  const int fine = axis[0].fine, nodes = (fine + 1) * (fine + 1);
  const int cell[2] = {part[0] / fine, part[1] / fine};
  const int corner = part[0] % fine * (fine + 1) + part[1] % fine;
  const double *local = multiscale->value +
                        ((size_t)cell[0] * (size_t)axis[1].cells + (size_t)cell[1]) *
                            (size_t)(LOCALS * nodes);
  double wx[2], wy[2];
  interpolate(&axis[0], order[0], part[0], place[0], wx);
  interpolate(&axis[1], order[1], part[1], place[1], wy);
  int count = 0;
  for (int k = 0; k < LOCALS; k++) {
    const double *phi = local + (ptrdiff_t)k * nodes + corner;
    const double sum = wx[0] * (wy[0] * phi[0] + wy[1] * phi[1]) +
                       wx[1] * (wy[0] * phi[fine + 1] + wy[1] * phi[fine + 2]);
    const int function = dvi__fine_axis_node(&axis[0], cell[0], k / 2) *
                             dvi__fine_axis_nodes(&axis[1]) +
                         dvi__fine_axis_node(&axis[1], cell[1], k % 2);
    count = put(function, sum, count, column, value);
  }
  return count;
}
