/* Two point vortices in a plane. The one-form is alpha = gamma S/2 (-y, x) for each.
 *
 *     vortices-linear   S = 1,         H = gamma_1 gamma_2 ln d^2/(4 pi)
 *     vortices          S = 1 + r^2,   H = gamma_1 gamma_2 S_1 S_2 ln d^2/(2 pi)
 *
 * The first pair turns about its centre. Source: Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

typedef struct pair {
  double gamma[2], kappa; /* S = 1 + kappa r^2 */
  double factor;          /* H = factor S_1 S_2 ln d^2 */
} pair;

static const double pi = 3.14159265358979323846;

/* alpha of a vortex depends only on its own coordinates. */
static const int block_start[] = {0, 2, 4, 6, 8}, block_row[] = {0, 1, 0, 1, 2, 3, 2, 3};

static double vortex_weight(const pair *own, const double *x)
{
  return 1 + own->kappa * (x[0] * x[0] + x[1] * x[1]);
}

static int vortices_one_form(const double *q, double *alpha, void *user)
{
  const pair *own = user;
  for (int k = 0; k < 2; k++) {
    const double *x = q + 2 * k, half = 0.5 * own->gamma[k] * vortex_weight(own, x);
    alpha[2 * k] = -half * x[1];
    alpha[2 * k + 1] = half * x[0];
  }
  return 0;
}

static int vortices_one_form_gradient(const double *q, double *alpha_q, void *user)
{
  const pair *own = user;
  for (int k = 0; k < 2; k++) {
    const double *x = q + 2 * k, half = 0.5 * own->gamma[k], S = vortex_weight(own, x),
                 twice = 2 * own->kappa;
    double *out = alpha_q + 4 * k;
    out[0] = -half * twice * x[0] * x[1];
    out[1] = -half * (S + twice * x[1] * x[1]);
    out[2] = half * (S + twice * x[0] * x[0]);
    out[3] = half * twice * x[0] * x[1];
  }
  return 0;
}

static int vortices_one_form_hessian(const double *q, const double *w, double *alpha_w_qq,
                                     void *user)
{
  const pair *own = user;
  for (int k = 0; k < 2; k++) {
    const double *x = q + 2 * k, *u = w + 2 * k, c = own->gamma[k] * own->kappa;
    double *out = alpha_w_qq + 4 * k;
    out[0] = c * (3 * x[0] * u[1] - x[1] * u[0]);
    out[1] = out[2] = c * (x[1] * u[1] - x[0] * u[0]);
    out[3] = c * (x[0] * u[1] - 3 * x[1] * u[0]);
  }
  return 0;
}

/* The parts of H and its derivatives, which are d = x_1 - x_2, weights, and their gradients in the
 * four coordinates. */
typedef struct parts {
  double S[2], l, d2, l_q[4], S_q[2][4];
} parts;

static parts vortices_parts(const pair *own, const double *q)
{
  parts p = {.S = {vortex_weight(own, q), vortex_weight(own, q + 2)}};
  const double dx = q[0] - q[2], dy = q[1] - q[3];
  p.d2 = dx * dx + dy * dy;
  p.l = log(p.d2);
  p.l_q[0] = 2 * dx / p.d2;
  p.l_q[1] = 2 * dy / p.d2;
  p.l_q[2] = -p.l_q[0];
  p.l_q[3] = -p.l_q[1];
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++) p.S_q[k][2 * k + i] = 2 * own->kappa * q[2 * k + i];
  return p;
}

static int vortices_hamiltonian(double t, const double *q, double *value_of_H, void *user)
{
  const pair *own = user;
  const parts p = vortices_parts(own, q);
  (void)t;
  *value_of_H = own->factor * p.S[0] * p.S[1] * p.l;
  return 0;
}

static int vortices_gradient(double t, const double *q, double *H_q, void *user)
{
  const pair *own = user;
  const parts p = vortices_parts(own, q);
  (void)t;
  for (int i = 0; i < 4; i++)
    H_q[i] = own->factor *
             ((p.S_q[0][i] * p.S[1] + p.S[0] * p.S_q[1][i]) * p.l + p.S[0] * p.S[1] * p.l_q[i]);
  return 0;
}

/* Compute d2 ln d^2/dq2, which is 2 delta_ij/d^2 with the sign of the block, minus the product of
 * the gradients. */
static double vortices_log_hessian(const parts *p, int i, int j)
{
  const double sign = i / 2 == j / 2 ? 1 : -1;
  return (i % 2 == j % 2 ? 2 * sign / p->d2 : 0) - p->l_q[i] * p->l_q[j];
}

static int vortices_hessian(double t, const double *q, double *H_qq, void *user)
{
  const pair *own = user;
  const parts p = vortices_parts(own, q);
  (void)t;
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) {
      const double both_i = p.S_q[0][i] * p.S[1] + p.S[0] * p.S_q[1][i],
                   both_j = p.S_q[0][j] * p.S[1] + p.S[0] * p.S_q[1][j];
      double mixed = p.S_q[0][i] * p.S_q[1][j] + p.S_q[1][i] * p.S_q[0][j];
      if (i == j) mixed += 2 * own->kappa * p.S[1 - i / 2];
      H_qq[4 * j + i] = own->factor * (mixed * p.l + both_i * p.l_q[j] + both_j * p.l_q[i] +
                                       p.S[0] * p.S[1] * vortices_log_hessian(&p, i, j));
    }
  return 0;
}

static int vortices_rotation(const double *q, double *xi, void *user)
{
  (void)user;
  for (int k = 0; k < 2; k++) {
    xi[2 * k] = -q[2 * k + 1];
    xi[2 * k + 1] = q[2 * k];
  }
  return 0;
}

/* Compute the solution. Both turn about the centre of circulation, here the origin, at the rate
 * 3/pi. */
static int vortices_exact_linear(const problem *made, double t, double *q, double *p)
{
  const double angle = 3 / pi * t;
  for (int k = 0; k < 4; k += 2) {
    q[k] = made->q[k] * cos(angle) - made->q[k + 1] * sin(angle);
    q[k + 1] = made->q[k] * sin(angle) + made->q[k + 1] * cos(angle);
  }
  return vortices_one_form(q, p, made->parameters);
}

static dvi_status vortices_make(pair own, const double *start, problem *made)
{
  const dvi_status status = problem_room(made, 4, sizeof(pair));
  if (status != DVI_OK) return status;
  *(pair *)made->parameters = own;
  memcpy(made->q, start, 4 * sizeof *start);
  for (int i = 0; i < 4; i++) problem_label(made, i, "%c_%d", i % 2 ? 'y' : 'x', i / 2 + 1);

  const dvi_one_form form = {.value = vortices_one_form,
                             .gradient = vortices_one_form_gradient,
                             .hessian = vortices_one_form_hessian,
                             .gradients = {block_start, block_row},
                             .qq = {block_start, block_row},
                             .user = made->parameters};
  const dvi_potential hamiltonian = {.name = "H",
                                     .value = vortices_hamiltonian,
                                     .gradient = vortices_gradient,
                                     .hessian = vortices_hessian,
                                     .user = made->parameters};
  const dvi_symmetry symmetry = {.name = "angular_momentum", .generator = vortices_rotation};
  return problem_one_form_system(made, &form, &hamiltonian, 1, &symmetry);
}

static dvi_status vortices_make_linear(const double *setting, problem *made)
{
  static const double start[] = {1.0 / 3.0, 0, -2.0 / 3.0, 0};
  (void)setting;
  return vortices_make((pair){.gamma = {4, 2}, .factor = 8 / (4 * pi)}, start, made);
}

static dvi_status vortices_make_weighted(const double *setting, problem *made)
{
  static const double start[] = {0.5, 0.1, 0.5, -0.1};
  (void)setting;
  return vortices_make((pair){.gamma = {0.5, 0.5}, .kappa = 1, .factor = 0.25 / (2 * pi)}, start,
                       made);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q_linear[] = {0.1925553923748704, 0.27209103619647379,
                                         -0.38511078474974081, -0.54418207239294758};
static const double digits_p_linear[] = {-0.54418207239294758, 0.38511078474974081,
                                         0.54418207239294758, -0.38511078474974081};

const problem_entry problem_entry_vortices_linear = {
    .name = "vortices-linear",
    .summary = "two point vortices that turn about each other; degenerate, exact solution known",
    .make = vortices_make_linear,
    .exact = vortices_exact_linear,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 1.0,
    .digits_q = digits_q_linear,
    .digits_p = digits_p_linear,
};

static const double digits_q[] = {0.34162219556328388, -0.3045647215322177, 0.51449169766719338,
                                  -0.20658184215249473};
static const double digits_p[] = {0.092090122739494767, 0.10329505584786046, 0.067520126743644382,
                                  0.16815875138434647};

const problem_entry problem_entry_vortices = {
    .name = "vortices",
    .summary = "two point vortices with a weight that grows outwards; degenerate",
    .make = vortices_make_weighted,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
