/* Reversible step control. An integrating controller advances z, the number of steps in a unit of
 * time over h,
 *
 *     dz/dtau = -g_q.v/g  if dt/dtau = 1/z,        z = 1/g  at the start,
 *
 * in two halves around each step, so that a step of -h undoes one of h. Sources: Hairer and
 * Soederlind 2005, sec. 3, and Hairer, Lubich and Wanner 2006, sec. VIII.3.2. */
#include <math.h>

#include "core/status.h"
#include "integrator/integrator_struct.h"

/* Evaluate dz/dtau = -g_q.v/g at a state. */
static dvi_status density_rate(dvi_integrator *I, const dvi__state *state, double *rate)
{
  dvi__monitored_time *monitored = I->monitored;
  double g, along = 0;
  dvi__guess_velocity(I->system->n, I->now.q, I->last.q, I->last.p, I->last_h, monitored->v);
  DVI_TRY(dvi__legendre_inverse(I->evaluator, state->t, state->q, state->p, monitored->v));
  DVI_TRY(dvi__monitor_value(monitored->monitor, 1, state->q, &g));
  DVI_TRY(dvi__monitor_gradient(monitored->monitor, 1, state->q, monitored->g_q));
  for (int i = 0; i < I->system->n; i++) along += monitored->g_q[i] * monitored->v[i];
  *rate = -along / g;
  return DVI_OK;
}

/* Advance z by half a step. */
static dvi_status density_half_step(dvi_integrator *I, const dvi__state *state, double h, double z,
                                    double *next)
{
  double rate;
  DVI_TRY(density_rate(I, state, &rate));
  *next = z + 0.5 * h * rate;
  if (*next > 0 && isfinite(*next)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "step control: the steps' density z went from %.3g to %.3g; h is too large for "
                   "how fast %s changes",
                   z, *next, I->monitored->name);
}

dvi_status dvi__control_begin(dvi_integrator *I, double h, double *length)
{
  *length = h;
  I->next.density = I->now.density;
  if (I->monitored == NULL || I->monitored->pacing != DVI_STEP_CONTROL) return DVI_OK;
  DVI_TRY(density_half_step(I, &I->now, h, I->now.density, &I->next.density));
  *length = h / I->next.density;
  return dvi__check_step(I->now.t, *length);
}

dvi_status dvi__control_end(dvi_integrator *I, double h)
{
  if (I->monitored == NULL || I->monitored->pacing != DVI_STEP_CONTROL) return DVI_OK;
  return density_half_step(I, &I->next, h, I->next.density, &I->next.density);
}
