#include "method/split/friction.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/linear.h"

enum { MOST_ITERATIONS = 50 };

/* A matrix is kept if the last correction was this part of the one before. The first correction
 * counts as fast. */
static const double fast_change = 0.1;

struct dvi__friction {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi_counters *counters;
  dvi__pattern pattern;         /* of M - h/2 F_v */
  int *mass_place, *by_v_place; /* places of the entries of both */
  dvi__linear *matrix;          /* NULL if the pattern has the diagonal alone */
  double *values, *F_q, *F_v;   /* [entries] */
  double *residual, *given;     /* [n], residual or correction, and p0 - h/2 dV */
  double *v, *F;                /* [n], velocity of the step, and the forces at it */
};

/* ---- create ---- */

static dvi_status friction_allocate(dvi__friction *f)
{
  const dvi_system *s = f->system;
  const size_t n = (size_t)s->n;
  f->mass_place = DVI_NEW(int, dvi__pattern_entries(&s->vv));
  f->by_v_place = DVI_NEW(int, dvi__pattern_entries(&s->by_v));
  f->values = DVI_NEW(double, dvi__pattern_entries(&f->pattern));
  f->F_q = DVI_NEW(double, dvi__pattern_entries(&s->by_q));
  f->F_v = DVI_NEW(double, dvi__pattern_entries(&s->by_v));
  f->residual = DVI_NEW(double, 4 * n);
  if (!f->mass_place || !f->by_v_place || !f->values || !f->F_q || !f->F_v || !f->residual)
    return dvi__fail(DVI_NO_MEMORY, "verlet: no memory for forces of %zu coordinates", n);
  f->given = f->residual + n;
  f->v = f->given + n;
  f->F = f->v + n;
  dvi__pattern_embed(&s->vv, &f->pattern, f->mass_place);
  dvi__pattern_embed(&s->by_v, &f->pattern, f->by_v_place);
  return DVI_OK;
}

static dvi_status friction_prepare(dvi__friction *f)
{
  DVI_TRY(dvi__evaluator_create(f->system, 1, DVI__HESSIANS, f->counters, &f->evaluator));
  DVI_TRY(dvi__pattern_union(&f->system->vv, &f->system->by_v, &f->pattern));
  DVI_TRY(friction_allocate(f));
  /* the mass fills the diagonal */
  if (dvi__pattern_entries(&f->pattern) == f->pattern.columns) return DVI_OK;
  return dvi__linear_create(&f->pattern, DVI__LINEAR_AUTO, f->counters, &f->matrix);
}

dvi_status dvi__friction_create(const dvi_system *system, dvi_counters *counters,
                                dvi__friction **friction)
{
  dvi__friction *f = *friction = DVI_NEW(dvi__friction, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  f->system = system;
  f->counters = counters;
  const dvi_status status = friction_prepare(f);
  if (status != DVI_OK) dvi__friction_destroy(friction);
  return status;
}

void dvi__friction_destroy(dvi__friction **friction)
{
  dvi__friction *f = *friction;
  if (f == NULL) return;
  dvi__linear_destroy(&f->matrix);
  dvi__evaluator_destroy(&f->evaluator);
  dvi__pattern_clear(&f->pattern);
  dvi__release(f->mass_place);
  dvi__release(f->by_v_place);
  dvi__release(f->values);
  dvi__release(f->F_q);
  dvi__release(f->F_v);
  dvi__release(f->residual);
  dvi__release(f);
  *friction = NULL;
}

/* ---- solve ---- */

static dvi_status evaluate_force(dvi__friction *f, const dvi__state *state)
{
  return dvi__forces(f->evaluator, DVI__FRICTION, 1, &state->t, state->q, f->v, f->F);
}

static dvi_status factor_diagonal(const dvi__friction *f)
{
  const int n = f->pattern.columns;
  for (int i = 0; i < n; i++)
    if (f->values[i] == 0)
      return dvi__fail(DVI_SINGULAR, "the %d x %d matrix is singular to working precision", n, n);
  return DVI_OK;
}

static dvi_status factor_matrix(dvi__friction *f, const dvi__state *state, double h)
{
  const dvi_system *s = f->system;
  const double *mass = s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
  const int in_mass = dvi__pattern_entries(&s->vv), in_by_v = dvi__pattern_entries(&s->by_v);
  f->counters->jacobians++;
  DVI_TRY(dvi__forces_jacobian(f->evaluator, 1, &state->t, state->q, f->v, f->F_q, f->F_v));
  memset(f->values, 0, (size_t)dvi__pattern_entries(&f->pattern) * sizeof(double));
  for (int e = 0; e < in_mass; e++) f->values[f->mass_place[e]] = mass[e];
  for (int e = 0; e < in_by_v; e++) f->values[f->by_v_place[e]] -= 0.5 * h * f->F_v[e];
  return f->matrix != NULL ? dvi__linear_factor(f->matrix, f->values) : factor_diagonal(f);
}

static dvi_status solve_matrix(dvi__friction *f, double *x)
{
  if (f->matrix != NULL) return dvi__linear_solve(f->matrix, x);
  for (int i = 0; i < f->pattern.columns; i++) x[i] /= f->values[i];
  return DVI_OK;
}

/* Correct v by one iteration, with a new matrix or the last one. *change becomes the largest
 * change. F stays as it is. */
static dvi_status correct_velocity(dvi__friction *f, const dvi__state *state, double h, int renew,
                                   double *change)
{
  const int n = f->system->n;
  const double *mass = f->system->mass_diagonal, half = 0.5 * h;
  f->counters->residuals++;
  if (mass == NULL)
    DVI_TRY(
        dvi__lagrangian_gradient(f->evaluator, 1, &state->t, state->q, f->v, NULL, f->residual));
  for (int i = 0; i < n; i++) {
    const double p = mass != NULL ? mass[i] * f->v[i] : f->residual[i];
    f->residual[i] = f->given[i] + half * f->F[i] - p;
  }
  if (renew) DVI_TRY(factor_matrix(f, state, h));
  DVI_TRY(solve_matrix(f, f->residual));
  *change = dvi__largest((size_t)n, f->residual);
  if (!isfinite(*change))
    return dvi__fail(DVI_NOT_FINITE, "the velocity of the step is not finite");
  for (int i = 0; i < n; i++) f->v[i] += f->residual[i];
  return DVI_OK;
}

/* Let F follow the last correction of v, which is as small as roundings, by its derivative. */
static void follow_correction(const dvi__friction *f)
{
  const dvi__pattern *by_v = &f->system->by_v;
  for (int j = 0; j < by_v->columns; j++)
    for (int e = by_v->start[j]; e < by_v->start[j + 1]; e++)
      f->F[by_v->row[e]] += f->F_v[e] * f->residual[j];
}

/* Newton's method goes on until its corrections are roundings, or as small as roundings and no
 * longer smaller than the last. The matrix is kept while they shrink fast. */
static dvi_status find_velocity(dvi__friction *f, const dvi__state *state, double h)
{
  const size_t n = (size_t)f->system->n;
  double change = HUGE_VAL, before = HUGE_VAL;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const double last = change;
    const int renew = iteration == 0 || !(last <= fast_change * before);
    DVI_TRY(correct_velocity(f, state, h, renew, &change));
    before = last;
    const double size = dvi__largest(n, f->v);
    if (change <= 4 * DBL_EPSILON * size || (change <= 1e-10 * size && change >= 0.5 * last)) {
      follow_correction(f);
      return DVI_OK;
    }
    DVI_TRY(evaluate_force(f, state));
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the velocity of the step does not settle in %d iterations (change %.1e)",
                   (int)MOST_ITERATIONS, change);
}

/* Newton's method begins without friction, near which the velocity of short steps is. The equation
 * may have others, to which the last step's velocity may lead. */
dvi_status dvi__friction_solve(dvi__friction *f, const dvi__state *state, double h,
                               const double *V_q)
{
  f->counters->newtons++;
  for (int i = 0; i < f->system->n; i++) f->given[i] = state->p[i] - 0.5 * h * V_q[i];
  dvi__mass_solve(f->evaluator, 1, f->given, f->v);
  DVI_TRY(evaluate_force(f, state));
  return find_velocity(f, state, h);
}

dvi_status dvi__friction_end(dvi__friction *f, const dvi__state *state)
{
  return evaluate_force(f, state);
}

const double *dvi__friction_velocity(const dvi__friction *f)
{
  return f->v;
}

const double *dvi__friction_force(const dvi__friction *f)
{
  return f->F;
}
