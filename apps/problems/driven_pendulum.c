/* A pendulum in a plane whose pivot swings to and fro: x = a sin(omega t), the angle measured from the top.
 *
 *     L = v^2/2 + a omega cos(omega t) v cos q - cos q        (without the pivot's own energy, which moves nothing)
 *
 * A general Lagrangian that depends on time, and its momentum p = v + a omega cos(omega t) cos q, too. */
#include <math.h>

#include "entry.h"

typedef struct drive {
  double speed, omega; /* a omega */
} drive;

static int value(int count, const double *t, const double *q, const double *v, double *L, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++) L[k] = 0.5 * v[k] * v[k] + (own.speed * cos(own.omega * t[k]) * v[k] - 1.0) * cos(q[k]);
  return 0;
}

static int rate(int count, const double *t, const double *q, const double *v, double *L_t, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++) L_t[k] = -own.omega * own.speed * sin(own.omega * t[k]) * v[k] * cos(q[k]);
  return 0;
}

static int gradient(int count, const double *t, const double *q, const double *v, double *L_q, double *L_v, void *user)
{
  const drive own = *(const drive *)user;
  for (int k = 0; k < count; k++) {
    const double pivot = own.speed * cos(own.omega * t[k]);
    L_q[k] = (1.0 - pivot * v[k]) * sin(q[k]);
    L_v[k] = v[k] + pivot * cos(q[k]);
  }
  return 0;
}

static int hessian(int count, const double *t, const double *q, const double *v, double *L_qq, double *L_qv, double *L_vv,
                   void *user)
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

static dvi_status make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 1, sizeof(drive));
  if (status != DVI_OK) return status;
  drive *own = made->parameters;
  *own = (drive){setting[0] * setting[1], setting[1]};
  problem_label(made, 0, "q");
  made->q[0] = 2.0;

  const dvi_lagrangian lagrangian = {
      .value_batch = value, .gradient_batch = gradient, .hessian_batch = hessian, .rate_batch = rate, .user = own};
  const dvi_system_terms terms = {.dimension = 1, .lagrangian = &lagrangian};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "a", .value = 0.25, .least = 0.0, .most = 1e3, .help = "how far the pivot swings, not negative"},
    {.name = "omega", .value = 2.0, .least = 1e-3, .most = 1e3, .help = "the angular frequency of the pivot, 1e-3 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {5.1591454283311110};
static const double digits_p[] = {-0.50718242515947013};

const problem_entry problem_entry_driven_pendulum = {
    .name = "driven-pendulum",
    .summary = "a pendulum whose pivot swings; a Lagrangian that depends on time",
    .parameters = parameters,
    .make = make,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
