/* One harmonic oscillator, L = v^2/2 - k q^2/2, with one-point callbacks. */
#include <float.h>
#include <math.h>

#include "entry.h"

static int oscillator_potential(double t, const double *q, double *V, void *user)
{
  const double k = *(const double *)user;
  (void)t;
  *V = 0.5 * k * q[0] * q[0];
  return 0;
}

static int oscillator_gradient(double t, const double *q, double *V_q, void *user)
{
  const double k = *(const double *)user;
  (void)t;
  V_q[0] = k * q[0];
  return 0;
}

static int oscillator_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q;
  V_qq[0] = *(const double *)user;
  return 0;
}

/* Evaluate V = k q^2/2 along a curve. */
static int oscillator_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                             double *V_qq, void *user)
{
  (void)t;
  problem_spring_taylor(*(const double *)user, degree, q, V, V_q, V_qq);
  return 0;
}

/* Compute q = q0 cos(w t), p = -w q0 sin(w t), w^2 = k. */
static int oscillator_exact(const problem *made, double t, double *q, double *p)
{
  const double k = *(const double *)made->parameters;
  double c, s;
  problem_oscillation(k, t, &c, &s);
  q[0] = made->q[0] * c;
  p[0] = -sqrt(k) * made->q[0] * s;
  return 0;
}

static dvi_status oscillator_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 1, sizeof(double));
  if (status != DVI_OK) return status;
  double *k = made->parameters;
  *k = setting[0];
  problem_label(made, 0, "q");
  made->q[0] = 0.5;

  const dvi_potential spring = {.name = "spring",
                                .value = oscillator_potential,
                                .gradient = oscillator_gradient,
                                .hessian = oscillator_hessian,
                                .user = k,
                                .taylor = oscillator_taylor};
  return problem_potential_system(made, 1, &spring);
}

static const problem_parameter parameters[] = {
    {.name = "k",
     .value = 0.5,
     .least = DBL_MIN,
     .most = DBL_MAX,
     .help = "the stiffness of the spring, positive"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.34913449102311928};
static const double digits_p[] = {0.25308605964970438};

const problem_entry problem_entry_oscillator = {
    .name = "oscillator",
    .summary = "a harmonic oscillator; exact solution known",
    .parameters = parameters,
    .make = oscillator_make,
    .exact = oscillator_exact,
    .h = 0.1,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 50.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
