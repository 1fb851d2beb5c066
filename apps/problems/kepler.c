/* The planar Kepler problem, L = |v|^2/2 + 1/|q|, from the pericentre of an orbit with semi-major
 * axis 1. */
#include <dvi/taylor.h>
#include <float.h>
#include <math.h>

#include "entry.h"

static int kepler_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const double *restrict x = q, *restrict y = q + count;
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = -1.0 / sqrt(x[k] * x[k] + y[k] * y[k]);
  return 0;
}

/* Compute the gradient at no more points than a tile has. */
PROBLEM_INLINE void kepler_gradient_at(const int points, const double *restrict x,
                                       const double *restrict y, double *restrict V_x,
                                       double *restrict V_y)
{
  double r[PROBLEM_TILE];
  for (int k = 0; k < points; k++) r[k] = x[k] * x[k] + y[k] * y[k];
  problem_inverse_cubes(points, r);
  for (int k = 0; k < points; k++) {
    V_x[k] = x[k] * r[k];
    V_y[k] = y[k] * r[k];
  }
}

PROBLEM_LANES static int kepler_gradient(int count, const double *t, const double *q, double *V_q,
                                         void *user)
{
  int k = 0;
  (void)t, (void)user;
  for (; k + 8 <= count; k += 8)
    kepler_gradient_at(8, q + k, q + count + k, V_q + k, V_q + count + k);
  for (; k < count; k++) kepler_gradient_at(1, q + k, q + count + k, V_q + k, V_q + count + k);
  return 0;
}

static int kepler_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const double *restrict x = q, *restrict y = q + count;
  double *restrict V_xx = V_qq, *restrict V_yx = V_qq + count, *restrict V_xy = V_qq + 2 * count,
                   *restrict V_yy = V_qq + 3 * count;
  (void)t, (void)user;
  for (int k = 0; k < count; k++) {
    const double r2 = x[k] * x[k] + y[k] * y[k];
    const double inverse = 1.0 / (r2 * sqrt(r2)), curvature = 3.0 * inverse / r2;
    V_xx[k] = inverse - curvature * x[k] * x[k];
    V_yx[k] = -curvature * x[k] * y[k];
    V_xy[k] = V_yx[k];
    V_yy[k] = inverse - curvature * y[k] * y[k];
  }
  return 0;
}

/* Evaluate the Hessian's series for kepler_taylor. cube is r^-3. */
static void kepler_series_hessian(int degree, double q_i[2][DVI_TAYLOR_MAX + 1],
                                  const double *square, const double *cube, double *V_qq)
{
  double fifth[DVI_TAYLOR_MAX + 1], slope[DVI_TAYLOR_MAX + 1], entry[DVI_TAYLOR_MAX + 1];
  dvi_taylor_divide(degree, cube, square, fifth);
  for (int i = 0; i < 2; i++) {
    dvi_taylor_multiply(degree, q_i[i], fifth, slope);
    for (int j = 0; j < 2; j++) {
      dvi_taylor_multiply(degree, slope, q_i[j], entry);
      for (int k = 0; k <= degree; k++)
        V_qq[4 * k + 2 * i + j] = (i == j ? cube[k] : 0.0) - 3.0 * entry[k];
    }
  }
}

/* Evaluate V = -1/r along a curve, with V_x = x/r^3 and V_xy = -3 x y/r^5 (+ 1/r^3 on the
 * diagonal). */
static int kepler_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                         double *V_qq, void *user)
{
  double q_i[2][DVI_TAYLOR_MAX + 1], square[DVI_TAYLOR_MAX + 1], power[DVI_TAYLOR_MAX + 1],
      product[DVI_TAYLOR_MAX + 1];
  (void)t, (void)user;
  for (int i = 0; i < 2; i++) dvi_taylor_get(degree, 2, q, i, q_i[i]);
  dvi_taylor_multiply(degree, q_i[0], q_i[0], square);
  dvi_taylor_add_product(degree, q_i[1], q_i[1], square);
  dvi_taylor_power(degree, square, -0.5, power);
  dvi_taylor_put(degree, 1, power, -1.0, 0, V);
  dvi_taylor_power(degree, square, -1.5, power);
  for (int i = 0; i < 2; i++) {
    dvi_taylor_multiply(degree, q_i[i], power, product);
    dvi_taylor_put(degree, 2, product, 1.0, i, V_q);
  }
  if (V_qq) kepler_series_hessian(degree, q_i, square, power, V_qq);
  return 0;
}

static int kepler_rotation(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  return 0;
}

/* Compute the Laplace-Runge-Lenz vector p x (q x p) - q/|q|, which points to the pericentre and has
 * length e. */
static int kepler_laplace_x(double t, const double *q, const double *p, double *I, void *user)
{
  (void)t, (void)user;
  *I = p[1] * (q[0] * p[1] - q[1] * p[0]) - q[0] / hypot(q[0], q[1]);
  return 0;
}

static int kepler_laplace_y(double t, const double *q, const double *p, double *I, void *user)
{
  (void)t, (void)user;
  *I = -p[0] * (q[0] * p[1] - q[1] * p[0]) - q[1] / hypot(q[0], q[1]);
  return 0;
}

/* Compute E - sin E without cancellation. */
static double minus_sine(double E)
{
  if (fabs(E) > 1.0) return E - sin(E);
  double term = E, sum = 0.0;
  for (int k = 3; k <= 21; k += 2) {
    term *= -E * E / (k * (k - 1));
    sum -= term;
  }
  return sum;
}

/* Return the mean anomaly t mod 2 pi, in [-pi, pi]. 2 pi is subtracted in two parts, the first one
 * exactly, because t may be millions of periods. */
static double mean_anomaly(double t)
{
  const double period = 6.2831853071795865, period_rest = 2.4492935982947064e-16;
  const double turns = nearbyint(t / period);
  return fma(-turns, period, t) - turns * period_rest;
}

/* Solve Kepler's equation E - e sin E = M. On [0, pi] the left side rises and is convex, so that
 * Newton's method comes down to the root from any point to the right of it, such as M + e or pi.
 * The iteration ends when it no longer comes down. */
static double eccentric_anomaly(double e, double M)
{
  const double target = fabs(M);
  double E, next = fmin(target + e, 3.14159265358979324);
  do {
    E = next;
    const double sine = sin(0.5 * E), slope = (1.0 - e) + 2.0 * e * sine * sine;
    next = E - ((1.0 - e) * E + e * minus_sine(E) - target) / slope;
  } while (next < E);
  return copysign(E, M);
}

static int kepler_exact(const problem *made, double t, double *q, double *p)
{
  const double e = *(const double *)made->parameters;
  if (!isfinite(t)) return -1;
  const double E = eccentric_anomaly(e, mean_anomaly(t));
  const double s = sin(0.5 * E), b = sqrt((1.0 - e) * (1.0 + e));
  const double r = (1.0 - e) + 2.0 * e * s * s;
  q[0] = (1.0 - e) - 2.0 * s * s;
  q[1] = b * sin(E);
  p[0] = -sin(E) / r;
  p[1] = b * cos(E) / r;
  return 0;
}

static dvi_status kepler_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 2, sizeof(double));
  if (status != DVI_OK) return status;
  double *e = made->parameters;
  *e = setting[0];
  made->bodies = 1;
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  made->q[0] = 1.0 - *e;
  made->v[1] = sqrt((1.0 + *e) / (1.0 - *e));

  const dvi_potential gravity = {.name = "gravity",
                                 .value_batch = kepler_potential,
                                 .gradient_batch = kepler_gradient,
                                 .hessian_batch = kepler_hessian,
                                 .taylor = kepler_taylor};
  const dvi_symmetry symmetry = {.name = "angular_momentum", .generator = kepler_rotation};
  const dvi_invariant laplace[2] = {{.name = "laplace_x", .value = kepler_laplace_x},
                                    {.name = "laplace_y", .value = kepler_laplace_y}};
  const dvi_system_terms terms = {.dimension = 2,
                                  .mass = {.scalar = 1.0},
                                  .potentials = &gravity,
                                  .potential_count = 1,
                                  .symmetries = &symmetry,
                                  .symmetry_count = 1,
                                  .invariants = laplace,
                                  .invariant_count = 2,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "e",
     .value = 0.6,
     .least = 0.0,
     .most = 1.0 - 0.5 * DBL_EPSILON,
     .start_only = 1,
     .help = "the eccentricity, 0 <= e < 1"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-1.5350235919098137, -0.28366840649978086};
static const double digits_p[] = {0.22715073207749834, -0.47918775820321957};

const problem_entry problem_entry_kepler = {
    .name = "kepler",
    .summary = "two bodies in a plane, period 2 pi, eccentricity e; exact solution known",
    .parameters = parameters,
    .make = kepler_make,
    .exact = kepler_exact,
    .h = 0.05,
    .t_end = 100.0,
    .order_h = 0.02,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
