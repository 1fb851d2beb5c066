/* Continuous functions that are polynomials of degree k on each cell, by their values at k+1 nodes
 * of Gauss and Lobatto, the ends of the cell among them.
 *
 * The quadrature is that of Gauss with k+1 points, which is exact for the products of two
 * functions. With lumped=yes the nodes are the quadrature points. The mass is diagonal then, and
 * the eigenvalues keep their order 2k (Karniadakis and Sherwin 2005, sec. 2.3.4). */
#include "core/status.h"
#include "field/space/lagrange.h"
#include "space/quadrature.h"

enum { DEGREE, CELLS, LUMPED, POINTS, DEGREE_MOST = 8, CELLS_MOST = 1 << 30, POINTS_MOST = 80 };

static dvi_status fem_create(const dvi_space_options *options, const dvi_axis *axis,
                             dvi__line *line)
{
  (void)options;
  const int degree = line->value[DEGREE], points = line->value[POINTS],
            taken = points != 0 ? points : degree + 1;
  const double cells = line->value[CELLS];
  long double mark[DEGREE_MOST + 1] = {0}, weight[DEGREE_MOST + 1] = {0};
  if (line->value[LUMPED] && points != 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "space: fem: points=%d with lumped=yes, whose points are the nodes; leave one "
                     "of them out",
                     points);
  DVI_TRY(dvi__space_check_sizes(degree * cells, taken * cells));
  DVI_TRY(dvi__line_divide(axis, line->value[CELLS], line));
  DVI_TRY(dvi__quadrature_long(DVI_LOBATTO, degree + 1, mark, weight));
  DVI_TRY(dvi__line_interpolate(degree, mark, line));
  line->smoothness = 1;
  return line->value[LUMPED] ? dvi__line_lump(degree, weight, line) : dvi__line_gauss(taken, line);
}

static void fem_explain(const dvi__line *line, dvi__note *note)
{
  if (line->is_nodal)
    dvi__note_add(note, "lumped: the nodes are the points, exact for polynomials of degree %d",
                  2 * line->value[DEGREE] - 1);
  else
    dvi__explain_gauss(line, note);
}

const dvi__kind dvi__fem = {
    .form = {.name = "fem",
             .key = {[DEGREE] = {"degree", 1, DEGREE_MOST, 1, NULL},
                     [CELLS] = {"cells", 1, CELLS_MOST, 0, NULL},
                     [LUMPED] = {"lumped", 0, 1, 0, dvi__no_yes},
                     [POINTS] = {"points", 1, POINTS_MOST, 0, NULL}}},
    .create = fem_create,
    .local = dvi__line_polynomials,
    .is_affine = 1,
    .destroy = dvi__lagrange_destroy,
    .explain = fem_explain,
};
