/* A spherical pendulum in Cartesian coordinates,
 *
 *     L = m |q'|^2/2 - m g q_z,   (|q|^2 - l^2)/2 = 0. */
#include <math.h>

#include "entry.h"

typedef struct bob {
  double m, g, l;
} bob;

static int weight(double t, const double *q, double *V, void *user)
{
  const bob *own = user;
  (void)t;
  *V = own->m * own->g * q[2];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const bob *own = user;
  (void)t, (void)q;
  V_q[0] = V_q[1] = 0;
  V_q[2] = own->m * own->g;
  return 0;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user;
  return 0;
}

static int rod(double t, const double *q, double *phi, void *user)
{
  const bob *own = user;
  (void)t;
  *phi = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - own->l * own->l) / 2;
  return 0;
}

static int rod_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 3; i++) phi_q[i] = q[i];
  return 0;
}

static int rod_hessian(double t, const double *q, const double *w, double *phi_w, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < 3; i++) phi_w[i] = w[0];
  return 0;
}

static int vertical(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  xi[2] = 0;
  return 0;
}

static dvi_status spherical_constrained_make(const double *setting, problem *made)
{
  static const int nothing[] = {0, 0, 0, 0}, own_start[] = {0, 1, 2, 3}, own_row[] = {0, 1, 2};
  const dvi_status status = problem_room(made, 3, sizeof(bob));
  if (status != DVI_OK) return status;
  bob *own = made->parameters;
  *own = (bob){.m = setting[0], .g = setting[1], .l = setting[2]};
  for (int i = 0; i < 3; i++) problem_label(made, i, "%c", "xyz"[i]);
  made->q[0] = own->l * sin(1.0);
  made->q[2] = -own->l * cos(1.0);
  made->v[0] = own->l * cos(1.0) / 2;
  made->v[1] = own->l * 2;
  made->v[2] = own->l * sin(1.0) / 2;

  const dvi_potential potential = {.name = "weight",
                                   .value = weight,
                                   .gradient = weight_gradient,
                                   .hessian = weight_hessian,
                                   .qq = {nothing, nothing},
                                   .quadratic = 1,
                                   .user = own};
  const dvi_holonomic rows = {.name = "rod",
                              .count = 1,
                              .value = rod,
                              .gradient = rod_gradient,
                              .hessian = rod_hessian,
                              .qq = {own_start, own_row},
                              .user = own};
  const dvi_symmetry symmetry = {.name = "angular momentum", .generator = vertical};
  const dvi_system_terms terms = {.dimension = 3,
                                  .mass = {.scalar = own->m},
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .holonomics = &rows,
                                  .holonomic_count = 1,
                                  .symmetries = &symmetry,
                                  .symmetry_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    PROBLEM_MASS(1.0),
    PROBLEM_GRAVITY(9.81),
    {.name = "l", .value = 1.0, .least = 1e-3, .most = 1e3, .help = "the length of the rod"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.31606940157927429, 0.68935471740719877, -0.65183602767395465};
static const double digits_p[] = {-1.6830328642110226, 1.6538624824442755, 0.93296885745398226};

const problem_entry problem_entry_spherical_constrained = {
    .name = "spherical-constrained",
    .summary = "a spherical pendulum in Cartesian coordinates; a constraint",
    .parameters = parameters,
    .make = spherical_constrained_make,
    .h = 0.02,
    .t_end = 20.0,
    .order_h = 0.05,
    .order_t_end = 2.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
