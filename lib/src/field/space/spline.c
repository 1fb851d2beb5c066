/* B-splines of degree p with p-1 continuous derivatives at the ends of the cells.
 *
 * Knots are the ends of the cells. Those beyond the ends of the axis are the ends themselves, or on
 * a periodic axis the knots of the next period. Function r of cell c is B_{c-p+r,p}. Its derivative
 * is
 *
 *     B'_{i,d} = d [ B_{i,d-1} / (t_{i+d} - t_i) - B_{i+1,d-1} / (t_{i+d+1} - t_{i+1}) ],
 *
 * so that derivatives of order r take the splines of degree p-r and this formula r times. Sources:
 * de Boor 1978, ch. X; Piegl and Tiller 1997, algorithm A2.2. */
#include "core/status.h"
#include "field/space/kind.h"

enum { DEGREE, CELLS, POINTS, DEGREE_MOST = 8, CELLS_MOST = 1 << 30, POINTS_MOST = 80 };

static dvi_status spline_create(const dvi_space_options *options, const dvi_axis *axis,
                                dvi__line *line)
{
  (void)options;
  const int degree = line->value[DEGREE],
            points = line->value[POINTS] != 0 ? line->value[POINTS] : degree + 1;
  const double cells = line->value[CELLS];
  DVI_TRY(dvi__space_check_sizes(cells, points * cells));
  DVI_TRY(dvi__line_divide(axis, line->value[CELLS], line));
  line->degree = degree;
  line->locals = degree + 1;
  line->stride = 1;
  line->smoothness = degree;
  line->functions = line->cells + (line->periodic ? 0 : degree);
  return dvi__line_gauss(points, line);
}

static double knot(const dvi__line *line, int64_t i)
{
  const int64_t cells = line->cells;
  if (!line->periodic) return line->node[i < 0 ? 0 : i > cells ? cells : i];
  const int64_t period = i >= 0 ? i / cells : -((cells - 1 - i) / cells);
  return line->node[i - period * cells] + (double)period * (line->to - line->from);
}

/* The splines [d+1] of degree d, from the knots t around s in [t[0], t[1]]. */
static void splines(int d, const double *t, double s, double *value)
{
  value[0] = 1;
  for (int j = 1; j <= d; j++) {
    double carried = 0;
    for (int r = 0; r < j; r++) {
      const double left = s - t[r + 1 - j], right = t[r + 1] - s;
      const double part = value[r] / (right + left);
      value[r] = carried + right * part;
      carried = left * part;
    }
    value[j] = carried;
  }
}

/* Replace splines of degree d-1 by derivatives of those of degree d. */
static void differentiate(int d, const double *t, double *value)
{
  double lower = 0;
  for (int j = 0; j <= d; j++) {
    const double upper = j < d ? value[j] / (t[j + 1] - t[j + 1 - d]) : 0;
    value[j] = (double)d * (lower - upper);
    lower = upper;
  }
}

static void spline_local(const dvi__line *line, int order, int64_t cell, double s, double *value)
{
  const int degree = line->value[DEGREE];
  const double origin = line->node[cell], width = line->node[cell + 1] - origin;
  double around[2 * DEGREE_MOST], *t = around + degree - 1;
  for (int i = 1 - degree; i <= degree; i++) t[i] = (knot(line, cell + i) - origin) / width;
  splines(degree - order, t, s, value);
  for (int d = degree - order + 1; d <= degree; d++) differentiate(d, t, value);
}

const dvi__kind dvi__spline = {
    .form = {.name = "spline",
             .key = {[DEGREE] = {"degree", 1, DEGREE_MOST, 3, NULL},
                     [CELLS] = {"cells", 1, CELLS_MOST, 0, NULL},
                     [POINTS] = {"points", 1, POINTS_MOST, 0, NULL}}},
    .create = spline_create,
    .local = spline_local,
    .explain = dvi__explain_gauss,
};
