/* A pendulum in a plane whose pivot swings to and fro by x = a sin(omega t), with the angle
 * measured from the top.
 *
 *     L = v^2/2 + a omega cos(omega t) v cos q - cos q
 *     (without the pivot's own energy, which moves nothing)
 *
 * The general Lagrangian depends on time, and so does its momentum p = v + a omega cos(omega t) cos
 * q. */
#include <dvi/taylor.h>
#include <math.h>

#include "entry.h"

typedef struct drive {
  double speed, omega; /* speed is a omega */
} drive;

static int driven_pendulum_lagrangian(int count, const double *t, const double *q, const double *v,
                                      double *L, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++)
    L[k] = 0.5 * v[k] * v[k] + (own.speed * cos(own.omega * t[k]) * v[k] - 1.0) * cos(q[k]);
  return 0;
}

static int driven_pendulum_rate(int count, const double *t, const double *q, const double *v,
                                double *L_t, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++)
    L_t[k] = -own.omega * own.speed * sin(own.omega * t[k]) * v[k] * cos(q[k]);
  return 0;
}

static int driven_pendulum_gradient(int count, const double *t, const double *q, const double *v,
                                    double *L_q, double *L_v, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++) {
    const double pivot = own.speed * cos(own.omega * t[k]);
    L_q[k] = (1.0 - pivot * v[k]) * sin(q[k]);
    L_v[k] = v[k] + pivot * cos(q[k]);
  }
  return 0;
}

static int driven_pendulum_hessian(int count, const double *t, const double *q, const double *v,
                                   double *L_qq, double *L_qv, double *L_vv, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++) {
    const double pivot = own.speed * cos(own.omega * t[k]);
    L_qq[k] = (1.0 - pivot * v[k]) * cos(q[k]);
    L_qv[k] = -pivot * sin(q[k]);
    L_vv[k] = 1.0;
  }
  return 0;
}

/* Evaluate L and its derivatives along a curve, on which t is a series, too. */
static int driven_pendulum_taylor(int degree, const double *t, const double *q, const double *v,
                                  double *L, double *L_q, double *L_v, double *L_qq, double *L_qv,
                                  double *L_vv, void *user)
{
  const drive own = *(const drive *)user;
  double phase[DVI_TAYLOR_MAX + 1], unwanted[DVI_TAYLOR_MAX + 1], pivot[DVI_TAYLOR_MAX + 1],
      factor[DVI_TAYLOR_MAX + 1];
  double sine[DVI_TAYLOR_MAX + 1], cosine[DVI_TAYLOR_MAX + 1];
  dvi_taylor_combine(degree, own.omega, t, 0.0, t, phase);
  dvi_taylor_sin_cos(degree, phase, unwanted, pivot);
  for (int k = 0; k <= degree; k++) pivot[k] *= own.speed;
  dvi_taylor_sin_cos(degree, q, sine, cosine);
  for (int k = 0; k <= degree; k++) factor[k] = (k == 0) - dvi_taylor_product(k, pivot, v);
  for (int k = 0; k <= degree; k++) {
    if (L) L[k] = 0.5 * dvi_taylor_product(k, v, v) - dvi_taylor_product(k, factor, cosine);
    if (L_q) L_q[k] = dvi_taylor_product(k, factor, sine);
    if (L_v) L_v[k] = v[k] + dvi_taylor_product(k, pivot, cosine);
    if (L_qq) L_qq[k] = dvi_taylor_product(k, factor, cosine);
    if (L_qv) L_qv[k] = -dvi_taylor_product(k, pivot, sine);
    if (L_vv) L_vv[k] = k == 0;
  }
  return 0;
}

static dvi_status driven_pendulum_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 1, sizeof(drive));
  if (status != DVI_OK) return status;
  drive *own = made->parameters;
  *own = (drive){.speed = setting[0] * setting[1], .omega = setting[1]};
  problem_label(made, 0, "q");
  made->q[0] = 2.0;

  const dvi_lagrangian lagrangian = {.value_batch = driven_pendulum_lagrangian,
                                     .gradient_batch = driven_pendulum_gradient,
                                     .hessian_batch = driven_pendulum_hessian,
                                     .rate_batch = driven_pendulum_rate,
                                     .user = own,
                                     .taylor = driven_pendulum_taylor};
  const dvi_system_terms terms = {.dimension = 1, .lagrangian = &lagrangian};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "a",
     .value = 0.25,
     .least = 0.0,
     .most = 1e3,
     .help = "how far the pivot swings, not negative"},
    {.name = "omega",
     .value = 2.0,
     .least = 1e-3,
     .most = 1e3,
     .help = "the angular frequency of the pivot, 1e-3 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {5.1591454283311110};
static const double digits_p[] = {-0.50718242515947013};

const problem_entry problem_entry_driven_pendulum = {
    .name = "driven-pendulum",
    .summary = "a pendulum whose pivot swings; a Lagrangian that depends on time",
    .parameters = parameters,
    .make = driven_pendulum_make,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
