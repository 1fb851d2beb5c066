#include "step/onestep/stages.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

struct dvi__stages {
  dvi__vector_field *field;
  const dvi__runge_kutta *method;
  int n, unknowns;
  dvi__pattern pattern; /* full */
  dvi__linear *linear, *transposed;
  const double *unit;
  int first;
  double t, h;
  const double *z;
  double *slope;         /* [2n*2n*s] h f_z at the stages, column by column */
  double *values;        /* [unknowns^2] */
  double *point, *image; /* [2n] */
  /* [unknowns] x has the increments, those of momenta over `unit`; R has the residual, then the
   * correction */
  double *x, *R;
};

/* ---- equations ---- */

static double *stages_at(const dvi__stages *s, double *numbers, int j)
{
  return numbers + (size_t)j * 2 * (size_t)s->n;
}

static double stages_unit_of(const dvi__stages *s, int component)
{
  return component < s->n ? 1 : s->unit[component - s->n];
}

/* Multiply x by unit, or divide by unit if `over`. */
static void stages_scale(const dvi__stages *s, int over, double *x)
{
  for (int j = 0; j < s->method->stages; j++)
    for (int i = s->n; i < 2 * s->n; i++)
      stages_at(s, x, j)[i] *= over ? 1 / stages_unit_of(s, i) : stages_unit_of(s, i);
}

static dvi_status stages_residual(dvi__stages *s, const double *x, double *R)
{
  const dvi__runge_kutta *m = s->method;
  for (int j = 0; j < m->stages; j++) {
    const size_t row = (size_t)j * 2 * (size_t)s->n;
    for (int i = 0; i < 2 * s->n; i++) {
      double sum = 0;
      for (int k = 0; k < m->stages; k++) sum += m->a[j][k] * x[k * 2 * s->n + i];
      s->point[i] = s->z[i] + stages_unit_of(s, i) * sum;
    }
    const dvi_status status = dvi__vector_field_place(s->field, s->first + j, s->t + m->c[j] * s->h,
                                                      s->point, s->point + s->n, s->image);
    if (status != DVI_OK) return dvi__fail_in(status, "stage %d", j + 1);
    for (int i = 0; i < 2 * s->n; i++)
      R[row + (size_t)i] = x[row + (size_t)i] - s->h / stages_unit_of(s, i) * s->image[i];
  }
  return DVI_OK;
}

/* Compute h f_z at all stages. */
static dvi_status stages_slopes(dvi__stages *s, double h)
{
  const int z = 2 * s->n;
  memset(s->point, 0, (size_t)z * sizeof *s->point);
  for (int j = 0; j < s->method->stages; j++) {
    DVI_TRY(dvi__vector_field_select(s->field, s->first + j));
    for (int c = 0; c < z; c++) {
      double *column = s->slope + (size_t)(j * z + c) * (size_t)z;
      s->point[c] = stages_unit_of(s, c);
      dvi__vector_field_product(s->field, s->point, s->image);
      s->point[c] = 0;
      for (int i = 0; i < s->n; i++) {
        column[i] = h * s->image[s->n + i];
        column[s->n + i] = -h / s->unit[i] * s->image[i];
      }
    }
  }
  return DVI_OK;
}

/* Return entry (i,c) of block (j,k). */
static double stages_entry(const dvi__stages *s, int j, int i, int k, int c)
{
  const int z = 2 * s->n;
  return (j == k && i == c) - s->method->a[j][k] * s->slope[(j * z + c) * z + i];
}

static dvi_status stages_matrix(dvi__stages *s, double h, int transposed, double *values)
{
  const int z = 2 * s->n;
  DVI_TRY(stages_slopes(s, h));
  for (int column = 0; column < s->unknowns; column++)
    for (int row = 0; row < s->unknowns; row++)
      *values++ = transposed ? stages_entry(s, column / z, column % z, row / z, row % z)
                             : stages_entry(s, row / z, row % z, column / z, column % z);
  return DVI_OK;
}

/* ---- create ---- */

static dvi_status stages_allocate(dvi__stages *s)
{
  const size_t z = 2 * (size_t)s->n, all = (size_t)s->unknowns;
  s->slope = DVI_NEW(double, (z * z * (size_t)s->method->stages));
  s->values = DVI_NEW(double, (all * all));
  s->point = DVI_NEW(double, z);
  s->image = DVI_NEW(double, z);
  s->x = DVI_NEW(double, all);
  s->R = DVI_NEW(double, all);
  if (s->slope && s->values && s->point && s->image && s->x && s->R) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", s->method->stages,
                   s->n);
}

static dvi_status stages_initialise(dvi__stages *s, dvi_counters *counters)
{
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, s->unknowns, "stages", &s->pattern));
  DVI_TRY(stages_allocate(s));
  DVI_TRY(dvi__linear_create(&s->pattern, DVI__LINEAR_DENSE, counters, &s->transposed));
  return dvi__linear_create(&s->pattern, DVI__LINEAR_DENSE, counters, &s->linear);
}

dvi_status dvi__stages_create(dvi__vector_field *field, int n, const dvi__runge_kutta *method,
                              dvi_counters *counters, dvi__stages **stages)
{
  *stages = NULL;
  dvi__stages *s = DVI_NEW(dvi__stages, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  s->field = field;
  s->method = method;
  s->n = n;
  s->unknowns = 2 * n * method->stages;
  const dvi_status status = stages_initialise(s, counters);
  if (status != DVI_OK) dvi__stages_destroy(&s);
  *stages = s;
  return status;
}

void dvi__stages_destroy(dvi__stages **stages)
{
  dvi__stages *s = *stages;
  if (s == NULL) return;
  dvi__linear_destroy(&s->linear);
  dvi__linear_destroy(&s->transposed);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->slope);
  dvi__release(s->values);
  dvi__release(s->point);
  dvi__release(s->image);
  dvi__release(s->x);
  dvi__release(s->R);
  dvi__release(s);
  *stages = NULL;
}

void dvi__stages_unit(dvi__stages *s, const double *unit)
{
  s->unit = unit;
}

/* ---- solve ---- */

dvi_status dvi__stages_factor(dvi__stages *s, int first, double h)
{
  s->first = first;
  DVI_TRY(stages_matrix(s, h, 0, s->values));
  return dvi__linear_factor(s->linear, s->values);
}

/* Compute the Jacobian at the points of the last residual. */
static dvi_status stages_renew_jacobian(dvi__stages *s)
{
  DVI_TRY(dvi__vector_field_differentiate(s->field, s->first, s->method->stages));
  const dvi_status status = dvi__stages_factor(s, s->first, s->h);
  return status == DVI_SINGULAR
             ? dvi__fail_in(DVI_NOT_CONVERGED, "the stages' Jacobian cannot be factored")
             : status;
}

/* Iterate by Newton's method to roundoff, that is until corrections are a few roundings, or are
 * noise that does not shrink. The Jacobian is kept while the corrections shrink fast. */
static dvi_status stages_newton(dvi__stages *s)
{
  enum { MOST = 40 };
  const size_t all = (size_t)s->unknowns;
  const double few = 2 * DBL_EPSILON, noise = 1e4 * DBL_EPSILON, fast = 0.05;
  double last = HUGE_VAL;
  int fresh = 0;
  for (int iteration = 0; iteration < MOST; iteration++) {
    DVI_TRY(stages_residual(s, s->x, s->R));
    if (!fresh) DVI_TRY(stages_renew_jacobian(s));
    dvi__linear_solve(s->linear, s->R);
    for (size_t i = 0; i < all; i++) s->x[i] -= s->R[i];
    const double correction = dvi__largest(all, s->R), whole = dvi__largest(all, s->x);
    if (correction <= few * whole || (correction <= noise * whole && correction >= 0.5 * last))
      return DVI_OK;
    if (!(correction <= 1e300)) break;
    fresh = correction <= fast * last;
    last = correction;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not settle (change %.1e)", last);
}

/* Start from stages that all move as z does. */
dvi_status dvi__stages_solve(dvi__stages *s, int first, double t, double h, const double *z,
                             double *W)
{
  s->first = first;
  s->t = t;
  s->h = h;
  s->z = z;
  DVI_TRY(dvi__vector_field_place(s->field, first, t, z, z + s->n, s->image));
  for (int j = 0; j < s->method->stages; j++)
    for (int i = 0; i < 2 * s->n; i++)
      stages_at(s, s->x, j)[i] = h / stages_unit_of(s, i) * s->image[i];
  DVI_TRY(stages_newton(s));
  DVI_TRY(stages_residual(s, s->x, s->R));
  memcpy(W, s->x, (size_t)s->unknowns * sizeof *W);
  stages_scale(s, 0, W);
  return DVI_OK;
}

dvi_status dvi__stages_solve_transposed(dvi__stages *s, int first, double h, double *x)
{
  s->first = first;
  DVI_TRY(stages_matrix(s, h, 1, s->values));
  DVI_TRY(dvi__linear_factor(s->transposed, s->values));
  stages_scale(s, 0, x);
  dvi__linear_solve(s->transposed, x);
  stages_scale(s, 1, x);
  return DVI_OK;
}

void dvi__stages_apply(dvi__stages *s, double *x)
{
  stages_scale(s, 1, x);
  dvi__linear_solve(s->linear, x);
  stages_scale(s, 0, x);
}
