/* Spectral lines of series with noise, and their standard errors. */
#include <dvi/spectrum.h>
#include <math.h>

#include "support/suite.h"
#include "support/waves/damped.h"

enum { MOST = 64, SAMPLES = 300 };

static const damped three[] = {{0.4, 0.001, 1, 0.5}, {0.43, 0, 0.5, -2}, {2.1, 0.01, 0.3, 1}};

/* A series with noise, and what was found in it. */
static int find(double noise, int seed, const dvi_spectrum_options *options,
                dvi_spectral_line line[MOST], dvi_spectrum_report *report)
{
  double y[SAMPLES];
  int count = 0;
  damped_sum(3, three, 1, SAMPLES, y);
  damped_add_noise(noise, (uint64_t)seed + 1, SAMPLES, y);
  ck_assert_msg(dvi_spectrum(SAMPLES, 1, y, 1, options, MOST, &count, line, NULL, NULL, report) ==
                    DVI_OK,
                "%s", dvi_last_error());
  return count;
}

/* Each level of noise finds the three lines and no other, with errors that follow a normal
 * distribution of the standard errors that are given. Of 300 numbers one is beyond four of them in
 * 1 of 50 cases, and none is here. */
START_TEST(noise_hides_no_line_and_makes_none)
{
  static const double noise[] = {1e-8, 1e-6, 1e-4, 1e-2, 1e-1};
  for (int seed = 0; seed < repeats(10); seed++) {
    dvi_spectral_line line[MOST];
    dvi_spectrum_report report;
    ck_assert_int_eq(find(noise[_i], seed, NULL, line, &report), 3);
    for (int k = 0; k < 3; k++) {
      ck_assert_double_lt(fabs(line[k].frequency - three[k].frequency), 4 * line[k].error);
      ck_assert_double_lt(fabs(line[k].decay - three[k].decay), 4 * line[k].error);
    }
  }
}
END_TEST

/* The mean square of 600 errors beside the standard errors is 1 +- 0.06, and a little more because
 * the noise is an estimate. The matrix pencil without the fit after it has 1.4. */
START_TEST(errors_have_the_size_that_is_given)
{
  const int seeds = repeats(100);
  double sum = 0;
  for (int seed = 100; seed < 100 + seeds; seed++) {
    dvi_spectral_line line[MOST];
    dvi_spectrum_report report;
    ck_assert_int_eq(find(1e-3, seed, NULL, line, &report), 3);
    for (int k = 0; k < 3; k++) {
      const double frequency = (line[k].frequency - three[k].frequency) / line[k].error,
                   decay = (line[k].decay - three[k].decay) / line[k].error;
      sum += frequency * frequency + decay * decay;
    }
  }
  ck_assert_double_gt(sum / (6 * seeds), is_short_run() ? 0.5 : 0.85);
  ck_assert_double_lt(sum / (6 * seeds), is_short_run() ? 2 : 1.2);
}
END_TEST

/* No estimate from N samples can have a smaller standard error than sqrt(24/N^3) noise/A (Rife and
 * Boorstyn 1974, eq. 16, without decay sqrt(24); N^2 - 1 for N^2). A decay that is estimated, too,
 * does not change it, since it is orthogonal to the frequency. */
START_TEST(the_error_of_one_line_is_the_bound_of_cramer_and_rao)
{
  const damped one = {1.3, 0, 2, 0.7};
  const double noise = 1e-4, N = SAMPLES, bound = sqrt(24 / (N * (N * N - 1))) * noise / 2;
  double y[SAMPLES];
  dvi_spectral_line line[MOST];
  dvi_spectrum_report report;
  int count = 0;
  damped_sum(1, &one, 1, SAMPLES, y);
  damped_add_noise(noise, 5, SAMPLES, y);
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, 1, NULL, MOST, &count, line, NULL, NULL, &report),
                   DVI_OK);
  ck_assert_int_eq(count, 1);
  /* the noise is known from 300 samples to 4 per cent */
  ck_assert_double_eq_tol(line[0].error / bound, 1, 0.12);
  ck_assert_double_eq_tol(report.residual / (noise / sqrt(2)), 1, 0.12);
}
END_TEST

START_TEST(noise_alone_has_no_lines)
{
  double y[SAMPLES] = {0};
  dvi_spectral_line line[MOST];
  int count = 9;
  damped_add_noise(1, (uint64_t)_i, SAMPLES, y);
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, 1, NULL, MOST, &count, line, NULL, NULL, NULL),
                   DVI_OK);
  ck_assert_int_eq(count, 0);
}
END_TEST

/* 300 samples lift a line above noise of its own size: its singular value is A N/4, and those of
 * noise end near 1.6 sqrt(2 N) of its size. */
START_TEST(a_line_as_strong_as_the_noise_is_found)
{
  const damped one = {1.3, 0, 1.5, 0.7};
  double y[SAMPLES];
  dvi_spectral_line line[MOST];
  int count = 0;
  damped_sum(1, &one, 1, SAMPLES, y);
  damped_add_noise(1, (uint64_t)_i, SAMPLES, y);
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, 1, NULL, MOST, &count, line, NULL, NULL, NULL),
                   DVI_OK);
  ck_assert_int_eq(count, 1);
  ck_assert_double_lt(fabs(line[0].frequency - 1.3), 4 * line[0].error);
  ck_assert_double_lt(line[0].error, 2e-3);
}
END_TEST

/* Four series with noise of their own are as good as one with half of the noise. */
START_TEST(more_probes_make_errors_smaller)
{
  enum { PROBES = 4 };
  double y[PROBES * SAMPLES];
  dvi_spectral_line one[MOST], all[MOST];
  int count = 0;
  for (int p = 0; p < PROBES; p++) {
    damped_sum(3, three, 1, SAMPLES, y + p * SAMPLES);
    damped_add_noise(1e-3, (uint64_t)p + 11, SAMPLES, y + p * SAMPLES);
  }
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, 1, NULL, MOST, &count, one, NULL, NULL, NULL),
                   DVI_OK);
  ck_assert_int_eq(count, 3);
  ck_assert_int_eq(dvi_spectrum(SAMPLES, PROBES, y, 1, NULL, MOST, &count, all, NULL, NULL, NULL),
                   DVI_OK);
  ck_assert_int_eq(count, 3);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_eq_tol(all[k].error / one[k].error, 0.5, 0.06);
    ck_assert_double_lt(fabs(all[k].frequency - three[k].frequency), 4 * all[k].error);
  }
}
END_TEST

SUITE(spectrum_noise)
{
  tcase_add_loop_test(tests, noise_hides_no_line_and_makes_none, 0, 5);
  tcase_add_test(tests, errors_have_the_size_that_is_given);
  tcase_add_test(tests, the_error_of_one_line_is_the_bound_of_cramer_and_rao);
  tcase_add_loop_test(tests, noise_alone_has_no_lines, 1, 6);
  tcase_add_loop_test(tests, a_line_as_strong_as_the_noise_is_found, 1, 6);
  tcase_add_test(tests, more_probes_make_errors_smaller);
}
