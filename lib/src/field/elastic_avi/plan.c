/* The steps of the cells.
 *
 * A cell by itself has the stiffness K at rest and an equal part of its mass at each of its nodes.
 * With the largest eigenvalue lambda of K against it, and a damping beta K, the steps of
 * dvi__solid_resist are stable for
 *
 *     h^2 lambda + 4 h beta lambda < 4,    h < (2/omega) / (sqrt(1 + (beta omega)^2) + beta omega)
 *
 * with omega = sqrt(lambda). The sum over the cells says the same of the whole solid with equal
 * steps, whose largest frequency is not above that of any cell (Lew and others 2003). With classes
 * the steps are h 2^j, h the shortest of them, which have a common period. Steps of their own have
 * resonances at any fraction of their bounds, which are only slow (Fong, Darve and Lew 2008). */
#include "field/elastic_avi/plan.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic_avi/slabs.h"
#include "field/mesh/share.h"
#include "march/kind.h"

static const double rounding = 1e-12;

void dvi__solid_plan_clear(dvi__solid_plan *plan)
{
  dvi__release(plan->bound);
  dvi__release(plan->step);
  dvi__release(plan->class);
  dvi__release(plan->slab);
  dvi__release(plan->turn);
  *plan = (dvi__solid_plan){0};
}

static double bound_of(double omega, double beta)
{
  const double b = beta * omega;
  return 2 / omega / (sqrt(1 + b * b) + b);
}

/* A cell whose components are all given has no events. */
static int has_events(const dvi_elastic *e, int64_t cell)
{
  const int *vertex = e->vertex + cell * (e->n + 1);
  for (int a = 0; a <= e->n; a++)
    for (int i = 0; i < e->n; i++)
      if (e->unknown[(int64_t)vertex[a] * e->n + i] >= 0) return 1;
  return 0;
}

static dvi_status find_bounds(const dvi_elastic *e, dvi__solid_plan *plan)
{
  plan->tightest = INFINITY;
  for (int64_t c = 0; c < e->cells; c++) {
    double lambda;
    plan->bound[c] = plan->step[c] = INFINITY;
    if (!has_events(e, c)) continue;
    DVI_TRY(dvi__solid_largest(e, c, &lambda));
    plan->bound[c] = bound_of(sqrt(lambda), e->materials[e->material[c]].beta);
    if (!(plan->bound[c] > 0) || isinf(plan->bound[c]))
      return dvi__fail(DVI_NOT_FINITE, "avi: the longest stable step of cell %lld is %g",
                       (long long)dvi__whole_number(e->mesh, e->n, c), plan->bound[c]);
    if (plan->bound[c] < plan->tightest) plan->tightest_cell = c;
    plan->tightest = fmin(plan->tightest, plan->bound[c]);
  }
  return DVI_OK;
}

/* The bound of equal steps is that of the whole solid. */
static dvi_status find_common_bound(const dvi_elastic *e, dvi__solid_plan *plan)
{
  double omega, beta = 0;
  for (int i = 0; i < e->material_count; i++) beta = fmax(beta, e->materials[i].beta);
  DVI_TRY(dvi_elastic_fastest(e, &omega));
  plan->tightest = bound_of(omega, beta);
  for (int64_t c = 0; c < e->cells; c++)
    if (isfinite(plan->bound[c])) plan->bound[c] = plan->tightest;
  return DVI_OK;
}

/* Give the first of the cells with the least bound by itself, by its number in the whole mesh, and
 * where it is. */
static dvi_status find_tightest(const dvi_elastic *e, const dvi__solid_plan *plan, double *number,
                                double x[DVI__SOLID_AXES])
{
  const double nowhere = -(double)INFINITY, own = -plan->least_here;
  const int64_t cell = plan->tightest_cell;
  double least = own;
  DVI_TRY(dvi__largest_of_all(e->mesh, 1, &least));
  const double here = own == least ? -(double)dvi__whole_number(e->mesh, e->n, cell) : nowhere;
  *number = here;
  DVI_TRY(dvi__largest_of_all(e->mesh, 1, number));
  for (int i = 0; i < e->n; i++)
    x[i] = here == *number ? e->point[(int64_t)e->vertex[cell * (e->n + 1)] * e->n + i] : nowhere;
  *number = -*number;
  return dvi__largest_of_all(e->mesh, e->n, x);
}

static dvi_status find_fraction(const dvi_elastic *e, const dvi__solid_request *request,
                                const dvi__solid_plan *plan, double *fraction)
{
  double number, x[DVI__SOLID_AXES] = {0};
  *fraction = request->fraction > 0 ? request->fraction : 0.5;
  if (request->step > 0) *fraction = request->step / plan->tightest;
  if (*fraction < 1) return DVI_OK;
  DVI_TRY(find_tightest(e, plan, &number, x));
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "%s: steps of %g times their bounds are not stable; the least bound is %.9g, "
                   "of cell %.0f near (%g, %g, %g): take a shorter step",
                   request->is_equal ? "verlet" : "avi", *fraction, plan->tightest, number, x[0],
                   x[1], x[2]);
}

static void choose_classes(const dvi_elastic *e, double fraction, double span,
                           dvi__solid_plan *plan)
{
  const double shortest = dvi__fit_step(fraction * plan->tightest, span);
  for (int64_t c = 0; c < e->cells; c++) {
    if (isinf(plan->bound[c])) continue;
    const double ratio = fraction * plan->bound[c] / shortest * (1 + rounding);
    const int j = ilogb(fmin(fmax(ratio, 1), ldexp(1, DVI__SOLID_CLASSES - 1)));
    plan->class[c] = j;
    plan->step[c] = ldexp(shortest, j);
    if (j >= plan->classes) plan->classes = j + 1;
  }
}

static void choose_free(const dvi_elastic *e, double fraction, double span, dvi__solid_plan *plan)
{
  for (int64_t c = 0; c < e->cells; c++)
    if (isfinite(plan->bound[c])) plan->step[c] = dvi__fit_step(fraction * plan->bound[c], span);
}

/* Replace lengths by the least one, and the longest one, of all processes. */
static dvi_status find_extremes(const dvi_elastic *e, double *least, double *most)
{
  double extreme[2] = {-*least, *most};
  DVI_TRY(dvi__largest_of_all(e->mesh, 2, extreme));
  *least = -extreme[0];
  *most = extreme[1];
  return DVI_OK;
}

static dvi_status choose(const dvi_elastic *e, const dvi__solid_request *request,
                         dvi__solid_plan *plan)
{
  double fraction, none = 0;
  const double span = request->step > 0 ? 0 : request->span;
  plan->least_here = plan->tightest;
  DVI_TRY(find_extremes(e, &plan->tightest, &none));
  if (request->is_equal) DVI_TRY(find_common_bound(e, plan));
  DVI_TRY(find_fraction(e, request, plan, &fraction));
  plan->classes = 1;
  (request->is_free ? choose_free : choose_classes)(e, fraction, span, plan);
  plan->shortest = INFINITY;
  for (int64_t c = 0; c < e->cells; c++) {
    plan->shortest = fmin(plan->shortest, plan->step[c]);
    if (isfinite(plan->step[c])) plan->longest = fmax(plan->longest, plan->step[c]);
  }
  double classes = plan->classes;
  DVI_TRY(find_extremes(e, &plan->shortest, &plan->longest));
  DVI_TRY(dvi__largest_of_all(e->mesh, 1, &classes));
  plan->classes = (int)classes;
  return dvi__solid_slabs_make(e, request, plan);
}

dvi_status dvi__solid_plan_make(const dvi_elastic *solid, const dvi__solid_request *request,
                                dvi__solid_plan *plan)
{
  *plan = (dvi__solid_plan){.bound = DVI_NEW(double, solid->cells),
                            .step = DVI_NEW(double, solid->cells),
                            .class = DVI_NEW(int, solid->cells),
                            .slab = DVI_NEW(int, solid->cells),
                            .turn = DVI_NEW(uint8_t, solid->cells)};
  const int has_memory = plan->bound && plan->step && plan->class && plan->slab && plan->turn;
  dvi_status status = has_memory
                          ? find_bounds(solid, plan)
                          : dvi__fail(DVI_NO_MEMORY, "avi: no memory for the steps of %lld cells",
                                      (long long)solid->cells);
  status = dvi__agree(solid->mesh, status);
  if (status == DVI_OK && has_memory) status = choose(solid, request, plan);
  if (status != DVI_OK) dvi__solid_plan_clear(plan);
  return status;
}
