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

/* ---- Jacobian of Newton's method ---- */

/* Give the numbers of an entry. */
static int width_of(const dvi__solver *solver)
{
  return solver->equations.linear == DVI__LINEAR_COMPLEX ? 2 : 1;
}

static size_t jacobian_entries(const dvi__solver *solver)
{
  return (size_t)width_of(solver) * (size_t)dvi__pattern_entries(solver->equations.pattern);
}

static dvi_status solver_create_linear(dvi__solver *s)
{
  const dvi__equations *e = &s->equations;
  if (e->whole != NULL) return dvi__linear_create_iterative(e->whole, s->counters, &s->linear);
  if (s->values == NULL) s->values = DVI_NEW(double, jacobian_entries(s));
  if (s->pairs == NULL && width_of(s) == 2) s->pairs = DVI_NEW(double, 2 * (int64_t)e->unknowns);
  if (s->values == NULL || (s->pairs == NULL && width_of(s) == 2))
    return dvi__fail(DVI_NO_MEMORY, "solver: no memory for a Jacobian of %zu entries",
                     jacobian_entries(s));
  if (e->border > 0)
    return dvi__linear_create_bordered(e->pattern, e->border, s->counters, &s->linear);
  return dvi__linear_create(e->pattern, e->linear, s->counters, &s->linear);
}

dvi_status dvi__solver_prepare(dvi__solver *solver)
{
  dvi__equations *equations = &solver->equations;
  if (solver->linear != NULL) return DVI_OK;
  if (equations->prepare != NULL) DVI_TRY(equations->prepare(equations->of, equations));
  return solver_create_linear(solver);
}

dvi_status dvi__solver_jacobian(dvi__solver *solver, const double *x, double *values)
{
  DVI_TRY(dvi__solver_prepare(solver));
  solver->counters->jacobians++;
  return solver->equations.jacobian(solver->equations.of, x, values);
}

/* Turn a failure to factor into the failure of a step. A Jacobian may be singular at one point of
 * one step, which a smaller step may avoid. Memory does not grow with smaller steps. */
static dvi_status solver_test_factor(dvi_status factored)
{
  if (factored == DVI_OK) return DVI_OK;
  if (factored != DVI_SINGULAR && factored < 0)
    return dvi__fail_in(factored, "the Jacobian of the step's equations");
  return dvi__fail_in(DVI_NOT_CONVERGED, "the Jacobian of the step's equations cannot be factored");
}

/* Let the equations invert their Jacobian. */
static dvi_status solver_invert(dvi__solver *solver, const double *x)
{
  const dvi__equations *equations = &solver->equations;
  solver->counters->jacobians++;
  DVI_TRY(equations->invert(equations->of, x, &solver->inverted));
  solver->counters->factorizations += solver->inverted;
  return DVI_OK;
}

static dvi_status solver_fill(dvi__solver *solver, const double *x)
{
  if (solver->equations.invert == NULL) return dvi__solver_jacobian(solver, x, solver->values);
  solver->equations.fill(solver->equations.of, solver->values);
  return DVI_OK;
}

dvi_status dvi__solver_factor(dvi__solver *solver, const double *x)
{
  solver->factored = solver->inverted = 0;
  if (solver->equations.invert != NULL) DVI_TRY(solver_invert(solver, x));
  if (solver->inverted) return DVI_OK;
  DVI_TRY(dvi__solver_prepare(solver));
  DVI_TRY(solver_fill(solver, x));
  const dvi_status factored = dvi__linear_factor(solver->linear, solver->values);
  solver->factored = factored == DVI_OK;
  solver->in_use = 1;
  return solver_test_factor(factored);
}

dvi_status dvi__solver_take_jacobian(dvi__solver *solver, const double *values)
{
  DVI_TRY(dvi__solver_prepare(solver));
  const size_t bytes = jacobian_entries(solver) * sizeof *values;
  solver->in_use = 1;
  solver->inverted = 0;
  if (solver->factored && memcmp(solver->values, values, bytes) == 0) return DVI_OK;
  memcpy(solver->values, values, bytes);
  const dvi_status status = dvi__linear_factor(solver->linear, solver->values);
  solver->factored = status == DVI_OK;
  return status;
}

/* Rounding is a large part of changes below this size relative to the largest unknowns. */
static const double rounding = 1e-9;

double dvi__solver_least_part(const dvi__solver *solver)
{
  return fmax(rounding, sqrt(solver->equations.noise));
}

double dvi__solver_worst_ratio(const dvi__solver *solver, double least, const double *of,
                               const double *to)
{
  const int unknowns = solver->equations.unknowns, group = solver->equations.group;
  double worst = 0;
  for (int first = 0; first < unknowns; first += group) {
    const size_t count = (size_t)(first + group < unknowns ? group : unknowns - first);
    const double one = dvi__largest(count, of + first),
                 other = fmax(dvi__largest(count, to + first), least);
    worst = dvi__worse_ratio(worst, one, other);
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
  const double least = dvi__solver_least_part(solver) *
                       dvi__largest((size_t)solver->equations.unknowns, x);
  report->contraction = report->correction / report->largest_first;
  report->first = dvi__solver_worst_ratio(solver, least, solver->before, x);
  report->bend = dvi__solver_worst_ratio(solver, least, solver->residual, solver->before);
}

/* Each term of a row is itself the result of a few products and sums. */
static const double floor_of_row = 4 * DBL_EPSILON;

/* Where corrections have settled, they answer the roundings of some rows. Other rows, of which they
 * solve all but this part of what they move, are done. What is left there are squares of the
 * corrections, which may be above the row's own roundings. */
static const double settled_part = 1e-4;

/* Add |J||x| to sum. */
static void add_moved(const dvi__solver *solver, const double *x, double *sum)
{
  const dvi__pattern *pattern = solver->equations.pattern;
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      sum[pattern->row[e]] += fabs(solver->values[width_of(solver) * e] * x[j]);
}

dvi_status dvi__solver_at_floor(dvi__solver *solver, const double *x, int settled, double most,
                                int *at_floor)
{
  const size_t unknowns = (size_t)solver->equations.unknowns;
  *at_floor = 0;
  if (solver->magnitude == NULL) return DVI_OK;
  memset(solver->moved, 0, unknowns * sizeof(double));
  if (settled && solver->in_use) add_moved(solver, solver->residual, solver->moved);
  DVI_TRY(dvi__solver_residual(solver, x, solver->residual));
  if (!(dvi__largest(unknowns, solver->residual) <= most)) return DVI_OK;
  solver->equations.magnitudes(solver->equations.of, solver->magnitude);
  if (solver->in_use) add_moved(solver, x, solver->magnitude);
  *at_floor = 1;
  for (size_t i = 0; i < unknowns; i++)
    *at_floor &= fabs(solver->residual[i]) <=
                 fmax(floor_of_row * solver->magnitude[i], settled_part * solver->moved[i]);
  return DVI_OK;
}

/* ---- create ---- */

static dvi_status solver_allocate(dvi__solver *solver)
{
  const size_t unknowns = (size_t)solver->equations.unknowns;
  const int has_magnitudes = solver->equations.magnitudes != NULL;
  if (solver->equations.group == 0) solver->equations.group = 1;
  solver->residual = DVI_NEW(double, unknowns);
  solver->before = DVI_NEW(double, unknowns);
  if (has_magnitudes) {
    solver->magnitude = DVI_NEW(double, 2 * unknowns);
    solver->moved = solver->magnitude != NULL ? solver->magnitude + unknowns : NULL;
  }
  if (solver->residual && solver->before && (!has_magnitudes || solver->magnitude)) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "solver: no memory for %zu unknowns", unknowns);
}

dvi_status dvi__solver_create(const dvi__equations *equations, dvi_counters *counters,
                              dvi__solver **solver)
{
  dvi__solver *made = *solver = DVI_NEW(dvi__solver, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "solver: no memory");
  made->equations = *equations;
  made->counters = counters;
  const dvi_status status = solver_allocate(made);
  if (status != DVI_OK) dvi__solver_destroy(solver);
  return status;
}

void dvi__solver_destroy(dvi__solver **solver)
{
  dvi__solver *s = *solver;
  if (s == NULL) return;
  dvi__kinsol_destroy(&s->kinsol);
  dvi__kinsol_destroy(&s->tester);
  dvi__kinsol_destroy(&s->many);
  dvi__linear_destroy(&s->linear);
  dvi__release(s->residual);
  dvi__release(s->before);
  dvi__release(s->magnitude);
  dvi__release(s->values);
  dvi__release(s->pairs);
  dvi__release(s);
  *solver = NULL;
}

dvi_status dvi__solver_correction(dvi__solver *solver, double *r)
{
  if (solver->inverted) {
    solver->counters->solves++;
    solver->equations.correct(solver->equations.of, r);
    return DVI_OK;
  }
  if (solver->pairs == NULL) return dvi__linear_solve(solver->linear, r);
  for (int i = 0; i < solver->equations.unknowns; i++) {
    solver->pairs[2 * i] = r[i];
    solver->pairs[2 * i + 1] = 0;
  }
  DVI_TRY(dvi__linear_solve(solver->linear, solver->pairs));
  for (int i = 0; i < solver->equations.unknowns; i++) r[i] = solver->pairs[2 * i];
  return DVI_OK;
}

void dvi__solver_apply_factor(dvi__solver *solver, double *b)
{
  (void)dvi__solver_correction(solver, b);
}

int dvi__solver_sign(const dvi__solver *solver)
{
  const int sign = solver->factored ? dvi__linear_sign(solver->linear) : 0;
  return sign != 0 ? sign : 1;
}

int dvi__solver_is_definite(const dvi__solver *solver, int sign)
{
  if (!solver->factored || !dvi__linear_tells_definite(solver->linear)) return 1;
  return dvi__linear_is_definite(solver->linear, sign);
}

dvi__linear *dvi__solver_linear(const dvi__solver *solver)
{
  return solver->linear;
}

/* Fixed point iteration pays while each iteration gains a third of a digit. A step by simplified
 * Newton's method costs about as much as 40 to 300 iterations. A patient user takes any gain. */
static const dvi__criteria
    paying = {.stagnant = 0.35, .noise = 32 * DBL_EPSILON, .slowest = 0.45, .steady = 1},
    any_gain = {.stagnant = 1.0, .noise = 1e4 * DBL_EPSILON, .slowest = 1.0, .steady = 1};

dvi__criteria dvi__fixed_point_criteria(int patient, int own_variables)
{
  dvi__criteria criteria = patient ? any_gain : paying;
  criteria.ahead = own_variables;
  return criteria;
}

int dvi__fixed_point_most(int patient)
{
  return patient ? MOST_PATIENT_ITERATIONS : MOST_FIXED_POINT_ITERATIONS;
}

/* Keep the own variables before an iteration, if they are going to be tested. */
static void keep_point(dvi__solver *s)
{
  const dvi__equations *equations = &s->equations;
  s->has_point = s->keeps_point;
  if (s->has_point)
    memcpy(dvi__kinsol_point(s->tester, 0), equations->own_point(equations->of),
           (size_t)equations->own_unknowns * sizeof(double));
}

/* Make one iteration. Gives the largest correction and the largest unknown. */
static dvi_status fixed_point_iterate(dvi__solver *s, double *x, double *correction, double *whole)
{
  const dvi__equations *equations = &s->equations;
  if (equations->fixed_point_iterate != NULL) {
    s->counters->residuals++;
    keep_point(s);
    return equations->fixed_point_iterate(equations->of, correction, whole);
  }
  DVI_TRY(dvi__solver_residual(s, x, s->residual));
  equations->chord(equations->of, s->residual);
  dvi__correct(equations->unknowns, s->residual, x, correction, whole);
  return DVI_OK;
}

dvi_status dvi__solver_prepare_chord(dvi__solver *s, const double *x)
{
  const dvi__equations *equations = &s->equations;
  return equations->prepare_chord != NULL ? equations->prepare_chord(equations->of, x) : DVI_OK;
}

static dvi_status fixed_point_begin(dvi__solver *s, const double *x)
{
  if (s->equations.fixed_point_iterate == NULL) return dvi__solver_prepare_chord(s, x);
  s->equations.fixed_point_begin(s->equations.of, x);
  return DVI_OK;
}

/* Half a digit is worth an iteration. n x n systems cost a small part of the one that Newton's
 * method factors. */
static const dvi__criteria frozen_criteria = {
    .stagnant = 0.35, .noise = 1e4 * DBL_EPSILON, .slowest = 0.3, .steady = 1};

dvi__criteria dvi__simplified_criteria(void)
{
  return frozen_criteria;
}

int dvi__simplified_most(void)
{
  return MOST_FIXED_POINT_ITERATIONS;
}

/* Report on the first two corrections of an iteration with the Jacobian of its guess. */
static void note_frozen(const dvi__history *history, double whole, dvi__solve_report *report)
{
  if (report->iterations == 1) report->first = history->last / whole;
  if (report->iterations == 2) report->contraction = report->bend = history->last / history->before;
}

/* Tell whether the next correction's own part no longer counts, where the step reads all results at
 * the corrected point. */
static int is_foreseen(const dvi__history *history, double whole)
{
  return history->contraction > 0 && history->contraction <= dvi__unseen_part(history->own / whole);
}

static dvi_status solve_by_fixed_point(dvi__solver *s, double size, int patient, double *x,
                                       dvi__solve_report *report)
{
  const int most = dvi__fixed_point_most(patient);
  const int frozen = s->equations.fixed_point_frozen;
  const dvi__criteria criteria = frozen ? frozen_criteria
                                        : dvi__fixed_point_criteria(
                                              patient, s->equations.fixed_point_iterate != NULL);
  dvi__history history = {0};
  double whole;
  DVI_TRY(fixed_point_begin(s, x));
  for (report->iterations = 1; report->iterations <= most; report->iterations++) {
    DVI_TRY(fixed_point_iterate(s, x, &report->correction, &whole));
    const dvi__progress progress = dvi__test_correction(report->correction, &history, &criteria,
                                                        whole, size);
    if (frozen) note_frozen(&history, whole, report);
    if (progress == DVI__CONVERGED || (frozen && is_foreseen(&history, whole))) {
      s->whole = whole;
      if (s->equations.fixed_point_iterate != NULL)
        s->equations.fixed_point_end(s->equations.of, x);
      return DVI_OK;
    }
    if (progress == DVI__STALLED) break;
  }
  if (s->equations.fixed_point_iterate != NULL && !(report->correction <= DBL_MAX))
    return dvi__fail(DVI_NOT_FINITE, "fixed point iteration met numbers that are not finite");
  return dvi__fail(DVI_NOT_CONVERGED,
                   "fixed point iteration contracts too slowly (change %.1e after %.1e)",
                   history.last, history.before);
}

static dvi_status solve_by_simplified_newton(dvi__solver *s, double size, int wary, double *x,
                                             dvi__solve_report *report)
{
  const dvi__equations *equations = &s->equations;
  dvi__history history = {0};
  double whole;
  s->in_use = 0;
  const dvi_status frozen_at = equations->freeze(equations->of, x);
  if (frozen_at == DVI_SINGULAR)
    return dvi__fail_in(DVI_NOT_CONVERGED, "the frozen Jacobian cannot be factored");
  if (frozen_at != DVI_OK) return frozen_at;
  for (report->iterations = 1; report->iterations <= MOST_FIXED_POINT_ITERATIONS;
       report->iterations++) {
    DVI_TRY(dvi__solver_residual(s, x, s->residual));
    equations->frozen(equations->of, s->residual);
    dvi__correct(equations->unknowns, s->residual, x, &report->correction, &whole);
    dvi__solver_note(s, x, report);
    const dvi__progress progress = dvi__test_correction(report->correction, &history,
                                                        &frozen_criteria, whole, size);
    int converged = progress == DVI__CONVERGED;
    if (progress == DVI__STALLED) DVI_TRY(dvi__solver_at_floor(s, x, 0, HUGE_VAL, &converged));
    if (converged) return DVI_OK;
    if (progress == DVI__STALLED ||
        (wary && report->iterations == 2 && dvi__misleading(&history, whole)))
      break;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "simplified Newton's method contracts too slowly (change %.1e after %.1e)",
                   history.last, history.before);
}

static dvi_status solve_by_kinsol(dvi__solver *s, double size, double *x, dvi__solve_report *report)
{
  DVI_TRY(dvi__kinsol_prepare(s, 0, &s->kinsol));
  s->counters->kinsols++;
  DVI_TRY(dvi__solver_prepare_chord(s, x));
  /* KINSOL's own test is skipped. Newton's method from its last point is the stricter test. */
  const dvi_status searched = dvi__kinsol_solve(s->kinsol, size, x, report);
  if (searched < 0) return searched;
  const int iterations = report->iterations;
  const dvi_status polished = dvi__newton(s, size, 0, x, report);
  report->iterations += iterations;
  /* first and bend were those of the final Newton iterations alone */
  report->first = report->bend = 0;
  return polished;
}

dvi_status dvi__solve(dvi__solver *solver, dvi__rung rung, double size, int wary, int patient,
                      double *x, dvi__solve_report *report)
{
  *report = (dvi__solve_report){0};
  switch (rung) {
  case DVI__FIXED_POINT: return solve_by_fixed_point(solver, size, patient, x, report);
  case DVI__SIMPLIFIED: return solve_by_simplified_newton(solver, size, wary, x, report);
  case DVI__NEWTON: return dvi__newton(solver, size, wary, x, report);
  case DVI__KINSOL: return solve_by_kinsol(solver, size, x, report);
  }
  return dvi__fail(DVI_BAD_ARGUMENT, "solver: unknown rung %d", (int)rung);
}
