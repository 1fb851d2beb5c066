/* A general Lagrangian L(t,q,v) has q' = v, p' = L_q, p = L_v. Source: Marsden and West 2001, sec.
 * 1.2.5 (the Legendre map p = L_v and its inverse).
 *
 * The inverse is Newton's method on p - L_v = 0, damped by the natural monotonicity test. A step d
 * = L_vv^{-1} (p - L_v) is taken in full, or by halves, so that the next simplified step, with the
 * same L_vv, is shorter (Deuflhard 2004, sec. 3.3). Steps out of the domain of L, as beyond the
 * speed of light, are halved too. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/term/declare.h"

enum { MOST_ITERATIONS = 100, MOST_HALVINGS = 30 };

/* The state of Newton's method, v and the arrays of one iteration, all [n]. */
typedef struct search {
  dvi__evaluator *e;
  double t;
  const double *q, *p;
  double *v, *residual, *step; /* v, the residual p - L_v, and the step from v */
  /* v, residual and simplified step (with the old L_vv) after the step */
  double *trial, *trial_residual, *trial_step;
} search;

static double largest_magnitude(int n, const double *x)
{
  double norm = 0;
  for (int i = 0; i < n; i++) norm = fmax(norm, fabs(x[i]));
  return norm;
}

static dvi_status legendre_residual(const search *s, const double *v, double *residual)
{
  const size_t n = (size_t)s->e->system->n;
  if (dvi__first_not_finite(n, v) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the velocity at t = %.6g is not finite", s->t);
  DVI_TRY(dvi__lagrangian_gradient(s->e, 1, &s->t, s->q, v, NULL, residual));
  for (size_t i = 0; i < n; i++) residual[i] = s->p[i] - residual[i];
  return DVI_OK;
}

static double legendre_solve(const search *s, const double *residual, double *step)
{
  const int n = s->e->system->n;
  memcpy(step, residual, (size_t)n * sizeof(double));
  dvi__linear_solve(s->e->velocity, step);
  return dvi__first_not_finite((size_t)n, step) < 0 ? largest_magnitude(n, step) : HUGE_VAL;
}

/* Move along the step as far as the test allows. *size becomes that of the next simplified step.
 * *settled says that the step was rounding noise. A velocity that vanishes (p = A(q), with a
 * magnetic term A) has no size of its own to measure noise by. Then the momentum is used. */
static dvi_status damped_step(search *s, double *size, int *settled)
{
  const int n = s->e->system->n;
  const double scale = largest_magnitude(n, s->v);
  const int small = *size <= 1e-10 * scale ||
                    largest_magnitude(n, s->residual) <= 1e-10 * largest_magnitude(n, s->p);
  dvi_status status = DVI_OK;
  *settled = 0;
  for (int halvings = 0; halvings <= MOST_HALVINGS; halvings++) {
    const double part = ldexp(1.0, -halvings);
    for (int i = 0; i < n; i++) s->trial[i] = s->v[i] + part * s->step[i];
    status = legendre_residual(s, s->trial, s->trial_residual);
    if (status < 0) return status;
    if (status != DVI_OK) continue;
    const double next = legendre_solve(s, s->trial_residual, s->trial_step);
    *settled = small && next >= 0.5 * *size;
    if (!*settled && !(next <= (1 - 0.25 * part) * *size)) continue;
    memcpy(s->v, s->trial, (size_t)n * sizeof(double));
    memcpy(s->residual, s->trial_residual, (size_t)n * sizeof(double));
    *size = next;
    return DVI_OK;
  }
  return status != DVI_OK
             ? status
             : dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not settle (change %.1e)", *size);
}

/* Iterate from the guess in v to the roundoff floor. DVI_SINGULAR says that L_vv is singular at the
 * guess itself. */
static dvi_status legendre_newton(search *s)
{
  DVI_TRY(legendre_residual(s, s->v, s->residual));
  double size = HUGE_VAL;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const double *L_vv;
    int settled;
    DVI_TRY(dvi__velocity_hessian(s->e, s->t, s->q, s->v, &L_vv));
    const dvi_status status = dvi__linear_factor(s->e->velocity, L_vv);
    if (status == DVI_SINGULAR && iteration > 0) break;
    if (status != DVI_OK) return status;
    size = legendre_solve(s, s->residual, s->step);
    if (size <= 2 * DBL_EPSILON * largest_magnitude(s->e->system->n, s->v)) return DVI_OK;
    DVI_TRY(damped_step(s, &size, &settled));
    if (settled || size <= 2 * DBL_EPSILON * largest_magnitude(s->e->system->n, s->v))
      return DVI_OK;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not settle (change %.1e)", size);
}

/* Apply Newton's method from the guess in v, then from velocities along the momentum. A Lagrangian
 * may be regular only away from v = 0, as v^4/4 is, or have its solution beyond a point where L_vv
 * is singular. */
static dvi_status newton_from_guesses(search *s)
{
  static const double along[] = {1, 0x1p4, 0x1p-4, 0x1p8, 0x1p-8, 0x1p16, 0x1p-16};
  const int guesses = sizeof along / sizeof *along;
  dvi_status status = legendre_newton(s);
  int singular = status == DVI_SINGULAR;
  for (int k = 0; k < guesses && (status > 0 || status == DVI_SINGULAR); k++) {
    for (int i = 0; i < s->e->system->n; i++) s->v[i] = along[k] * s->p[i];
    status = legendre_newton(s);
    singular += status == DVI_SINGULAR;
  }
  if (singular == 1 + guesses) return dvi__lagrangian_is_degenerate(s->t);
  if (status == DVI_SINGULAR || status == DVI_NOT_CONVERGED)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "no velocity found for the momentum at t = %.6g: Newton's method did not "
                     "settle from any of %d guesses",
                     s->t, 1 + guesses);
  return status;
}

dvi_status dvi__search_velocity(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *v)
{
  const size_t n = (size_t)e->system->n;
  double *found = e->velocity_search;
  search s = {
      e, t, q, p, found, found + n, found + 2 * n, found + 3 * n, found + 4 * n, found + 5 * n};
  memcpy(found, v, n * sizeof(double));
  DVI_TRY(newton_from_guesses(&s));
  memcpy(v, found, n * sizeof(double));
  return DVI_OK;
}

dvi_status dvi__velocity_hessian_is_regular(dvi__evaluator *e, double t, const double *q,
                                            const double *v)
{
  const double *L_vv;
  DVI_TRY(dvi__velocity_hessian(e, t, q, v, &L_vv));
  const dvi_status status = dvi__linear_factor(e->velocity, L_vv);
  return status == DVI_SINGULAR ? dvi__lagrangian_is_degenerate(t) : status;
}

dvi_status dvi__prepare_velocity_hessian(dvi__evaluator *e, dvi__derivatives most)
{
  (void)most;
  return dvi__linear_create(&e->system->vv, DVI__LINEAR_AUTO, e->counters, &e->velocity);
}

static int lagrangian_is_declared(const dvi_system_terms *terms)
{
  return terms->lagrangian != NULL && terms->holonomic_count == 0 && terms->nonholonomic_count == 0;
}

static dvi_status declare_lagrangian(const dvi_system_terms *terms, dvi_system *s)
{
  static const char *const part[] = {"Lagrangian: d2L/dq2", "Lagrangian: d2L/dqdv",
                                     "Lagrangian: d2L/dv2"};
  const dvi_lagrangian *given = terms->lagrangian;
  if (given->value == NULL && given->value_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the Lagrangian has no value callback");
  DVI_TRY(dvi__check_shapes("the Lagrangian", given->value && given->value_batch,
                            given->gradient && given->gradient_batch,
                            given->hessian && given->hessian_batch,
                            given->rate && given->rate_batch));
  DVI_TRY(dvi__check_rate(s, "the Lagrangian", given->rate || given->rate_batch));
  s->terms |= DVI__LAGRANGIAN;
  return dvi__declare_function(s, given, "Lagrangian", part);
}

const dvi__dynamics dvi__dynamics_general_lagrangian = {
    .name = "general Lagrangian",
    .function = "Lagrangian",
    .equations = DVI__EULER_LAGRANGE,
    .searches_velocity = 1,
    .has_kinetic_energy = 1,
    .is_declared = lagrangian_is_declared,
    .declare = declare_lagrangian,
    .prepare = dvi__prepare_velocity_hessian,
    .velocity = dvi__search_velocity,
    .regular = dvi__velocity_hessian_is_regular,
    .motion = dvi__motion_of_lagrangian,
    .energy = dvi__energy_of_lagrangian,
    .value = dvi__value_of_point,
    .forces = dvi__forces_of_point,
    .momentum = dvi__momentum_of_point,
};
