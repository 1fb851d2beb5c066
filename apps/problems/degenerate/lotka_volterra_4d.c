/* Four species, H = sum_i q_i + b_i ln q_i and alpha_i = sum_j C_ij ln q_j / (2 q_i) with an
 * antisymmetric C. Source: Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

enum { N = 4 };

static const double C[N][N] = {{0, 1, -1, 1}, {-1, 0, 1, -1}, {1, -1, 0, 1}, {-1, 1, -1, 0}};
static const double b[N] = {-1, -2, -1, -1};

static int is_outside(const double *q)
{
  return !(q[0] > 0 && q[1] > 0 && q[2] > 0 && q[3] > 0);
}

/* Compute q_i alpha_i = sum_j C_ij ln q_j / 2. */
static double lotka_volterra_4d_sum(const double *q, int i)
{
  double s = 0;
  for (int j = 0; j < N; j++) s += 0.5 * C[i][j] * log(q[j]);
  return s;
}

static int lotka_volterra_4d_one_form(const double *q, double *alpha, void *user)
{
  (void)user;
  if (is_outside(q)) return 1;
  for (int i = 0; i < N; i++) alpha[i] = lotka_volterra_4d_sum(q, i) / q[i];
  return 0;
}

static int lotka_volterra_4d_one_form_gradient(const double *q, double *alpha_q, void *user)
{
  (void)user;
  if (is_outside(q)) return 1;
  for (int i = 0; i < N; i++)
    for (int k = 0; k < N; k++)
      alpha_q[N * i + k] = k == i ? -lotka_volterra_4d_sum(q, i) / (q[i] * q[i])
                                  : 0.5 * C[i][k] / (q[i] * q[k]);
  return 0;
}

static int lotka_volterra_4d_one_form_hessian(const double *q, const double *w, double *alpha_w_qq,
                                              void *user)
{
  (void)user;
  if (is_outside(q)) return 1;
  for (int k = 0; k < N; k++)
    for (int l = 0; l < N; l++) {
      double s = k == l ? 2 * w[k] * lotka_volterra_4d_sum(q, k) / (q[k] * q[k] * q[k]) : 0;
      if (k != l)
        s -= 0.5 * (w[k] * C[k][l] / (q[l] * q[k] * q[k]) + w[l] * C[l][k] / (q[k] * q[l] * q[l]));
      for (int i = 0; i < N && k == l; i++) s -= 0.5 * w[i] * C[i][k] / (q[k] * q[k] * q[i]);
      alpha_w_qq[N * l + k] = s;
    }
  return 0;
}

static int lotka_volterra_4d_hamiltonian(double t, const double *q, double *value_of_H, void *user)
{
  (void)t, (void)user;
  if (is_outside(q)) return 1;
  *value_of_H = 0;
  for (int i = 0; i < N; i++) *value_of_H += q[i] + b[i] * log(q[i]);
  return 0;
}

static int lotka_volterra_4d_gradient(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < N; i++) H_q[i] = 1 + b[i] / q[i];
  return 0;
}

static int lotka_volterra_4d_hessian(double t, const double *q, double *H_qq, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < N; i++) H_qq[i] = -b[i] / (q[i] * q[i]);
  return 0;
}

static const int diagonal_start[] = {0, 1, 2, 3, 4}, diagonal_row[] = {0, 1, 2, 3};

static dvi_status lotka_volterra_4d_make(const double *setting, problem *made)
{
  static const double q[N] = {2, 1, 1, 1};
  (void)setting;
  const dvi_status status = problem_room(made, N, 1);
  if (status != DVI_OK) return status;
  memcpy(made->q, q, sizeof q);
  for (int i = 0; i < N; i++) problem_label(made, i, "q_%d", i + 1);

  const dvi_one_form form = {.value = lotka_volterra_4d_one_form,
                             .gradient = lotka_volterra_4d_one_form_gradient,
                             .hessian = lotka_volterra_4d_one_form_hessian};
  const dvi_potential hamiltonian = {.name = "H",
                                     .value = lotka_volterra_4d_hamiltonian,
                                     .gradient = lotka_volterra_4d_gradient,
                                     .hessian = lotka_volterra_4d_hessian,
                                     .qq = {diagonal_start, diagonal_row}};
  return problem_one_form_system(made, &form, &hamiltonian, 0, NULL);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {1.3748735653782593, 1.3106942389097525, 2.302370934659371,
                                  1.1653546483773685};
static const double digits_p[] = {-0.14923445812393354, 0.13830540641690078, 0.04361379852203847,
                                  -0.37831584513867866};

const problem_entry problem_entry_lotka_volterra_4d = {
    .name = "lotka-volterra-4d",
    .summary = "four species that live on one another; degenerate",
    .make = lotka_volterra_4d_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
