/* Euler's elastica, which is a bent rod, or a car that is steered at unit speed with the least
 * effort. q = (x, y, theta), and by Pontryagin's principle
 *
 *     x' = cos theta, y' = sin theta, theta' = u with the least integral of u^2/2,
 *     H = p_x cos theta + p_y sin theta + p_theta^2/2.
 *
 * H is linear in two momenta, d2H/dp2 is singular, and there is no Lagrangian. p_x = -1 and p_y = 0
 * are the force at the rod's end, p_theta is its curvature. Source: Jurdjevic 1997, Geometric
 * Control Theory, ch. 7. */
#include <math.h>

#include "entry.h"

enum { X, Y, THETA };

static int elastica_hamiltonian(double t, const double *q, const double *p, double *value,
                                void *user)
{
  (void)t, (void)user;
  *value = p[X] * cos(q[THETA]) + p[Y] * sin(q[THETA]) + p[THETA] * p[THETA] / 2;
  return 0;
}

static int elastica_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                             void *user)
{
  const double c = cos(q[THETA]), s = sin(q[THETA]);
  (void)t, (void)user;
  H_q[X] = H_q[Y] = 0;
  H_q[THETA] = p[Y] * c - p[X] * s;
  H_p[X] = c;
  H_p[Y] = s;
  H_p[THETA] = p[THETA];
  return 0;
}

static int elastica_hessian(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                            double *H_pp, void *user)
{
  const double c = cos(q[THETA]), s = sin(q[THETA]);
  (void)t, (void)user;
  H_qq[0] = -p[X] * c - p[Y] * s;
  H_qp[0] = -s;
  H_qp[1] = c;
  H_pp[0] = 1;
  return 0;
}

static int elastica_along_x(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  xi[X] = 1;
  xi[Y] = xi[THETA] = 0;
  return 0;
}

static int elastica_along_y(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  xi[Y] = 1;
  xi[X] = xi[THETA] = 0;
  return 0;
}

static int elastica_turn(const double *q, double *xi, void *user)
{
  (void)user;
  xi[X] = -q[Y];
  xi[Y] = q[X];
  xi[THETA] = 1;
  return 0;
}

/* ---- the solution ---- */

enum { MEANS = 8 };

/* Compute sin and cos of the amplitude am(u, k) of Jacobi's functions, and E(am(u, k), k), by
 * arithmetic and geometric means (Abramowitz and Stegun 1964, 16.4 and 17.6). */
static void elastica_jacobi(double u, double k, double *sn, double *cn, double *E)
{
  double a[MEANS + 1] = {1}, c[MEANS + 1] = {k}, b = sqrt((1 - k) * (1 + k)), lost = k * k / 2;
  for (int m = 0; m < MEANS; m++) {
    a[m + 1] = (a[m] + b) / 2;
    c[m + 1] = (a[m] - b) / 2;
    b = sqrt(a[m] * b);
    lost += ldexp(c[m + 1] * c[m + 1], m);
  }
  double phi = ldexp(a[MEANS] * u, MEANS);
  *E = u * (1 - lost);
  for (int m = MEANS; m > 0; m--) {
    *E += c[m] * sin(phi);
    phi = (phi + asin(c[m] * sin(phi) / a[m])) / 2;
  }
  *sn = sin(phi);
  *cn = cos(phi);
}

/* Compute the solution. theta'' = -sin theta is a pendulum's equation, x' = 1 - 2 sin^2(theta/2),
 * and p_theta + y is conserved. */
static int elastica_exact(const problem *made, double t, double *q, double *p)
{
  const double k = made->p[THETA] / 2;
  double sn, cn, E;
  elastica_jacobi(t, k, &sn, &cn, &E);
  q[X] = 2 * E - t;
  q[Y] = 2 * k * (1 - cn);
  q[THETA] = 2 * asin(k * sn);
  p[X] = -1;
  p[Y] = 0;
  p[THETA] = 2 * k * cn;
  return 0;
}

/* ---- the problem ---- */

static const int theta_start[] = {0, 0, 0, 1}, theta_row[] = {THETA};
static const int mixed_start[] = {0, 1, 2, 2}, mixed_row[] = {THETA, THETA};

static dvi_status elastica_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 3, 1);
  if (status != DVI_OK) return status;
  problem_label(made, X, "x");
  problem_label(made, Y, "y");
  problem_label(made, THETA, "theta");
  made->p[X] = -1;
  made->p[THETA] = setting[0];

  const dvi_hamiltonian hamiltonian = {.value = elastica_hamiltonian,
                                       .gradient = elastica_gradient,
                                       .hessian = elastica_hessian,
                                       .qq = {theta_start, theta_row},
                                       .qp = {mixed_start, mixed_row},
                                       .pp = {theta_start, theta_row}};
  const dvi_symmetry symmetries[] = {{.name = "force_x", .generator = elastica_along_x},
                                     {.name = "force_y", .generator = elastica_along_y},
                                     {.name = "moment", .generator = elastica_turn}};
  const dvi_system_terms terms = {.dimension = 3,
                                  .autonomous = 1,
                                  .hamiltonian = &hamiltonian,
                                  .symmetries = symmetries,
                                  .symmetry_count = 3};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "kappa",
     .value = 1.0,
     .least = 0.01,
     .most = 1.99,
     .start_only = 1,
     .help = "the curvature at the start, 0.01 to 1.99; of 1.8178 it is a figure of eight"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {1.410139291229121, 1.2698649654510866, 1.0046145586725654};
static const double digits_p[] = {-1, 0, -0.26986496545108658};

const problem_entry problem_entry_elastica = {
    .name = "elastica",
    .summary = "a bent rod, or a car steered with least effort: a degenerate Hamiltonian, exact "
               "solution known",
    .parameters = parameters,
    .make = elastica_make,
    .exact = elastica_exact,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.2,
    .order_t_end = 2.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
