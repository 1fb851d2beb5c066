/* The choice of how to find the growth, and the common period of a schedule. */
#include "field/avi/monodromy.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <dvi/number.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/philox.h"

enum { DENOMINATOR_MOST = 64, PERIOD_MOST = 1000, ALL_MODES_MOST = 500 };

/* Events that a search may cost, unless the user asks for a span. */
static const double events_wanted = 5e7;

dvi_status dvi__avi_carry(dvi__avi *avi, double t)
{
  const double limit = t * (1 + 4 * DBL_EPSILON);
  dvi__avi_rewind(avi, 0);
  return (avi->is_queued ? dvi__avi_run_queue : dvi__avi_run_slots)(avi, limit);
}

dvi_status dvi__avi_check_size(double size, double time)
{
  if (isfinite(size)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE,
                   "stability: a field grows beyond all numbers within %g, so that its growth is "
                   "not told; take a shorter span, or shorter steps",
                   time);
}

/* ---- the common period ---- */

static int64_t greatest_divisor(int64_t a, int64_t b)
{
  while (b != 0) {
    const int64_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/* The common multiple of the steps in units of shortest/q, or 0 if one is no multiple of the unit,
 * or if it is too long. */
static int64_t common_multiple(const dvi__avi *avi, int q)
{
  const double most = PERIOD_MOST * avi->longest / avi->shortest * q;
  int64_t multiple = 1, last = 0;
  for (int64_t f = 0; f < avi->active_faces; f++) {
    const double units = avi->step[f] / avi->shortest * q;
    if (fabs(units - rint(units)) > 1e-10 * units) return 0;
    const int64_t p = (int64_t)rint(units);
    if (p == last) continue;
    last = p;
    multiple = multiple / greatest_divisor(multiple, p) * p;
    if ((double)multiple > most) return 0;
  }
  return multiple;
}

static double common_period(const dvi__avi *avi)
{
  if (!avi->is_queued) return avi->longest;
  if (avi->longest > 1e6 * avi->shortest) return 0;
  for (int q = 1; q <= DENOMINATOR_MOST; q++) {
    const int64_t multiple = common_multiple(avi, q);
    if (multiple > 0) return (double)multiple * avi->shortest / q;
  }
  return 0;
}

/* ---- fields to begin with ---- */

static double random_between(uint64_t number)
{
  uint32_t x[4] = {(uint32_t)number, (uint32_t)(number >> 32), 0, 0};
  dvi__philox(x, 1);
  return ldexp((double)x[0], -31) - 1;
}

/* Add d^T h to a vector of the edges. */
static void add_transposed(const dvi__avi *avi, const double *h, double *x)
{
  for (int64_t i = 0; i < avi->active_faces * avi->width; i++) {
    const int code = avi->facet[i], e = dvi__avi_number(code);
    if (e < avi->free_edges) x[e] += code < 0 ? -h[i / avi->width] : h[i / avi->width];
  }
}

/* D = d^T h and A = M1^-1 d^T h with random h are M1-orthogonal to all fields of zero curl. */
void dvi__avi_scatter(dvi__avi *avi, double *h)
{
  double *const parts[] = {avi->A, avi->D};
  double energy = 0;
  for (int k = 0; k < 2; k++) {
    memset(parts[k], 0, (size_t)avi->edges * sizeof(double));
    for (int64_t f = 0; f < avi->active_faces; f++)
      h[f] = sqrt(avi->M2[f]) * random_between((uint64_t)(2 * f + k));
    add_transposed(avi, h, parts[k]);
  }
  const double per_A = 0.5 * avi->bound;
  for (int64_t e = 0; e < avi->free_edges; e++) {
    energy += avi->D[e] * avi->D[e] * avi->inverse[e];
    avi->A[e] *= avi->inverse[e] * per_A;
  }
  for (int64_t f = 0; f < avi->active_faces; f++) {
    const double B = dvi__avi_field(avi, f, avi->A);
    energy += B * B * avi->M2[f];
  }
  for (int64_t e = 0; e < avi->free_edges; e++) {
    avi->A[e] /= sqrt(energy);
    avi->D[e] /= sqrt(energy);
  }
}

/* ---- without a period ---- */

enum { SEGMENTS = 64 };

/* Logarithms of the amplitude beyond which nothing new is seen: what has fallen so far consists of
 * roundings, and no part of it grew. */
static const double faint = -20, large = 80;

/* The growth is that of the second half of the way, on which the fastest field has come forth. */
dvi_status dvi__avi_follow(dvi__avi *avi, double span, dvi_stability *report)
{
  double size[SEGMENTS + 1], energy;
  int last = 0;
  dvi__avi_scatter(avi, avi->impulse);
  dvi__avi_rewind(avi, 0);
  avi->start_energy = 1;
  DVI_TRY(dvi__avi_energy(avi, &energy, NULL));
  size[0] = 0.5 * log(energy);
  while (last < SEGMENTS && size[last] < large && size[last] > faint) {
    avi->t = span * (last + 1) / SEGMENTS;
    DVI_TRY(dvi__avi_run_queue(avi, avi->t));
    DVI_TRY(dvi__avi_energy(avi, &energy, NULL));
    DVI_TRY(dvi__avi_check_size(energy, span / SEGMENTS));
    size[++last] = 0.5 * log(energy);
  }
  const int half = last / 2;
  const double time = span / SEGMENTS;
  report->growth = exp(fmax(size[last] - size[half], 0) / (time * (last - half)));
  report->span = time * last;
  report->followed = 1;
  report->resolution = 0.5 * log(2.0 * (double)avi->free_edges) / report->span;
  return DVI_OK;
}

/* ---- the report ---- */

static double default_span(const dvi__avi *avi)
{
  double rate = 0;
  for (int64_t f = 0; f < avi->active_faces; f++) rate += 1 / avi->step[f];
  return fmin(fmax(events_wanted / rate, 256 * avi->longest), 16384 * avi->longest);
}

static void say(dvi_stability *report, const char *format, ...) DVI_PRINTF(2, 3);
static void say(dvi_stability *report, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(report->schedule, DVI_SCHEDULE_SIZE, format, arguments);
  va_end(arguments);
}

static void describe(const dvi__avi *avi, dvi_stability *report)
{
  const double from = avi->shortest, to = avi->longest;
  if (from == to)
    say(report, "equal steps of %.6g", from);
  else if (!avi->is_queued)
    say(report, "%d classes of steps, powers of 2 from %.6g to %.6g", avi->classes, from, to);
  else if (report->period > 0)
    say(report, "free steps from %.6g to %.6g with the common period %.6g", from, to,
        report->period);
  else
    say(report, "free steps from %.6g to %.6g without a common period", from, to);
}

static dvi_status find_growth(dvi__avi *avi, double span, dvi_stability *report)
{
  report->period = common_period(avi);
  if (report->period > 0 && avi->free_edges <= ALL_MODES_MOST)
    return dvi__avi_all_multipliers(avi, report->period, report);
  if (!(span > 0)) span = default_span(avi);
  if (report->period > 0) return dvi__avi_largest_multipliers(avi, report->period, span, report);
  return dvi__avi_follow(avi, span, report);
}

dvi_status dvi__avi_stability(const dvi__avi_terms *terms, double span, dvi_stability *report)
{
  dvi__avi *avi;
  dvi_stability found = {0};
  dvi__avi_terms bare = *terms;
  bare.current = NULL;
  bare.currents = 0;
  DVI_TRY(dvi__avi_create(&bare, &avi));
  const dvi_status status = find_growth(avi, span, &found);
  if (status == DVI_OK) {
    found.is_stable = found.growth <= 1 + found.resolution;
    describe(avi, &found);
    *report = found;
  }
  dvi__avi_destroy(&avi);
  return status;
}
