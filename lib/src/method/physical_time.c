/* Time inside a step of a time-transformed system. The step's path is a polynomial in tau; the time that has passed at tau is
 *
 *     t(tau) = t0 + (t1 - t0) G(tau)/G(1),     G(tau) = integral of g(q) from 0 to tau,     tau from 0 to 1,
 *
 * so that both ends are the step's own. */
#include <math.h>

#include "core/status.h"
#include "method/integrator_struct.h"

enum { MOST_ITERATIONS = 60 };

/* g on the last step's path. */
static dvi_status monitor_at(dvi_integrator *I, double tau, double *g)
{
  I->stepper.method->path(&I->stepper, I->last.q, 1, tau, I->pace->q, NULL);
  return dvi__pace_monitor(I->pace, I->pace->q, g);
}

/* G(tau). */
static dvi_status passed(dvi_integrator *I, double tau, double *G)
{
  *G = 0;
  for (int k = 0; k < DVI__PACE_POINTS; k++) {
    double g;
    DVI_TRY(monitor_at(I, tau * I->pace->node[k], &g));
    *G += tau * I->pace->weight[k] * g;
  }
  return DVI_OK;
}

/* The tau with G(tau) = fraction of G(1): G rises, so Newton's iterates are kept between the last ones below and above. */
static dvi_status find(dvi_integrator *I, double fraction, double whole, double *tau)
{
  double below = 0, above = 1, G, g;
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    DVI_TRY(passed(I, *tau, &G));
    DVI_TRY(monitor_at(I, *tau, &g));
    const double missed = fraction * whole - G, at = *tau;
    *(missed > 0 ? &below : &above) = at;
    *tau = at + missed / g;
    if (!(*tau >= below && *tau <= above)) *tau = 0.5 * (below + above);
    if (fabs(*tau - at) <= 1e-15) break;
  }
  return DVI_OK;
}

dvi_status dvi__pace_path(dvi_integrator *I, double fraction, double *q, double *v)
{
  double whole, g, tau = fraction;
  DVI_TRY(passed(I, 1, &whole));
  if (fraction > 0 && fraction < 1) DVI_TRY(find(I, fraction, whole, &tau));
  DVI_TRY(monitor_at(I, tau, &g));
  I->stepper.method->path(&I->stepper, I->last.q, 1, tau, q, v);
  for (int i = 0; v != NULL && i < I->system->n; i++) v[i] *= whole / (I->last_h * g); /* dq/dt = dq/dtau dtau/dt */
  return DVI_OK;
}
