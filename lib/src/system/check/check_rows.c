#include "system/check/check_rows.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/nonholonomic.h"

/* Rows of holonomic constraints, of nonholonomic ones, or of a contact. */
typedef struct timed_rows {
  const dvi__holonomic_term *places;
  const dvi__nonholonomic_term *velocities;
  const char *kind;                  /* "constraint" or "contact" */
  const char *name, *first, *second; /* of the constraint, and of its numbers */
  int rows, count;                   /* its rows, and all its numbers */
} timed_rows;

static timed_rows rows_of_places(const dvi__holonomic_term *term, const char *kind)
{
  const int rows = term->callbacks.count;
  return (timed_rows){.places = term,
                      .kind = kind,
                      .name = term->name,
                      .first = "value",
                      .second = "gradient",
                      .rows = rows,
                      .count = rows + dvi__pattern_entries(&term->gradients)};
}

static timed_rows rows_of_velocities(const dvi__nonholonomic_term *term)
{
  const int rows = term->callbacks.count;
  return (timed_rows){.velocities = term,
                      .kind = "constraint",
                      .name = term->name,
                      .first = "affine part",
                      .second = "matrix A",
                      .rows = rows,
                      .count = rows + dvi__pattern_entries(&term->transposed)};
}

static dvi_status collect_rows(const timed_rows *r, double t, const double *q, double *numbers)
{
  DVI_TRY(r->places != NULL ? dvi__holonomic_value(r->places, t, q, numbers)
                            : dvi__nonholonomic_affine(r->velocities, t, q, numbers));
  return r->places != NULL ? dvi__holonomic_gradient(r->places, t, q, numbers + r->rows)
                           : dvi__nonholonomic_value(r->velocities, t, q, numbers + r->rows);
}

/* Compare values and gradients at two other times, which are no multiples of each other. */
static dvi_status check_same(timed_rows r, double t, const double *q, double *numbers,
                             dvi_derivative_check *result)
{
  static const double apart[] = {0.618033988749895, -3.302775637731995};
  double *moved = numbers + r.count;
  DVI_TRY(collect_rows(&r, t, q, numbers));
  for (int k = 0; k < 2; k++) {
    const double other = t + apart[k] * fmax(1, fabs(t));
    DVI_TRY(collect_rows(&r, other, q, moved));
    for (int i = 0; i < r.count; i++) {
      if (numbers[i] == moved[i]) continue;
      const char *what = i < r.rows ? r.first : r.second;
      result->depends_on_time = 1;
      (void)snprintf(result->where, sizeof result->where, "%s '%.24s': its %s depends on t", r.kind,
                     r.name, what);
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "system check: %s '%s': its %s has %.17g at t = %.6g and %.17g at t = %.6g, "
                       "but the system is declared autonomous",
                       r.kind, r.name, what, numbers[i], t, moved[i], other);
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

static dvi_status check_rates(timed_rows r, double t, const double *q, double tolerance,
                              double *numbers, dvi_derivative_check *result)
{
  const dvi__holonomic_term *term = r.places;
  const int rows = r.rows;
  double *given = numbers, *rate = given + rows, *size = rate + rows, *value = size + rows;
  const double step = ldexp(1.0, ilogb(0.005 * fmax(1, fabs(t))));
  DVI_TRY(dvi__holonomic_rate(term, t, q, given));
  DVI_TRY(difference_rows(term, t, step, q, rate, size, value));
  for (int a = 0; a < rows; a++) {
    const double largest = fmax(fabs(given[a]), fabs(rate[a])),
                 wrong = fabs(given[a] - rate[a]) - 64 * DBL_EPSILON * size[a];
    if (wrong > 0) result->rate_error = fmax(result->rate_error, wrong / largest);
    if (!(wrong > tolerance * largest)) continue;
    (void)snprintf(result->where, sizeof result->where, "%s '%.24s': d phi_%d/dt is wrong", r.kind,
                   term->name, a);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system check: %s '%s': d phi_%d/dt is %.15g from the callback (0 without "
                     "one), %.15g from differences",
                     r.kind, term->name, a, given[a], rate[a]);
  }
  return DVI_OK;
}

dvi_status dvi__check_rows_in_time(const dvi_system *system, double t, const double *q,
                                   double tolerance, dvi_derivative_check *result)
{
  const int places = system->holonomic_count, all = places + system->contact_count;
  const size_t rows = (size_t)system->row_count + (system->contact_count > 0),
               n = (size_t)system->n;
  dvi_status status = DVI_OK;
  if (rows == 0) return DVI_OK;
  double *numbers = DVI_NEW(double, 2 * rows * (2 + n));
  if (numbers == NULL) return dvi__fail(DVI_NO_MEMORY, "system check: no memory for constraints");
  for (int k = 0; k < all && status == DVI_OK; k++) {
    const timed_rows r = k < places ? rows_of_places(&system->holonomics[k], "constraint")
                                    : rows_of_places(&system->contacts[k - places].gap, "contact");
    status = system->autonomous ? check_same(r, t, q, numbers, result)
                                : check_rates(r, t, q, tolerance, numbers, result);
  }
  for (int k = 0; k < system->nonholonomic_count && status == DVI_OK && system->autonomous; k++)
    status = check_same(rows_of_velocities(&system->nonholonomics[k]), t, q, numbers, result);
  dvi__release(numbers);
  return status;
}
