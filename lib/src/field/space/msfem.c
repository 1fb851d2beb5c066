/* Functions of the cells of an axis that solve (a phi')' = 0 in each, one for each node.
 *
 * The quadrature is that of Gauss in each of the equal parts of a cell. On two axes the functions
 * are no products, and the line has only cells and quadrature (msfem_plane.c).
 * Source: Hou and Wu 1997; Leok 2004, sec. 5.7.1. */
#include "field/space/msfem.h"

#include <dvi/quadrature.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multiscale/multiscale.h"
#include "field/multiscale/rise.h"

enum { CELLS_MOST = 1 << 20, FINE_MOST = 512, THREADS_MOST = 256, FINE = 16, LOCALS = 2 };

const char *const dvi__msfem_edges[] = {"solved", "linear", "oversampled", NULL};

/* The functions of the cells. */
typedef struct rises {
  dvi__fine_axis axis;
  dvi__rise rise;
} rises;

static void destroy(void *own)
{
  rises *r = own;
  if (r == NULL) return;
  dvi__fine_axis_clear(&r->axis);
  dvi__rise_clear(&r->rise);
  dvi__release(r);
}

int dvi__msfem_points(const dvi__line *line, int axes)
{
  const int points = line->value[DVI__MSFEM_POINTS];
  return points != 0 ? points : axes == 1 ? 8 : 2;
}

static dvi_status make_quadrature(int points, dvi__line *line)
{
  const int fine = line->value[DVI__MSFEM_FINE];
  double node[DVI__MSFEM_POINTS_MOST], weight[DVI__MSFEM_POINTS_MOST];
  DVI_TRY(dvi_quadrature(DVI_GAUSS, points, node, weight));
  line->cell_points = fine * points;
  line->place = DVI_NEW(double, line->cell_points);
  line->weight = DVI_NEW(double, line->cell_points);
  line->mark = DVI_NEW(double, LOCALS);
  if (line->place == NULL || line->weight == NULL || line->mark == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %d points", line->cell_points);
  for (int k = 0; k < line->cell_points; k++) {
    const int part = k / points, point = k % points;
    line->place[k] = (part + node[point]) / fine;
    line->weight[k] = weight[point] / fine;
  }
  line->mark[1] = 1;
  return DVI_OK;
}

static dvi_status solve(const dvi_space_options *options, dvi__line *line)
{
  const int points = dvi__msfem_points(line, 1);
  const dvi__coefficient coefficient = {"space: msfem", 1, options->coefficient, options->user};
  rises *r = line->own = DVI_NEW(rises, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  DVI_TRY(dvi__fine_axis_create(line->node, (int)line->cells, line->value[DVI__MSFEM_FINE],
                                line->periodic, &r->axis));
  return dvi__rise_create(&r->axis, &coefficient, points, &r->rise);
}

static dvi_status check(const dvi_space_options *options, const dvi__line *line)
{
  if (options->coefficient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "space: msfem without a coefficient; set options.coefficient");
  if (options->axes > 2)
    return dvi__fail(DVI_UNSUPPORTED, "space: msfem on %d axes; 1 or 2 are possible",
                     options->axes);
  if (options->axes == 1 && line->value[DVI__MSFEM_EDGES] != DVI__EDGES_SOLVED)
    return dvi__fail(DVI_BAD_OPTION, "space: msfem: edges=%s on one axis, whose cells have none",
                     dvi__msfem_edges[line->value[DVI__MSFEM_EDGES]]);
  if (line->value[DVI__MSFEM_OVERLAP] != 0 &&
      line->value[DVI__MSFEM_EDGES] != DVI__EDGES_OVERSAMPLED)
    return dvi__fail(DVI_BAD_OPTION, "space: msfem: overlap=%d is for edges=oversampled",
                     line->value[DVI__MSFEM_OVERLAP]);
  return DVI_OK;
}

static dvi_status create(const dvi_space_options *options, const dvi_axis *axis, dvi__line *line)
{
  DVI_TRY(check(options, line));
  DVI_TRY(dvi__line_divide(axis, line->value[DVI__MSFEM_CELLS], line));
  const int points = dvi__msfem_points(line, options->axes);
  DVI_TRY(dvi__space_check_sizes((double)line->cells,
                                 (double)line->cells * line->value[DVI__MSFEM_FINE] * points));
  line->locals = LOCALS;
  line->stride = 1;
  line->smoothness = 1;
  line->functions = line->cells + (line->periodic ? 0 : 1);
  DVI_TRY(make_quadrature(points, line));
  return options->axes == 1 ? solve(options, line) : DVI_OK;
}

/* The functions of the left and of the right end, in the coordinate s of the cell. */
static void local(const dvi__line *line, int order, int64_t cell, double s, double *value)
{
  const rises *r = line->own;
  const int fine = r->axis.fine, at = (int)(s * fine), part = at < fine ? at : fine - 1;
  const double rise = dvi__rise_value(&r->rise, &r->axis, order, (int)cell * fine + part,
                                      s * fine - part);
  const double scale = order == 0 ? 1 : line->node[cell + 1] - line->node[cell];
  value[1] = s == 1 && order == 0 ? 1 : rise * scale;
  value[0] = order == 0 ? 1 - value[1] : -value[1];
}

static void explain(const dvi__line *line, dvi__note *note)
{
  const rises *r = line->own;
  dvi__note_add(note,
                "%d parts of each cell with %d Gauss points, from which the integrals of 1/a "
                "differ by %.1e from those of twice as many parts",
                r->axis.fine, r->rise.points, r->rise.defect);
}

const dvi__kind dvi__msfem = {
    .form = {.name = "msfem",
             .key = {[DVI__MSFEM_CELLS] = {"cells", 1, CELLS_MOST, 0, NULL},
                     [DVI__MSFEM_FINE] = {"fine", 1, FINE_MOST, FINE, NULL},
                     [DVI__MSFEM_POINTS] = {"points", 1, DVI__MSFEM_POINTS_MOST, 0, NULL},
                     [DVI__MSFEM_EDGES] = {"edges", 0, 2, 0, dvi__msfem_edges},
                     [DVI__MSFEM_OVERLAP] = {"overlap", 0, FINE_MOST, 0, NULL},
                     [DVI__MSFEM_THREADS] = {"threads", 1, THREADS_MOST, 1, NULL}}},
    .create = create,
    .local = local,
    .destroy = destroy,
    .explain = explain,
    .domain = &dvi__msfem_plane,
    .domain_axes = 2,
};
