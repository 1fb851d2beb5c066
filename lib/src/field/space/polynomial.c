/* One polynomial of degree N on the whole axis, by its values at N+1 nodes.
 *
 * legendre has the nodes of Gauss and Lobatto, which are the quadrature points. chebyshev has the
 * extrema of Chebyshev's polynomial, (1 - cos(pi j/N))/2 on [0,1], and N+1 points of Gauss, so that
 * the mass is exact (Karniadakis and Sherwin 2005, secs. 2.3 and 2.4). Both span the same space,
 * and what differs is the quadrature. */
#include "core/status.h"
#include "field/space/lagrange.h"
#include "space/quadrature.h"

enum { DEGREE, POINTS, DEGREE_MOST = DVI__LOCALS_MOST - 1 };

/* All derivatives of a polynomial are square integrable, unless ends are joined. */
static int smoothness_of(const dvi__line *line, int degree)
{
  if (line->periodic) return 1;
  return degree < DVI__ORDER_MOST ? degree : DVI__ORDER_MOST;
}

static dvi_status make_element(const dvi_axis *axis, dvi_rule nodes, dvi__line *line,
                               long double *weight)
{
  const int degree = line->value[DEGREE];
  long double mark[DVI__LOCALS_MOST] = {0};
  if (degree == 0)
    return dvi__fail(DVI_BAD_OPTION, "space: %s has no degree; give degree=1 to %d",
                     line->kind->form.name, DEGREE_MOST);
  if (axis->nodes != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: axis %s has nodes, but %s has one cell", line->name,
                     line->kind->form.name);
  DVI_TRY(dvi__line_divide(axis, 1, line));
  DVI_TRY(dvi__quadrature_long(nodes, degree + 1, mark, weight));
  line->smoothness = smoothness_of(line, degree);
  return dvi__line_interpolate(degree, mark, line);
}

static dvi_status legendre_create(const dvi_space_options *options, const dvi_axis *axis,
                                  dvi__line *line)
{
  (void)options;
  long double weight[DVI__LOCALS_MOST] = {0};
  DVI_TRY(make_element(axis, DVI_LOBATTO, line, weight));
  return dvi__line_lump(line->value[DEGREE], weight, line);
}

static dvi_status chebyshev_create(const dvi_space_options *options, const dvi_axis *axis,
                                   dvi__line *line)
{
  (void)options;
  long double weight[DVI__LOCALS_MOST] = {0};
  DVI_TRY(make_element(axis, DVI_CLENSHAW_CURTIS, line, weight));
  return dvi__line_gauss(line->value[POINTS] != 0 ? line->value[POINTS] : line->value[DEGREE] + 1,
                         line);
}

static void legendre_explain(const dvi__line *line, dvi__note *note)
{
  dvi__note_add(note, "the nodes are the points, exact for polynomials of degree %d",
                2 * line->value[DEGREE] - 1);
}

const dvi__kind dvi__legendre_element = {
    .form = {.name = "legendre", .key = {[DEGREE] = {"degree", 1, DEGREE_MOST, 0, NULL}}},
    .create = legendre_create,
    .local = dvi__line_polynomials,
    .is_affine = 1,
    .destroy = dvi__lagrange_destroy,
    .explain = legendre_explain,
};

const dvi__kind dvi__chebyshev_element = {
    .form = {.name = "chebyshev",
             .key = {[DEGREE] = {"degree", 1, DEGREE_MOST, 0, NULL},
                     [POINTS] = {"points", 1, DVI__QUADRATURE_MOST, 0, NULL}}},
    .create = chebyshev_create,
    .local = dvi__line_polynomials,
    .is_affine = 1,
    .destroy = dvi__lagrange_destroy,
    .explain = dvi__explain_gauss,
};
