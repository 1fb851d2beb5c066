#include "field/multiscale/sample.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* A larger change of a mean by twice as many parts shows that the parts do not see the coefficient.
 * Four parts a period of one with a contrast of 100 stay below it. */
static const double unresolved = .25;

/* Means of the coefficient and of its inverse over a coarse cell. */
typedef struct means {
  double a, inverse;
} means;

typedef struct sampling {
  const dvi__fine_axis *axis;
  const dvi__coefficient *coefficient;
  double *x, *a;         /* [4*parts] points of a line, and [2*parts] values */
  means *coarse, *finer; /* [cells of axis 1] of the coarse cells that are under way */
} sampling;

/* Sample at the centres of `pieces` pieces of each part of axis 1, on a line at x, and add the
 * values to the means. */
static dvi_status sample_line(const sampling *s, double x, int pieces, means *sum)
{
  const dvi__fine_axis *y = &s->axis[1];
  const int count = pieces * y->parts;
  for (int j = 0; j < count; j++) {
    s->x[j] = x;
    s->x[count + j] = dvi__fine_axis_point(y, j / pieces, (j % pieces + .5) / pieces);
  }
  DVI_TRY(dvi__coefficient_sample(s->coefficient, count, s->x, s->a));
  const double share = 1. / (pieces * y->fine) / (pieces * s->axis[0].fine);
  for (int j = 0; j < count; j++) {
    means *cell = &sum[j / (pieces * y->fine)];
    cell->a += share * s->a[j];
    cell->inverse += share / s->a[j];
  }
  return DVI_OK;
}

static dvi_status refuse(const sampling *s, int ci, int cj)
{
  const dvi__fine_axis *x = &s->axis[0], *y = &s->axis[1];
  return dvi__fail(DVI_BAD_OPTION,
                   "%s: fine=%d does not resolve the coefficient: from (%.10g, %.10g) to (%.10g, "
                   "%.10g) its mean is %g and that of its inverse %g, but %g and %g with twice as "
                   "many parts; take more parts",
                   s->coefficient->name, x->fine, x->end[ci * x->fine], y->end[cj * y->fine],
                   x->end[(ci + 1) * x->fine], y->end[(cj + 1) * y->fine], s->coarse[cj].a,
                   s->coarse[cj].inverse, s->finer[cj].a, s->finer[cj].inverse);
}

/* Compare the means of a column of coarse cells. */
static dvi_status compare(const sampling *s, int ci, double *defect)
{
  for (int cj = 0; cj < s->axis[1].cells; cj++) {
    const double of_a = dvi__coefficient_defect(s->coarse[cj].a, s->finer[cj].a);
    const double of_inverse = dvi__coefficient_defect(s->coarse[cj].inverse, s->finer[cj].inverse);
    const double larger = of_a > of_inverse ? of_a : of_inverse;
    if (larger > unresolved) return refuse(s, ci, cj);
    if (larger > *defect) *defect = larger;
  }
  return DVI_OK;
}

static dvi_status sample_column(const sampling *s, int ci, double *a, double *defect)
{
  const dvi__fine_axis *x = &s->axis[0], *y = &s->axis[1];
  memset(s->coarse, 0, (size_t)y->cells * sizeof *s->coarse);
  memset(s->finer, 0, (size_t)y->cells * sizeof *s->finer);
  for (int i = ci * x->fine; i < (ci + 1) * x->fine; i++) {
    DVI_TRY(sample_line(s, dvi__fine_axis_point(x, i, .5), 1, s->coarse));
    memcpy(a + (size_t)i * (size_t)y->parts, s->a, (size_t)y->parts * sizeof *a);
    for (int half = 0; half < 2; half++)
      DVI_TRY(sample_line(s, dvi__fine_axis_point(x, i, .25 + .5 * half), 2, s->finer));
  }
  return compare(s, ci, defect);
}

static dvi_status sample_all(const sampling *s, double *a, double *defect)
{
  if (!s->x || !s->a || !s->coarse || !s->finer)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %d points of the coefficient",
                     s->coefficient->name, 2 * s->axis[1].parts);
  *defect = 0;
  for (int ci = 0; ci < s->axis[0].cells; ci++) DVI_TRY(sample_column(s, ci, a, defect));
  return DVI_OK;
}

dvi_status dvi__coefficient_of_cells(const dvi__fine_axis axis[2],
                                     const dvi__coefficient *coefficient, double *a, double *defect)
{
  const sampling s = {axis,
                      coefficient,
                      DVI_NEW(double, 4 * (size_t)axis[1].parts),
                      DVI_NEW(double, 2 * (size_t)axis[1].parts),
                      DVI_NEW(means, axis[1].cells),
                      DVI_NEW(means, axis[1].cells)};
  const dvi_status status = sample_all(&s, a, defect);
  dvi__release(s.x);
  dvi__release(s.a);
  dvi__release(s.coarse);
  dvi__release(s.finer);
  return status;
}
