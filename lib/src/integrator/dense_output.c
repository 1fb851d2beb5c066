/* The path of the last step, between its ends. */
#include <math.h>

#include "core/status.h"
#include "integrator/hits.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"

void dvi__cubic_point(int n, const dvi__cubic *c, double tau, double *q, double *v)
{
  const double h = c->h, a = (1 + 2 * tau) * (1 - tau) * (1 - tau), b = tau * (1 - tau) * (1 - tau);
  const double e = tau * tau * (3 - 2 * tau), d = tau * tau * (tau - 1);
  const double a1 = h != 0 ? 6 * tau * (tau - 1) / h : 0, b1 = (1 - tau) * (1 - 3 * tau),
               d1 = tau * (3 * tau - 2);
  for (int i = 0; i < n; i++) {
    const double q0 = c->q0[i], q1 = c->q1[i], v0 = c->v0[i], v1 = c->v1[i];
    if (q != NULL) q[i] = a * q0 + h * b * v0 + e * q1 + h * d * v1;
    if (v != NULL) v[i] = a1 * (q0 - q1) + b1 * v0 + d1 * v1;
  }
}

/* Evaluate Hermite's cubic through both ends of the last step. */
static dvi_status hermite_cubic(dvi_integrator *I, double tau, double *q, double *v)
{
  DVI_TRY(dvi__integrator_velocities(I));
  DVI_TRY(dvi__state_velocity(I, &I->last, I->last_v));
  DVI_TRY(dvi__state_velocity(I, &I->now, I->v));
  const dvi__cubic cubic = {I->last_h, I->last.q, I->last_v, I->now.q, I->v};
  dvi__cubic_point(I->system->n, &cubic, tau, q, v);
  return DVI_OK;
}

dvi_status dvi__integrator_path(dvi_integrator *I, double tau, double *q, double *v)
{
  if (I->stepper.method->path == NULL) return hermite_cubic(I, tau, q, v);
  I->stepper.method->path(&I->stepper, I->last.q, I->last_h, tau, q, v);
  const size_t n = (size_t)I->system->n, nv = (size_t)I->system->nv;
  if ((q == NULL || dvi__first_not_finite(n, q) < 0) &&
      (v == NULL || dvi__first_not_finite(nv, v) < 0))
    return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "interpolate: the path is not finite at t = %.17g",
                   I->last.t + tau * I->last_h);
}

dvi_status dvi_integrator_interpolate(dvi_integrator *I, double t, double *q, double *v)
{
  if (I == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "interpolate: the integrator is NULL");
  if (dvi_integrator_last_step(I) == 0)
    return dvi__fail(DVI_BAD_STATE, "interpolate: no step was taken yet");
  const double first = dvi_integrator_hit_count(I) > 0 ? dvi__hits_first_time(I) : I->last.t;
  /* Use the rounded ends, because late in a run t0 + h is rounded by a large part of h. */
  const double whole = (t - first) / (I->now.t - first), rounding = 1e-12;
  if (!(whole >= -rounding && whole <= 1 + rounding))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "interpolate: t = %.17g is outside of the last step, %.17g to %.17g", t, first,
                     I->now.t);
  if (dvi__hits_before(I, t)) return dvi__hits_path(I, t, q, v);
  const double tau = (t - I->last.t) / (I->now.t - I->last.t);
  if (I->stepper.method->path == NULL && I->system->dynamics->on_manifold)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "interpolate: %s has no path between its steps, and a cubic would leave the rotations; "
        "lie-verlet and lie-galerkin have one",
        I->stepper.method->name);
  if (I->stepper.method->path != NULL && I->monitored != NULL &&
      I->monitored->pacing == DVI_TIME_TRANSFORM)
    return dvi__monitored_time_path(I, tau, q, v);
  return dvi__integrator_path(I, tau, q, v);
}
