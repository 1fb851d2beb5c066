/* Conditions of the boundary, and the values that they fix, at rest or moving. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"
#include "field/space/kind.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for conditions");
}

/* ---- sites ---- */

/* The coefficients of a coordinate are where the functions of a nodal space are 1, and the ends of
 * an interval for all spaces. */
static int coordinate(int64_t count, const double *x, double *f, void *user)
{
  memcpy(f, x + *(const int *)user * count, (size_t)count * sizeof *f);
  return 0;
}

static int square(int64_t count, const double *x, double *f, void *user)
{
  for (int64_t k = 0; k < count; k++) {
    f[k] = 0;
    for (int d = 0; d < *(const int *)user; d++) f[k] += x[d * count + k] * x[d * count + k];
  }
  return 0;
}

static dvi_status find_sites(dvi_density *density)
{
  if (density->site != NULL) return DVI_OK;
  density->site = DVI_NEW(double, density->dimension * density->functions);
  if (density->site == NULL) return no_memory();
  for (int d = 0; d < density->dimension; d++)
    DVI_TRY(dvi_space_interpolate(density->space, coordinate, &d,
                                  density->site + d * density->functions));
  return DVI_OK;
}

/* Tell if coefficients are values at the sites, as those of a parabola. */
static dvi_status find_nodal(const dvi_density *density, int *is_nodal)
{
  const int64_t n = density->functions;
  int dimension = density->dimension;
  double *room = DVI_NEW(double, 2 * n);
  if (room == NULL) return no_memory();
  const dvi_status status = dvi_space_interpolate(density->space, square, &dimension, room);
  (void)square(n, density->site, room + n, &dimension);
  double most = 0;
  *is_nodal = 1;
  for (int64_t i = 0; i < n; i++) most = fmax(most, fabs(room[n + i]));
  for (int64_t i = 0; i < n; i++)
    if (!(fabs(room[i] - room[n + i]) <= 1e-10 * most)) *is_nodal = 0;
  dvi__release(room);
  return status;
}

/* Copy the points of functions, axis by axis. */
static double *copy_sites(const dvi_density *density, int64_t count, const int *function)
{
  double *x = DVI_NEW(double, density->dimension *count);
  for (int d = 0; d < density->dimension && x != NULL; d++)
    for (int64_t i = 0; i < count; i++)
      x[d * count + i] = density->site[d * density->functions + function[i]];
  return x;
}

/* ---- checks ---- */

static dvi_status check(const dvi_density *density, const dvi_density_condition *condition, int i)
{
  int64_t count;
  if (condition->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: condition %d has no part of the boundary", i);
  if (condition->kind != DVI_FREE && condition->kind != DVI_FIXED)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: the condition on \"%s\" has no kind %d",
                     condition->part, (int)condition->kind);
  if (condition->component < -1 || condition->component >= density->components)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "density: the condition on \"%s\" is for component %d, 0 to %d, or -1 for all, "
        "possible",
        condition->part, condition->component, density->components - 1);
  if (condition->rate != NULL && condition->datum == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: the datum on \"%s\" has a rate, and no value",
                     condition->part);
  if (!isfinite(condition->robin))
    return dvi__fail(DVI_NOT_FINITE, "density: `robin` on \"%s\" is %g", condition->part,
                     condition->robin);
  if (condition->robin != 0 && condition->kind == DVI_FIXED)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: values on \"%s\" are fixed, and `robin` is set: take DVI_FREE",
                     condition->part);
  if (dvi_space_boundary(density->space, condition->part, &count) != NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "density: a condition is set on \"%s\", which is no part of the boundary%s",
                   condition->part, density->is_fourier ? ": fourier has none" : "");
}

dvi_status dvi__density_check_datum(const dvi_density *density,
                                    const dvi_density_condition *condition, int failed,
                                    int64_t count, const double *x, const double *datum)
{
  if (failed != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "density: the datum on \"%s\" returned %d",
                     condition->part, failed);
  for (int64_t i = 0; i < count; i++)
    if (!isfinite(datum[i]))
      return dvi__fail(DVI_NOT_FINITE, "density: the datum on \"%s\" is %g at %s = %.6g",
                       condition->part, datum[i], dvi_space_axis(density->space, 0), x[i]);
  return DVI_OK;
}

/* ---- values ---- */

/* The datum at time 0 as a function of x. */
static int initial_datum(int64_t count, const double *x, double *f, void *user)
{
  const dvi_density_condition *condition = user;
  return condition->datum(count, 0, x, f, condition->user);
}

/* Find the values [count] at functions of a part: at their sites, or by the nearest field. */
static dvi_status find_values(const dvi_density *density, const dvi_density_condition *condition,
                              int64_t count, const int *function, double *value)
{
  int is_nodal = 1;
  if (condition->datum == NULL) return DVI_OK;
  if (density->dimension > 1) DVI_TRY(find_nodal(density, &is_nodal));
  if (is_nodal) {
    double *x = copy_sites(density, count, function);
    if (x == NULL) return no_memory();
    const int failed = condition->datum(count, 0, x, value, condition->user);
    const dvi_status status = dvi__density_check_datum(density, condition, failed, count, x, value);
    dvi__release(x);
    return status;
  }
  if (condition->rate != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: values on \"%s\" move, and functions are not 1 at nodes: take "
                     "kind=fem",
                     condition->part);
  double *U = DVI_NEW(double, density->functions);
  if (U == NULL) return no_memory();
  const dvi_status status = dvi_space_interpolate(density->space, initial_datum, (void *)condition,
                                                  U);
  for (int64_t i = 0; i < count; i++) value[i] = U[function[i]];
  dvi__release(U);
  return status;
}

/* Fix the free ones of these functions of a component. The first condition counts. */
static dvi_status fix_component(dvi_density *density, const dvi_density_condition *condition, int c,
                                int64_t count, const int *function, const double *value)
{
  int64_t free = 0;
  int *moving = DVI_NEW(int, count);
  if (moving == NULL) return no_memory();
  dvi__moving_values *mover = density->mover + density->movers;
  for (int64_t i = 0; i < count; i++) {
    const int64_t place = c * density->functions + function[i];
    if (density->number[place] < 0) continue;
    density->number[place] = -1;
    density->fixed[place] = condition->rate == NULL ? value[i] : 0;
    if (condition->rate == NULL) continue;
    density->number[place] = -2 - (int)(density->moving + free);
    moving[free++] = function[i];
  }
  if (free > 0) {
    *mover = (dvi__moving_values){.given = *condition,
                                  .component = c,
                                  .first = density->moving,
                                  .count = free,
                                  .x = copy_sites(density, free, moving)};
    density->moving += free;
    density->movers++;
  }
  dvi__release(moving);
  return free == 0 || mover->x != NULL ? DVI_OK : no_memory();
}

static dvi_status fix_part(dvi_density *density, const dvi_density_condition *condition)
{
  int64_t count;
  const int *function = dvi_space_boundary(density->space, condition->part, &count);
  double *value = DVI_NEW(double, count);
  if (value == NULL) return no_memory();
  dvi_status status = find_sites(density);
  if (status == DVI_OK) status = find_values(density, condition, count, function, value);
  for (int c = 0; c < density->components && status == DVI_OK; c++)
    if (condition->component < 0 || condition->component == c)
      status = fix_component(density, condition, c, count, function, value);
  dvi__release(value);
  return status;
}

dvi_status dvi__density_fix(dvi_density *density, const dvi_density_terms *terms)
{
  density->number = DVI_NEW(int, density->places);
  density->unknown = DVI_NEW(int, density->places);
  density->fixed = DVI_NEW(double, density->places);
  density->gauge = DVI_NEW(int, density->components);
  density->mover = DVI_NEW(dvi__moving_values, terms->conditions * density->components);
  if (!density->number || !density->unknown || !density->fixed || !density->gauge ||
      !density->mover)
    return no_memory();
  for (int i = 0; i < terms->conditions; i++) {
    DVI_TRY(check(density, terms->condition + i, i));
    if (terms->condition[i].kind == DVI_FIXED) DVI_TRY(fix_part(density, terms->condition + i));
  }
  return dvi__density_number(density);
}

int dvi__density_is_circle(const dvi_density *density)
{
  const dvi_space *space = density->space;
  return !density->is_fourier && space->lines == 1 && space->line[0].periodic;
}

/* Return function i of the numbering. On a circle functions are numbered from both ends in turn, 0,
 * n-1, 1, n-2, .., so that neighbours have near numbers. */
static int64_t numbered_function(const dvi_density *density, int64_t i)
{
  if (!dvi__density_is_circle(density)) return i;
  return i % 2 == 0 ? i / 2 : density->functions - 1 - i / 2;
}

dvi_status dvi__density_number(dvi_density *density)
{
  int count = 0;
  for (int64_t i = 0; i < density->functions; i++)
    for (int c = 0; c < density->components; c++) {
      const int64_t place = c * density->functions + numbered_function(density, i);
      if (density->number[place] < 0) continue;
      density->unknown[count] = (int)place;
      density->number[place] = count++;
    }
  density->unknowns = count;
  if (count > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "density: all %lld coefficients are fixed, and nothing is unknown",
                   (long long)density->places);
}

/* ---- values that move ---- */

int dvi__density_moving(const dvi_density *density, double t, double *G, double *rate,
                        double *second)
{
  int failed = 0;
  for (int i = 0; i < density->movers && failed == 0; i++) {
    const dvi__moving_values *m = density->mover + i;
    if (G != NULL) failed = m->given.datum(m->count, t, m->x, G + m->first, m->given.user);
    if (failed == 0 && rate != NULL)
      failed = m->given.rate(m->count, t, m->x, rate + m->first,
                             second != NULL ? second + m->first : NULL, m->given.user);
  }
  return failed;
}
