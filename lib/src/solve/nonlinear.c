#include "solve/nonlinear.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "solve/solver_struct.h"

enum { MOST_FIXED_POINT_ITERATIONS = 60, MOST_PATIENT_ITERATIONS = 1000 };

dvi_status dvi__solver_residual(dvi__solver *solver, const double *x, double *r)
{
  solver->counters->residuals++;
  return solver->equations.residual(solver->equations.of, x, r);
}

dvi_status dvi__solver_jacobian(dvi__solver *solver, const double *x, double *values)
{
  solver->counters->jacobians++;
  return solver->equations.jacobian(solver->equations.of, x, values);
}

dvi_status dvi__solver_factor(dvi__solver *solver, const double *x)
{
  solver->factored = 0;
  DVI_TRY(dvi__solver_jacobian(solver, x, solver->values));
  solver->factored = dvi__linear_factor(solver->linear, solver->values) == DVI_OK;
  solver->in_use = 1;
  /* A singular Jacobian at one point of one step: a smaller step may avoid it. */
  return solver->factored ? DVI_OK : dvi__fail_in(DVI_NOT_CONVERGED, "the Jacobian of the step's equations cannot be factored");
}

dvi_status dvi__solver_take_jacobian(dvi__solver *solver, const double *values)
{
  const size_t bytes = (size_t)dvi__pattern_entries(solver->equations.pattern) * sizeof *values;
  solver->in_use = 1;
  if (solver->factored && memcmp(solver->values, values, bytes) == 0) return DVI_OK;
  memcpy(solver->values, values, bytes);
  const dvi_status status = dvi__linear_factor(solver->linear, solver->values);
  solver->factored = status == DVI_OK;
  return status;
}

/* Of smaller changes, relative to the largest unknowns, rounding is a large part. */
static const double rounding = 1e-9;

double dvi__solver_least_part(const dvi__solver *solver)
{
  return fmax(rounding, sqrt(solver->equations.noise));
}

/* The worst ratio of two vectors, group by group; of groups of `to` no less than `least` counts. */
static double worst_ratio(const dvi__solver *solver, double least, const double *of, const double *to)
{
  const int unknowns = solver->equations.unknowns, group = solver->equations.group;
  double worst = 0;
  for (int first = 0; first < unknowns; first += group) {
    const size_t count = (size_t)(first + group < unknowns ? group : unknowns - first);
    const double one = dvi__largest(count, of + first), other = fmax(dvi__largest(count, to + first), least);
    if (one > worst * other) worst = other > 0 ? one / other : HUGE_VAL;
  }
  return worst;
}

void dvi__solver_note(const dvi__solver *solver, const double *x, dvi__solve_report *report)
{
  if (report->iterations == 1) {
    report->largest_first = report->correction;
    memcpy(solver->before, solver->residual, (size_t)solver->equations.unknowns * sizeof(double));
  }
  if (report->iterations != 2) return;
  const double least = dvi__solver_least_part(solver) * dvi__largest((size_t)solver->equations.unknowns, x);
  report->contraction = report->correction / report->largest_first;
  report->first = worst_ratio(solver, least, solver->before, x);
  report->bend = worst_ratio(solver, least, solver->residual, solver->before);
}

/* Each term of a row is itself the end of a few products and sums. */
static const double floor_of_row = 4 * DBL_EPSILON;

dvi_status dvi__solver_at_floor(dvi__solver *solver, const double *x, int *at_floor)
{
  const dvi__pattern *pattern = solver->equations.pattern;
  *at_floor = 0;
  if (solver->magnitude == NULL || !solver->in_use) return DVI_OK;
  DVI_TRY(dvi__solver_residual(solver, x, solver->residual));
  solver->equations.magnitudes(solver->equations.of, solver->magnitude);
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      solver->magnitude[pattern->row[e]] += fabs(solver->values[e] * x[j]);
  *at_floor = 1;
  for (int i = 0; i < solver->equations.unknowns; i++)
    *at_floor &= fabs(solver->residual[i]) <= floor_of_row * solver->magnitude[i];
  return DVI_OK;
}

static dvi_status fill(dvi__solver *solver)
{
  const dvi__pattern *pattern = solver->equations.pattern;
  const size_t unknowns = (size_t)solver->equations.unknowns;
  if (solver->equations.group == 0) solver->equations.group = 1;
  solver->residual = DVI_NEW(double, unknowns);
  solver->before = DVI_NEW(double, unknowns);
  solver->values = DVI_NEW(double, dvi__pattern_entries(pattern));
  if (solver->equations.magnitudes != NULL) solver->magnitude = DVI_NEW(double, unknowns);
  if (!solver->residual || !solver->before || !solver->values || (solver->equations.magnitudes != NULL && !solver->magnitude))
    return dvi__fail(DVI_NO_MEMORY, "solver: no memory for %zu unknowns", unknowns);
  const int border = solver->equations.border;
  DVI_TRY(border > 0 ? dvi__linear_create_bordered(pattern, border, solver->counters, &solver->linear)
                     : dvi__linear_create(pattern, solver->equations.linear, solver->counters, &solver->linear));
  return dvi__kinsol_create(solver, &solver->kinsol);
}

dvi_status dvi__solver_create(const dvi__equations *equations, dvi_counters *counters, dvi__solver **solver)
{
  *solver = NULL;
  dvi__solver *made = DVI_NEW(dvi__solver, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "solver: no memory");
  made->equations = *equations;
  made->counters = counters;
  const dvi_status status = fill(made);
  if (status != DVI_OK) dvi__solver_destroy(&made);
  *solver = made;
  return status;
}

void dvi__solver_destroy(dvi__solver **solver)
{
  dvi__solver *s = *solver;
  if (s == NULL) return;
  dvi__kinsol_destroy(&s->kinsol);
  dvi__linear_destroy(&s->linear);
  dvi__release(s->residual);
  dvi__release(s->before);
  dvi__release(s->magnitude);
  dvi__release(s->values);
  dvi__release(s);
  *solver = NULL;
}

void dvi__solver_apply_factor(dvi__solver *solver, double *b)
{
  dvi__linear_solve(solver->linear, b);
}

int dvi__solver_sign(const dvi__solver *solver)
{
  return solver->factored ? dvi__linear_sign(solver->linear) : 1;
}

int dvi__solver_is_definite(const dvi__solver *solver, int sign)
{
  if (!solver->factored || dvi__linear_kind_of(solver->linear) != DVI__LINEAR_SPARSE) return 1;
  return dvi__linear_is_definite(solver->linear, sign);
}

dvi__linear_kind dvi__solver_linear_kind(const dvi__solver *solver)
{
  return dvi__linear_kind_of(solver->linear);
}

/* Fixed point iteration pays while each iteration gains a third of a digit: a step by simplified Newton's method costs about as much as 40 to 300 of
 * them. A patient user takes any gain. */
static const dvi__pace paying = {0.35, 32 * DBL_EPSILON, 0.45, 1, 0}, any_gain = {1.0, 1e4 * DBL_EPSILON, 1.0, 1, 0};

dvi__pace dvi__fixed_point_pace(int patient, int sweeps)
{
  dvi__pace pace = patient ? any_gain : paying;
  pace.ahead = sweeps;
  return pace;
}

int dvi__fixed_point_most(int patient)
{
  return patient ? MOST_PATIENT_ITERATIONS : MOST_FIXED_POINT_ITERATIONS;
}

/* One iteration: the largest correction, and the largest unknown. */
static dvi_status iterate(dvi__solver *s, double *x, double *correction, double *whole)
{
  const dvi__equations *equations = &s->equations;
  if (equations->sweep != NULL) {
    s->counters->residuals++;
    return equations->sweep(equations->of, correction, whole);
  }
  DVI_TRY(dvi__solver_residual(s, x, s->residual));
  equations->chord(equations->of, s->residual);
  dvi__correct(equations->unknowns, s->residual, x, correction, whole);
  return DVI_OK;
}

static dvi_status prepare(dvi__solver *s, const double *x)
{
  if (s->equations.sweep == NULL) return s->equations.prepare_chord(s->equations.of, x);
  s->equations.sweep_from(s->equations.of, x);
  return DVI_OK;
}

static dvi_status fixed_point(dvi__solver *s, double size, int patient, double *x, dvi__solve_report *report)
{
  const int most = dvi__fixed_point_most(patient);
  const dvi__pace pace = dvi__fixed_point_pace(patient, s->equations.sweep != NULL);
  dvi__trail trail = {0};
  double whole;
  DVI_TRY(prepare(s, x));
  for (report->iterations = 1; report->iterations <= most; report->iterations++) {
    DVI_TRY(iterate(s, x, &report->correction, &whole));
    const dvi__progress progress = dvi__judge(report->correction, &trail, &pace, whole, size);
    if (progress == DVI__CONVERGED) {
      if (s->equations.sweep != NULL) s->equations.sweep_to(s->equations.of, x);
      return DVI_OK;
    }
    if (progress == DVI__STALLED) break;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "fixed point iteration contracts too slowly (change %.1e after %.1e)", trail.last,
                   trail.before);
}

/* Half a digit an iteration is worth it: n x n systems cost a small part of the one that Newton's method factors. */
static const dvi__pace frozen = {0.35, 1e4 * DBL_EPSILON, 0.3, 1, 0};

static dvi_status simplified(dvi__solver *s, double size, int wary, double *x, dvi__solve_report *report)
{
  const dvi__equations *equations = &s->equations;
  dvi__trail trail = {0};
  double whole;
  s->in_use = 0;
  const dvi_status frozen_at = equations->freeze(equations->of, x);
  if (frozen_at == DVI_SINGULAR) return dvi__fail_in(DVI_NOT_CONVERGED, "the frozen Jacobian cannot be factored");
  if (frozen_at != DVI_OK) return frozen_at;
  for (report->iterations = 1; report->iterations <= MOST_FIXED_POINT_ITERATIONS; report->iterations++) {
    DVI_TRY(dvi__solver_residual(s, x, s->residual));
    equations->frozen(equations->of, s->residual);
    dvi__correct(equations->unknowns, s->residual, x, &report->correction, &whole);
    dvi__solver_note(s, x, report);
    const dvi__progress progress = dvi__judge(report->correction, &trail, &frozen, whole, size);
    int converged = progress == DVI__CONVERGED;
    if (progress == DVI__STALLED) DVI_TRY(dvi__solver_at_floor(s, x, &converged));
    if (converged) return DVI_OK;
    if (progress == DVI__STALLED || (wary && report->iterations == 2 && dvi__misleading(&trail, whole))) break;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "simplified Newton's method contracts too slowly (change %.1e after %.1e)", trail.last,
                   trail.before);
}

static dvi_status kinsol(dvi__solver *s, double size, double *x, dvi__solve_report *report)
{
  s->counters->kinsols++;
  DVI_TRY(s->equations.prepare_chord(s->equations.of, x));
  /* KINSOL's verdict is not asked for: Newton's method from its last point is the stricter test. */
  const dvi_status searched = dvi__kinsol_solve(s->kinsol, size, x, report);
  if (searched < 0) return searched;
  const int iterations = report->iterations;
  const dvi_status polished = dvi__newton(s, size, 0, x, report);
  report->iterations += iterations;
  report->first = report->bend = 0; /* they were those of the polish alone */
  return polished;
}

dvi_status dvi__solve(dvi__solver *solver, dvi__rung rung, double size, int wary, int patient, double *x, dvi__solve_report *report)
{
  *report = (dvi__solve_report){0};
  switch (rung) {
  case DVI__FIXED_POINT: return fixed_point(solver, size, patient, x, report);
  case DVI__SIMPLIFIED: return simplified(solver, size, wary, x, report);
  case DVI__NEWTON: return dvi__newton(solver, size, wary, x, report);
  case DVI__KINSOL: return kinsol(solver, size, x, report);
  }
  return dvi__fail(DVI_BAD_ARGUMENT, "solver: unknown rung %d", (int)rung);
}

dvi_status dvi__certify(dvi__solver *solver, double size, const double *x, dvi__solve_report *report)
{
  int certified = 0;
  DVI_TRY(solver->equations.prepare_chord(solver->equations.of, x));
  DVI_TRY(dvi__kinsol_certify(solver->kinsol, size, x, &certified, report));
  if (!certified)
    return dvi__fail(DVI_NOT_CONVERGED, "KINSOL does not certify the solution (scaled residual %.1e)", report->residual);
  solver->counters->certified++;
  return DVI_OK;
}
