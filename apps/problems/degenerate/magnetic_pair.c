/* A mass on a spring and a charge without mass in the field S = 1 + y^2 + z^2, which meet in the
 * vector potential y/2 of the first. The system is half degenerate.
 *
 *     L = x'^2/2 + x' y/2 - z (1 + y^2 + z^2/3) y' - x^2/2 - cos y - sin z,
 *     H = (p_x - y/2)^2/2 + x^2/2 + cos y + sin z,
 *     phi = p_y + z (1 + y^2 + z^2/3) and p_z,  {phi_1, phi_2} = S.
 *
 * The charge is that of Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

enum { X, Y, Z };

static int magnetic_pair_hamiltonian(double t, const double *q, const double *p, double *value,
                                     void *user)
{
  const double u = p[X] - q[Y] / 2;
  (void)t, (void)user;
  *value = (u * u + q[X] * q[X]) / 2 + cos(q[Y]) + sin(q[Z]);
  return 0;
}

static int magnetic_pair_gradient(double t, const double *q, const double *p, double *H_q,
                                  double *H_p, void *user)
{
  const double u = p[X] - q[Y] / 2;
  (void)t, (void)user;
  H_q[X] = q[X];
  H_q[Y] = -u / 2 - sin(q[Y]);
  H_q[Z] = cos(q[Z]);
  H_p[X] = u;
  H_p[Y] = H_p[Z] = 0;
  return 0;
}

static int magnetic_pair_hessian(double t, const double *q, const double *p, double *H_qq,
                                 double *H_qp, double *H_pp, void *user)
{
  (void)t, (void)p, (void)user;
  H_qq[X] = 1;
  H_qq[Y] = 0.25 - cos(q[Y]);
  H_qq[Z] = -sin(q[Z]);
  H_qp[0] = -0.5;
  H_pp[0] = 1;
  return 0;
}

static int magnetic_pair_constraint(const double *q, const double *p, double *value, void *user)
{
  (void)user;
  value[0] = p[Y] + q[Z] * (1 + q[Y] * q[Y] + q[Z] * q[Z] / 3);
  value[1] = p[Z];
  return 0;
}

/* Evaluate the gradient of the first constraint in y, z and p_y, and of the second one in p_z. */
static int magnetic_pair_constraint_gradient(const double *q, const double *p, double *phi_z,
                                             void *user)
{
  (void)p, (void)user;
  phi_z[0] = 2 * q[Y] * q[Z];
  phi_z[1] = 1 + q[Y] * q[Y] + q[Z] * q[Z];
  phi_z[2] = phi_z[3] = 1;
  return 0;
}

static int magnetic_pair_constraint_hessian(const double *q, const double *p, const double *w,
                                            double *qq, double *qp, double *pp, void *user)
{
  (void)p, (void)qp, (void)pp, (void)user;
  qq[0] = qq[3] = 2 * q[Z] * w[0];
  qq[1] = qq[2] = 2 * q[Y] * w[0];
  return 0;
}

static const int none[] = {0, 0, 0, 0}, diagonal_start[] = {0, 1, 2, 3}, diagonal_row[] = {0, 1, 2};
static const int first_start[] = {0, 1, 1, 1}, x_row[] = {X}, y_row[] = {Y};
static const int phi_start[] = {0, 3, 4}, phi_row[] = {Y, Z, 3 + Y, 3 + Z};
static const int curved_start[] = {0, 0, 2, 4}, curved_row[] = {Y, Z, Y, Z};

static dvi_status magnetic_pair_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 3, 1);
  if (status != DVI_OK) return status;
  (void)setting;
  problem_label(made, X, "x");
  problem_label(made, Y, "y");
  problem_label(made, Z, "z");
  made->q[X] = 0.5;
  made->q[Y] = 1;
  made->q[Z] = 1;
  made->p[X] = 0.5;
  made->p[Y] = -7.0 / 3.0;
  made->p[Z] = 0;

  const dvi_hamiltonian hamiltonian = {.value = magnetic_pair_hamiltonian,
                                       .gradient = magnetic_pair_gradient,
                                       .hessian = magnetic_pair_hessian,
                                       .qq = {diagonal_start, diagonal_row},
                                       .qp = {first_start, y_row},
                                       .pp = {first_start, x_row}};
  const dvi_constraint constraint = {.count = 2,
                                     .value = magnetic_pair_constraint,
                                     .gradient = magnetic_pair_constraint_gradient,
                                     .hessian = magnetic_pair_constraint_hessian,
                                     .gradients = {phi_start, phi_row},
                                     .qq = {curved_start, curved_row},
                                     .qp = {none, NULL},
                                     .pp = {none, NULL}};
  const dvi_system_terms terms = {
      .dimension = 3, .autonomous = 1, .hamiltonian = &hamiltonian, .constraint = &constraint};
  return problem_system(made, &terms);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.019223868249110727, 0.24508559618908332, 0.53652043520071755};
static const double digits_p[] = {-0.10250617557092001, -0.62022746390801096, 0};

const problem_entry problem_entry_magnetic_pair = {
    .name = "magnetic-pair",
    .summary = "a mass on a spring and a charge without mass in a magnetic field; half degenerate",
    .make = magnetic_pair_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.2,
    .order_t_end = 2.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
