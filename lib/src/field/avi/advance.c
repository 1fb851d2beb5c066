/* The run of the events, and the alarm. Steps of their own are never stable, only slow to show it.
 * So the energy is looked at once in 64 of the longest steps, at times that do not depend on how
 * the way is cut. */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "field/avi/engine.h"
#include "field/step/alarm.h"

enum { STEPS_BETWEEN_CHECKS = 64 };

static const double roundings = 4 * DBL_EPSILON;

static dvi_status integrate(const dvi__avi *avi, int i, double from, double to, double *half)
{
  const double middle = from + 0.5 * (to - from);
  const dvi__avi_current *current = avi->current + i;
  DVI_TRY(current->impulse(from, middle, half + 2 * i, current->user));
  return current->impulse(middle, to, half + 2 * i + 1, current->user);
}

dvi_status dvi__avi_signals(const dvi__avi *avi, double from, double to, double *half)
{
  for (int i = 0; i < avi->currents; i++) DVI_TRY(integrate(avi, i, from, to, half));
  return DVI_OK;
}

dvi_status dvi__avi_signals_at(const dvi__avi *avi, int64_t e, double from, double to, double *half)
{
  const dvi__avi_extra *extra = avi->extras + avi->extra[e];
  for (int i = extra->push; i < extra->push + extra->pushes; i++)
    DVI_TRY(integrate(avi, avi->push[i].current, from, to, half));
  return DVI_OK;
}

static dvi_status run(dvi__avi *avi, double t)
{
  const double limit = t + roundings * fmax(fabs(t), fabs(avi->t0));
  avi->view->t = (double)NAN; /* events of the present time may be left after a failure */
  DVI_TRY((avi->is_queued ? dvi__avi_run_queue : dvi__avi_run_slots)(avi, limit));
  avi->t = t;
  return DVI_OK;
}

static double time_of_check(const dvi__avi *avi)
{
  return avi->t0 + (double)(avi->checks + 1) * (STEPS_BETWEEN_CHECKS * avi->longest);
}

static dvi_status compare_energy(dvi__avi *avi)
{
  static const dvi__alarm_words words = {
      .method = "avi",
      .reference = "the start and its currents",
      .remedy = "the steps are in resonance; take shorter ones, and powers of 2 of the shortest",
      .last = "shorter steps"};
  double energy, growth;
  DVI_TRY(dvi__avi_energy(avi, &energy, &growth));
  const dvi_status status = dvi__judge_growth(&words, avi->t, energy, growth, &avi->allowed);
  if (status != DVI_NOT_FINITE) avi->checks++;
  return status;
}

dvi_status dvi__avi_advance(dvi__avi *avi, double t)
{
  while (time_of_check(avi) <= t) {
    DVI_TRY(run(avi, time_of_check(avi)));
    DVI_TRY(compare_energy(avi));
  }
  return run(avi, t);
}

double dvi__avi_time(const dvi__avi *avi)
{
  return avi->t;
}
