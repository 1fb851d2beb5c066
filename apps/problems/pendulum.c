/* A pendulum in a plane, L = v^2/2 - cos q. The angle is measured from the top, so that a start
 * near q = 0 stays near the separatrix. */
#include <dvi/taylor.h>
#include <float.h>
#include <math.h>

#include "entry.h"

static int pendulum_potential(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = cos(q[k]);
  return 0;
}

static int pendulum_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V_q[k] = -sin(q[k]);
  return 0;
}

static int pendulum_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V_qq[k] = -cos(q[k]);
  return 0;
}

/* Evaluate V = cos q along a curve. */
static int pendulum_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                           double *V_qq, void *user)
{
  double sine[DVI_TAYLOR_MAX + 1], cosine[DVI_TAYLOR_MAX + 1];
  (void)t, (void)user;
  dvi_taylor_sin_cos(degree, q, sine, cosine);
  dvi_taylor_put(degree, 1, cosine, 1.0, 0, V);
  dvi_taylor_put(degree, 1, sine, -1.0, 0, V_q);
  dvi_taylor_put(degree, 1, cosine, -1.0, 0, V_qq);
  return 0;
}

static dvi_status pendulum_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 1, 1);
  if (status != DVI_OK) return status;
  problem_label(made, 0, "q");
  made->q[0] = setting[0];

  const dvi_potential gravity = {.name = "gravity",
                                 .value_batch = pendulum_potential,
                                 .gradient_batch = pendulum_gradient,
                                 .hessian_batch = pendulum_hessian,
                                 .taylor = pendulum_taylor};
  return problem_potential_system(made, 1, &gravity);
}

static const problem_parameter parameters[] = {
    {.name = "q0",
     .value = 1.1592794807274085998, /* acos 0.4 */
     .least = -DBL_MAX,
     .most = DBL_MAX,
     .start_only = 1,
     .help = "the angle from the top at which it starts at rest, any number; 1e-3 is hard"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {4.8592812392772634};
static const double digits_p[] = {0.71222949776755343};

const problem_entry problem_entry_pendulum = {
    .name = "pendulum",
    .summary = "a plane pendulum, angle from the top",
    .parameters = parameters,
    .make = pendulum_make,
    .h = 0.1,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 20.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
