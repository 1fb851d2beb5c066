/* Steps in a fictitious time: how they are made, started and ended. */
#include "integrator/pace.h"

#include <dvi/quadrature.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "system/evaluate/dynamics.h"

/* ---- create, destroy ---- */

static dvi_status fill(dvi__pace *p, const dvi_system *system, const dvi_monitor *monitor, dvi_counters *counters)
{
  p->given = *monitor;
  p->energy = (double)NAN;
  p->q = DVI_NEW(double, system->n);
  p->v = DVI_NEW(double, system->n);
  p->g_q = DVI_NEW(double, system->n);
  if (!p->q || !p->v || !p->g_q) return dvi__fail(DVI_NO_MEMORY, "monitor: no memory for %d coordinates", system->n);
  if (p->pacing == DVI_TIME_TRANSFORM)
    DVI_TRY(dvi__transformed_create(system, monitor, counters, &p->transformed));
  else
    DVI_TRY(dvi__monitor_create(system, monitor, 1, DVI__GRADIENTS, counters, &p->monitor));
  const dvi__monitor *made = p->transformed != NULL ? dvi__transformed_monitor(p->transformed) : p->monitor;
  (void)snprintf(p->name, sizeof p->name, "%s", dvi__monitor_name(made));
  p->given.function.name = p->name;
  return dvi_quadrature(DVI_GAUSS, DVI__PACE_POINTS, p->node, p->weight);
}

dvi_status dvi__pace_create(const dvi_system *system, const dvi_monitor *monitor, dvi_pacing pacing, dvi_counters *counters,
                            dvi__pace **pace)
{
  *pace = NULL;
  dvi__pace *p = DVI_NEW(dvi__pace, 1);
  if (p == NULL) return dvi__fail(DVI_NO_MEMORY, "monitor: no memory");
  p->pacing = pacing;
  const dvi_status status = fill(p, system, monitor, counters);
  if (status != DVI_OK) dvi__pace_destroy(&p);
  *pace = p;
  return status;
}

void dvi__pace_destroy(dvi__pace **pace)
{
  dvi__pace *p = *pace;
  if (p == NULL) return;
  dvi__transformed_destroy(&p->transformed);
  dvi__monitor_destroy(&p->monitor);
  dvi__release(p->q);
  dvi__release(p->v);
  dvi__release(p->g_q);
  dvi__release(p);
  *pace = NULL;
}

const dvi_system *dvi__pace_system(const dvi__pace *pace, const dvi_system *system)
{
  return pace != NULL && pace->transformed != NULL ? dvi__transformed_system(pace->transformed) : system;
}

static dvi__monitor *monitor_of(const dvi__pace *pace)
{
  return pace->transformed != NULL ? dvi__transformed_monitor(pace->transformed) : pace->monitor;
}

dvi_status dvi__pace_monitor(dvi__pace *pace, const double *q, double *g)
{
  return dvi__monitor_value(monitor_of(pace), 1, q, g);
}

dvi_status dvi__pace_slope(dvi__pace *pace, const double *q, double *g_q)
{
  return dvi__monitor_gradient(monitor_of(pace), 1, q, g_q);
}

const char *dvi_integrator_monitor(const dvi_integrator *integrator)
{
  return integrator != NULL && integrator->pace != NULL ? integrator->pace->name : NULL;
}

void dvi__pace_explain(const dvi__pace *pace, dvi__text *text)
{
  if (pace->pacing == DVI_TIME_TRANSFORM)
    dvi__text_add(text, "time: transformed, dt/dtau = g(q), %s; steps are steps of tau, of a general Lagrangian with mass M/g\n",
                  pace->name);
  else
    dvi__text_add(text, "time: steps follow %s by reversible control; symmetric, not symplectic\n", pace->name);
}

/* ---- start ---- */

void dvi__pace_set_energy(dvi__pace *pace, double energy)
{
  pace->energy = energy;
  pace->expanded = 0;
  if (pace->transformed != NULL)
    dvi__transformed_set_energy(pace->transformed, energy);
  else
    dvi__monitor_set_energy(pace->monitor, energy);
}

/* L_v.v - L, or H at the start's momenta. */
static dvi_status energy_at(dvi_integrator *I, double t, const double *q, const double *v, const double *momenta, double *energy)
{
  double L, *p = I->pace->g_q;
  if (I->system->dynamics->by_momentum) return dvi__lagrangian_value(I->evaluator, 1, &t, q, momenta, energy);
  DVI_TRY(dvi__lagrangian_value(I->evaluator, 1, &t, q, v, &L));
  DVI_TRY(dvi__lagrangian_gradient(I->evaluator, 1, &t, q, v, NULL, p));
  *energy = -L;
  for (int i = 0; i < I->system->n; i++) *energy += p[i] * v[i];
  return DVI_OK;
}

dvi_status dvi__pace_start(dvi_integrator *I, double t, const double *q, const double *v, const double *p, double *w,
                           double *density)
{
  dvi__pace *pace = I->pace;
  const double before = pace->energy;
  double g = 1, energy = before;
  if (!pace->holds) DVI_TRY(energy_at(I, t, q, v, p, &energy));
  dvi__pace_set_energy(pace, energy);
  const dvi_status status = dvi__pace_monitor(pace, q, &g);
  if (status != DVI_OK) {
    dvi__pace_set_energy(pace, before);
    return status;
  }
  for (int i = 0; i < I->system->n; i++) w[i] = pace->pacing == DVI_TIME_TRANSFORM ? g * v[i] : v[i];
  *density = 1 / g;
  return DVI_OK;
}

/* ---- the last step of a run ---- */

enum { MOST_TRIES = 60 };

/* The time past the end, in the direction of the run. */
static double past(const dvi_integrator *I, double h, double t_end)
{
  const double later = (I->now.t - t_end) - I->now.t_carry;
  return h > 0 ? later : -later;
}

/* The run ends at t_end itself, not a few roundings beside it: what follows, or ends there too, finds it so. */
static dvi_status arrive(dvi_integrator *I, double t_end)
{
  I->now.t = t_end;
  I->now.t_carry = 0;
  I->last_h = (t_end - I->last.t) + I->last.t_carry;
  return DVI_OK;
}

/* The length of the step from here that ends at t_end: Illinois' variant of regula falsi (Dowell and Jarratt 1971) between one that falls short and
 * one that passes the end, `over`; bisection while that one fails, `over` NaN, for beyond the end are places that the run never comes to, down to
 * `least`. */
static dvi_status step_to_end(dvi_integrator *I, double h, double over, double least, double t_end, double tolerance)
{
  double longer = h, shorter = 0, under = past(I, h, t_end);
  dvi_status failure = DVI_OK;
  int side = 0;
  for (int i = 0; i < MOST_TRIES && fabs(longer - shorter) > least; i++) {
    const double part = isnan(over) ? 0.5 : under / (under - over), length = shorter + (longer - shorter) * part;
    const dvi_status status = dvi_integrator_step(I, length);
    if (status < 0) return status;
    if (status > 0) failure = status;
    const double missed = status == DVI_OK ? past(I, h, t_end) : (double)NAN;
    if (fabs(missed) <= tolerance) return arrive(I, t_end);
    if (status == DVI_OK) dvi__integrator_take_back(I);
    if (missed < 0) {
      shorter = length, under = missed;
      if (side < 0) over *= 0.5;
      side = -1;
    } else {
      longer = length, over = missed;
      if (side > 0) under *= 0.5;
      side = 1;
    }
  }
  if (failure != DVI_OK) return failure; /* its sentence is the last one */
  return dvi__fail(DVI_NOT_CONVERGED, "%s: the step from t = %.9g that ends at t = %.9g was not found; try a smaller h",
                   I->stepper.method->name, I->now.t, t_end);
}

/* After a step that has failed: it may have been one past the end, by the monitor here. */
static dvi_status retry(dvi_integrator *I, double h, double t_end, double tolerance, dvi_status failure)
{
  double g;
  if (failure < 0 || dvi__pace_monitor(I->pace, I->now.q, &g) != DVI_OK || past(I, h, t_end) + 2 * fabs(h) * g < 0) return failure;
  return step_to_end(I, h, (double)NAN, 0.0625 * tolerance / g, t_end, tolerance);
}

dvi_status dvi__pace_step(dvi_integrator *I, double h, double t_end, double tolerance)
{
  const dvi_status status = dvi_integrator_step(I, h);
  if (status != DVI_OK) return retry(I, h, t_end, tolerance, status);
  const double over = past(I, h, t_end);
  if (over < -tolerance) return DVI_OK;
  if (over <= tolerance) return arrive(I, t_end);
  dvi__integrator_take_back(I);
  return step_to_end(I, h, over, 0, t_end, tolerance);
}
