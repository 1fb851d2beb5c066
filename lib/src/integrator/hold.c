/* When a contact is held, and when it is released (held.h). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "integrator/hits_struct.h"
#include "num/finite.h"
#include "system/dynamics/holonomic.h"
#include "system/evaluate/dynamics.h"

/* Part of the forces below which that of a contact counts as 0. It has second derivatives along the
 * motion, by differences. */
static const double no_force = 1e-7;

/* The path of a step is searched in this many parts for a force that changes its sign. */
enum { PARTS = 4, MOST_ITERATIONS = 12 };

/* ---- the force ---- */

static double length_of(size_t n, const double *x)
{
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

dvi_status dvi__held_force(dvi_integrator *I, double t, const double *q, const double *v, double *N,
                           double *size)
{
  struct dvi__hits *s = I->hits;
  const dvi__contact_term *term = &I->system->contacts[s->bodies.held];
  double lambda;
  DVI_TRY(dvi__rows_acceleration(I->evaluator, t, q, v, NULL, &lambda));
  *N = -lambda;
  if (size == NULL) return DVI_OK;
  DVI_TRY(dvi__holonomic_gradient(&term->gap, t, q, s->G));
  DVI_TRY(I->system->dynamics->forces(I->evaluator, t, q, v, s->dual));
  const double gradient = length_of((size_t)term->gap.gradients.start[1], s->G);
  *size = fabs(lambda) + length_of((size_t)I->system->n, s->dual) / gradient;
  return DVI_OK;
}

dvi_status dvi_integrator_contact_force(dvi_integrator *I, int contact, double *force)
{
  if (I == NULL || force == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "contact force: an argument is NULL");
  if (!dvi__hits_divide(I))
    return dvi__fail(DVI_UNSUPPORTED, "contact force: %s",
                     I->hits == NULL ? "the system declares no contacts"
                                     : "the method keeps contacts closed itself, by impulses");
  if (!dvi_integrator_may_hold(I, contact))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "contact force: contact %d is not declared with `hold`, and has no force",
                     contact);
  if (!I->started)
    return dvi__fail(
        DVI_BAD_STATE,
        "contact force: the integrator has no state yet; call dvi_integrator_start first");
  *force = 0;
  if (dvi__bodies_held(I) != contact) return DVI_OK;
  DVI_TRY(dvi__integrator_velocity(I, I->hits->moved));
  return dvi__held_force(I, I->now.t, I->now.q, I->hits->moved, force, NULL);
}

/* ---- the start ---- */

/* Move the state onto phi = 0 and phi' = 0, and record the impulse. */
static dvi_status settle(dvi_integrator *I, int k, double t)
{
  struct dvi__hits *s = I->hits;
  const dvi__pattern *pattern = &I->system->contacts[k].gap.gradients;
  const size_t n = (size_t)I->system->n;
  double *q = s->bodies.start, *v = q + n, *p = v + n, along = 0, square = 0;
  dvi__touch touch;
  DVI_TRY(dvi__contact_touch(&I->system->contacts[k], I->now.t, q, v, s->G, &touch));
  DVI_TRY(I->system->dynamics->constraint->project(I->evaluator, I->now.t, I->now.q, I->now.p));
  memset(I->now.q_compensation, 0, n * sizeof(double));
  memcpy(s->moved, v, n * sizeof(double));
  DVI_TRY(dvi__legendre_inverse(I->evaluator, I->now.t, I->now.q, I->now.p, s->moved));
  for (int e = 0; e < pattern->start[1]; e++) {
    along += s->G[e] * (I->now.p[pattern->row[e]] - p[pattern->row[e]]);
    square += s->G[e] * s->G[e];
  }
  const dvi_hit hit = {
      .contact = k, .t = t, .before = touch.rate, .impulse = along / square, .kind = DVI_HOLD};
  DVI_TRY(dvi__supply_jump(I, q, v, p));
  return dvi__record(I, &hit, I->now.q, v, s->moved);
}

static dvi_status try_to_hold(dvi_integrator *I, int k, double t, int *holds)
{
  struct dvi__hits *s = I->hits;
  const size_t n = (size_t)I->system->n;
  double N, size;
  DVI_TRY(dvi__held_force(I, I->now.t, I->now.q, s->bodies.start + n, &N, &size));
  if (!(N > no_force * size)) return DVI_OK;
  DVI_TRY(settle(I, k, t));
  *holds = 1;
  dvi__integrator_begin_anew(I, s->moved);
  return DVI_OK;
}

dvi_status dvi__hold(dvi_integrator *I, int k, double t, int *holds)
{
  struct dvi__hits *s = I->hits;
  const size_t n = (size_t)I->system->n;
  *holds = 0;
  if (!I->system->contacts[k].callbacks.hold || s->bodies.held >= 0 || s->let_go == k ||
      s->made.h < 0)
    return DVI_OK;
  DVI_TRY(dvi__integrator_velocity(I, s->bodies.start + n));
  memcpy(s->bodies.start, I->now.q, n * sizeof(double));
  memcpy(s->bodies.start + 2 * n, I->now.p, n * sizeof(double));
  dvi__bodies_choose(I, k);
  const dvi_status status = try_to_hold(I, k, t, holds);
  if (!*holds) dvi__bodies_choose(I, -1);
  return status;
}

/* ---- the end ---- */

dvi_status dvi__let_go(dvi_integrator *I)
{
  struct dvi__hits *s = I->hits;
  const int k = s->bodies.held;
  dvi__touch touch;
  DVI_TRY(dvi__integrator_velocity(I, s->moved));
  DVI_TRY(dvi__contact_touch(&I->system->contacts[k], I->now.t, I->now.q, s->moved, s->G, &touch));
  const dvi_hit hit = {
      .contact = k, .t = I->now.t, .before = touch.rate, .after = touch.rate, .kind = DVI_RELEASE};
  dvi__bodies_choose(I, -1);
  s->let_go = k;
  DVI_TRY(dvi__record(I, &hit, I->now.q, s->moved, s->moved));
  dvi__integrator_begin_anew(I, s->moved);
  return DVI_OK;
}

static dvi_status force_on_path(dvi_integrator *I, double tau, double *N)
{
  struct dvi__hits *s = I->hits;
  DVI_TRY(dvi__searched_path(I, tau, s->q, s->moved));
  return dvi__held_force(I, I->last.t + tau * I->last_h, s->q, s->moved, N, NULL);
}

/* Find the zero between a, where the force is Na >= 0, and b, where it is Nb < 0, by false position
 * with halved weights (Dowell and Jarratt 1971, the Illinois rule). */
static dvi_status zero_on_path(dvi_integrator *I, double a, double Na, double b, double Nb,
                               double *tau)
{
  for (int i = 0; i < MOST_ITERATIONS && b - a > 1e-9; i++) {
    double N;
    *tau = (a * Nb - b * Na) / (Nb - Na);
    DVI_TRY(force_on_path(I, *tau, &N));
    if (N < 0) {
      b = *tau, Nb = N, Na /= 2;
    } else {
      a = *tau, Na = N, Nb /= 2;
    }
  }
  return DVI_OK;
}

dvi_status dvi__find_release(dvi_integrator *I, double N0, double *tau)
{
  double before = N0, N;
  *tau = HUGE_VAL;
  for (int part = 0; part < PARTS; part++, before = N) {
    const double a = part / (double)PARTS, b = (part + 1) / (double)PARTS;
    DVI_TRY(force_on_path(I, b, &N));
    if (N < 0) {
      *tau = b;
      return zero_on_path(I, a, before, b, N, tau);
    }
  }
  return DVI_OK;
}

/* The force at the end of a step of this length, which replaces the last one. */
static dvi_status force_after(dvi_integrator *I, double length, double *N)
{
  struct dvi__hits *s = I->hits;
  dvi__integrator_smooth_back(I);
  DVI_TRY(dvi__integrator_smooth_step(I, length));
  DVI_TRY(dvi__integrator_velocity(I, s->moved));
  return dvi__held_force(I, I->now.t, I->now.q, s->moved, N, NULL);
}

/* The secant method begins with the force's slope on the path. */
dvi_status dvi__locate_release(dvi_integrator *I, double tau, double *length)
{
  const double whole = *length, apart = 1e-3;
  double ahead, behind, N, before = HUGE_VAL;
  DVI_TRY(force_on_path(I, fmin(1, tau + apart), &ahead));
  DVI_TRY(force_on_path(I, fmax(0, tau - apart), &behind));
  double slope = (ahead - behind) / (fmin(1, tau + apart) - fmax(0, tau - apart));
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    *length = tau * whole;
    if (dvi__check_step(I->last.t, *length) != DVI_OK) {
      dvi__integrator_smooth_back(I);
      *length = 0;
      return DVI_OK;
    }
    DVI_TRY(force_after(I, *length, &N));
    const double next = fmin(1, fmax(0, tau - N / slope));
    if (fabs(next - tau) <= 4 * DBL_EPSILON || (i > 1 && fabs(N) >= 0.5 * fabs(before))) break;
    before = N;
    tau = next;
  }
  return DVI_OK;
}
