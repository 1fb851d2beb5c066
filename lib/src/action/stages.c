#include "action/stages.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "solve/nonlinear.h"

struct dvi__stages {
  dvi__field *field;
  const dvi__runge_kutta *method;
  int n, unknowns;
  dvi__pattern pattern; /* full */
  dvi__solver *solver;
  dvi__linear *transposed;
  const double *unit;
  int first;
  double t, h;
  const double *z;
  double *slope;         /* [2n*2n*s] h f_z at the stages, column by column */
  double *values;        /* [unknowns^2] */
  double *point, *image; /* [2n] */
  double *x;             /* [unknowns] increments, those of momenta over `unit` */
};

/* ---- equations ---- */

static double *at(const dvi__stages *s, double *numbers, int j)
{
  return numbers + (size_t)j * 2 * (size_t)s->n;
}

static double unit_of(const dvi__stages *s, int component)
{
  return component < s->n ? 1 : s->unit[component - s->n];
}

/* x <- x times unit, or over it. */
static void scale(const dvi__stages *s, int over, double *x)
{
  for (int j = 0; j < s->method->stages; j++)
    for (int i = s->n; i < 2 * s->n; i++) at(s, x, j)[i] *= over ? 1 / unit_of(s, i) : unit_of(s, i);
}

static dvi_status residual(void *of, const double *x, double *R)
{
  dvi__stages *s = of;
  const dvi__runge_kutta *m = s->method;
  for (int j = 0; j < m->stages; j++) {
    const size_t row = (size_t)j * 2 * (size_t)s->n;
    for (int i = 0; i < 2 * s->n; i++) {
      double sum = 0;
      for (int k = 0; k < m->stages; k++) sum += m->a[j][k] * x[k * 2 * s->n + i];
      s->point[i] = s->z[i] + unit_of(s, i) * sum;
    }
    const dvi_status status = dvi__field_place(s->field, s->first + j, s->t + m->c[j] * s->h, s->point, s->point + s->n, s->image);
    if (status != DVI_OK) return dvi__fail_in(status, "stage %d", j + 1);
    for (int i = 0; i < 2 * s->n; i++) R[row + (size_t)i] = x[row + (size_t)i] - s->h / unit_of(s, i) * s->image[i];
  }
  return DVI_OK;
}

/* h f_z at all stages. */
static dvi_status slopes(dvi__stages *s, double h)
{
  const int z = 2 * s->n;
  memset(s->point, 0, (size_t)z * sizeof *s->point);
  for (int j = 0; j < s->method->stages; j++) {
    DVI_TRY(dvi__field_select(s->field, s->first + j));
    for (int c = 0; c < z; c++) {
      double *column = s->slope + (size_t)(j * z + c) * (size_t)z;
      s->point[c] = unit_of(s, c);
      dvi__field_product(s->field, s->point, s->image);
      s->point[c] = 0;
      for (int i = 0; i < s->n; i++) {
        column[i] = h * s->image[s->n + i];
        column[s->n + i] = -h / s->unit[i] * s->image[i];
      }
    }
  }
  return DVI_OK;
}

/* Entry (i,c) of block (j,k). */
static double entry(const dvi__stages *s, int j, int i, int k, int c)
{
  const int z = 2 * s->n;
  return (j == k && i == c) - s->method->a[j][k] * s->slope[(j * z + c) * z + i];
}

static dvi_status matrix(dvi__stages *s, double h, int transposed, double *values)
{
  const int z = 2 * s->n;
  DVI_TRY(slopes(s, h));
  for (int column = 0; column < s->unknowns; column++)
    for (int row = 0; row < s->unknowns; row++)
      *values++ = transposed ? entry(s, column / z, column % z, row / z, row % z)
                             : entry(s, row / z, row % z, column / z, column % z);
  return DVI_OK;
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  dvi__stages *s = of;
  DVI_TRY(residual(of, x, s->values));
  DVI_TRY(dvi__field_differentiate(s->field, s->first, s->method->stages));
  return matrix(s, s->h, 0, values);
}

static dvi_status no_chord(void *of, const double *x)
{
  (void)of, (void)x;
  return DVI_OK;
}

static dvi_status row_scale(void *of, double *scale_of, int *unchanged)
{
  const dvi__stages *s = of;
  for (int i = 0; i < s->unknowns; i++) scale_of[i] = 1;
  *unchanged = 1;
  return DVI_OK;
}

/* ---- making it ---- */

static dvi_status allocate(dvi__stages *s)
{
  const size_t z = 2 * (size_t)s->n, all = (size_t)s->unknowns;
  s->slope = DVI_NEW(double, z *z *(size_t)s->method->stages);
  s->values = DVI_NEW(double, all *all);
  s->point = DVI_NEW(double, z);
  s->image = DVI_NEW(double, z);
  s->x = DVI_NEW(double, all);
  if (s->slope && s->values && s->point && s->image && s->x) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", s->method->stages, s->n);
}

static dvi_status fill(dvi__stages *s, dvi_counters *counters)
{
  dvi__equations equations = {.unknowns = s->unknowns,
                              .pattern = &s->pattern,
                              .linear = DVI__LINEAR_DENSE,
                              .of = s,
                              .residual = residual,
                              .jacobian = jacobian,
                              .prepare_chord = no_chord,
                              .row_scale = row_scale};
  DVI_TRY(allocate(s));
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, s->unknowns, "stages", &s->pattern));
  DVI_TRY(dvi__linear_create(&s->pattern, DVI__LINEAR_DENSE, counters, &s->transposed));
  return dvi__solver_create(&equations, counters, &s->solver);
}

dvi_status dvi__stages_create(dvi__field *field, int n, const dvi__runge_kutta *method, dvi_counters *counters,
                              dvi__stages **stages)
{
  *stages = NULL;
  dvi__stages *s = DVI_NEW(dvi__stages, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  s->field = field;
  s->method = method;
  s->n = n;
  s->unknowns = 2 * n * method->stages;
  const dvi_status status = fill(s, counters);
  if (status != DVI_OK) dvi__stages_destroy(&s);
  *stages = s;
  return status;
}

void dvi__stages_destroy(dvi__stages **stages)
{
  dvi__stages *s = *stages;
  if (s == NULL) return;
  dvi__solver_destroy(&s->solver);
  dvi__linear_destroy(&s->transposed);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->slope);
  dvi__release(s->values);
  dvi__release(s->point);
  dvi__release(s->image);
  dvi__release(s->x);
  dvi__release(s);
  *stages = NULL;
}

void dvi__stages_unit(dvi__stages *s, const double *unit)
{
  s->unit = unit;
}

/* ---- solving ---- */

/* From stages that all move as z does. */
dvi_status dvi__stages_solve(dvi__stages *s, int first, double t, double h, const double *z, double *W)
{
  dvi__solve_report report;
  s->first = first;
  s->t = t;
  s->h = h;
  s->z = z;
  DVI_TRY(dvi__field_place(s->field, first, t, z, z + s->n, s->image));
  for (int j = 0; j < s->method->stages; j++)
    for (int i = 0; i < 2 * s->n; i++) at(s, s->x, j)[i] = h / unit_of(s, i) * s->image[i];
  DVI_TRY(dvi__solve(s->solver, DVI__NEWTON, dvi__largest((size_t)s->n, z), 0, 0, s->x, &report));
  DVI_TRY(residual(s, s->x, s->values));
  memcpy(W, s->x, (size_t)s->unknowns * sizeof *W);
  scale(s, 0, W);
  return DVI_OK;
}

dvi_status dvi__stages_solve_transposed(dvi__stages *s, int first, double h, double *x)
{
  s->first = first;
  DVI_TRY(matrix(s, h, 1, s->values));
  DVI_TRY(dvi__linear_factor(s->transposed, s->values));
  scale(s, 0, x);
  dvi__linear_solve(s->transposed, x);
  scale(s, 1, x);
  return DVI_OK;
}

dvi_status dvi__stages_factor(dvi__stages *s, int first, double h)
{
  s->first = first;
  DVI_TRY(matrix(s, h, 0, s->values));
  return dvi__solver_take_jacobian(s->solver, s->values);
}

void dvi__stages_apply(dvi__stages *s, double *x)
{
  scale(s, 1, x);
  dvi__solver_apply_factor(s->solver, x);
  scale(s, 0, x);
}
