/* The guiding centre of a charged particle in the field 1 + r^2 along z.
 *
 *     alpha = (-y s, x s, u, 0),  s = (2 + r^2)/4,  H = u^2/2 + mu (1 + r^2)
 *
 * The exact motion turns about the axis at the rate 2 mu/(1 + r^2), and moves along it with the
 * speed u. Source: Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

static const double mu = 0.01;

static int guiding_centre_one_form(const double *q, double *alpha, void *user)
{
  const double x = q[0], y = q[1], s = 0.25 * (2 + x * x + y * y);
  (void)user;
  alpha[0] = -y * s;
  alpha[1] = x * s;
  alpha[2] = q[3];
  alpha[3] = 0;
  return 0;
}

/* alpha_x and alpha_y depend on x and y, alpha_z on u. */
static const int gradient_start[] = {0, 2, 4, 5, 5}, gradient_row[] = {0, 1, 0, 1, 3};

static int guiding_centre_one_form_gradient(const double *q, double *alpha_q, void *user)
{
  const double x = q[0], y = q[1], s = 0.25 * (2 + x * x + y * y);
  (void)user;
  alpha_q[0] = -0.5 * x * y;
  alpha_q[1] = -s - 0.5 * y * y;
  alpha_q[2] = s + 0.5 * x * x;
  alpha_q[3] = 0.5 * x * y;
  alpha_q[4] = 1;
  return 0;
}

static const int hessian_start[] = {0, 2, 4, 4, 4}, hessian_row[] = {0, 1, 0, 1};

static int guiding_centre_one_form_hessian(const double *q, const double *w, double *alpha_w_qq,
                                           void *user)
{
  const double x = q[0], y = q[1];
  (void)user;
  alpha_w_qq[0] = -0.5 * y * w[0] + 1.5 * x * w[1];
  alpha_w_qq[1] = alpha_w_qq[2] = -0.5 * x * w[0] + 0.5 * y * w[1];
  alpha_w_qq[3] = -1.5 * y * w[0] + 0.5 * x * w[1];
  return 0;
}

static int guiding_centre_hamiltonian(double t, const double *q, double *value_of_H, void *user)
{
  (void)t, (void)user;
  *value_of_H = 0.5 * q[3] * q[3] + mu * (1 + q[0] * q[0] + q[1] * q[1]);
  return 0;
}

static int guiding_centre_gradient(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  H_q[0] = 2 * mu * q[0];
  H_q[1] = 2 * mu * q[1];
  H_q[2] = 0;
  H_q[3] = q[3];
  return 0;
}

static const int H_start[] = {0, 1, 2, 2, 3}, H_row[] = {0, 1, 3};

static int guiding_centre_hessian(double t, const double *q, double *H_qq, void *user)
{
  (void)t, (void)q, (void)user;
  H_qq[0] = H_qq[1] = 2 * mu;
  H_qq[2] = 1;
  return 0;
}

static int guiding_centre_rotation(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  xi[2] = xi[3] = 0;
  return 0;
}

static int guiding_centre_shift(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  xi[0] = xi[1] = xi[3] = 0;
  xi[2] = 1;
  return 0;
}

static int guiding_centre_exact(const problem *made, double t, double *q, double *p)
{
  const double x = made->q[0], y = made->q[1], u = made->q[3],
               angle = 2 * mu / (1 + x * x + y * y) * t;
  q[0] = x * cos(angle) - y * sin(angle);
  q[1] = x * sin(angle) + y * cos(angle);
  q[2] = made->q[2] + u * t;
  q[3] = u;
  return guiding_centre_one_form(q, p, NULL);
}

static dvi_status guiding_centre_make(const double *setting, problem *made)
{
  (void)setting;
  const dvi_status status = problem_room(made, 4, 1);
  if (status != DVI_OK) return status;
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  problem_label(made, 2, "z");
  problem_label(made, 3, "u");
  made->q[0] = made->q[3] = 0.5;

  const dvi_one_form form = {.value = guiding_centre_one_form,
                             .gradient = guiding_centre_one_form_gradient,
                             .hessian = guiding_centre_one_form_hessian,
                             .gradients = {gradient_start, gradient_row},
                             .qq = {hessian_start, hessian_row}};
  const dvi_potential hamiltonian = {.name = "H",
                                     .value = guiding_centre_hamiltonian,
                                     .gradient = guiding_centre_gradient,
                                     .hessian = guiding_centre_hessian,
                                     .qq = {H_start, H_row}};
  const dvi_symmetry symmetries[] = {
      {.name = "angular_momentum", .generator = guiding_centre_rotation},
      {.name = "axial_momentum", .generator = guiding_centre_shift}};
  return problem_one_form_system(made, &form, &hamiltonian, 2, symmetries);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.2599766706654848, 0.42709733165835867, 32, 0.5};
static const double digits_p[] = {-0.24024224905782676, 0.14623687724933521, 0.5, 0};

const problem_entry problem_entry_guiding_centre = {
    .name = "guiding-centre",
    .summary = "the guiding centre of a particle in an axial magnetic field; degenerate, exact "
               "solution known",
    .make = guiding_centre_make,
    .exact = guiding_centre_exact,
    .h = 0.5,
    .t_end = 1000.0,
    .order_h = 4.0,
    .order_t_end = 64.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
