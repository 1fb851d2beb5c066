/* Spectral lines of sums that are known, without noise. */
#include <dvi/spectrum.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/suite.h"
#include "support/waves/damped.h"

enum { MOST = 64, SAMPLES = 300 };

static const double pi = 3.14159265358979323846;

/* What dvi_spectrum found. */
typedef struct found {
  int count;
  dvi_spectral_line line[MOST];
  double amplitude[2 * MOST], phase[2 * MOST];
  dvi_spectrum_report report;
} found;

static void find(int64_t samples, int probes, const double *y, double interval,
                 const dvi_spectrum_options *options, found *f)
{
  const dvi_status status = dvi_spectrum(samples, probes, y, interval, options, MOST, &f->count,
                                         f->line, f->amplitude, f->phase, &f->report);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
}

/* Every line is found, and no other. The decay and the amplitude have the line's own conditioning,
 * 1/T and 1. */
static void check_lines(int count, const damped *line, const found *f, double tolerance)
{
  ck_assert_int_eq(f->count, count);
  for (int k = 0; k < count; k++) {
    ck_assert_double_eq_tol(f->line[k].frequency, line[k].frequency, tolerance);
    ck_assert_double_eq_tol(f->line[k].decay, line[k].decay, tolerance);
    ck_assert_double_eq_tol(f->line[k].amplitude, line[k].amplitude, tolerance);
    ck_assert_double_eq_tol(f->amplitude[k], line[k].amplitude, tolerance);
    ck_assert_double_eq_tol(f->phase[k], line[k].phase, tolerance);
  }
}

static const damped five[] = {{0.3, 0.001, 1, 0.5},
                              {0.7, 0.02, 0.5, -2},
                              {1.1, 0, 2, 3},
                              {1.9, 0.05, 0.1, 0},
                              {2.8, 0.004, 0.01, 1}};

/* Roundoff is 1e-16 of the largest amplitude, and is divided by the smallest, 0.01. The goal is
 * 1e-12. */
START_TEST(a_sum_of_damped_oscillations_is_taken_apart)
{
  double y[SAMPLES];
  found f;
  damped_sum(5, five, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, NULL, &f);
  check_lines(5, five, &f, 1e-12);
  ck_assert_int_eq(f.report.lines, 5);
  ck_assert_int_eq(f.report.exponentials, 10);
  ck_assert_int_eq(f.report.room, SAMPLES / 2);
  ck_assert_int_eq(f.report.parts, 1);
  ck_assert_double_lt(f.report.residual, 1e-13);
}
END_TEST

START_TEST(the_interval_is_the_unit_of_time)
{
  double y[SAMPLES];
  damped line[5];
  found f;
  for (int k = 0; k < 5; k++)
    line[k] = (damped){five[k].frequency * 50, five[k].decay * 50, five[k].amplitude,
                       five[k].phase};
  damped_sum(5, line, 0.02, SAMPLES, y);
  find(SAMPLES, 1, y, 0.02, NULL, &f);
  check_lines(5, line, &f, 5e-11);
}
END_TEST

/* Scaling is by powers of two, which changes no bit. */
START_TEST(units_change_no_bit)
{
  double y[SAMPLES], scaled[SAMPLES];
  found f, g;
  damped_sum(5, five, 1, SAMPLES, y);
  for (int i = 0; i < SAMPLES; i++) scaled[i] = ldexp(y[i], _i);
  find(SAMPLES, 1, y, 1, NULL, &f);
  find(SAMPLES, 1, scaled, 1, NULL, &g);
  ck_assert_int_eq(g.count, f.count);
  for (int k = 0; k < f.count; k++) {
    ck_assert_double_eq(g.line[k].frequency, f.line[k].frequency);
    ck_assert_double_eq(g.line[k].amplitude, ldexp(f.line[k].amplitude, _i));
  }
}
END_TEST

/* The spectrum of a Fourier transform would show one line, of width 2 pi/T. Roundoff in y moves the
 * frequencies of a pair at the distance d by 1/(d T)^2 times more than those of single lines. */
START_TEST(a_pair_much_closer_than_a_transform_tells_is_two_lines)
{
  static const double parts[] = {0.5, 0.1, 0.01}, tolerance[] = {1e-14, 1e-13, 2e-11};
  const double distance = parts[_i] * 2 * pi / SAMPLES;
  const damped pair[] = {{1, 0, 1, 0.3}, {1 + distance, 0.001, 0.7, -1}};
  double y[SAMPLES];
  found f;
  damped_sum(2, pair, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, NULL, &f);
  ck_assert_int_eq(f.count, 2);
  for (int k = 0; k < 2; k++) {
    ck_assert_double_eq_tol(f.line[k].frequency, pair[k].frequency, tolerance[_i]);
    ck_assert_double_eq_tol(f.line[k].decay, pair[k].decay, tolerance[_i]);
    ck_assert_double_le(fabs(f.line[k].frequency - pair[k].frequency), 4 * f.line[k].error);
  }
}
END_TEST

/* An exponential and a constant have the frequency 0, alternating signs the highest one. A negative
 * amplitude is a phase of pi. */
START_TEST(real_exponentials_have_the_frequency_zero_or_the_highest)
{
  const damped line[] = {{0, 0, 3, 0}, {0, 0.05, 2, pi}, {1, 0, 1, 0.1}};
  double y[SAMPLES];
  found f;
  damped_sum(3, line, 1, SAMPLES, y);
  for (int i = 0; i < SAMPLES; i++) y[i] += (i % 2 == 0 ? 0.5 : -0.5) * exp(-0.01 * i);
  find(SAMPLES, 1, y, 1, NULL, &f);
  ck_assert_int_eq(f.count, 4);
  const int constant = f.line[0].decay < 0.025 ? 0 : 1;
  for (int k = 0; k < 2; k++) {
    ck_assert_double_eq(f.line[k].frequency, 0);
    ck_assert_double_eq(f.line[k].quality, 0);
  }
  ck_assert_double_eq_tol(f.line[constant].decay, 0, 1e-13);
  ck_assert_double_eq_tol(f.amplitude[constant], 3, 1e-12);
  ck_assert_double_eq(f.phase[constant], 0);
  ck_assert_double_eq_tol(f.line[!constant].decay, 0.05, 1e-13);
  ck_assert_double_eq_tol(f.amplitude[!constant], 2, 1e-12);
  ck_assert_double_eq(f.phase[!constant], pi);
  ck_assert_double_eq(f.line[3].frequency, pi);
  ck_assert_double_eq_tol(f.line[3].decay, 0.01, 1e-13);
  ck_assert_double_eq_tol(f.line[3].amplitude, 0.5, 1e-12);
}
END_TEST

START_TEST(a_growing_line_has_a_negative_decay_and_quality)
{
  const damped line[] = {{0.9, -0.03, 1e-3, 1}, {1.7, 0.01, 1, 0}};
  double y[SAMPLES];
  found f;
  damped_sum(2, line, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, NULL, &f);
  check_lines(2, line, &f, 1e-12);
  ck_assert_double_eq_tol(f.line[0].quality, -15, 1e-9);
  ck_assert_double_eq_tol(f.line[1].quality, 85, 1e-9);
}
END_TEST

/* A mode that one probe cannot see, because it stands at a node, is found by the other one. */
START_TEST(probes_share_their_lines)
{
  const damped first[] = {{0.5, 0.01, 1, 0}, {1.2, 0, 0, 0}, {2, 0.02, 0.2, 1}},
               second[] = {{0.5, 0.01, 0, 0}, {1.2, 0, 0.3, 2}, {2, 0.02, 0.7, -1}};
  double y[2 * SAMPLES];
  found f;
  damped_sum(3, first, 1, SAMPLES, y);
  damped_sum(3, second, 1, SAMPLES, y + SAMPLES);
  find(SAMPLES, 2, y, 1, NULL, &f);
  ck_assert_int_eq(f.count, 3);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_eq_tol(f.line[k].frequency, first[k].frequency, 1e-13);
    ck_assert_double_eq_tol(f.line[k].decay, first[k].decay, 1e-13);
    ck_assert_double_eq_tol(f.amplitude[2 * k], first[k].amplitude, 1e-12);
    ck_assert_double_eq_tol(f.amplitude[2 * k + 1], second[k].amplitude, 1e-12);
    ck_assert_double_eq(f.line[k].amplitude, fmax(f.amplitude[2 * k], f.amplitude[2 * k + 1]));
  }
  ck_assert_double_eq_tol(f.phase[5], -1, 1e-12);
}
END_TEST

/* 60 samples have room for 30 exponentials, of which a fifth tell the noise: 12 lines. Two series
 * have room for 40, and tell 16. */
START_TEST(two_probes_tell_more_lines_than_one)
{
  enum { FEW = 60, LINES = 15 };
  damped line[LINES];
  double y[2 * FEW];
  found f;
  for (int p = 0; p < 2; p++) {
    for (int k = 0; k < LINES; k++)
      line[k] = (damped){pi * (k + 0.5) / LINES, 0, 1 + 0.5 * sin(k + p), cos(3 * k + 5 * p)};
    damped_sum(LINES, line, 1, FEW, y + p * FEW);
  }
  find(FEW, 1, y, 1, NULL, &f);
  ck_assert_int_lt(f.count, LINES);
  find(FEW, 2, y, 1, NULL, &f);
  ck_assert_int_eq(f.count, LINES);
  for (int k = 0; k < LINES; k++)
    ck_assert_double_eq_tol(f.line[k].frequency, line[k].frequency, 1e-12);
}
END_TEST

START_TEST(the_strongest_lines_are_given_in_ascending_order)
{
  double y[SAMPLES];
  found f;
  dvi_spectral_line line[2];
  double amplitude[2], phase[2];
  int count = 0;
  damped_sum(5, five, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, NULL, &f);
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, 1, NULL, 2, &count, line, amplitude, phase, NULL),
                   DVI_OK);
  ck_assert_int_eq(count, 2);
  ck_assert_double_eq(line[0].frequency, f.line[0].frequency);
  ck_assert_double_eq(line[1].frequency, f.line[2].frequency);
  ck_assert_double_eq(phase[1], f.phase[2]);
}
END_TEST

START_TEST(a_band_has_its_own_lines_alone)
{
  const dvi_spectrum_options band = {.size = sizeof band, .lowest = 0.69, .highest = 2};
  double y[SAMPLES];
  found f;
  damped_sum(5, five, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, &band, &f);
  check_lines(3, five + 1, &f, 1e-12);
}
END_TEST

START_TEST(a_band_without_lines_has_none)
{
  const dvi_spectrum_options band = {.size = sizeof band, .lowest = 2, .highest = 2.5};
  double y[SAMPLES];
  found f = {.count = 9};
  damped_sum(5, five, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, &band, &f);
  ck_assert_int_eq(f.count, 0);
}
END_TEST

/* A tolerance leaves out what is weaker. */
START_TEST(lines_below_the_tolerance_are_left_out)
{
  const dvi_spectrum_options rough = {.size = sizeof rough, .tolerance = 0.01};
  double y[SAMPLES];
  found f;
  damped_sum(5, five, 1, SAMPLES, y);
  find(SAMPLES, 1, y, 1, &rough, &f);
  ck_assert_int_eq(f.count, 3);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_eq_tol(f.line[k].frequency, five[k].frequency, 1e-3);
    ck_assert_double_le(fabs(f.line[k].frequency - five[k].frequency), 4 * f.line[k].error);
  }
}
END_TEST

/* One exponential less than there is room for tells that there is no noise. */
START_TEST(six_samples_tell_one_line)
{
  const damped line = {1, 0.1, 2, 0.5};
  double y[6];
  found f;
  damped_sum(1, &line, 1, 6, y);
  find(6, 1, y, 1, NULL, &f);
  check_lines(1, &line, &f, 1e-14);
}
END_TEST

/* An impulse is no exponential, wherever it is. */
START_TEST(an_impulse_is_no_line)
{
  const int places[] = {0, 1, SAMPLES / 2, SAMPLES - 1};
  double y[SAMPLES] = {0};
  found f = {.count = 9};
  y[places[_i]] = 1;
  find(SAMPLES, 1, y, 1, NULL, &f);
  ck_assert_int_eq(f.count, 0);
}
END_TEST

/* t is no sum of exponentials, but the limit of one. */
START_TEST(a_ramp_has_finite_numbers)
{
  double y[SAMPLES];
  found f;
  for (int i = 0; i < SAMPLES; i++) y[i] = i * (i - 7.0);
  find(SAMPLES, 1, y, 1, NULL, &f);
  ck_assert_int_ge(f.count, 1);
  ck_assert_double_lt(f.report.residual, 1e-6);
  for (int k = 0; k < f.count; k++) {
    ck_assert_double_lt(f.line[k].frequency, 0.1);
    ck_assert(isfinite(f.line[k].decay) && isfinite(f.line[k].error));
    ck_assert(isfinite(f.line[k].quality) && isfinite(f.amplitude[k]) && isfinite(f.phase[k]));
  }
}
END_TEST

/* ---- refusals ---- */

static void check_refused(dvi_status expected, const char *words, int64_t samples, const double *y,
                          double interval, const dvi_spectrum_options *options, int most)
{
  dvi_spectral_line line[MOST], before[MOST];
  int count = -7;
  memset(line, 1, sizeof line);
  memcpy(before, line, sizeof line);
  ck_assert_int_eq(
      dvi_spectrum(samples, 1, y, interval, options, most, &count, line, NULL, NULL, NULL),
      expected);
  check_words(words);
  ck_assert_int_eq(count, -7);
  ck_assert_mem_eq(line, before, sizeof line);
}

START_TEST(what_has_no_spectrum_is_refused_with_a_sentence)
{
  const dvi_spectrum_options unsized = {.lowest = 1},
                             negative = {.size = sizeof negative, .lowest = -1},
                             inverted = {.size = sizeof inverted, .lowest = 2, .highest = 1},
                             beyond = {.size = sizeof beyond, .highest = 4},
                             rough = {.size = sizeof rough, .tolerance = 1};
  double y[SAMPLES], constant[SAMPLES];
  damped_sum(5, five, 1, SAMPLES, y);
  for (int i = 0; i < SAMPLES; i++) constant[i] = 0.1;
  check_refused(DVI_BAD_SIZE, "5 samples are too few", 5, y, 1, NULL, MOST);
  check_refused(DVI_BAD_SIZE, "room for 0 lines", SAMPLES, y, 1, NULL, 0);
  check_refused(DVI_BAD_ARGUMENT, "constant, 0.1", SAMPLES, constant, 1, NULL, MOST);
  check_refused(DVI_BAD_ARGUMENT, "interval between samples is 0", SAMPLES, y, 0, NULL, MOST);
  check_refused(DVI_BAD_ARGUMENT, "interval between samples is -1", SAMPLES, y, -1, NULL, MOST);
  check_refused(DVI_BAD_ARGUMENT, "options.size", SAMPLES, y, 1, &unsized, MOST);
  check_refused(DVI_BAD_ARGUMENT, "no band from -1", SAMPLES, y, 1, &negative, MOST);
  check_refused(DVI_BAD_ARGUMENT, "no band from 2 to 1", SAMPLES, y, 1, &inverted, MOST);
  check_refused(DVI_BAD_ARGUMENT, "0 to 3.14159", SAMPLES, y, 1, &beyond, MOST);
  check_refused(DVI_BAD_ARGUMENT, "tolerance is 1", SAMPLES, y, 1, &rough, MOST);
  check_refused(DVI_BAD_ARGUMENT, "a series", SAMPLES, NULL, 1, NULL, MOST);
  y[17] = (double)NAN;
  check_refused(DVI_NOT_FINITE, "sample 17", SAMPLES, y, 1, NULL, MOST);
}
END_TEST

START_TEST(lacking_memory_is_a_status)
{
  enum { FEW = 40 };
  double y[FEW];
  found f = {.count = 0};
  dvi_status status = DVI_NO_MEMORY;
  long successes = 0;
  damped_sum(2, five, 1, FEW, y);
  for (; status == DVI_NO_MEMORY && successes < 100; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_spectrum(FEW, 1, y, 1, NULL, MOST, &f.count, f.line, NULL, NULL, NULL);
    dvi__fail_allocations_after(-1);
    if (status != DVI_OK) ck_assert_int_eq(f.count, 0);
  }
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_ge(successes, 20);
  ck_assert_int_eq(f.count, 2);
}
END_TEST

SUITE(spectrum)
{
  tcase_add_test(tests, a_sum_of_damped_oscillations_is_taken_apart);
  tcase_add_test(tests, the_interval_is_the_unit_of_time);
  tcase_add_loop_test(tests, units_change_no_bit, -1, 2);
  tcase_add_loop_test(tests, a_pair_much_closer_than_a_transform_tells_is_two_lines, 0, 3);
  tcase_add_test(tests, real_exponentials_have_the_frequency_zero_or_the_highest);
  tcase_add_test(tests, a_growing_line_has_a_negative_decay_and_quality);
  tcase_add_test(tests, probes_share_their_lines);
  tcase_add_test(tests, two_probes_tell_more_lines_than_one);
  tcase_add_test(tests, the_strongest_lines_are_given_in_ascending_order);
  tcase_add_test(tests, a_band_has_its_own_lines_alone);
  tcase_add_test(tests, a_band_without_lines_has_none);
  tcase_add_test(tests, lines_below_the_tolerance_are_left_out);
  tcase_add_test(tests, six_samples_tell_one_line);
  tcase_add_loop_test(tests, an_impulse_is_no_line, 0, 4);
  tcase_add_test(tests, a_ramp_has_finite_numbers);
  tcase_add_test(tests, what_has_no_spectrum_is_refused_with_a_sentence);
  tcase_add_test(tests, lacking_memory_is_a_status);
}
