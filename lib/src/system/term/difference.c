#include "system/term/difference.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"

/* Central differences of 6th order. These are the weights of (f(x + m step) - f(x - m step)) /
 * step, and the step where truncation meets roundoff. */
static const double weight[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};

static double sixth_order_step(void)
{
  return pow(DBL_EPSILON, 1.0 / 7.0);
}

/* A point nearer to the origin than this is taken to pass the origin. Steps that shrink further
 * would drown in the rounding of the values. */
static const double smallest_size = 1e-2;

/* Choose steps near relative * (size of the coordinate), rounded to powers of two so that multiples
 * and quotients are exact. A coordinate near zero is measured by the largest one of its point. */
static void choose_steps(int n, int count, const double *x, double relative, double *step)
{
  for (size_t k = 0, points = (size_t)count; k < points; k++) {
    double whole = smallest_size;
    for (size_t i = 0; i < (size_t)n; i++) whole = fmax(whole, 0.1 * fabs(x[i * points + k]));
    for (size_t i = 0; i < (size_t)n; i++)
      step[i * points + k] = ldexp(1.0, ilogb(relative * fmax(fabs(x[i * points + k]), whole)));
  }
}

/* Compute both estimates of a row of the gradient at all points, from the same six evaluations at
 * each. The 6th order goes to d->plus_v, the 4th to d->minus_v. */
static dvi_status difference_row(dvi__batch_value value, const void *function, dvi__differences *d,
                                 size_t row, int count, const double *x)
{
  static const double fourth_weight[3] = {8.0 / 12.0, -1.0 / 12.0, 0};
  const size_t points = (size_t)count;
  double *sixth = d->plus_v, *fourth = d->minus_v;
  for (size_t k = 0; k < points; k++) sixth[k] = fourth[k] = 0;
  for (int m = 1; m <= 3; m++) {
    for (size_t k = 0; k < points; k++) d->moved[row + k] = x[row + k] + m * d->step[row + k];
    DVI_TRY(value(function, count, d->moved, d->plus));
    for (size_t k = 0; k < points; k++) d->moved[row + k] = x[row + k] - m * d->step[row + k];
    DVI_TRY(value(function, count, d->moved, d->minus));
    d->points += 2L * count;
    for (size_t k = 0; k < points; k++) {
      const double quotient = (d->plus[k] - d->minus[k]) / d->step[row + k];
      sixth[k] += weight[m - 1] * quotient;
      fourth[k] += fourth_weight[m - 1] * quotient;
    }
  }
  memcpy(d->moved + row, x + row, points * sizeof(double));
  return DVI_OK;
}

/* If the two estimates differ by more than this, a singularity is so near that the better one errs
 * by more than 1e-11, unless roundoff explains the difference. For a pole at R the errors are about
 * 4 (step/R)^4 and 36 (step/R)^6. */
static const double estimates_agree = 1e-8;

/* Shorten the steps of the points at which they are too long, and return the count of these
 * points. */
static int shorten_steps(dvi__differences *d, size_t row, int count)
{
  int shortened = 0;
  for (int k = 0; k < count; k++) {
    double *step = d->step + row + k;
    const double noise = 16 * DBL_EPSILON * fmax(fabs(d->plus[k]), fabs(d->minus[k])) / *step;
    if (fabs(d->plus_v[k] - d->minus_v[k]) <= estimates_agree * fabs(d->plus_v[k]) + noise)
      continue;
    *step *= 0.25;
    shortened++;
  }
  return shortened;
}

dvi_status dvi__difference_gradient(dvi__batch_value value, const void *function,
                                    dvi__differences *d, int n, int count, const double *x,
                                    double *gradient)
{
  enum { MOST_TRIES = 8 };
  const size_t points = (size_t)count;
  choose_steps(n, count, x, sixth_order_step(), d->step);
  memcpy(d->moved, x, (size_t)n * points * sizeof(double));
  for (size_t row = 0; row < (size_t)n * points; row += points) {
    DVI_TRY(difference_row(value, function, d, row, count, x));
    for (int tries = 1; tries < MOST_TRIES && shorten_steps(d, row, count) > 0; tries++)
      DVI_TRY(difference_row(value, function, d, row, count, x));
    memcpy(gradient + row, d->plus_v, points * sizeof(double));
  }
  return DVI_OK;
}

static void move_group(const dvi__differences *d, const dvi__groups *groups, int g, int n,
                       int count, double sign, const double *x)
{
  const size_t points = (size_t)count;
  for (int j = 0; j < n; j++)
    for (size_t at = (size_t)j * points; at < ((size_t)j + 1) * points; at++)
      d->moved[at] = groups->of_column[j] == g ? x[at] + sign * d->step[at] : x[at];
}

static void fill_columns(const dvi__pattern *pattern, const dvi__groups *groups, int g, int count,
                         const double *plus, const double *minus, const double *step,
                         double *values)
{
  const size_t points = (size_t)count;
  for (int j = 0; j < pattern->columns; j++) {
    if (groups->of_column[j] != g) continue;
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      for (size_t k = 0; k < points; k++) {
        const size_t at = (size_t)pattern->row[e] * points + k;
        values[(size_t)e * points + k] = (plus[at] - minus[at]) /
                                         (2 * step[(size_t)j * points + k]);
      }
  }
}

dvi_status dvi__difference_hessian(dvi__batch_gradient gradient, const void *function,
                                   dvi__differences *d, const dvi__groups *groups, int noisy,
                                   int count, const double *x, const dvi__pattern *first,
                                   double *first_values, const dvi__pattern *second,
                                   double *second_values)
{
  const int n = first != NULL ? first->columns : second->columns;
  choose_steps(n, count, x, noisy ? 1e-3 : cbrt(DBL_EPSILON), d->step);
  for (int g = 0; g < groups->count; g++) {
    move_group(d, groups, g, n, count, 1, x);
    DVI_TRY(gradient(function, count, d->moved, d->plus, d->plus_v));
    move_group(d, groups, g, n, count, -1, x);
    DVI_TRY(gradient(function, count, d->moved, d->minus, d->minus_v));
    d->points += 2L * count;
    if (first != NULL)
      fill_columns(first, groups, g, count, d->plus, d->minus, d->step, first_values);
    if (second != NULL)
      fill_columns(second, groups, g, count, d->plus_v, d->minus_v, d->step, second_values);
  }
  return DVI_OK;
}

static void add_difference(int n, double factor, const double *plus, const double *minus,
                           double *sum)
{
  for (int i = 0; i < n; i++) sum[i] += factor * (plus[i] - minus[i]);
}

dvi_status dvi__difference_column(dvi__batch_gradient gradient, const void *function,
                                  dvi__differences *d, int n, int j, const double *x, double *first,
                                  double *second)
{
  const size_t size = (size_t)n * sizeof(double);
  choose_steps(n, 1, x, ldexp(sixth_order_step(), -d->shorter), d->step);
  memcpy(d->moved, x, size);
  memset(first, 0, size);
  memset(second, 0, size);
  for (int m = 1; m <= 3; m++) {
    d->moved[j] = x[j] + m * d->step[j];
    DVI_TRY(gradient(function, 1, d->moved, d->plus, d->plus_v));
    d->moved[j] = x[j] - m * d->step[j];
    DVI_TRY(gradient(function, 1, d->moved, d->minus, d->minus_v));
    d->points += 2;
    add_difference(n, weight[m - 1] / d->step[j], d->plus, d->minus, first);
    add_difference(n, weight[m - 1] / d->step[j], d->plus_v, d->minus_v, second);
  }
  return DVI_OK;
}
