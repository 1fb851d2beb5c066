/* Checking potentials that are declared quadratic, whose gradient is V_q(t,q) = K q + b(t).
 *
 * With g_s = V_q(t, q + s d), s from -2 to 2, for a direction d with all components not 0, the
 * tests are
 *
 *     g_1 - 2 g_0 + g_-1 = 0        and        (g_2 - g_-2) - 2 (g_1 - g_-1) = 0.
 *
 * The first one finds terms even in d, the second one terms odd in d. Two other times t' must have
 * g_1(t') - g_0(t') = g_1 - g_0. */
#include "system/check/check_quadratic.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"

enum { PLACES = 5, TIMES = 2, LISTS = PLACES + 2 * TIMES };

/* Return a move about as large as the coordinates, and at least 1. No two moves are
 * commensurable. */
static double move_coordinate(const double *q, int i)
{
  const double golden = 0.618033988749895 * (i + 1), part = golden - floor(golden);
  return (i % 2 == 0 ? 1 : -1) * (0.5 + part) * fmax(1, fabs(q[i]));
}

/* Evaluate V_q at q + s d, s = -2, .., 2 at t, and 0, 1 at each other time, [n] each. moved [n] is
 * work. */
static dvi_status evaluate_gradients(const dvi__potential_term *p, dvi__scratch *scratch, double t,
                                     const double *q, double *moved, double *gradient)
{
  static const double apart[] = {0, 0.618033988749895, -3.302775637731995};
  const int n = scratch->n;
  for (int k = 0; k < LISTS; k++) {
    const double s = k < PLACES ? k - 2 : (k - PLACES) % 2,
                 at = t + apart[k < PLACES ? 0 : 1 + (k - PLACES) / 2] * fmax(1, fabs(t));
    for (int i = 0; i < n; i++) moved[i] = q[i] + s * move_coordinate(q, i);
    DVI_TRY(dvi__potential_gradient(p, scratch, 1, &at, moved, gradient + (ptrdiff_t)k * n));
  }
  return DVI_OK;
}

/* Measure the deviation of component i from linearity. */
static double nonlinearity_of(const double *g, int n, int i)
{
  const double *at = g + i, even = at[3 * n] - 2 * at[2 * n] + at[n],
               odd = (at[4 * n] - at[0]) - 2 * (at[3 * n] - at[n]);
  double worst = fmax(fabs(even), fabs(odd));
  for (int k = PLACES; k < LISTS; k += 2)
    worst = fmax(worst, fabs((at[(k + 1) * n] - at[k * n]) - (at[3 * n] - at[2 * n])));
  return worst;
}

static dvi_status test_linearity(const dvi__potential_term *p, int n, const double *gradient,
                                 double tolerance, dvi_derivative_check *result)
{
  /* Differences of a value resolve no less than this. */
  const double noise = dvi__potential_has_gradient(p) ? 0 : sqrt(DBL_EPSILON);
  double largest = 0, worst = 0;
  int row = 0;
  for (ptrdiff_t k = 0; k < LISTS * (ptrdiff_t)n; k++) largest = fmax(largest, fabs(gradient[k]));
  for (int i = 0; i < n; i++)
    if (nonlinearity_of(gradient, n, i) > worst) worst = nonlinearity_of(gradient, n, i), row = i;
  if (!(worst > (tolerance + noise) * largest)) return DVI_OK;
  result->not_quadratic = 1;
  (void)snprintf(result->where, sizeof result->where,
                 "potential '%.24s': dV/dq (%d) is not linear in q", p->name, row);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: potential '%.24s' is declared quadratic, but dV/dq (%d) is not "
                   "linear in q with a constant slope: off "
                   "by %.3g, its largest entry %.3g",
                   p->name, row, worst, largest);
}

dvi_status dvi__check_quadratic(const dvi_system *system, dvi__scratch *scratch, double t,
                                const double *q, double tolerance, dvi_derivative_check *result)
{
  const size_t n = (size_t)system->n;
  double *numbers = DVI_NEW(double, (LISTS + 1) * n);
  dvi_status status = DVI_OK;
  if (numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "system check: no memory for %d dimensions", system->n);
  for (int k = 0; k < system->potential_count && status == DVI_OK; k++) {
    const dvi__potential_term *p = &system->potentials[k];
    if (!p->callbacks.quadratic) continue;
    status = evaluate_gradients(p, scratch, t, q, numbers + LISTS * n, numbers);
    if (status == DVI_OK) status = test_linearity(p, system->n, numbers, tolerance, result);
  }
  dvi__release(numbers);
  return status;
}
