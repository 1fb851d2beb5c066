/* The choice of how to find the growth. */
#include "field/step/growth.h"

#include <math.h>
#include <stdarg.h>
#include <dvi/number.h>

#include "core/status.h"
#include "num/philox.h"

enum { ALL_MODES_MOST = 500, SEGMENTS = 64 };

dvi_status dvi__check_size(double size, double time)
{
  if (isfinite(size)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE,
                   "stability: a field grows beyond all numbers within %g, so that its growth is "
                   "not told; take a shorter span, or shorter steps",
                   time);
}

double dvi__random_between(uint64_t number)
{
  uint32_t x[4] = {(uint32_t)number, (uint32_t)(number >> 32), 0, 0};
  dvi__philox(x, 1);
  return ldexp((double)x[0], -31) - 1;
}

/* ---- without a period ---- */

/* Logarithms of the amplitude beyond which nothing new is seen: what has fallen so far consists of
 * roundings, and no part of it grew. */
static const double faint = -20, large = 80;

/* The growth is that of the second half of the way, on which the fastest field has come forth. */
static dvi_status follow(const dvi__flow *flow, double span, dvi_stability *report)
{
  double size[SEGMENTS + 1], energy;
  int last = 0;
  flow->strain->scatter(flow);
  DVI_TRY(flow->energy(flow->of, 0, &energy));
  size[0] = 0.5 * log(energy);
  while (last < SEGMENTS && size[last] < large && size[last] > faint) {
    DVI_TRY(flow->energy(flow->of, span * (last + 1) / SEGMENTS, &energy));
    DVI_TRY(dvi__check_size(energy, span / SEGMENTS));
    size[++last] = 0.5 * log(energy);
  }
  const int half = last / 2;
  const double time = span / SEGMENTS;
  report->growth = exp(fmax(size[last] - size[half], 0) / (time * (last - half)));
  report->span = time * last;
  report->followed = 1;
  report->resolution = 0.5 * log(2.0 * (double)flow->n) / report->span;
  return DVI_OK;
}

/* ---- the report ---- */

void dvi__say_schedule(dvi_stability *report, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(report->schedule, DVI_SCHEDULE_SIZE, format, arguments);
  va_end(arguments);
}

void dvi__say_steps(dvi_stability *report, double shortest, double longest, int classes)
{
  if (shortest == longest)
    dvi__say_schedule(report, "equal steps of %.6g", shortest);
  else if (classes > 0)
    dvi__say_schedule(report, "%d classes of steps, powers of 2 from %.6g to %.6g", classes,
                      shortest, longest);
  else if (report->period > 0)
    dvi__say_schedule(report, "free steps from %.6g to %.6g with the common period %.6g", shortest,
                      longest, report->period);
  else
    dvi__say_schedule(report, "free steps from %.6g to %.6g without a common period", shortest,
                      longest);
}

/* ---- the choice ---- */

static double default_span(const dvi__schedule *s)
{
  double rate = 0;
  for (int64_t i = 0; i < s->count; i++) rate += 1 / s->step[i];
  return fmin(fmax(s->events / rate, 256 * s->longest), 16384 * s->longest);
}

dvi_status dvi__find_growth(const dvi__flow *flow, const dvi__schedule *schedule, double span,
                            dvi_stability *report)
{
  if (report->period > 0 && flow->n <= ALL_MODES_MOST && !flow->has_memory)
    return dvi__all_multipliers(flow, report->period, report);
  if (!(span > 0)) span = default_span(schedule);
  if (report->period > 0) return dvi__largest_multipliers(flow, report->period, span, report);
  return follow(flow, span, report);
}
