/* Steps in a fictitious time by a monitor: creation, start, and the last step of a run. */
#include "integrator/monitored_time.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "system/evaluate/dynamics.h"

/* ---- create, destroy ---- */

static dvi_status monitored_time_prepare(dvi__monitored_time *m, const dvi_system *system,
                                         const dvi_monitor *monitor, dvi_counters *counters)
{
  m->given = *monitor;
  m->energy = (double)NAN;
  m->q = DVI_NEW(double, system->n);
  m->v = DVI_NEW(double, system->n);
  m->g_q = DVI_NEW(double, system->n);
  if (!m->q || !m->v || !m->g_q)
    return dvi__fail(DVI_NO_MEMORY, "monitor: no memory for %d coordinates", system->n);
  if (m->pacing == DVI_TIME_TRANSFORM)
    DVI_TRY(dvi__transformed_create(system, monitor, counters, &m->transformed));
  else
    DVI_TRY(dvi__monitor_create(system, monitor, 1, DVI__GRADIENTS, counters, &m->monitor));
  const dvi__monitor *made = m->transformed != NULL ? dvi__transformed_monitor(m->transformed)
                                                    : m->monitor;
  (void)snprintf(m->name, sizeof m->name, "%s", dvi__monitor_name(made));
  m->given.function.name = m->name;
  return DVI_OK;
}

dvi_status dvi__monitored_time_create(const dvi_system *system, const dvi_monitor *monitor,
                                      dvi_pacing pacing, dvi_counters *counters,
                                      dvi__monitored_time **monitored)
{
  *monitored = NULL;
  dvi__monitored_time *m = DVI_NEW(dvi__monitored_time, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "monitor: no memory");
  m->pacing = pacing;
  const dvi_status status = monitored_time_prepare(m, system, monitor, counters);
  if (status != DVI_OK) dvi__monitored_time_destroy(&m);
  *monitored = m;
  return status;
}

void dvi__monitored_time_destroy(dvi__monitored_time **monitored)
{
  dvi__monitored_time *m = *monitored;
  if (m == NULL) return;
  dvi__transformed_destroy(&m->transformed);
  dvi__monitor_destroy(&m->monitor);
  dvi__release(m->q);
  dvi__release(m->v);
  dvi__release(m->g_q);
  dvi__release(m);
  *monitored = NULL;
}

const dvi_system *dvi__monitored_time_system(const dvi__monitored_time *monitored,
                                             const dvi_system *system)
{
  return monitored != NULL && monitored->transformed != NULL
             ? dvi__transformed_system(monitored->transformed)
             : system;
}

static dvi__monitor *monitor_of(const dvi__monitored_time *monitored)
{
  return monitored->transformed != NULL ? dvi__transformed_monitor(monitored->transformed)
                                        : monitored->monitor;
}

dvi_status dvi__monitored_time_value(dvi__monitored_time *monitored, const double *q, double *g)
{
  return dvi__monitor_value(monitor_of(monitored), 1, q, g);
}

dvi_status dvi__monitored_time_gradient(dvi__monitored_time *monitored, const double *q,
                                        double *g_q)
{
  return dvi__monitor_gradient(monitor_of(monitored), 1, q, g_q);
}

const char *dvi_integrator_monitor(const dvi_integrator *integrator)
{
  return integrator != NULL && integrator->monitored != NULL ? integrator->monitored->name : NULL;
}

void dvi__monitored_time_explain(const dvi__monitored_time *monitored, dvi__text *text)
{
  if (monitored->pacing == DVI_TIME_TRANSFORM)
    dvi__text_add(text,
                  "time: transformed, dt/dtau = g(q), %s; steps are steps of tau, of a general "
                  "Lagrangian with mass M/g\n",
                  monitored->name);
  else
    dvi__text_add(text, "time: steps follow %s by reversible control; symmetric, not symplectic\n",
                  monitored->name);
}

/* ---- start ---- */

void dvi__monitored_time_set_energy(dvi__monitored_time *monitored, double energy)
{
  monitored->energy = energy;
  monitored->expanded = 0;
  if (monitored->transformed != NULL)
    dvi__transformed_set_energy(monitored->transformed, energy);
  else
    dvi__monitor_set_energy(monitored->monitor, energy);
}

/* Evaluate the energy L_v.v - L, or H at the start's momenta. */
static dvi_status energy_at(dvi_integrator *I, double t, const double *q, const double *v,
                            const double *momenta, double *energy)
{
  double L, *p = I->monitored->g_q;
  if (I->system->dynamics->by_momentum)
    return dvi__lagrangian_value(I->evaluator, 1, &t, q, momenta, energy);
  DVI_TRY(dvi__lagrangian_value(I->evaluator, 1, &t, q, v, &L));
  DVI_TRY(dvi__lagrangian_gradient(I->evaluator, 1, &t, q, v, NULL, p));
  *energy = -L;
  for (int i = 0; i < I->system->n; i++) *energy += p[i] * v[i];
  return DVI_OK;
}

dvi_status dvi__monitored_time_start(dvi_integrator *I, double t, const double *q, const double *v,
                                     const double *p, double *w, double *density)
{
  dvi__monitored_time *monitored = I->monitored;
  const double before = monitored->energy;
  double g = 1, energy = before;
  if (!monitored->holds) DVI_TRY(energy_at(I, t, q, v, p, &energy));
  dvi__monitored_time_set_energy(monitored, energy);
  const dvi_status status = dvi__monitored_time_value(monitored, q, &g);
  if (status != DVI_OK) {
    dvi__monitored_time_set_energy(monitored, before);
    return status;
  }
  for (int i = 0; i < I->system->n; i++)
    w[i] = monitored->pacing == DVI_TIME_TRANSFORM ? g * v[i] : v[i];
  *density = 1 / g;
  return DVI_OK;
}

/* ---- the last step of a run ---- */

enum { MOST_TRIES = 60, TRIES_BY_RATE = 8 };

/* Return the time past the end, in the direction of the run. */
static double time_past_end(const dvi_integrator *I, double h, double t_end)
{
  const double later = (I->now.t - t_end) - I->now.t_compensation;
  return h > 0 ? later : -later;
}

/* Set the time to t_end itself, not a few roundings beside it, for later runs and comparisons. */
static dvi_status arrive_at_end(dvi_integrator *I, double t_end)
{
  I->now.t = t_end;
  I->now.t_compensation = 0;
  I->last_h = (t_end - I->last.t) + I->last.t_compensation;
  return DVI_OK;
}

/* Give g at a state of transformed steps, the rate at which the time grows with their length there.
 * NaN with other steps, or if the monitor fails. */
static double rate_at(const dvi_integrator *I, const dvi__state *state)
{
  double g;
  if (I->monitored->transformed == NULL ||
      dvi__monitored_time_value(I->monitored, state->q, &g) != DVI_OK)
    return (double)NAN;
  return g;
}

/* Give the part of the last step, of length h, that takes this part of its time, by the cubic with
 * the rates at both ends. NaN if they are not known. */
static double part_of_step(const dvi_integrator *I, double h, double time)
{
  const double whole = fabs(I->last_h / h), start = rate_at(I, &I->last) / whole,
               end = rate_at(I, &I->now) / whole;
  double x = time;
  for (int i = 0; i < 4; i++) {
    const double missed = x * (start + x * (3 - 2 * start - end + x * (start + end - 2))) - time,
                 slope = start + x * (6 - 4 * start - 2 * end + 3 * x * (start + end - 2));
    x -= missed / slope;
  }
  return x;
}

/* Take the step from here that ends at t_end. Its length is found by Newton's method from `guess`,
 * or by Illinois' variant of regula falsi (Dowell and Jarratt 1971), between a step that falls
 * short and one that passes the end by `over`. While the longer step fails, over is NaN and the
 * interval is bisected, down to `least`. A failure there is no failure of the run, which never
 * reaches states beyond the end. */
static dvi_status step_to_end(dvi_integrator *I, double h, double guess, double over, double least,
                              double t_end, double tolerance)
{
  double longer = h, shorter = 0, under = time_past_end(I, h, t_end);
  dvi_status failure = DVI_OK;
  char sentence[DVI__SENTENCE_SIZE] = "";
  int side = 0;
  for (int i = 0; i < MOST_TRIES && fabs(longer - shorter) > least; i++) {
    const double part = isnan(over) ? 0.5 : under / (under - over);
    const int is_between = i < TRIES_BY_RATE && (guess - shorter) * (longer - guess) > 0;
    const double length = is_between ? guess : shorter + (longer - shorter) * part;
    const dvi_status status = dvi_integrator_step(I, length);
    if (status < 0) return status;
    if (status > 0) {
      failure = status;
      (void)snprintf(sentence, sizeof sentence, "%s", dvi_last_error());
    }
    const double missed = status == DVI_OK ? time_past_end(I, h, t_end) : (double)NAN;
    if (fabs(missed) <= tolerance) return arrive_at_end(I, t_end);
    guess = (double)NAN;
    if (status == DVI_OK) {
      guess = length - copysign(missed / rate_at(I, &I->now), length);
      dvi__integrator_take_back(I);
    }
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
  if (failure != DVI_OK) return dvi__fail(failure, "%s", sentence);
  return dvi__fail(
      DVI_NOT_CONVERGED,
      "%s: the step from t = %.9g that ends at t = %.9g was not found; try a smaller h",
      I->stepper.method->name, I->now.t, t_end);
}

/* Handle a failed step. If the monitor shows that the step may have passed the end, take the one
 * that ends there. */
static dvi_status retry_to_end(dvi_integrator *I, double h, double t_end, double tolerance,
                               dvi_status failure)
{
  double g;
  if (failure < 0 || dvi__monitored_time_value(I->monitored, I->now.q, &g) != DVI_OK ||
      time_past_end(I, h, t_end) + 2 * fabs(h) * g < 0)
    return failure;
  return step_to_end(I, h, (double)NAN, (double)NAN, 0.0625 * tolerance / g, t_end, tolerance);
}

dvi_status dvi__monitored_time_step(dvi_integrator *I, double h, double t_end, double tolerance)
{
  const dvi_status status = dvi_integrator_step(I, h);
  if (status != DVI_OK) return retry_to_end(I, h, t_end, tolerance, status);
  const double over = time_past_end(I, h, t_end);
  if (over < -tolerance) return DVI_OK;
  if (over <= tolerance) return arrive_at_end(I, t_end);
  const double part = part_of_step(I, h, 1 - over / fabs(I->last_h));
  dvi__integrator_take_back(I);
  return step_to_end(I, h, part * h, over, 0, t_end, tolerance);
}
