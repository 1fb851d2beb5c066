/* The rotation of normal modes, y'' = -lambda y - b, in closed form. */
#include <string.h>

#include "step/split/integrable_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "system/term/term.h"

dvi_status dvi__integrable_find_modes(dvi__integrable *own, dvi_counters *counters)
{
  const size_t n = (size_t)own->n;
  const double zero = 0;
  own->kind = &dvi__integrable_rotation;
  own->shift = DVI_NEW(double, n);
  own->y = DVI_NEW(double, n);
  own->w = DVI_NEW(double, n);
  own->f = DVI_NEW(double, n);
  if (!own->shift || !own->y || !own->w || !own->f) return dvi__fail(DVI_NO_MEMORY, "no memory");
  DVI_TRY(dvi__modes_create(own->fast, DVI__MODES_BLOCK_MOST, counters, &own->modes));
  memset(own->y, 0, n * sizeof(double));
  DVI_TRY(dvi__potentials_gradient(own->evaluator, 1, &zero, own->y, own->f));
  dvi__modes_of_forces(own->modes, own->f, own->shift);
  return DVI_OK;
}

/* Find phi_tau(z) - z, of momenta only where dp is wanted. */
static void rotate(dvi__integrable *own, double tau, const double *q, const double *p, double *dp)
{
  const double *square = dvi__modes_squares(own->modes);
  dvi__modes_of_coordinates(own->modes, q, own->y);
  dvi__modes_of_forces(own->modes, p, own->w);
  for (int k = 0; k < own->n; k++) {
    double c[4];
    dvi__modes_functions(tau * tau * square[k], c);
    const double pull = square[k] * own->y[k] + own->shift[k], w = own->w[k];
    own->y[k] = tau * c[1] * w - tau * tau * c[2] * pull;
    own->w[k] = -tau * c[1] * pull - tau * tau * c[2] * square[k] * w;
  }
  dvi__modes_to_coordinates(own->modes, own->y, own->dq);
  if (dp != NULL) dvi__modes_to_forces(own->modes, own->w, dp);
}

static dvi_status rotation_change(dvi__integrable *own, double tau, const double *q,
                                  const double *p)
{
  rotate(own, tau, q, p, own->dp);
  return DVI_OK;
}

static dvi_status rotation_move(dvi__integrable *own, const dvi__points *at, double *to_q,
                                double *to_p)
{
  double *q = own->z, *p = own->f;
  for (int k = 0; k < at->count; k++) {
    dvi__gather_point(own->n, at->count, k, at->q, q);
    dvi__gather_point(own->n, at->count, k, at->p, p);
    rotate(own, at->tau[k], q, p, to_p != NULL ? own->dp : NULL);
    for (int i = 0; i < own->n; i++) q[i] += own->dq[i];
    dvi__scatter_result(own->n, at->count, k, q, to_q);
    if (to_p == NULL) continue;
    for (int i = 0; i < own->n; i++) p[i] += own->dp[i];
    dvi__scatter_result(own->n, at->count, k, p, to_p);
  }
  return DVI_OK;
}

static dvi_status rotation_pullback(dvi__integrable *own, const dvi__points *at,
                                    const double *lambda_q, const double *lambda_p, double *by_q,
                                    double *by_p)
{
  const double *square = dvi__modes_squares(own->modes);
  (void)lambda_p;
  for (int k = 0; k < at->count; k++) {
    dvi__gather_point(own->n, at->count, k, lambda_q, own->f);
    dvi__modes_of_forces(own->modes, own->f, own->y);
    for (int j = 0; j < own->n; j++) {
      double c[4];
      dvi__modes_functions(at->tau[k] * at->tau[k] * square[j], c);
      own->w[j] = at->tau[k] * c[1] * own->y[j];
      own->y[j] *= c[0];
    }
    dvi__modes_to_forces(own->modes, own->y, own->dp);
    dvi__modes_to_coordinates(own->modes, own->w, own->dq);
    dvi__scatter_result(own->n, at->count, k, own->dp, by_q);
    dvi__scatter_result(own->n, at->count, k, own->dq, by_p);
  }
  return DVI_OK;
}

const dvi__integrable_kind dvi__integrable_rotation = {
    .words = "rotation, the exact motion of quadratic fast potentials",
    .move = rotation_move,
    .change = rotation_change,
    .pullback = rotation_pullback};
