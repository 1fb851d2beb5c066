/* The Henon-Heiles system, V = (x^2+y^2)/2 + lambda (x^2 y - y^3/3). It models a star in the
 * meridian plane of a galaxy. */
#include <dvi/taylor.h>
#include <float.h>

#include "entry.h"

static int henon_heiles_potential(int count, const double *t, const double *q, double *V,
                                  void *user)
{
  const double lambda = *(const double *)user;
  const double *restrict x = q, *restrict y = q + count;
  (void)t;
  for (int k = 0; k < count; k++)
    V[k] = 0.5 * (x[k] * x[k] + y[k] * y[k]) + lambda * y[k] * (x[k] * x[k] - y[k] * y[k] / 3.0);
  return 0;
}

static int henon_heiles_gradient(int count, const double *t, const double *q, double *V_q,
                                 void *user)
{
  const double lambda = *(const double *)user;
  const double *restrict x = q, *restrict y = q + count;
  double *restrict V_x = V_q, *restrict V_y = V_q + count;
  (void)t;
  for (int k = 0; k < count; k++) {
    V_x[k] = x[k] + 2.0 * lambda * x[k] * y[k];
    V_y[k] = y[k] + lambda * (x[k] * x[k] - y[k] * y[k]);
  }
  return 0;
}

static int henon_heiles_hessian(int count, const double *t, const double *q, double *V_qq,
                                void *user)
{
  const double lambda = *(const double *)user;
  const double *restrict x = q, *restrict y = q + count;
  double *restrict V_xx = V_qq, *restrict V_yx = V_qq + count, *restrict V_xy = V_qq + 2 * count,
                   *restrict V_yy = V_qq + 3 * count;
  (void)t;
  for (int k = 0; k < count; k++) {
    V_xx[k] = 1.0 + 2.0 * lambda * y[k];
    V_yx[k] = 2.0 * lambda * x[k];
    V_xy[k] = V_yx[k];
    V_yy[k] = 1.0 - 2.0 * lambda * y[k];
  }
  return 0;
}

/* Evaluate V and its derivatives along a curve. */
static int henon_heiles_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                               double *V_qq, void *user)
{
  const double lambda = *(const double *)user;
  double x[DVI_TAYLOR_MAX + 1], y[DVI_TAYLOR_MAX + 1], xx[DVI_TAYLOR_MAX + 1],
      xy[DVI_TAYLOR_MAX + 1], yy[DVI_TAYLOR_MAX + 1];
  (void)t;
  dvi_taylor_get(degree, 2, q, 0, x);
  dvi_taylor_get(degree, 2, q, 1, y);
  dvi_taylor_multiply(degree, x, x, xx);
  dvi_taylor_multiply(degree, x, y, xy);
  dvi_taylor_multiply(degree, y, y, yy);
  for (int k = 0; k <= degree; k++) {
    if (V)
      V[k] = 0.5 * (xx[k] + yy[k]) +
             lambda * (dvi_taylor_product(k, xx, y) - dvi_taylor_product(k, yy, y) / 3.0);
    if (V_q) {
      V_q[2 * k] = x[k] + 2.0 * lambda * xy[k];
      V_q[2 * k + 1] = y[k] + lambda * (xx[k] - yy[k]);
    }
    if (V_qq) {
      V_qq[4 * k] = (k == 0) + 2.0 * lambda * y[k];
      V_qq[4 * k + 1] = V_qq[4 * k + 2] = 2.0 * lambda * x[k];
      V_qq[4 * k + 3] = (k == 0) - 2.0 * lambda * y[k];
    }
  }
  return 0;
}

static dvi_status henon_heiles_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 2, sizeof(double));
  if (status != DVI_OK) return status;
  double *lambda = made->parameters;
  *lambda = setting[0];
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  made->q[0] = made->q[1] = 0.2;
  made->v[0] = made->v[1] = 0.3;

  const dvi_potential well = {.name = "well",
                              .value_batch = henon_heiles_potential,
                              .gradient_batch = henon_heiles_gradient,
                              .hessian_batch = henon_heiles_hessian,
                              .user = lambda,
                              .taylor = henon_heiles_taylor};
  return problem_potential_system(made, 1, &well);
}

static const problem_parameter parameters[] = {
    {.name = "lambda",
     .value = 1.0,
     .least = -1e100,
     .most = 1e100,
     .help = "the strength of the cubic terms, any number"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.0060364422011938717, 0.14151745647242115};
static const double digits_p[] = {0.13578508570275227, 0.48378156160197641};

const problem_entry problem_entry_henon_heiles = {
    .name = "henon-heiles",
    .summary = "a star in a galaxy's meridian plane; regular and chaotic orbits",
    .parameters = parameters,
    .make = henon_heiles_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 20.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
