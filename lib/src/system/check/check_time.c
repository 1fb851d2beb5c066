/* Checking what a system declares about time. Either the system is autonomous, or its terms have
 * rates. */
#include "system/check/check_time.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/difference.h"
#include "system/term/force.h"
#include "system/term/vector.h"

/* One of potential, lagrangian, vector potential and force, and the point at which it is
 * evaluated. */
typedef struct subject {
  const dvi__potential_term *potential;
  const dvi__lagrangian_term *lagrangian;
  const dvi__vector_term *vector;
  const dvi__force_term *force;
  dvi__scratch *scratch;
  const double *q, *v;
} subject;

static void name_subject(const subject *s, size_t size, char *text)
{
  if (s->potential != NULL)
    (void)snprintf(text, size, "potential '%.24s'", s->potential->name);
  else if (s->force != NULL)
    (void)snprintf(text, size, "force '%.24s'", s->force->name);
  else if (s->vector != NULL)
    (void)snprintf(text, size, "vector potential");
  else
    (void)snprintf(text, size, "%s", s->lagrangian != NULL ? s->lagrangian->name : "");
}

/* ---- rates ---- */

/* Evaluate the term as a function of time alone. */
static dvi_status value_of_time(const void *function, int count, const double *t, double *value)
{
  const subject *s = function;
  return s->potential != NULL
             ? dvi__potential_value(s->potential, s->scratch, count, t, s->q, value)
             : dvi__general_value(s->lagrangian, s->scratch, count, t, s->q, s->v, value);
}

/* A vector potential stands for the sum of its components times these weights. */
static double sum_of_components(const subject *s, const double *A)
{
  double sum = 0;
  for (int i = 0; i < s->scratch->n; i++) sum += (1 + 0.618033988749895 * i) * A[i];
  return sum;
}

static dvi_status vector_of_time(const void *function, int count, const double *t, double *value)
{
  const subject *s = function;
  for (int k = 0; k < count; k++) {
    DVI_TRY(dvi__vector_value(s->vector, s->scratch, 1, t + k, s->q, s->scratch->point_v));
    value[k] = sum_of_components(s, s->scratch->point_v);
  }
  return DVI_OK;
}

static dvi_status rate_of(const subject *s, double t, double *given)
{
  if (s->potential != NULL)
    return dvi__potential_rate(s->potential, s->scratch, 1, &t, s->q, given);
  if (s->vector == NULL)
    return dvi__general_rate(s->lagrangian, s->scratch, 1, &t, s->q, s->v, given);
  DVI_TRY(dvi__vector_rate(s->vector, s->scratch, 1, &t, s->q, s->scratch->point_v));
  *given = sum_of_components(s, s->scratch->point_v);
  return DVI_OK;
}

static int has_rate(const subject *s)
{
  return s->potential != NULL ? dvi__potential_has_rate(s->potential)
         : s->vector != NULL  ? dvi__vector_has_rate(s->vector)
                              : dvi__general_has_rate(s->lagrangian);
}

static dvi_status check_rate(const subject *s, dvi__differences *d, double t, double tolerance,
                             dvi_derivative_check *result)
{
  double given, differenced;
  char owner[48];
  if (!has_rate(s)) return DVI_OK;
  DVI_TRY(rate_of(s, t, &given));
  DVI_TRY(dvi__difference_gradient(s->vector != NULL ? vector_of_time : value_of_time, s, d, 1, 1,
                                   &t, &differenced));
  const double noise = 64 * DBL_EPSILON * fmax(fabs(d->plus[0]), fabs(d->minus[0])) / d->step[0];
  const double wrong = fabs(given - differenced) - noise,
               largest = fmax(fabs(given), fabs(differenced));
  if (wrong > 0) result->rate_error = fmax(result->rate_error, wrong / largest);
  if (!(wrong > tolerance * largest)) return DVI_OK;
  name_subject(s, sizeof owner, owner);
  const char *rate = s->potential != NULL ? "dV/dt" : s->vector != NULL ? "dA/dt" : "dL/dt";
  (void)snprintf(result->where, sizeof result->where, "%s: %s is wrong", owner, rate);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: %s: %s is %.15g from the callback, %.15g from differences", owner,
                   rate, given, differenced);
}

/* ---- autonomous systems ---- */

/* Collect a force at one time in the place of a gradient, and the Jacobians that it gives in that
 * of Hessians. */
static dvi_status collect_force(const subject *s, double t, size_t longest, double *numbers)
{
  double *F_q = numbers + 1 + 2 * (size_t)s->scratch->n;
  DVI_TRY(dvi__force_value(s->force, s->scratch, 1, &t, s->q, s->v, numbers + 1));
  if (!dvi__force_has_jacobian(s->force)) return DVI_OK;
  return dvi__force_jacobian(s->force, s->scratch, 1, &t, s->q, s->v, F_q, F_q + longest);
}

/* Collect A at one time in the place of a gradient, and its derivatives in that of Hessians. */
static dvi_status collect_vector(const subject *s, double t, size_t longest, double *numbers)
{
  double *A_q = numbers + 1 + 2 * (size_t)s->scratch->n;
  DVI_TRY(dvi__vector_value(s->vector, s->scratch, 1, &t, s->q, numbers + 1));
  DVI_TRY(dvi__vector_gradients(s->vector, s->scratch, 1, &t, s->q, A_q));
  return dvi__vector_hessian(s->vector, s->scratch, 1, &t, s->q, s->v, A_q + longest);
}

/* Collect all numbers of the term at one time, its value, its gradient (2 n numbers) and its
 * Hessian (3 times `longest`). */
static dvi_status collect_numbers(const subject *s, double t, size_t longest, double *numbers)
{
  const size_t n = (size_t)s->scratch->n;
  double *gradient = numbers + 1, *hessian = gradient + 2 * n;
  if (s->force != NULL) return collect_force(s, t, longest, numbers);
  if (s->vector != NULL) return collect_vector(s, t, longest, numbers);
  if (s->potential != NULL) {
    DVI_TRY(dvi__potential_value(s->potential, s->scratch, 1, &t, s->q, numbers));
    DVI_TRY(dvi__potential_gradient(s->potential, s->scratch, 1, &t, s->q, gradient));
    if (s->potential->callbacks.without_hessian) return DVI_OK;
    return dvi__potential_hessian(s->potential, s->scratch, 1, &t, s->q, hessian);
  }
  DVI_TRY(dvi__general_value(s->lagrangian, s->scratch, 1, &t, s->q, s->v, numbers));
  DVI_TRY(
      dvi__general_gradient(s->lagrangian, s->scratch, 1, &t, s->q, s->v, gradient, gradient + n));
  return dvi__general_hessian(s->lagrangian, s->scratch, 1, &t, s->q, s->v, hessian,
                              hessian + longest, hessian + 2 * longest);
}

static dvi_status report_change(const subject *s, size_t at, double t, double other, double here,
                                double there, dvi_derivative_check *result)
{
  const int is_first = at < 1 + 2 * (size_t)s->scratch->n;
  const char *what = s->force != NULL    ? (is_first ? "value" : "Jacobian")
                     : s->vector != NULL ? (is_first ? "value" : "gradient or Hessian")
                     : at == 0           ? "value"
                     : is_first          ? "gradient"
                                         : "Hessian";
  char owner[48];
  name_subject(s, sizeof owner, owner);
  result->depends_on_time = 1;
  (void)snprintf(result->where, sizeof result->where, "%s: its %s depends on t", owner, what);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: %s: its %s has %.17g at t = %.6g and %.17g at t = %.6g, but the "
                   "system is declared autonomous",
                   owner, what, here, t, there, other);
}

/* Compare the term at two other times, which are no multiples of each other. A periodic term
 * differs at one of them. `numbers` holds two fingerprints. */
static dvi_status check_autonomous(const subject *s, double t, size_t longest, double *numbers,
                                   dvi_derivative_check *result)
{
  const double apart[] = {0.618033988749895, -3.302775637731995};
  const size_t count = 1 + 2 * (size_t)s->scratch->n + 3 * longest;
  double *moved = numbers + count;
  memset(numbers, 0, 2 * count * sizeof(double));
  DVI_TRY(collect_numbers(s, t, longest, numbers));
  for (int k = 0; k < 2; k++) {
    const double other = t + apart[k] * fmax(1, fabs(t));
    DVI_TRY(collect_numbers(s, other, longest, moved));
    for (size_t i = 0; i < count; i++)
      if (numbers[i] != moved[i])
        return report_change(s, i, t, other, numbers[i], moved[i], result);
  }
  return DVI_OK;
}

/* ---- all terms ---- */

/* Check every term. `numbers` is NULL if rates are to be checked. */
static dvi_status each_term(const dvi_system *system, subject s, dvi__differences *d, double t,
                            double tolerance, double *numbers, dvi_derivative_check *result)
{
  const size_t longest = (size_t)dvi__longest_hessian(system, 1);
  for (int k = system->lagrangian != NULL ? -1 : 0; k < system->potential_count; k++) {
    s.potential = k >= 0 ? &system->potentials[k] : NULL;
    s.lagrangian = k >= 0 ? NULL : system->lagrangian;
    DVI_TRY(numbers != NULL ? check_autonomous(&s, t, longest, numbers, result)
                            : check_rate(&s, d, t, tolerance, result));
  }
  s.potential = NULL;
  s.lagrangian = NULL;
  s.vector = system->vector;
  if (s.vector != NULL)
    DVI_TRY(numbers != NULL ? check_autonomous(&s, t, longest, numbers, result)
                            : check_rate(&s, d, t, tolerance, result));
  s.vector = NULL;
  for (int k = 0; numbers != NULL && k < system->force_count; k++) {
    s.force = &system->forces[k];
    DVI_TRY(check_autonomous(&s, t, longest, numbers, result));
  }
  return DVI_OK;
}

dvi_status dvi__check_time(const dvi_system *system, dvi__scratch *scratch,
                           dvi__differences *differences, double t, const double *q,
                           const double *v, double tolerance, dvi_derivative_check *result)
{
  const subject at = {.scratch = scratch, .q = q, .v = v};
  if (!system->autonomous) return each_term(system, at, differences, t, tolerance, NULL, result);
  const size_t count = 1 + 2 * (size_t)system->n + 3 * (size_t)dvi__longest_hessian(system, 1);
  double *numbers = DVI_NEW(double, 2 * count);
  if (numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "system check: no memory for %d dimensions", system->n);
  const dvi_status status = each_term(system, at, differences, t, tolerance, numbers, result);
  dvi__release(numbers);
  return status;
}
