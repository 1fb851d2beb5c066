#include "system/check/check_rows.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"

/* Compare values and gradients at two other times, which are no multiples of each other. */
static dvi_status check_same(const dvi__holonomic_term *term, double t, const double *q,
                             double *numbers, dvi_derivative_check *result)
{
  static const double apart[] = {0.618033988749895, -3.302775637731995};
  const int rows = term->callbacks.count, count = rows + dvi__pattern_entries(&term->gradients);
  double *moved = numbers + count;
  DVI_TRY(dvi__holonomic_value(term, t, q, numbers));
  DVI_TRY(dvi__holonomic_gradient(term, t, q, numbers + rows));
  for (int k = 0; k < 2; k++) {
    const double other = t + apart[k] * fmax(1, fabs(t));
    DVI_TRY(dvi__holonomic_value(term, other, q, moved));
    DVI_TRY(dvi__holonomic_gradient(term, other, q, moved + rows));
    for (int i = 0; i < count; i++) {
      if (numbers[i] == moved[i]) continue;
      const char *what = i < rows ? "value" : "gradient";
      result->depends_on_time = 1;
      (void)snprintf(result->where, sizeof result->where, "constraint '%.24s': its %s depends on t",
                     term->name, what);
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "system check: constraint '%s': its %s has %.17g at t = %.6g and %.17g at t "
                       "= %.6g, but the system is declared autonomous",
                       term->name, what, numbers[i], t, moved[i], other);
    }
  }
  return DVI_OK;
}

/* Write the differences of the values in time, of order 6, and the size of their summands. */
static dvi_status difference_rows(const dvi__holonomic_term *term, double t, double step,
                                  const double *q, double *rate, double *size, double *value)
{
  static const double weight[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};
  const int rows = term->callbacks.count;
  for (int a = 0; a < rows; a++) rate[a] = size[a] = 0;
  for (int m = -3; m <= 3; m++) {
    if (m == 0) continue;
    DVI_TRY(dvi__holonomic_value(term, t + m * step, q, value));
    const double by = (m > 0 ? weight[m - 1] : -weight[-m - 1]) / step;
    for (int a = 0; a < rows; a++) {
      rate[a] += by * value[a];
      size[a] += fabs(by * value[a]);
    }
  }
  return DVI_OK;
}

static dvi_status check_rates(const dvi__holonomic_term *term, double t, const double *q,
                              double tolerance, double *numbers, dvi_derivative_check *result)
{
  const int rows = term->callbacks.count;
  double *given = numbers, *rate = given + rows, *size = rate + rows, *value = size + rows;
  const double step = ldexp(1.0, ilogb(0.005 * fmax(1, fabs(t))));
  DVI_TRY(dvi__holonomic_rate(term, t, q, given));
  DVI_TRY(difference_rows(term, t, step, q, rate, size, value));
  for (int a = 0; a < rows; a++) {
    const double largest = fmax(fabs(given[a]), fabs(rate[a])),
                 wrong = fabs(given[a] - rate[a]) - 64 * DBL_EPSILON * size[a];
    if (wrong > 0) result->rate_error = fmax(result->rate_error, wrong / largest);
    if (!(wrong > tolerance * largest)) continue;
    (void)snprintf(result->where, sizeof result->where, "constraint '%.24s': d phi_%d/dt is wrong",
                   term->name, a);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system check: constraint '%s': d phi_%d/dt is %.15g from the callback (0 "
                     "without one), %.15g from differences",
                     term->name, a, given[a], rate[a]);
  }
  return DVI_OK;
}

dvi_status dvi__check_rows_in_time(const dvi_system *system, double t, const double *q,
                                   double tolerance, dvi_derivative_check *result)
{
  const size_t rows = (size_t)system->row_count, n = (size_t)system->n;
  dvi_status status = DVI_OK;
  if (rows == 0) return DVI_OK;
  double *numbers = DVI_NEW(double, 2 * rows * (2 + n));
  if (numbers == NULL) return dvi__fail(DVI_NO_MEMORY, "system check: no memory for constraints");
  for (int k = 0; k < system->holonomic_count && status == DVI_OK; k++)
    status = system->autonomous
                 ? check_same(&system->holonomics[k], t, q, numbers, result)
                 : check_rates(&system->holonomics[k], t, q, tolerance, numbers, result);
  dvi__release(numbers);
  return status;
}
