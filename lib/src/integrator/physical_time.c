/* Physical time inside a step of a time-transformed system. The step's path is a polynomial in tau.
 * The physical time at tau is
 *
 *     t(tau) = t0 + (t1 - t0) G(tau)/G(1),
 *     G(tau) = integral of g(q) from 0 to tau,     tau from 0 to 1,
 *
 * so that both ends are the step's own. g on the path is expanded once a step in Legendre
 * polynomials, by Gauss quadrature,
 *
 *     g = sum_m a_m P_m(x),     x = 2 tau - 1,
 *     G = 1/2 a_0 (x + 1) + 1/2 sum_m a_m (P_m+1 - P_m-1)/(2m + 1). */
#include <dvi/quadrature.h>
#include <math.h>

#include "core/status.h"
#include "integrator/integrator_struct.h"

enum { POINTS = DVI__MONITORED_POINTS, MOST_ITERATIONS = 60 };

/* Evaluate P_0 .. P_POINTS at x. */
static void legendre_polynomials(double x, double *P)
{
  P[0] = 1;
  P[1] = x;
  for (int m = 1; m < POINTS; m++) P[m + 1] = ((2 * m + 1) * x * P[m] - m * P[m - 1]) / (m + 1);
}

static dvi_status expand_monitor(dvi_integrator *I)
{
  dvi__monitored_time *monitored = I->monitored;
  double P[POINTS + 1], g;
  if (monitored->expanded) return DVI_OK;
  if (monitored->weight[0] == 0)
    DVI_TRY(dvi_quadrature(DVI_GAUSS, POINTS, monitored->node, monitored->weight));
  for (int m = 0; m < POINTS; m++) monitored->series[m] = 0;
  for (int k = 0; k < POINTS; k++) {
    I->stepper.method->path(&I->stepper, I->last.q, 1, monitored->node[k], monitored->q, NULL);
    DVI_TRY(dvi__monitored_time_value(monitored, monitored->q, &g));
    legendre_polynomials(2 * monitored->node[k] - 1, P);
    for (int m = 0; m < POINTS; m++)
      monitored->series[m] += (2 * m + 1) * monitored->weight[k] * P[m] * g;
  }
  monitored->expanded = 1;
  return DVI_OK;
}

/* Return G(tau), and g at tau. */
static double monitor_integral(const dvi__monitored_time *monitored, double tau, double *g)
{
  const double *a = monitored->series;
  double P[POINTS + 1], G = a[0] * tau;
  legendre_polynomials(2 * tau - 1, P);
  *g = a[0];
  for (int m = 1; m < POINTS; m++) {
    G += 0.5 * a[m] * (P[m + 1] - P[m - 1]) / (2 * m + 1);
    *g += a[m] * P[m];
  }
  return G;
}

/* Find the tau with G(tau) = wanted. G rises, so Newton's iterates are kept between the last ones
 * below and above. */
static double find_tau(const dvi__monitored_time *monitored, double wanted, double tau)
{
  double below = 0, above = 1, g;
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    const double at = tau, missed = wanted - monitor_integral(monitored, at, &g);
    *(missed > 0 ? &below : &above) = at;
    tau = at + missed / g;
    if (!(tau >= below && tau <= above)) tau = 0.5 * (below + above);
    if (fabs(tau - at) <= 1e-15) break;
  }
  return tau;
}

dvi_status dvi__monitored_time_path(dvi_integrator *I, double fraction, double *q, double *v)
{
  double g, tau = fraction;
  DVI_TRY(expand_monitor(I));
  const double whole = monitor_integral(I->monitored, 1, &g);
  if (fraction > 0 && fraction < 1) tau = find_tau(I->monitored, fraction * whole, fraction);
  I->stepper.method->path(&I->stepper, I->last.q, 1, tau, I->monitored->q, v);
  DVI_TRY(dvi__monitored_time_value(I->monitored, I->monitored->q, &g));
  for (int i = 0; i < I->system->n; i++) {
    if (q != NULL) q[i] = I->monitored->q[i];
    if (v != NULL) v[i] *= whole / (I->last_h * g); /* dq/dt = dq/dtau dtau/dt */
  }
  return DVI_OK;
}
