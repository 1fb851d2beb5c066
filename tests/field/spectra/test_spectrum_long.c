/* Spectral lines of long series, which are solved part by part. */
#include <dvi/spectrum.h>
#include <math.h>
#include <stdlib.h>

#include "support/suite.h"
#include "support/waves/damped.h"

enum { MOST = 300 };

static const double pi = 3.14159265358979323846;

typedef struct found {
  int count;
  dvi_spectral_line line[MOST];
  double phase[MOST];
  dvi_spectrum_report report;
} found;

static void find(int lines, const damped *line, int64_t samples,
                 const dvi_spectrum_options *options, found *f)
{
  double *y = malloc((size_t)samples * sizeof *y);
  ck_assert_ptr_nonnull(y);
  damped_sum(lines, line, 1, samples, y);
  const dvi_status status = dvi_spectrum(samples, 1, y, 1, options, MOST, &f->count, f->line, NULL,
                                         f->phase, &f->report);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  free(y);
}

static void check_line(const found *f, int k, const damped *line, double tolerance)
{
  ck_assert_double_eq_tol(f->line[k].frequency, line->frequency, tolerance);
  ck_assert_double_eq_tol(f->line[k].decay, line->decay, tolerance);
  ck_assert_double_eq_tol(f->line[k].amplitude, line->amplitude, 1e3 * tolerance);
  ck_assert_double_eq_tol(f->phase[k], line->phase, 1e3 * tolerance);
}

/* The borders of the parts are at multiples of pi/parts, where lines stand, and others beside
 * them. */
START_TEST(lines_at_the_borders_of_parts_are_found_once)
{
  enum { PARTS = 9 };
  const int parts = is_short_run() ? 3 : PARTS, lines = 3 * parts - 3;
  damped line[3 * PARTS];
  found f;
  for (int k = 0; k < lines; k++) {
    const double beside[] = {-0.002, 0, 0.003};
    line[k] = (damped){pi * (1 + k / 3) / parts + beside[k % 3], 1e-5 * k, 1 + 0.1 * k, 0.1 * k};
  }
  find(lines, line, 550 * parts, NULL, &f);
  ck_assert_int_eq(f.report.parts, parts);
  ck_assert_int_eq(f.count, lines);
  for (int k = 0; k < lines; k++) check_line(&f, k, &line[k], 1e-13);
}
END_TEST

/* The first number of samples that is filtered. Its lines reach from the frequency 0 to the
 * highest. */
START_TEST(a_filter_changes_no_line)
{
  const damped line[] = {{0, 0.001, 2, 0},       {0.004, 0, 1, 0.5},     {0.8, 0.002, 1, 1},
                         {pi / 2, 0, 0.1, -1.5}, {1.6, 0.004, 0.5, 2.5}, {3.1, 0.001, 0.3, -0.5}};
  found f;
  find(6, line, 1023 + _i, NULL, &f);
  ck_assert_int_eq(f.report.parts, 1 + _i);
  ck_assert_int_eq(f.count, 6);
  for (int k = 0; k < 6; k++) check_line(&f, k, &line[k], 1e-12);
}
END_TEST

/* A hundred thousand samples make no large matrix: one part of the band has 473 of its own. The
 * pair is a fifth of 2 pi/T apart. */
START_TEST(a_narrow_band_of_a_long_series_is_one_part)
{
  enum { SAMPLES = 100000 };
  const damped line[] = {
      {0.2, 0, 1, 0}, {1, 1e-6, 1, 0.4}, {1 + 1.2e-5, 2e-6, 0.5, -1}, {2, 0, 5, 0}, {3, 0, 100, 0}};
  const dvi_spectrum_options band = {.size = sizeof band, .lowest = 0.995, .highest = 1.005};
  found f;
  find(5, line, SAMPLES, &band, &f);
  ck_assert_int_eq(f.report.parts, 1);
  ck_assert_int_lt(f.report.samples, 600);
  ck_assert_int_eq(f.count, 2);
  for (int k = 0; k < 2; k++) check_line(&f, k, &line[1 + k], 1e-12);
}
END_TEST

/* What is aliased into the band is below a hundredth of the tolerance, so that a line a million
 * times weaker than one outside keeps six digits more than the tolerance has, less two. */
START_TEST(a_strong_line_outside_the_band_leaves_a_weak_one_inside_alone)
{
  const damped line[] = {{1, 0, 1e-6, 0.4}, {1.02, 0, 1, 1}, {2.5, 1e-3, 1, 2}};
  const dvi_spectrum_options band = {.size = sizeof band, .lowest = 0.99, .highest = 1.01};
  found f;
  find(3, line, 30000, &band, &f);
  ck_assert_int_eq(f.count, 1);
  ck_assert_double_eq_tol(f.line[0].frequency, 1, 1e-12);
  ck_assert_double_eq_tol(f.line[0].amplitude, 1e-6, 1e-12);
}
END_TEST

START_TEST(many_lines_of_a_long_series_are_all_found)
{
  enum { LINES = 200 };
  damped line[LINES];
  found f;
  const int64_t samples = is_short_run() ? 1600 : 8000;
  const int lines = is_short_run() ? 40 : LINES;
  for (int k = 0; k < lines; k++)
    line[k] = (damped){pi * (k + 0.5 + 0.3 * sin(7 * k)) / lines, 1e-4 * (1 + sin(3 * k)),
                       2 + cos(5 * k), sin(k)};
  find(lines, line, samples, NULL, &f);
  ck_assert_int_eq(f.count, lines);
  for (int k = 0; k < lines; k++) check_line(&f, k, &line[k], 1e-11);
}
END_TEST

START_TEST(the_noise_of_a_long_series_is_told_from_its_lines)
{
  enum { SAMPLES = 1600 };
  const damped line[] = {{0.5, 1e-4, 1, 0}, {1.5, 0, 0.2, 1}, {1.51, 1e-3, 0.5, 2}};
  double y[SAMPLES];
  found f;
  damped_sum(3, line, 1, SAMPLES, y);
  damped_add_noise(1e-3, 3, SAMPLES, y);
  ck_assert_int_eq(
      dvi_spectrum(SAMPLES, 1, y, 1, NULL, MOST, &f.count, f.line, NULL, f.phase, &f.report),
      DVI_OK);
  ck_assert_int_eq(f.count, 3);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_lt(fabs(f.line[k].frequency - line[k].frequency), 4 * f.line[k].error);
    ck_assert_double_lt(f.line[k].error, 1e-4);
  }
}
END_TEST

SUITE(spectrum_long)
{
  tcase_add_test(tests, lines_at_the_borders_of_parts_are_found_once);
  tcase_add_loop_test(tests, a_filter_changes_no_line, 0, 2);
  tcase_add_test(tests, a_narrow_band_of_a_long_series_is_one_part);
  tcase_add_test(tests, a_strong_line_outside_the_band_leaves_a_weak_one_inside_alone);
  tcase_add_test(tests, many_lines_of_a_long_series_are_all_found);
  tcase_add_test(tests, the_noise_of_a_long_series_is_told_from_its_lines);
}
