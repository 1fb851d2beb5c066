/* A charged particle without mass in a plane, in the magnetic field 1 + 2 r^2, H = cos x + sin y.
 * The second gauge of the one-form leaves one component.
 *
 *     alpha = (1 + r^2)/2 (-y, x)   or   alpha = (-y (1 + 2 x^2 + 2 y^2/3), 0)
 *
 * Source: Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

/* The coefficients of both gauges, ( -y (c + d x^2 + e y^2),  f x (1 + x^2 + y^2) ). */
typedef struct massless_particle_gauge {
  double c, d, e, f;
} massless_particle_gauge;

static int massless_particle_one_form(const double *q, double *alpha, void *user)
{
  const massless_particle_gauge *g = user;
  const double x = q[0], y = q[1];
  alpha[0] = -y * (g->c + g->d * x * x + g->e * y * y);
  alpha[1] = g->f * x * (1 + x * x + y * y);
  return 0;
}

static int massless_particle_one_form_gradient(const double *q, double *alpha_q, void *user)
{
  const massless_particle_gauge *g = user;
  const double x = q[0], y = q[1];
  alpha_q[0] = -2 * g->d * x * y;
  alpha_q[1] = -(g->c + g->d * x * x + 3 * g->e * y * y);
  alpha_q[2] = g->f * (1 + 3 * x * x + y * y);
  alpha_q[3] = 2 * g->f * x * y;
  return 0;
}

static int massless_particle_one_form_hessian(const double *q, const double *w, double *alpha_w_qq,
                                              void *user)
{
  const massless_particle_gauge *g = user;
  const double x = q[0], y = q[1];
  alpha_w_qq[0] = -2 * g->d * y * w[0] + 6 * g->f * x * w[1];
  alpha_w_qq[1] = alpha_w_qq[2] = -2 * g->d * x * w[0] + 2 * g->f * y * w[1];
  alpha_w_qq[3] = -6 * g->e * y * w[0] + 2 * g->f * x * w[1];
  return 0;
}

static int massless_particle_hamiltonian(double t, const double *q, double *value_of_H, void *user)
{
  (void)t, (void)user;
  *value_of_H = cos(q[0]) + sin(q[1]);
  return 0;
}

static int massless_particle_gradient(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  H_q[0] = -sin(q[0]);
  H_q[1] = cos(q[1]);
  return 0;
}

static int massless_particle_hessian(double t, const double *q, double *H_qq, void *user)
{
  (void)t, (void)user;
  H_qq[0] = -cos(q[0]);
  H_qq[1] = -sin(q[1]);
  return 0;
}

static const int diagonal_start[] = {0, 1, 2}, diagonal_row[] = {0, 1};
static const char *const gauges[] = {"standard", "singular", NULL};

static dvi_status massless_particle_make(const double *setting, problem *made)
{
  static const massless_particle_gauge of_name[] = {{.c = 0.5, .d = 0.5, .e = 0.5, .f = 0.5},
                                                    {.c = 1, .d = 2, .e = 2.0 / 3.0}};
  const dvi_status status = problem_room(made, 2, sizeof(massless_particle_gauge));
  if (status != DVI_OK) return status;
  massless_particle_gauge *own = made->parameters;
  *own = of_name[(int)setting[0]];
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  made->q[0] = made->q[1] = 1;

  const dvi_one_form form = {.value = massless_particle_one_form,
                             .gradient = massless_particle_one_form_gradient,
                             .hessian = massless_particle_one_form_hessian,
                             .user = own};
  const dvi_potential hamiltonian = {.name = "H",
                                     .value = massless_particle_hamiltonian,
                                     .gradient = massless_particle_gradient,
                                     .hessian = massless_particle_hessian,
                                     .qq = {diagonal_start, diagonal_row}};
  return problem_one_form_system(made, &form, &hamiltonian, 0, NULL);
}

static const problem_parameter parameters[] = {
    {.name = "gauge",
     .choice = gauges,
     .most = 1,
     .whole = 1,
     .help = "the one-form: standard or singular"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.86001123161167659, 0.81736309057467182};
static const double digits_p[] = {-0.98398326782989476, 1.0353252695282553};

const problem_entry problem_entry_massless_particle = {
    .name = "massless-particle",
    .summary = "a charge without mass in a magnetic field; degenerate, in two gauges",
    .parameters = parameters,
    .make = massless_particle_make,
    .h = 0.2,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
