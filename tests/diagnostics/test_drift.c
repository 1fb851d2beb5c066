#include <math.h>

#include <dvi/diagnostics.h>

#include "support/suite.h"

static const double two_pi = 6.283185307179586;

/* Uniform on [-1,1), from a generator that is the same everywhere. */
static double draw_noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / 8388608.0 - 1;
}

/* The record of value(t) at count times 10, 10 + dt, 10 + 2 dt, ... */
static dvi_drift_fit fit_record(long count, double dt,
                                double (*value)(double t, double T, unsigned *state), unsigned seed)
{
  dvi_drift drift;
  dvi_drift_fit fit;
  unsigned state = seed;
  dvi_drift_init(&drift);
  for (long i = 0; i < count; i++) {
    const double t = 10 + (double)i * dt;
    dvi_drift_add(&drift, t, value(t, (double)count * dt, &state));
  }
  dvi_drift_result(&drift, &fit);
  return fit;
}

static double constant(double t, double T, unsigned *state)
{
  (void)t, (void)T, (void)state;
  return -0.3;
}

static double line(double t, double T, unsigned *state)
{
  (void)T, (void)state;
  return 2 - 3e-7 * t;
}

static double slow_oscillation(double t, double T, unsigned *state)
{
  (void)state;
  return cos(two_pi * t / T);
}

static double fast_oscillation(double t, double T, unsigned *state)
{
  (void)T, (void)state;
  return 1e-3 * cos(1.7 * t) + 2e-3 * sin(0.37 * t);
}

static double drifting_oscillation(double t, double T, unsigned *state)
{
  return fast_oscillation(t, T, state) + 1e-7 * t;
}

static double white_noise(double t, double T, unsigned *state)
{
  (void)t, (void)T;
  return draw_noise(state);
}

START_TEST(a_constant_has_no_drift_and_no_nan)
{
  const dvi_drift_fit fit = fit_record(1000, 0.1, constant, 1);
  ck_assert(fit.largest == 0 && fit.slope == 0 && fit.change == 0 && fit.deviation == 0 &&
            fit.significance == 0);
}
END_TEST

START_TEST(a_line_gives_its_slope_whatever_the_number_of_samples)
{
  static const long counts[] = {2, 3, 8, 63, 64, 65, 127, 128, 129, 1000, 12345, 100000};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    const dvi_drift_fit fit = fit_record(counts[i], 0.1, line, 1);
    /* values near 2 are rounded to 2e-16, times go up to 1e4, and errors are sums of up to 2e3
     * samples */
    ck_assert_double_eq_tol(fit.slope, -3e-7, 1e-14 / (0.1 * (double)counts[i]));
    ck_assert_double_eq_tol(fit.largest, 3e-7 * 0.1 * (double)(counts[i] - 1), 1e-15);
    if (counts[i] >= 8) ck_assert_double_gt(fit.significance, 1e3);
  }
}
END_TEST

START_TEST(change_is_the_slope_times_the_time_between_the_first_and_the_last_sample)
{
  /* some end in a block that is not full, which the slope leaves out */
  static const long counts[] = {2, 64, 65, 100, 1000, 12345};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    for (int backward = 0; backward < 2; backward++) {
      const double dt = backward ? -0.1 : 0.1;
      const dvi_drift_fit fit = fit_record(counts[i], dt, line, 1);
      /* as the slope's tolerance above */
      ck_assert_double_eq_tol(fit.change, -3e-7 * dt * (double)(counts[i] - 1), 1e-13);
    }
}
END_TEST

START_TEST(an_oscillation_is_no_drift)
{
  ck_assert_double_lt(fit_record(100000, 0.1, fast_oscillation, 1).significance, 3);
  ck_assert_double_lt(fit_record(1000, 0.1, fast_oscillation, 1).significance, 3);
}
END_TEST

START_TEST(one_slow_period_over_the_record_is_no_drift)
{
  ck_assert_double_lt(fit_record(6400, 0.1, slow_oscillation, 1).significance, 3);
}
END_TEST

START_TEST(a_drift_below_the_oscillation_is_found)
{
  /* change 1e-3 under an amplitude of 3e-3 */
  const dvi_drift_fit fit = fit_record(100000, 0.1, drifting_oscillation, 1);
  ck_assert_double_gt(fit.significance, 10);
  ck_assert_double_eq_tol(fit.slope, 1e-7, 4 * fit.deviation);
  ck_assert_double_eq_tol(fit.slope, 1e-7, 1e-9);
}
END_TEST

START_TEST(white_noise_is_rarely_called_a_drift)
{
  int called = 0;
  for (unsigned seed = 1; seed <= 200; seed++)
    called += fit_record(1000, 0.1, white_noise, 7919 * seed).significance > 3;
  /* a normal variable exceeds 3 in one of 370, the measured rate is at most one of 100 */
  ck_assert_int_le(called, 4);
}
END_TEST

START_TEST(a_random_walk_is_seldom_called_a_drift)
{
  int called = 0;
  for (unsigned seed = 1; seed <= 200; seed++) {
    dvi_drift drift;
    dvi_drift_fit fit;
    unsigned state = 104729 * seed;
    double walk = 0;
    dvi_drift_init(&drift);
    for (int i = 0; i < 1000; i++) dvi_drift_add(&drift, i, walk += draw_noise(&state));
    dvi_drift_result(&drift, &fit);
    called += fit.significance > 3;
  }
  ck_assert_int_le(called,
                   50); /* about 1 of 7 are, and with independent blocks it would be 4 of 5 */
}
END_TEST

START_TEST(the_slope_of_white_noise_scatters_as_its_deviation_says)
{
  double squares = 0, variance = 0;
  for (unsigned seed = 1; seed <= 300; seed++) {
    const dvi_drift_fit fit = fit_record(4096, 1, white_noise, 7919 * seed);
    squares += fit.slope * fit.slope;
    variance += fit.deviation * fit.deviation;
  }
  /* the correction for correlation errs on the safe side, by up to a factor 1.3, and 300 samples
   * give 4 percent */
  ck_assert_double_ge(sqrt(variance / squares), 0.9);
  ck_assert_double_le(sqrt(variance / squares), 1.5);
}
END_TEST

START_TEST(fewer_than_8_blocks_have_no_significance)
{
  ck_assert(isnan(fit_record(7, 0.1, line, 1).significance));
  ck_assert(!isnan(fit_record(8, 0.1, line, 1).significance));
  const dvi_drift_fit none = fit_record(0, 0.1, line, 1), one = fit_record(1, 0.1, line, 1);
  ck_assert(none.largest == 0 && none.slope == 0 && none.change == 0 && none.deviation == 0 &&
            isnan(none.significance));
  ck_assert(one.largest == 0 && one.slope == 0 && one.change == 0 && one.deviation == 0 &&
            isnan(one.significance));
}
END_TEST

START_TEST(samples_at_one_time_have_no_slope)
{
  const dvi_drift_fit fit = fit_record(100, 0, white_noise, 5);
  ck_assert(fit.slope == 0 && fit.deviation == 0 && fit.significance == 0);
  ck_assert_double_gt(fit.largest, 0.5);
}
END_TEST

START_TEST(a_nan_in_the_record_is_not_hidden)
{
  dvi_drift drift;
  dvi_drift_fit fit;
  dvi_drift_init(&drift);
  for (int i = 0; i < 100; i++) dvi_drift_add(&drift, i, i == 50 ? (double)NAN : 1);
  dvi_drift_result(&drift, &fit);
  ck_assert(isnan(fit.largest));
}
END_TEST

START_TEST(no_sample_is_lost_when_blocks_are_joined)
{
  dvi_drift drift;
  dvi_drift_init(&drift);
  double sum = 0;
  for (int i = 0; i < 10000; i++) {
    dvi_drift_add(&drift, i, i);
    double recorded = 0;
    for (int b = 0; b < drift.blocks; b++) recorded += drift.error[b];
    sum += i;
    ck_assert(recorded == sum); /* whole numbers are exact */
    ck_assert_int_eq((int)((drift.blocks - 1) * drift.per_block + drift.filled), i + 1);
  }
}
END_TEST

SUITE(drift)
{
  tcase_add_test(tests, a_constant_has_no_drift_and_no_nan);
  tcase_add_test(tests, a_line_gives_its_slope_whatever_the_number_of_samples);
  tcase_add_test(tests, change_is_the_slope_times_the_time_between_the_first_and_the_last_sample);
  tcase_add_test(tests, an_oscillation_is_no_drift);
  tcase_add_test(tests, one_slow_period_over_the_record_is_no_drift);
  tcase_add_test(tests, a_drift_below_the_oscillation_is_found);
  tcase_add_test(tests, white_noise_is_rarely_called_a_drift);
  tcase_add_test(tests, a_random_walk_is_seldom_called_a_drift);
  tcase_add_test(tests, the_slope_of_white_noise_scatters_as_its_deviation_says);
  tcase_add_test(tests, fewer_than_8_blocks_have_no_significance);
  tcase_add_test(tests, samples_at_one_time_have_no_slope);
  tcase_add_test(tests, a_nan_in_the_record_is_not_hidden);
  tcase_add_test(tests, no_sample_is_lost_when_blocks_are_joined);
}
