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
  dvi__linear *matrix;
  double *values, *F_q, *F_v;                     /* [entries] */
  double *numbers, *v, *force, *residual, *given; /* [n] each, all numbers, p0 - h/2 dV */
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
  f->numbers = DVI_NEW(double, 4 * n);
  if (!f->mass_place || !f->by_v_place || !f->values || !f->F_q || !f->F_v || !f->numbers)
    return dvi__fail(DVI_NO_MEMORY, "verlet: no memory for forces of %zu coordinates", n);
  f->v = f->numbers;
  f->force = f->v + n;
  f->residual = f->force + n;
  f->given = f->residual + n;
  dvi__pattern_embed(&s->vv, &f->pattern, f->mass_place);
  dvi__pattern_embed(&s->by_v, &f->pattern, f->by_v_place);
  return DVI_OK;
}

static dvi_status friction_prepare(dvi__friction *f)
{
  DVI_TRY(dvi__evaluator_create(f->system, 1, DVI__HESSIANS, f->counters, &f->evaluator));
  DVI_TRY(dvi__pattern_union(&f->system->vv, &f->system->by_v, &f->pattern));
  DVI_TRY(friction_allocate(f));
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
  dvi__release(f->numbers);
  dvi__release(f);
  *friction = NULL;
}

/* ---- solve ---- */

static dvi_status factor_matrix(dvi__friction *f, const dvi__state *state, double h)
{
  const dvi_system *s = f->system;
  const double *mass = s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
  f->counters->jacobians++;
  DVI_TRY(dvi__forces_jacobian(f->evaluator, 1, &state->t, state->q, f->v, f->F_q, f->F_v));
  memset(f->values, 0, (size_t)dvi__pattern_entries(&f->pattern) * sizeof(double));
  for (int e = 0; e < dvi__pattern_entries(&s->vv); e++) f->values[f->mass_place[e]] = mass[e];
  for (int e = 0; e < dvi__pattern_entries(&s->by_v); e++)
    f->values[f->by_v_place[e]] -= 0.5 * h * f->F_v[e];
  return dvi__linear_factor(f->matrix, f->values);
}

/* Correct v by one iteration, with a new matrix or the last one. *change becomes the largest
 * change. */
static dvi_status correct_velocity(dvi__friction *f, const dvi__state *state, double h, int renew,
                                   double *change)
{
  const int n = f->system->n;
  f->counters->residuals++;
  DVI_TRY(dvi__lagrangian_gradient(f->evaluator, 1, &state->t, state->q, f->v, NULL, f->residual));
  DVI_TRY(dvi__forces(f->evaluator, DVI__FRICTION, 1, &state->t, state->q, f->v, f->force));
  for (int i = 0; i < n; i++) f->residual[i] = f->given[i] + 0.5 * h * f->force[i] - f->residual[i];
  if (renew) DVI_TRY(factor_matrix(f, state, h));
  DVI_TRY(dvi__linear_solve(f->matrix, f->residual));
  if (dvi__first_not_finite((size_t)n, f->residual) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the velocity of the step is not finite");
  for (int i = 0; i < n; i++) f->v[i] += f->residual[i];
  *change = dvi__largest((size_t)n, f->residual);
  return DVI_OK;
}

/* Newton's method goes on until its corrections are roundings, or as small as roundings and no
 * longer smaller than the last. The matrix is kept while they shrink fast. */
static dvi_status find_velocity(dvi__friction *f, const dvi__state *state, double h)
{
  const size_t n = (size_t)f->system->n;
  double change = HUGE_VAL, before = HUGE_VAL;
  f->counters->newtons++;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const double last = change;
    const int renew = iteration == 0 || !(last <= fast_change * before);
    DVI_TRY(correct_velocity(f, state, h, renew, &change));
    before = last;
    const double size = dvi__largest(n, f->v);
    if (change <= 4 * DBL_EPSILON * size || (change <= 1e-10 * size && change >= 0.5 * last))
      return DVI_OK;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the velocity of the step does not settle in %d iterations (change %.1e)",
                   (int)MOST_ITERATIONS, change);
}

dvi_status dvi__friction_solve(dvi__friction *f, const dvi__state *state, double h,
                               const double *V_q, const double **F)
{
  for (int i = 0; i < f->system->n; i++) f->given[i] = state->p[i] - 0.5 * h * V_q[i];
  dvi__mass_solve(f->evaluator, 1, f->given, f->v);
  DVI_TRY(find_velocity(f, state, h));
  *F = f->force;
  return dvi__forces(f->evaluator, DVI__FRICTION, 1, &state->t, state->q, f->v, f->force);
}

dvi_status dvi__friction_end(dvi__friction *f, const dvi__state *state, const double **F)
{
  *F = f->force;
  return dvi__forces(f->evaluator, DVI__FRICTION, 1, &state->t, state->q, f->v, f->force);
}

const double *dvi__friction_velocity(const dvi__friction *f)
{
  return f->v;
}
