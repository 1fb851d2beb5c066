/* The choice of how to find the growth. */
#include "field/step/growth.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
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

/* ---- fields to begin with ---- */

static double random_between(uint64_t number)
{
  uint32_t x[4] = {(uint32_t)number, (uint32_t)(number >> 32), 0, 0};
  dvi__philox(x, 1);
  return ldexp((double)x[0], -31) - 1;
}

/* Add d^T h to a vector of the edges. */
static void add_transposed(const dvi__flow *flow, const double *h, double *x)
{
  for (int64_t i = 0; i < flow->faces * flow->width; i++) {
    const int code = flow->facet[i], e = dvi__flow_number(code);
    if (e < flow->n) x[e] += code < 0 ? -h[i / flow->width] : h[i / flow->width];
  }
}

/* D = d^T h and A = M1^-1 d^T h with random h are M1-orthogonal to all fields of zero curl. */
void dvi__scatter(const dvi__flow *flow)
{
  double *const parts[] = {flow->A, flow->D}, *h = flow->work;
  double energy = 0;
  for (int k = 0; k < 2; k++) {
    memset(parts[k], 0, (size_t)flow->n * sizeof(double));
    for (int64_t f = 0; f < flow->faces; f++)
      h[f] = sqrt(flow->M2[f]) * random_between((uint64_t)(2 * f + k));
    add_transposed(flow, h, parts[k]);
  }
  const double per_A = 0.5 * flow->bound;
  for (int64_t e = 0; e < flow->n; e++) {
    energy += flow->D[e] * flow->D[e] * flow->inverse[e];
    flow->A[e] *= flow->inverse[e] * per_A;
  }
  for (int64_t f = 0; f < flow->faces; f++) {
    const double B = dvi__flow_field(flow, f);
    energy += B * B * flow->M2[f];
  }
  for (int64_t e = 0; e < flow->n; e++) {
    flow->A[e] /= sqrt(energy);
    flow->D[e] /= sqrt(energy);
  }
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
  dvi__scatter(flow);
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
  if (report->period > 0 && flow->n <= ALL_MODES_MOST)
    return dvi__all_multipliers(flow, report->period, report);
  if (!(span > 0)) span = default_span(schedule);
  if (report->period > 0) return dvi__largest_multipliers(flow, report->period, span, report);
  return follow(flow, span, report);
}
