/* labels: reference */
/* Tests the remainder of Chebyshev expansions against its bound. The functions are in long
 * double. */
#include "step/split/expansion.h"

#include <float.h>
#include <math.h>

#include "support/suite.h"

static long double cosine(long double s)
{
  return s < 0 ? coshl(sqrtl(-s)) : cosl(sqrtl(s));
}

static long double sinc(long double s)
{
  const long double x = sqrtl(fabsl(s));
  return x < 1e-5L ? 1 - s / 6 : s < 0 ? sinhl(x) / x : sinl(x) / x;
}

static long double fall_of_series(long double s)
{
  return 1 - cosine(s);
}

static long double square(long double s)
{
  return sinc(s) * sinc(s);
}

static long double hochbruck_lubich(long double s)
{
  return sinc(s) * (7 - cosine(s)) / 6;
}

static long double gautschi(long double s)
{
  return sinc(s / 4) * sinc(s / 4) / sinc(s);
}

static long double stern(long double s)
{
  return sinc(s / 4) / sqrtl(sinc(s));
}

/* sum_j a_j (-s)^j/(2j + 3)!, with a_j = 1, or those of (1 - sinc x)/s and of (sinc^2(x/2) - sinc
 * x)/s where they do not cancel. */
static long double series(int squared, long double s)
{
  long double sum = 0, term = 1 / 6.0L;
  for (int j = 0; j < 20; j++, term *= -s / ((2 * j + 2) * (2 * j + 3)))
    sum += squared ? term * (2 * j + 2) / (2 * j + 4) : term;
  return sum;
}

static long double shift(long double s)
{
  return fabsl(s) < 1 ? series(0, s) : (1 - sinc(s)) / s;
}

/* With a = sinc(x/2), b = sinc x it is 1 - a/sqrt(b) = (b - a^2)/(b + a sqrt(b)). */
static long double stern_shift(long double s)
{
  const long double a = sinc(s / 4), b = sinc(s);
  return fabsl(s) < 1 ? -series(1, s) / (b + a * sqrtl(b)) : (1 - stern(s)) / s;
}

typedef struct function {
  dvi__growth growth;
  int divided;
  long double (*at)(long double s);
} function;

static const function functions[] = {{{1, 1, 0}, 0, cosine},
                                     {{1, 1, 0}, 0, sinc},
                                     {{1, 2, 0}, 0, fall_of_series},
                                     {{2, 1, 0}, 0, square},
                                     {{2, 4.0 / 3, 0}, 0, hochbruck_lubich},
                                     {{1, 1, 1}, 0, gautschi},
                                     {{0.5, 1, 0.5}, 0, stern},
                                     {{1, 1, 0}, 1, shift},
                                     {{0.5, 1, 0.5}, 1, stern_shift}};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

/* The intervals of s. Poles begin at 9.87. */
static const double intervals[][2] = {{0, 0.01}, {0, 1},    {-1, 4},   {-0.1, 9},
                                      {0, 100},  {-9, 400}, {0, 40000}};
enum { INTERVALS = sizeof intervals / sizeof *intervals, WITHOUT_POLES = 4 };

static double value(const void *user, double s)
{
  return (double)((const function *)user)->at(s);
}

static double room[2 * DVI__DEGREE_MOST + 3], c[DVI__DEGREE_MOST + 1];

/* The largest difference of the polynomial from the function. */
static double left_out(const function *f, int degree, double low, double high)
{
  long double most = 0;
  dvi__expansion_make(degree, low, high, value, f, room, c, 1);
  for (int i = 0; i <= 1000; i++) {
    const long double angle = i * 3.14159265358979323846L / 1000, z = cosl(angle);
    long double sum = 0;
    for (int k = 0; k <= degree; k++) sum += c[k] * cosl(k * angle);
    most = fmaxl(most, fabsl(sum - f->at(low + (high - low) * (1 + z) / 2)));
  }
  return (double)most;
}

/* Coefficients are rounded to a rounding of their size each, and so is s. Three quarters of the
 * degree would not be enough. */
START_TEST(what_is_left_out_is_within_its_bound)
{
  const double tolerance[] = {1e-2, 1e-5, 1e-9, DBL_EPSILON / 2};
  const function *f = &functions[_i % FUNCTIONS];
  const double low = intervals[_i / FUNCTIONS][0], high = intervals[_i / FUNCTIONS][1];
  double bound;
  if (f->growth.poles > 0 && _i / FUNCTIONS >= WITHOUT_POLES) {
    ck_assert_int_eq(dvi__expansion_degree(&f->growth, f->divided, low, high, 1e-9, &bound), -1);
    return;
  }
  for (int k = 0; k < 4; k++) {
    const int degree = dvi__expansion_degree(&f->growth, f->divided, low, high, tolerance[k],
                                             &bound);
    ck_assert(degree >= 0 && degree <= DVI__DEGREE_MOST);
    const double size = bound / tolerance[k], found = left_out(f, degree, low, high);
    ck_assert_msg(found <= bound + (8 * fmax(size, 1) + f->growth.type * sqrt(high)) * DBL_EPSILON,
                  "%g of at most %g at degree %d", found, bound, degree);
    if (k == 3 && degree > 10) ck_assert_double_gt(left_out(f, 3 * degree / 4, low, high), bound);
  }
}
END_TEST

/* J_2k(x) of cos x, which falls off when 2k has passed x. */
START_TEST(degrees_are_half_the_largest_angle_and_a_little_more)
{
  const dvi__growth cos_x = {1, 1, 0};
  double bound;
  for (int x = 1; x <= 1000; x *= 10) {
    const int degree = dvi__expansion_degree(&cos_x, 0, 0, (double)x * x, DBL_EPSILON / 2, &bound);
    ck_assert_double_le(degree, 0.5 * x + 7 * cbrt(x) + 1);
    ck_assert_double_ge(degree, 0.5 * x);
  }
}
END_TEST

SUITE(expansion)
{
  tcase_add_loop_test(tests, what_is_left_out_is_within_its_bound, 0, FUNCTIONS * INTERVALS);
  tcase_add_test(tests, degrees_are_half_the_largest_angle_and_a_little_more);
}
