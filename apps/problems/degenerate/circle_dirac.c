/* A pendulum as a particle on a circle. H = |p|^2/2 + y in the plane, and phi = (|q|^2 - 1)/2 and
 * q.p are of second class, {phi_1, phi_2} = |q|^2. Source: Dirac 1964. */
#include "entry.h"

static int circle_hamiltonian(double t, const double *q, const double *p, double *value, void *user)
{
  (void)t, (void)user;
  *value = (p[0] * p[0] + p[1] * p[1]) / 2 + q[1];
  return 0;
}

static int circle_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                           void *user)
{
  (void)t, (void)q, (void)user;
  H_q[0] = 0;
  H_q[1] = 1;
  H_p[0] = p[0];
  H_p[1] = p[1];
  return 0;
}

static int circle_hessian(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                          double *H_pp, void *user)
{
  (void)t, (void)q, (void)p, (void)H_qq, (void)H_qp, (void)user;
  H_pp[0] = H_pp[1] = 1;
  return 0;
}

static int circle_constraint(const double *q, const double *p, double *value, void *user)
{
  (void)user;
  value[0] = (q[0] * q[0] + q[1] * q[1] - 1) / 2;
  value[1] = q[0] * p[0] + q[1] * p[1];
  return 0;
}

/* Evaluate the gradient of the first constraint in q, and of the second one in q and p. */
static int circle_constraint_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  (void)user;
  for (int i = 0; i < 2; i++) {
    phi_z[i] = phi_z[4 + i] = q[i];
    phi_z[2 + i] = p[i];
  }
  return 0;
}

static int circle_constraint_hessian(const double *q, const double *p, const double *w, double *qq,
                                     double *qp, double *pp, void *user)
{
  (void)q, (void)p, (void)pp, (void)user;
  qq[0] = qq[1] = w[0];
  qp[0] = qp[1] = w[1];
  return 0;
}

static const int none_start[] = {0, 0, 0}, diagonal_start[] = {0, 1, 2}, diagonal_row[] = {0, 1};
static const int phi_start[] = {0, 2, 6}, phi_row[] = {0, 1, 0, 1, 2, 3};

static dvi_status circle_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 2, 1);
  if (status != DVI_OK) return status;
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  made->q[0] = 0.8;
  made->q[1] = 0.6;
  made->p[0] = 0.6 * setting[0];
  made->p[1] = -0.8 * setting[0];

  const dvi_pattern none = {none_start, NULL}, diagonal = {diagonal_start, diagonal_row};
  const dvi_hamiltonian hamiltonian = {.value = circle_hamiltonian,
                                       .gradient = circle_gradient,
                                       .hessian = circle_hessian,
                                       .qq = none,
                                       .qp = none,
                                       .pp = diagonal};
  const dvi_constraint constraint = {.count = 2,
                                     .value = circle_constraint,
                                     .gradient = circle_constraint_gradient,
                                     .hessian = circle_constraint_hessian,
                                     .gradients = {phi_start, phi_row},
                                     .qq = diagonal,
                                     .qp = diagonal,
                                     .pp = none};
  const dvi_system_terms terms = {
      .dimension = 2, .autonomous = 1, .hamiltonian = &hamiltonian, .constraint = &constraint};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "speed",
     .value = 0.5,
     .least = -10,
     .most = 10,
     .start_only = 1,
     .help = "that of the start at (0.8,0.6), clockwise, -10 to 10"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.45745352351439067, -0.88923353165761176};
static const double digits_p[] = {-1.5977690746194394, 0.82194954072921283};

const problem_entry problem_entry_circle_dirac = {
    .name = "circle-dirac",
    .summary = "a pendulum as a particle held on a circle; Hamiltonian with two constraints",
    .parameters = parameters,
    .make = circle_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.2,
    .order_t_end = 2.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
