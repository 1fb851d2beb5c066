/* Effective tensors of periodic coefficients. */
#include <dvi/multiscale.h>
#include <math.h>

#include "core/memory.h"
#include "support/suite.h"

static const double pi = 3.141592653589793;
static const dvi_axis period[] = {{.from = 0, .to = 1}, {.from = 0, .to = 1}};

static int layers(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 2 + 1.5 * sin(2 * pi * x[i]);
  return 0;
}

static int slanted_layers(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 2 + 1.5 * sin(2 * pi * (x[i] + x[count + i]));
  return 0;
}

static int checkerboard(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = (x[i] < .5) == (x[count + i] < .5) ? 1 : 4;
  return 0;
}

static int constant(int64_t count, const double *x, double *a, void *user)
{
  (void)x;
  for (int64_t i = 0; i < count; i++) a[i] = *(double *)user;
  return 0;
}

static int failing(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 1;
  return x[0] > .5 ? 3 : 0;
}

/* As many layers as `user` says. */
static int many_layers(int64_t count, const double *x, double *a, void *user)
{
  for (int64_t i = 0; i < count; i++) a[i] = 2 + 1.5 * sin(2 * pi * *(double *)user * x[i]);
  return 0;
}

static dvi_effective_options of(int axes, int fine,
                                int (*a)(int64_t, const double *, double *, void *))
{
  return (dvi_effective_options){.size = sizeof(dvi_effective_options),
                                 .axis = period,
                                 .axes = axes,
                                 .fine = fine,
                                 .coefficient = a};
}

/* sqrt(2^2 - 1.5^2), because the mean of 1/(b + c sin) is 1/sqrt(b^2 - c^2). */
START_TEST(on_one_axis_it_is_the_harmonic_mean)
{
  const dvi_effective_options options = of(1, 0, layers);
  double A;
  ck_assert_int_eq(dvi_effective_tensor(&options, &A), DVI_OK);
  ck_assert_double_eq_tol(A, sqrt(1.75), 1e-15);
}
END_TEST

/* Midpoint sums over periods of analytic functions converge like 0.45^64, the root of
 * 1.5 z^2 + 4 z + 1.5 (1e-22). What is left is roundoff of the solution. */
START_TEST(layers_have_a_harmonic_and_an_arithmetic_mean)
{
  const dvi_effective_options options = of(2, 64, layers);
  double A[4];
  ck_assert_int_eq(dvi_effective_tensor(&options, A), DVI_OK);
  ck_assert_double_eq_tol(A[0], sqrt(1.75), 1e-13);
  ck_assert_double_eq_tol(A[1], 0, 1e-13);
  ck_assert_double_eq_tol(A[2], 0, 1e-13);
  ck_assert_double_eq_tol(A[3], 2, 1e-13);
}
END_TEST

/* The layers of the last test, turned by 45 degrees, at a period of sqrt(2)/2. */
START_TEST(slanted_layers_have_order_2)
{
  const double across = sqrt(1.75), along = 2;
  double error[4];
  for (int i = 0; i < 4; i++) {
    const dvi_effective_options options = of(2, 16 << i, slanted_layers);
    double A[4];
    ck_assert_int_eq(dvi_effective_tensor(&options, A), DVI_OK);
    ck_assert_double_eq_tol(A[0], A[3], 1e-12);
    ck_assert(A[1] == A[2]);
    ck_assert_double_eq_tol(A[0] - A[1], along, 1e-12);
    error[i] = fabs(A[0] + A[1] - across);
  }
  for (int i = 1; i < 4; i++)
    ck_assert_double_eq_tol(log2(error[i - 1] / error[i]), 2, i == 1 ? .2 : .05);
}
END_TEST

/* A checkerboard has the geometric mean (Dykhne 1971), and minima over subspaces lie above it. The
 * digits are those of an independent program. */
START_TEST(a_checkerboard_falls_to_the_geometric_mean)
{
  const double expected[] = {2.0296, 2.0130, 2.0057};
  for (int i = 0; i < 3; i++) {
    const dvi_effective_options options = of(2, 16 << i, checkerboard);
    double A[4];
    ck_assert_int_eq(dvi_effective_tensor(&options, A), DVI_OK);
    ck_assert_double_eq_tol(A[0], expected[i], .6e-4);
    ck_assert_double_eq_tol(A[3], A[0], 1e-12);
    ck_assert_double_eq_tol(A[1], 0, 1e-12);
  }
}
END_TEST

START_TEST(one_part_and_other_periods_do)
{
  double a = 7, A[4];
  const dvi_axis axis[] = {{.from = -1, .to = 2}, {.from = 3, .to = 3.5}};
  for (int fine = 1; fine <= 3; fine++) {
    dvi_effective_options options = of(2, fine, constant);
    options.axis = axis;
    options.user = &a;
    ck_assert_int_eq(dvi_effective_tensor(&options, A), DVI_OK);
    ck_assert_double_eq_tol(A[0], 7, 1e-13);
    ck_assert_double_eq_tol(A[1], 0, 1e-13);
    ck_assert_double_eq_tol(A[3], 7, 1e-13);
  }
}
END_TEST

static void refuse(dvi_effective_options options, dvi_status status, const char *words)
{
  double A[4] = {5, 5, 5, 5};
  ck_assert_int_eq(dvi_effective_tensor(&options, A), status);
  check_words(words);
  for (int i = 0; i < 4; i++) ck_assert_double_eq(A[i], 5);
}

START_TEST(coefficients_that_are_not_positive_are_refused)
{
  const double bad[] = {0, -1, NAN, INFINITY, 1e-320};
  for (int i = 0; i < 5; i++)
    for (int axes = 1; axes <= 2; axes++) {
      dvi_effective_options options = of(axes, 4, constant);
      double a = bad[i];
      options.user = &a;
      refuse(options, DVI_NOT_FINITE, "must be positive");
    }
}
END_TEST

START_TEST(bad_arguments_are_refused)
{
  const dvi_effective_options good = of(2, 4, layers);
  dvi_effective_options options = good;
  options.coefficient = NULL;
  refuse(options, DVI_BAD_ARGUMENT, "missing");
  options = good;
  options.size = 0;
  refuse(options, DVI_BAD_ARGUMENT, "sizeof(dvi_effective_options)");
  options = good;
  options.axes = 3;
  refuse(options, DVI_BAD_SIZE, "3 axes");
  options = good;
  options.fine = 513;
  refuse(options, DVI_BAD_SIZE, "512");
  const dvi_axis empty[] = {{.from = 0, .to = 1}, {.from = 2, .to = 2}};
  options = good;
  options.axis = empty;
  refuse(options, DVI_BAD_ARGUMENT, "axis 1 goes from 2 to 2");
  refuse(of(2, 4, failing), DVI_CALLBACK_FAILED, "returned 3");
  refuse(of(1, 4, failing), DVI_CALLBACK_FAILED, "returned 3");
}
END_TEST

/* 16 centres see one phase of 16 waves, 32 another one. 8 points do not see 13 waves. */
START_TEST(coefficients_between_the_parts_are_refused)
{
  double periods = 16;
  dvi_effective_options options = of(2, 16, many_layers);
  options.user = &periods;
  refuse(options, DVI_BAD_OPTION, "take more parts");
  options = of(1, 1, many_layers);
  options.user = &periods;
  periods = 13;
  refuse(options, DVI_BAD_OPTION, "take more parts");
}
END_TEST

START_TEST(no_memory_is_reported)
{
  for (int axes = 1; axes <= 2; axes++) {
    const dvi_effective_options options = of(axes, 3, layers);
    double A[4];
    int failures = 0;
    for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; failures++) {
      dvi__fail_allocations_after(failures);
      status = dvi_effective_tensor(&options, A);
      dvi__fail_allocations_after(-1);
      if (status != DVI_OK) ck_assert_int_eq(status, DVI_NO_MEMORY);
    }
    ck_assert_int_gt(failures, 4);
  }
}
END_TEST

SUITE(multiscale_effective)
{
  tcase_add_test(tests, on_one_axis_it_is_the_harmonic_mean);
  tcase_add_test(tests, layers_have_a_harmonic_and_an_arithmetic_mean);
  tcase_add_test(tests, slanted_layers_have_order_2);
  tcase_add_test(tests, a_checkerboard_falls_to_the_geometric_mean);
  tcase_add_test(tests, one_part_and_other_periods_do);
  tcase_add_test(tests, coefficients_that_are_not_positive_are_refused);
  tcase_add_test(tests, bad_arguments_are_refused);
  tcase_add_test(tests, coefficients_between_the_parts_are_refused);
  tcase_add_test(tests, no_memory_is_reported);
}
