/* Predators and their prey, H = a.q + b.ln q with the two-form of 1/(q1 q2). Three one-forms, which
 * differ by the gradient of a function, give this two-form.
 *
 *     alpha = ( c q2 + left ln q2 / q1, c q1 + right ln q1 / q2 )
 *
 * Source: Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

typedef struct lotka_volterra_gauge {
  double c, left, right;
} lotka_volterra_gauge;

static int lotka_volterra_one_form(const double *q, double *alpha, void *user)
{
  const lotka_volterra_gauge *g = user;
  if (!(q[0] > 0 && q[1] > 0)) return 1;
  alpha[0] = g->c * q[1] + g->left * log(q[1]) / q[0];
  alpha[1] = g->c * q[0] + g->right * log(q[0]) / q[1];
  return 0;
}

static int lotka_volterra_one_form_gradient(const double *q, double *alpha_q, void *user)
{
  const lotka_volterra_gauge *g = user;
  if (!(q[0] > 0 && q[1] > 0)) return 1;
  alpha_q[0] = -g->left * log(q[1]) / (q[0] * q[0]);
  alpha_q[1] = g->c + g->left / (q[0] * q[1]);
  alpha_q[2] = g->c + g->right / (q[0] * q[1]);
  alpha_q[3] = -g->right * log(q[0]) / (q[1] * q[1]);
  return 0;
}

static int lotka_volterra_one_form_hessian(const double *q, const double *w, double *alpha_w_qq,
                                           void *user)
{
  const lotka_volterra_gauge *g = user;
  if (!(q[0] > 0 && q[1] > 0)) return 1;
  const double left = g->left * w[0] / q[0], right = g->right * w[1] / q[1];
  alpha_w_qq[0] = (2 * left * log(q[1]) / q[0] - right / q[0]) / q[0];
  alpha_w_qq[1] = alpha_w_qq[2] = -left / (q[0] * q[1]) - right / (q[0] * q[1]);
  alpha_w_qq[3] = (2 * right * log(q[0]) / q[1] - left / q[1]) / q[1];
  return 0;
}

static const double a[2] = {1, 1}, b[2] = {-1, -2};

static int lotka_volterra_hamiltonian(double t, const double *q, double *value_of_H, void *user)
{
  (void)t, (void)user;
  if (!(q[0] > 0 && q[1] > 0)) return 1;
  *value_of_H = a[0] * q[0] + a[1] * q[1] + b[0] * log(q[0]) + b[1] * log(q[1]);
  return 0;
}

static int lotka_volterra_gradient(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 2; i++) H_q[i] = a[i] + b[i] / q[i];
  return 0;
}

static int lotka_volterra_hessian(double t, const double *q, double *H_qq, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 2; i++) H_qq[i] = -b[i] / (q[i] * q[i]);
  return 0;
}

static const int diagonal_start[] = {0, 1, 2}, diagonal_row[] = {0, 1};
static const char *const gauges[] = {"standard", "singular", "symmetric", NULL};

static dvi_status lotka_volterra_make(const double *setting, problem *made)
{
  static const lotka_volterra_gauge of_name[] = {
      {.c = 1, .left = 1}, {.left = 1}, {.left = 0.5, .right = -0.5}};
  const dvi_status status = problem_room(made, 2, sizeof(lotka_volterra_gauge));
  if (status != DVI_OK) return status;
  lotka_volterra_gauge *own = made->parameters;
  *own = of_name[(int)setting[0]];
  problem_label(made, 0, "prey");
  problem_label(made, 1, "predators");
  made->q[0] = setting[1];
  made->q[1] = setting[2];

  const dvi_one_form form = {.value = lotka_volterra_one_form,
                             .gradient = lotka_volterra_one_form_gradient,
                             .hessian = lotka_volterra_one_form_hessian,
                             .user = own};
  const dvi_potential hamiltonian = {.name = "H",
                                     .value = lotka_volterra_hamiltonian,
                                     .gradient = lotka_volterra_gradient,
                                     .hessian = lotka_volterra_hessian,
                                     .qq = {diagonal_start, diagonal_row}};
  return problem_one_form_system(made, &form, &hamiltonian, 0, NULL);
}

static const problem_parameter parameters[] = {
    {.name = "gauge",
     .choice = gauges,
     .most = 2,
     .whole = 1,
     .help = "the one-form: standard, singular or symmetric"},
    {.name = "prey",
     .value = 1,
     .least = 1e-6,
     .most = 1e6,
     .start_only = 1,
     .help = "how many there are at the start, positive"},
    {.name = "predators",
     .value = 1,
     .least = 1e-6,
     .most = 1e6,
     .start_only = 1,
     .help = "how many there are at the start, positive"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.42457656586168324, 1.4198182433045652};
static const double digits_p[] = {2.2454145996096386, 0.42457656586168324};

const problem_entry problem_entry_lotka_volterra = {
    .name = "lotka-volterra",
    .summary = "predators and their prey; degenerate, in three gauges",
    .parameters = parameters,
    .make = lotka_volterra_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
