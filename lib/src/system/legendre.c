/* The Legendre map p = L_v(t,q,v) and its inverse.  Source: Marsden and West 2001, sec. 1.2.5. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "system/evaluator_struct.h"

enum { MOST_ITERATIONS = 50 };

static double max_norm(int n, const double *x)
{
  double norm = 0;
  for (int i = 0; i < n; i++) norm = fmax(norm, fabs(x[i]));
  return norm;
}

/* One Newton step: v += L_vv^{-1} (p - L_v). The size of the step goes to *size. */
static dvi_status newton_step(dvi__evaluator *e, double t, const double *q, const double *p, double *v, double *size)
{
  const int n = e->system->n;
  double *change = e->point[0];
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, NULL, change));
  for (int i = 0; i < n; i++) change[i] = p[i] - change[i];
  DVI_TRY(dvi__lagrangian_hessian(e, 1, &t, q, v, e->hessian[0], e->hessian[1], e->hessian[2]));
  if (dvi__linear_factor(e->velocity, e->hessian[2]) != DVI_OK)
    return dvi__fail_in(DVI_SINGULAR, "the Lagrangian is degenerate at t = %.6g: d2L/dv2 cannot be inverted", t);
  dvi__linear_solve(e->velocity, change);
  for (int i = 0; i < n; i++) v[i] += change[i];
  *size = max_norm(n, change);
  return DVI_OK;
}

/* Newton's method to the roundoff floor: it ends when the steps no longer shrink. */
static dvi_status newton(dvi__evaluator *e, double t, const double *q, const double *p, double *v)
{
  double size = HUGE_VAL;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const double last = size, scale = max_norm(e->system->n, v);
    DVI_TRY(newton_step(e, t, q, p, v, &size));
    if (!isfinite(size)) break;
    if (size <= 2 * DBL_EPSILON * scale || (size >= last && size <= 1e-10 * scale)) return DVI_OK;
    if (size == 0) return DVI_OK;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "no velocity found for the momentum at t = %.6g: Newton's method did not settle (last change %.1e)", t,
                   size);
}

dvi_status dvi__legendre_inverse(dvi__evaluator *e, double t, const double *q, const double *p, double *v)
{
  if (e->system->lagrangian == NULL) {
    dvi__mass_solve(e, 1, p, v);
    return DVI_OK;
  }
  const size_t size = (size_t)e->system->n * sizeof(double);
  memcpy(e->point[1], v, size);
  DVI_TRY(newton(e, t, q, p, e->point[1]));
  memcpy(v, e->point[1], size);
  return DVI_OK;
}
