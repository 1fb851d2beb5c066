/* The Legendre map p = L_v(t,q,v) and its inverse.  Source: Marsden and West 2001, sec. 1.2.5. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "system/evaluator_struct.h"

enum { MOST_ITERATIONS = 50 };

static double max_norm(int n, const double *x)
{
  double norm = 0;
  for (int i = 0; i < n; i++) norm = fmax(norm, fabs(x[i]));
  return norm;
}

/* One Newton step: v += L_vv^{-1} (p - L_v). The sizes of the step and of the residual before it go to *size and *residual. */
static dvi_status newton_step(dvi__evaluator *e, double t, const double *q, const double *p, double *v, double *size,
                              double *residual)
{
  const int n = e->system->n;
  double *change = e->point[0];
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, NULL, change));
  for (int i = 0; i < n; i++) change[i] = p[i] - change[i];
  *residual = max_norm(n, change);
  DVI_TRY(dvi__lagrangian_hessian(e, 1, &t, q, v, e->hessian[0], e->hessian[1], e->hessian[2]));
  const dvi_status status = dvi__linear_factor(e->velocity, e->hessian[2]);
  if (status == DVI_SINGULAR)
    return dvi__fail_in(status, "the Lagrangian is degenerate at t = %.6g: d2L/dv2 cannot be inverted", t);
  if (status != DVI_OK) return status;
  dvi__linear_solve(e->velocity, change);
  for (int i = 0; i < n; i++) v[i] += change[i];
  *size = dvi__first_not_finite((size_t)n, v) < 0 ? max_norm(n, change) : HUGE_VAL;
  return DVI_OK;
}

/* Newton's method to the roundoff floor: it ends when the steps no longer shrink. A velocity that vanishes (p = A(q), with a
 * magnetic term A) has no size of its own to measure the steps by; then the residual is measured by the momentum. */
static dvi_status newton(dvi__evaluator *e, double t, const double *q, const double *p, double *v)
{
  double size = HUGE_VAL, residual = HUGE_VAL;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const double last = size, scale = max_norm(e->system->n, v);
    DVI_TRY(newton_step(e, t, q, p, v, &size, &residual));
    if (!isfinite(size)) break;
    if (size <= 2 * DBL_EPSILON * scale) return DVI_OK;
    if (size >= last && (size <= 1e-10 * scale || residual <= 1e-10 * max_norm(e->system->n, p))) return DVI_OK;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "no velocity found for the momentum at t = %.6g: Newton's method did not settle (last change %.1e)", t, size);
}

dvi_status dvi__legendre_inverse(dvi__evaluator *e, double t, const double *q, const double *p, double *v)
{
  const size_t n = (size_t)e->system->n;
  double *found = e->point[1];
  if (e->system->lagrangian == NULL) {
    dvi__mass_solve(e, 1, p, found);
    if (dvi__first_not_finite(n, found) >= 0) return dvi__fail(DVI_NOT_FINITE, "the velocity M^-1 p at t = %.6g is not finite", t);
  } else {
    memcpy(found, v, n * sizeof(double));
    DVI_TRY(newton(e, t, q, p, found));
  }
  memcpy(v, found, n * sizeof(double));
  return DVI_OK;
}
