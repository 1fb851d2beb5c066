/* Spectral lines of series, part of the band by part.
 *
 * A short series is one part. A long one is filtered and decimated, with a stride D, around the
 * middles of parts whose width is at most pi/D. The poles beyond the ends of a part are known, too,
 * as far as the filter passes. The border to the next part is moved into the widest gap between
 * them, so that no line is found twice or is lost to a rounding. */
#include <dvi/spectrum.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/spectra/complex_number.h"
#include "field/spectra/filter.h"
#include "field/spectra/fit.h"
#include "field/spectra/pencil.h"

/* The samples of a part, about, and those that are one part. */
enum { PART = 512, WHOLE = 1023, LEAST = 6 };

static const double pi = 3.14159265358979323846;

/* Angles are radians a sample, and amplitudes are those of the scaled series. */
typedef struct spectrum {
  int64_t samples;
  int probes, parts, capacity, lines;
  const double *series;
  double scale, size; /* a power of two, and the root of the mean square after it */
  double tolerance, lowest, highest, border;
  dvi__filter filter;
  dvi__exponentials part;
  double complex *z, *c; /* of a part: [poles], [poles*probes] */
  double *error, *room;
  int poles;
  dvi_spectral_line *line;   /* [capacity] */
  double complex *amplitude; /* [capacity*probes] A exp(i phi) */
  double left;               /* sum of the mean squares that the parts leave */
  int exponentials;
} spectrum;

/* ---- arguments ---- */

static dvi_status check_options(const dvi_spectrum_options *o, double interval)
{
  if (o->size != sizeof *o)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "spectrum: set options.size to sizeof(dvi_spectrum_options)");
  if (!(interval > 0 && isfinite(interval)))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "spectrum: the interval between samples is %g, and has to be positive",
                     interval);
  if (!(o->tolerance >= 0 && o->tolerance < 1))
    return dvi__fail(DVI_BAD_ARGUMENT, "spectrum: the tolerance is %g: take a number below 1",
                     o->tolerance);
  const double most = pi / interval, highest = o->highest != 0 ? o->highest : most;
  if (o->lowest >= 0 && o->lowest < highest && highest <= most * (1 + 4 * DBL_EPSILON))
    return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "spectrum: there is no band from %g to %g: samples that are %g apart tell "
                   "frequencies from 0 to %g",
                   o->lowest, highest, interval, most);
}

static dvi_status check_series(int64_t samples, int probes, const double *series)
{
  int varies = 0;
  if (samples < LEAST)
    return dvi__fail(DVI_BAD_SIZE, "spectrum: %lld samples are too few: %d tell one line",
                     (long long)samples, (int)LEAST);
  for (int p = 0; p < probes; p++)
    for (int64_t i = 0; i < samples; i++) {
      const double y = series[p * samples + i];
      if (!isfinite(y))
        return dvi__fail(DVI_NOT_FINITE, "spectrum: sample %lld of series %d is %g", (long long)i,
                         p, y);
      varies |= y != series[p * samples];
    }
  if (varies) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT, "spectrum: the %lld samples of %s constant, %g, and have no frequency",
      (long long)samples, probes == 1 ? "the series are" : "all series are", series[0]);
}

/* ---- memory ---- */

/* Scale by a power of two, which changes no digit. */
static void measure(spectrum *s)
{
  const int64_t count = s->samples * s->probes;
  double most = 0, sum = 0;
  int exponent;
  for (int64_t i = 0; i < count; i++) most = fmax(most, fabs(s->series[i]));
  (void)frexp(most, &exponent);
  s->scale = ldexp(1, exponent > -1000 ? -exponent : 1000);
  for (int64_t i = 0; i < count; i++) sum += pow(s->scale * s->series[i], 2);
  s->size = sqrt(sum / (double)count);
}

static dvi_status spectrum_create(spectrum *s)
{
  const int64_t stride = s->samples > WHOLE ? s->samples / PART : 1;
  measure(s);
  DVI_TRY(dvi__filter_create(stride, 0.01 * s->tolerance, &s->filter));
  const int64_t length = dvi__filter_length(&s->filter, s->samples);
  const double parts = ceil((s->highest - s->lowest) / (pi / (double)stride) * (1 - 1e-12));
  s->parts = stride > 1 ? (int)fmax(parts, 1) : 1;
  s->part = (dvi__exponentials){.length = (int)length, .probes = s->probes};
  const size_t most = (size_t)dvi__poles_most((int)length, s->probes), P = (size_t)s->probes;
  s->capacity = (int)most * s->parts;
  s->part.y = DVI_NEW(double complex, P *(size_t)length);
  s->z = DVI_NEW(double complex, most);
  s->c = DVI_NEW(double complex, most *P);
  s->error = DVI_NEW(double, most);
  s->room = DVI_NEW(double, 2 * s->filter.taps);
  s->line = DVI_NEW(dvi_spectral_line, s->capacity);
  s->amplitude = DVI_NEW(double complex, (size_t)s->capacity *P);
  if (s->part.y && s->z && s->c && s->error && s->room && s->line && s->amplitude) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "spectrum: no memory for %d parts of %lld samples", s->parts,
                   (long long)length);
}

static void spectrum_clear(spectrum *s)
{
  dvi__filter_clear(&s->filter);
  dvi__release(s->part.y);
  dvi__release(s->z);
  dvi__release(s->c);
  dvi__release(s->error);
  dvi__release(s->room);
  dvi__release(s->line);
  dvi__release(s->amplitude);
}

/* ---- parts ---- */

/* Replace the poles of a part by exponents s of the series, z^n = exp(s n), and their coefficients
 * by those before the filter. */
static void undo_filter(spectrum *s, double middle)
{
  const double stride = (double)s->filter.stride;
  for (int k = 0; k < s->poles; k++) {
    const double complex from_middle = clog(s->z[k]) / stride;
    const double complex gain = dvi__filter_gain(&s->filter, from_middle);
    s->z[k] = from_middle + dvi__complex(0, middle);
    s->error[k] /= stride;
    for (int p = 0; p < s->probes; p++) s->c[k * s->probes + p] /= gain;
  }
}

/* Poles of real series come in pairs. Tell whether one is nearest to its own conjugate, and
 * therefore real. */
static int is_real(const spectrum *s, int k)
{
  const double complex pole = cexp(s->z[k]);
  const double own = 2 * fabs(cimag(pole));
  if (own * (double)s->samples > pi * cabs(pole)) return 0;
  for (int j = 0; j < s->poles; j++)
    if (j != k && cabs(cexp(s->z[j]) - conj(pole)) < own) return 0;
  return 1;
}

static void add_line(spectrum *s, int k, double frequency, int real)
{
  double complex *A = s->amplitude + (size_t)s->lines * (size_t)s->probes;
  dvi_spectral_line *line = &s->line[s->lines++];
  *line = (dvi_spectral_line){
      .frequency = frequency, .decay = -creal(s->z[k]), .error = s->error[k]};
  for (int p = 0; p < s->probes; p++) {
    const double complex c = s->c[k * s->probes + p];
    A[p] = real ? creal(c) : 2 * c;
    line->amplitude = fmax(line->amplitude, cabs(A[p]));
  }
}

/* Move the border to the next part into the widest gap between poles near it. */
static double next_border(const spectrum *s, double nominal)
{
  const double margin = (DVI__PASSBAND - 0.5) * pi / (double)s->filter.stride,
               end = nominal + margin;
  double widest = 0, border = nominal;
  for (int k = -1; k < s->poles; k++) {
    const double from = k < 0 ? nominal - margin : cimag(s->z[k]);
    double to = end;
    if (from < nominal - margin || from > end) continue;
    for (int j = 0; j < s->poles; j++)
      if (cimag(s->z[j]) > from) to = fmin(to, cimag(s->z[j]));
    if (to - from <= widest) continue;
    widest = to - from;
    border = from + 0.5 * widest;
  }
  return border;
}

/* Add the lines of a part from the last border on. */
static void add_lines(spectrum *s, double nominal, int is_last)
{
  const double from = s->border;
  if (!is_last) s->border = next_border(s, nominal);
  for (int k = 0; k < s->poles; k++) {
    const int real = is_real(s, k);
    const double angle = cimag(s->z[k]), frequency = real ? (fabs(angle) < 1 ? 0 : pi) : angle;
    if (frequency >= from && (is_last ? frequency <= s->highest : frequency < s->border))
      add_line(s, k, frequency, real);
  }
}

static dvi_status solve_part(spectrum *s, int part)
{
  const double width = (s->highest - s->lowest) / s->parts,
               middle = s->filter.stride > 1 ? s->lowest + (part + 0.5) * width : 0,
               floor = s->tolerance * s->size * dvi__hankel_size(s->part.length, s->probes);
  double left;
  for (int p = 0; p < s->probes; p++)
    dvi__filter_apply(&s->filter, middle, s->scale, s->part.length, s->series + p * s->samples,
                      s->room, s->part.y + (size_t)p * (size_t)s->part.length);
  DVI_TRY(dvi__find_poles(&s->part, floor, &s->poles, s->z));
  DVI_TRY(dvi__fit_exponentials(&s->part, DBL_EPSILON * s->size, s->poles, s->z, s->c, s->error,
                                &left));
  s->left += left;
  s->exponentials = s->poles > s->exponentials ? s->poles : s->exponentials;
  undo_filter(s, middle);
  add_lines(s, s->lowest + (part + 1) * width, part + 1 == s->parts);
  return DVI_OK;
}

/* ---- lines ---- */

/* A line by what it is sorted by, ascending. */
typedef struct rank {
  double key;
  int line;
} rank;

static int compare_ranks(const void *first, const void *second)
{
  const rank *a = first, *b = second;
  if (a->key != b->key) return a->key < b->key ? -1 : 1;
  return a->line < b->line ? -1 : 1;
}

/* List the lines that are no noise beside the strongest one. Returns their number, of which the
 * strongest `most` are listed, ascending in frequency. */
static int list_lines(const spectrum *s, int most, rank *list)
{
  double strongest = 0;
  int count = 0;
  for (int k = 0; k < s->lines; k++) strongest = fmax(strongest, s->line[k].amplitude);
  for (int k = 0; k < s->lines; k++)
    if (s->line[k].amplitude > s->tolerance * strongest)
      list[count++] = (rank){-s->line[k].amplitude, k};
  qsort(list, (size_t)count, sizeof *list, compare_ranks);
  const int given = count < most ? count : most;
  for (int i = 0; i < given; i++) list[i].key = s->line[list[i].line].frequency;
  qsort(list, (size_t)given, sizeof *list, compare_ranks);
  return count;
}

static dvi_spectral_line line_in_units(const spectrum *s, dvi_spectral_line line, double interval)
{
  const double turn = 2 * line.decay;
  line.quality = line.frequency == 0 ? 0 : turn == 0 ? (double)INFINITY : line.frequency / turn;
  line.error = (line.error + DBL_EPSILON * line.frequency) / interval;
  line.frequency /= interval;
  line.decay /= interval;
  line.amplitude /= s->scale;
  return line;
}

static void give_report(const spectrum *s, int lines, dvi_spectrum_report *report)
{
  const double sides = s->filter.stride > 1 ? 2 : 1;
  *report = (dvi_spectrum_report){.lines = lines,
                                  .residual = sqrt(sides * s->left) / s->size,
                                  .parts = s->parts,
                                  .samples = s->part.length,
                                  .exponentials = s->exponentials,
                                  .room = dvi__poles_most(s->part.length, s->probes)};
}

static dvi_status give_lines(const spectrum *s, double interval, int most, int *count,
                             dvi_spectral_line *line, double *amplitude, double *phase,
                             dvi_spectrum_report *report)
{
  rank *list = DVI_NEW(rank, s->lines);
  if (list == NULL) return dvi__fail(DVI_NO_MEMORY, "spectrum: no memory for %d lines", s->lines);
  const int lines = list_lines(s, most, list);
  *count = lines < most ? lines : most;
  for (int i = 0; i < *count; i++) {
    const double complex *A = s->amplitude + (size_t)list[i].line * (size_t)s->probes;
    line[i] = line_in_units(s, s->line[list[i].line], interval);
    for (int p = 0; p < s->probes; p++) {
      if (amplitude != NULL) amplitude[i * s->probes + p] = cabs(A[p]) / s->scale;
      if (phase != NULL) phase[i * s->probes + p] = carg(A[p]);
    }
  }
  if (report != NULL) give_report(s, lines, report);
  dvi__release(list);
  return DVI_OK;
}

dvi_status dvi_spectrum(int64_t samples, int probes, const double *series, double interval,
                        const dvi_spectrum_options *options, int most, int *count,
                        dvi_spectral_line *line, double *amplitude, double *phase,
                        dvi_spectrum_report *report)
{
  const dvi_spectrum_options defaults = {.size = sizeof defaults};
  if (options == NULL) options = &defaults;
  if (series == NULL || count == NULL || line == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "spectrum: a series, and places for lines are needed");
  if (probes < 1 || most < 1)
    return dvi__fail(DVI_BAD_SIZE, "spectrum: %d series and room for %d lines: 1 at least", probes,
                     most);
  DVI_TRY(check_options(options, interval));
  DVI_TRY(check_series(samples, probes, series));
  spectrum s = {.samples = samples,
                .probes = probes,
                .series = series,
                .tolerance = options->tolerance != 0 ? options->tolerance : 1e-10,
                .lowest = options->lowest * interval,
                .highest = options->highest != 0 ? fmin(options->highest * interval, pi) : pi};
  s.border = s.lowest;
  dvi_status status = spectrum_create(&s);
  for (int part = 0; part < s.parts && status == DVI_OK; part++) status = solve_part(&s, part);
  if (status == DVI_OK)
    status = give_lines(&s, interval, most, count, line, amplitude, phase, report);
  spectrum_clear(&s);
  return status;
}
