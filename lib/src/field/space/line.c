/* Spaces of one axis. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/space/kind.h"
#include "space/quadrature.h"

static const char *const axis_names[DVI_AXES_MAX] = {"x", "y", "z"};

/* ---- creation ---- */

static dvi_status check_axis(const dvi_axis *axis, const char *name)
{
  if (!isfinite(axis->from) || !isfinite(axis->to) || !(axis->from < axis->to))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "space: axis %s runs from %g to %g; finite ends in ascending "
                     "order are possible",
                     name, axis->from, axis->to);
  if ((axis->nodes != 0) != (axis->node != NULL) || axis->nodes < 0 || axis->nodes == 1)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "space: axis %s has %d nodes %s an array; give two or more, or none", name,
                     axis->nodes, axis->node != NULL ? "with" : "without");
  return DVI_OK;
}

static dvi_status read_kind(const dvi_space_options *options, const dvi_axis *axis, dvi__line *line)
{
  enum { MOST = 16 };
  const char *spec = axis->kind != NULL ? axis->kind : options->kind;
  const dvi__spec_form *form[MOST];
  int forms = 0, number = 0;
  if (spec == NULL)
    return dvi__fail(DVI_BAD_OPTION,
                     "space: axis %s has no kind; set options.kind, such as \"fem:cells=100\"",
                     line->name);
  for (; dvi__kinds[forms] != NULL; forms++) form[forms] = &dvi__kinds[forms]->form;
  DVI_TRY(dvi__spec_read(spec, forms, form, &number, line->value));
  line->kind = dvi__kinds[number];
  return DVI_OK;
}

static char *copy_text(const char *text)
{
  return dvi__duplicate(text, strlen(text) + 1, 1);
}

dvi_status dvi__line_create(const dvi_space_options *options, int d, dvi__line *line)
{
  const dvi_axis *axis = &options->axis[d];
  const char *name = axis->name != NULL ? axis->name : axis_names[d];
  DVI_TRY(check_axis(axis, name));
  *line = (dvi__line){
      .name = copy_text(name), .from = axis->from, .to = axis->to, .periodic = axis->periodic != 0};
  if (line->name == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  DVI_TRY(read_kind(options, axis, line));
  return line->kind->create(options, axis, line);
}

void dvi__line_clear(dvi__line *line)
{
  if (line->kind != NULL && line->kind->destroy != NULL) line->kind->destroy(line->own);
  dvi__release(line->name);
  dvi__release(line->node);
  dvi__release(line->place);
  dvi__release(line->weight);
  dvi__release(line->mark);
  *line = (dvi__line){0};
}

static dvi_status check_nodes(const dvi_axis *axis, int64_t cells, const dvi__line *line)
{
  const int last = axis->nodes - 1;
  if (cells != 0 && cells != last)
    return dvi__fail(DVI_BAD_OPTION, "space: axis %s has %d nodes, but cells=%lld; leave cells out",
                     line->name, axis->nodes, (long long)cells);
  for (int i = 0; i < last; i++)
    if (!(axis->node[i] < axis->node[i + 1]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "space: nodes %d and %d of axis %s, %g and %g, do not ascend", i, i + 1,
                       line->name, axis->node[i], axis->node[i + 1]);
  if (axis->node[0] != axis->from || axis->node[last] != axis->to)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "space: the nodes of axis %s run from %g to %g, but the axis from %g to %g",
                     line->name, axis->node[0], axis->node[last], axis->from, axis->to);
  return DVI_OK;
}

dvi_status dvi__line_divide(const dvi_axis *axis, int64_t cells, dvi__line *line)
{
  if (axis->nodes != 0) {
    DVI_TRY(check_nodes(axis, cells, line));
    cells = axis->nodes - 1;
  }
  if (cells == 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "space: %s on axis %s has no cells; give cells= or the nodes of the axis",
                     line->kind->form.name, line->name);
  line->cells = cells;
  line->node = axis->nodes != 0
                   ? dvi__duplicate(axis->node, (size_t)axis->nodes, sizeof *line->node)
                   : DVI_NEW(double, cells + 1);
  if (line->node == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld cells", (long long)cells);
  if (axis->nodes != 0) return DVI_OK;
  line->width = (line->to - line->from) / (double)cells;
  for (int64_t i = 0; i < cells; i++)
    line->node[i] = line->from + (line->to - line->from) * ((double)i / (double)cells);
  line->node[cells] = line->to;
  return DVI_OK;
}

dvi_status dvi__line_gauss(int n, dvi__line *line)
{
  long double node[DVI__QUADRATURE_MOST], weight[DVI__QUADRATURE_MOST];
  DVI_TRY(dvi__quadrature_long(DVI_GAUSS, n, node, weight));
  line->cell_points = n;
  line->place = DVI_NEW(double, n);
  line->weight = DVI_NEW(double, n);
  if (line->place == NULL || line->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %d points", n);
  for (int k = 0; k < n; k++) {
    line->place[k] = (double)node[k];
    line->weight[k] = (double)weight[k];
  }
  return DVI_OK;
}

void dvi__explain_gauss(const dvi__line *line, dvi__note *note)
{
  dvi__note_add(note, "%d Gauss points a cell, exact for polynomials of degree %d",
                line->cell_points, 2 * line->cell_points - 1);
}

/* ---- rows ---- */

/* Write the values of local functions as a row with ascending columns. Functions that a periodic
 * axis of few cells names twice are added. Zeros are left out. */
static int gather_row(const dvi__line *line, int64_t cell, const double *local, int *column,
                      double *value)
{
  int count = 0;
  for (int l = 0; l < line->locals; l++) {
    if (local[l] == 0) continue;
    const int function = (int)((cell * line->stride + l) % line->functions);
    int at = count;
    while (at > 0 && column[at - 1] >= function) at--;
    if (at < count && column[at] == function) {
      value[at] += local[l];
      continue;
    }
    for (int j = count++; j > at; j--) {
      column[j] = column[j - 1];
      value[j] = value[j - 1];
    }
    column[at] = function;
    value[at] = local[l];
  }
  return count;
}

/* By the chain rule a derivative in x is one in s over a power of the cell's length. */
static void scale_row(const dvi__line *line, int order, int64_t cell, int count, double *value)
{
  if (order == 0) return;
  const double factor = pow(dvi__cell_width(line, cell), -order);
  for (int i = 0; i < count; i++) value[i] *= factor;
}

/* Give the values of local functions at the points of a cell [cell_points*locals]. */
static void tabulate(const dvi__line *line, int order, int64_t cell, double *table)
{
  for (int k = 0; k < line->cell_points; k++)
    line->kind->local(line, order, cell, line->place[k], table + (ptrdiff_t)k * line->locals);
}

static void fill_operator(const dvi__line *line, int order, double *table, dvi__csr *matrix)
{
  int64_t row = 0;
  for (int64_t c = 0; c < line->cells; c++) {
    if (c == 0 || !line->kind->is_affine) tabulate(line, order, c, table);
    for (int k = 0; k < line->cell_points; k++, row++) {
      const int64_t start = matrix->start[row];
      const int count = gather_row(line, c, table + (ptrdiff_t)k * line->locals,
                                   matrix->column + start, matrix->value + start);
      scale_row(line, order, c, count, matrix->value + start);
      matrix->start[row + 1] = start + count;
    }
  }
}

dvi_status dvi__line_operator(const dvi__line *line, int order, dvi__csr *matrix)
{
  const int64_t points = dvi__line_points(line);
  double *table = DVI_NEW(double, (int64_t)line->cell_points * line->locals);
  if (table == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for a table of values");
  const dvi_status status = dvi__csr_allocate(points, line->functions, points * line->locals,
                                              matrix);
  if (status == DVI_OK) fill_operator(line, order, table, matrix);
  dvi__release(table);
  return status;
}

/* Find the cell of x, the last one that begins at or before it. */
static int64_t find_cell(const dvi__line *line, double x)
{
  int64_t low = 0, high = line->cells;
  while (high - low > 1) {
    const int64_t middle = low + (high - low) / 2;
    if (line->node[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  return low;
}

int dvi__line_row(const dvi__line *line, int order, double x, int *column, double *value)
{
  const double length = line->to - line->from;
  double local[DVI__LOCALS_MOST];
  if (!isfinite(x)) return 0;
  if (line->periodic) x -= length * floor((x - line->from) / length);
  if (line->periodic) x = fmin(fmax(x, line->from), line->to);
  if (x < line->from || x > line->to) return 0;
  const int64_t cell = find_cell(line, x);
  const double start = line->node[cell], width = line->node[cell + 1] - start;
  line->kind->local(line, order, cell, (x - start) / width, local);
  const int count = gather_row(line, cell, local, column, value);
  scale_row(line, order, cell, count, value);
  return count;
}
