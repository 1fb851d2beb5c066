#include "field/model/newton.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/model/on_all.h"
#include "solve/nonlinear.h"

typedef struct statics {
  const dvi_field *field;
  dvi__pattern pattern; /* that of K */
  double *second;       /* [unknowns] w V_uu */
} statics;

static dvi_status refuse(int failed)
{
  return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "field: the potential returned %d", failed);
}

/* Refuse a derivative of the potential that is not finite. */
static dvi_status check(const dvi_field *f, const double *derivative)
{
  for (int64_t i = 0; i < f->unknowns; i++)
    DVI_TRY(dvi__field_check_datum(f, "derivative of the potential", 0, derivative[i], 0,
                                   f->unknown[i]));
  return DVI_OK;
}

static dvi_status residual(void *of, const double *x, double *r)
{
  const dvi_field *f = ((const statics *)of)->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  const dvi__density density = {.first = ((statics *)of)->second};
  const int failed = dvi__field_density(f, x, 0, f->unknowns, &density);
  if (failed != 0) return refuse(failed);
  DVI_TRY(check(f, density.first));
  dvi_matrix_multiply(&K, 0, x, r);
  for (int64_t i = 0; i < f->unknowns; i++) r[i] += density.first[i] - f->load[i];
  return DVI_OK;
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  const statics *s = of;
  const dvi__csr *K = &s->field->stiffness;
  const dvi__density density = {.second = s->second};
  const int failed = dvi__field_density(s->field, x, 0, s->field->unknowns, &density);
  if (failed != 0) return refuse(failed);
  DVI_TRY(check(s->field, s->second));
  memcpy(values, K->value, (size_t)K->start[K->rows] * sizeof *values);
  for (int64_t i = 0; i < K->rows; i++) values[dvi__csr_find(K, i, (int)i)] += s->second[i];
  return DVI_OK;
}

/* A row changes by its entry of the diagonal of K for a unit of its unknown. */
static dvi_status row_scale(void *of, double *scale, int *unchanged)
{
  const dvi__csr *K = &((const statics *)of)->field->stiffness;
  for (int64_t i = 0; i < K->rows; i++) scale[i] = K->value[dvi__csr_find(K, i, (int)i)];
  *unchanged = 0;
  return DVI_OK;
}

static dvi_status run(statics *s, double *x, dvi_field_solve_report *report)
{
  dvi_counters counters = {0};
  dvi__solver *solver = NULL;
  dvi__solve_report solved = {0};
  const dvi__equations equations = {.unknowns = (int)s->field->unknowns,
                                    .of = s,
                                    .pattern = &s->pattern,
                                    .linear = DVI__LINEAR_SPARSE,
                                    .residual = residual,
                                    .jacobian = jacobian,
                                    .row_scale = row_scale};
  DVI_TRY(dvi__solver_create(&equations, &counters, &solver));
  const dvi_status status = dvi__solve(solver, DVI__KINSOL, 0, 0, 0, x, &solved);
  dvi__solver_destroy(&solver);
  report->iterations = solved.iterations;
  report->residual = solved.residual;
  if (status != DVI_NOT_CONVERGED) return status;
  return dvi__fail(status,
                   "field: Newton's method left a residual of %.2g after %d iterations: start from "
                   "values nearer to a solution",
                   solved.residual, solved.iterations);
}

/* The diagonal of the Jacobian beside K. */
static dvi_status diagonal(void *of, const double *x, double *d)
{
  const dvi_field *f = ((const statics *)of)->field;
  const dvi__density density = {.second = d};
  const int failed = dvi__field_density(f, x, 0, f->unknowns, &density);
  if (failed != 0) return refuse(failed);
  return check(f, d);
}

static dvi_status solve_on_all(statics *s, double *x, dvi_field_solve_report *report)
{
  const dvi__field_equations equations = {
      .field = s->field, .residual = residual, .diagonal = diagonal, .of = s};
  dvi__elliptic_report solved;
  s->second = DVI_NEW(double, s->field->unknowns);
  dvi_status status = dvi__agree(
      s->field->mesh, s->second != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for Newton's method"));
  if (status == DVI_OK) status = dvi__field_solve_on_all(&equations, x, &solved);
  dvi__release(s->second);
  if (status != DVI_OK) return status;
  report->iterations = solved.corrections;
  report->residual = solved.correction;
  return DVI_OK;
}

dvi_status dvi__field_newton(const dvi_field *field, double *x, dvi_field_solve_report *report)
{
  if (field->mesh->share != NULL) return solve_on_all(&(statics){.field = field}, x, report);
  const dvi__csr *K = &field->stiffness;
  if (K->start[K->rows] > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "field: an int cannot count %lld entries of a factor",
                     (long long)K->start[K->rows]);
  statics s = {.field = field, .second = DVI_NEW(double, field->unknowns)};
  s.pattern = (dvi__pattern){.rows = (int)K->rows,
                             .columns = (int)K->columns,
                             .start = DVI_NEW(int, K->rows + 1),
                             .row = K->column};
  dvi_status status = s.second != NULL && s.pattern.start != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for Newton's method");
  for (int64_t i = 0; i <= K->rows && s.pattern.start != NULL; i++)
    s.pattern.start[i] = (int)K->start[i];
  if (status == DVI_OK) status = run(&s, x, report);
  dvi__release(s.second);
  dvi__release(s.pattern.start);
  return status;
}
