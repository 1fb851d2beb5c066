#include "support/systems/forced.h"

#include <math.h>

#include "support/suite.h"

/* ---- potentials and Lagrangians ---- */

static int spring_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * q[0] * q[0];
  return 0;
}

static int spring_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0];
  return 0;
}

static int spring_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  V_qq[0] = 1;
  return 0;
}

static int pendulum_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -cos(q[0]);
  return 0;
}

static int pendulum_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = sin(q[0]);
  return 0;
}

static int pendulum_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  V_qq[0] = cos(q[0]);
  return 0;
}

static int round_value(double t, const double *q, double *V, void *user)
{
  const double rr = q[0] * q[0] + q[1] * q[1];
  (void)t, (void)user;
  *V = 0.5 * rr + 0.25 * rr * rr;
  return 0;
}

static int round_gradient(double t, const double *q, double *V_q, void *user)
{
  const double rr = q[0] * q[0] + q[1] * q[1];
  (void)t, (void)user;
  V_q[0] = (1 + rr) * q[0];
  V_q[1] = (1 + rr) * q[1];
  return 0;
}

static int round_hessian(double t, const double *q, double *V_qq, void *user)
{
  const double rr = q[0] * q[0] + q[1] * q[1];
  (void)t, (void)user;
  V_qq[0] = 1 + rr + 2 * q[0] * q[0];
  V_qq[1] = V_qq[2] = 2 * q[0] * q[1];
  V_qq[3] = 1 + rr + 2 * q[1] * q[1];
  return 0;
}

const dvi_potential unit_spring = {
    .value = spring_value, .gradient = spring_gradient, .hessian = spring_hessian};

static const dvi_potential pendulum = {.value = pendulum_value,
                                       .gradient = pendulum_gradient,
                                       .hessian = pendulum_hessian},
                           round_spring = {.value = round_value,
                                           .gradient = round_gradient,
                                           .hessian = round_hessian};

static int curved_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = 0.5 * (1 + q[0] * q[0]) * v[0] * v[0] - 0.5 * q[0] * q[0];
  return 0;
}

static int curved_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                           void *user)
{
  (void)t, (void)user;
  L_q[0] = q[0] * v[0] * v[0] - q[0];
  L_v[0] = (1 + q[0] * q[0]) * v[0];
  return 0;
}

static int curved_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                          double *L_vv, void *user)
{
  (void)t, (void)user;
  L_qq[0] = v[0] * v[0] - 1;
  L_qv[0] = 2 * q[0] * v[0];
  L_vv[0] = 1 + q[0] * q[0];
  return 0;
}

static const dvi_lagrangian curved = {
    .value = curved_value, .gradient = curved_gradient, .hessian = curved_hessian};

/* ---- forces ---- */

static int oscillator_force(double t, const double *q, const double *v, double *F, void *user)
{
  (void)q, (void)user;
  F[0] = -0.2 * v[0] + 0.5 * sin(2 * t);
  return 0;
}

static int oscillator_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                               void *user)
{
  (void)t, (void)q, (void)v, (void)user;
  F_q[0] = 0;
  F_v[0] = -0.2;
  return 0;
}

static int drag_force(double t, const double *q, const double *v, double *F, void *user)
{
  const double c = cos(q[0]);
  (void)user;
  F[0] = -0.3 * v[0] * v[0] * v[0] - 0.1 * v[0] * c * c + 0.4 * cos(1.3 * t);
  return 0;
}

static int drag_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                         void *user)
{
  const double c = cos(q[0]), s = sin(q[0]);
  (void)t, (void)user;
  F_q[0] = 0.2 * v[0] * c * s;
  F_v[0] = -0.9 * v[0] * v[0] - 0.1 * c * c;
  return 0;
}

static const double resistance = 0.1, stirring = 0.15;

static int stirring_force(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)user;
  F[0] = -resistance * v[0] - stirring * q[1];
  F[1] = -resistance * v[1] + stirring * q[0];
  return 0;
}

static int stirring_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                             void *user)
{
  (void)t, (void)q, (void)v, (void)user;
  F_q[0] = stirring;
  F_q[1] = -stirring;
  F_v[0] = F_v[1] = -resistance;
  return 0;
}

static int curved_force(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)user;
  F[0] = -0.2 * v[0] - 0.1 * q[0] * q[0] * q[0];
  return 0;
}

static int curved_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                           void *user)
{
  (void)t, (void)v, (void)user;
  F_q[0] = -0.3 * q[0] * q[0];
  F_v[0] = -0.2;
  return 0;
}

/* The velocity is not given to a force that does not depend on it. */
static int push_force(double t, const double *q, const double *v, double *F, void *user)
{
  (void)user;
  F[0] = cos(t) - 0.5 * q[0] * q[0] * q[0];
  return v != NULL ? -1 : 0;
}

static int push_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                         void *user)
{
  (void)t, (void)user;
  F_q[0] = -1.5 * q[0] * q[0];
  return v != NULL || F_v != NULL ? -1 : 0;
}

static int rotation(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  return 0;
}

/* ---- systems ---- */

static const int crossed_start[] = {0, 1, 2}, crossed_row[] = {1, 0}, straight_row[] = {0, 1};

typedef struct declared {
  const char *name;
  int n;
  const dvi_potential *potential;
  const dvi_lagrangian *lagrangian;
  dvi_force force;
  double q[FORCED_N], v[FORCED_N], span;
  int autonomous;
} declared;

static const declared table[FORCED_KINDS] = {
    {.name = "driven oscillator",
     .n = 1,
     .potential = &unit_spring,
     .force = {.value = oscillator_force, .jacobian = oscillator_jacobian},
     .q = {1},
     .span = 10},
    {.name = "dragged pendulum",
     .n = 1,
     .potential = &pendulum,
     .force = {.value = drag_force, .jacobian = drag_jacobian},
     .q = {1.5},
     .span = 10},
    {.name = "stirred spring",
     .n = 2,
     .potential = &round_spring,
     .force = {.value = stirring_force,
               .jacobian = stirring_jacobian,
               .by_q = {crossed_start, crossed_row},
               .by_v = {crossed_start, straight_row}},
     .q = {1, 0.2},
     .v = {-0.3, 0.8},
     .span = 4,
     .autonomous = 1},
    {.name = "curved line",
     .n = 1,
     .lagrangian = &curved,
     .force = {.value = curved_force, .jacobian = curved_jacobian},
     .q = {0.7},
     .v = {0.6},
     .span = 4,
     .autonomous = 1},
    {.name = "pushed spring",
     .n = 1,
     .potential = &unit_spring,
     .force = {.value = push_force, .jacobian = push_jacobian, .without_velocity = 1},
     .q = {0.5},
     .v = {-0.2},
     .span = 4}};

/* Batches of one point each, by the one-point callbacks at `user`. */
enum { NUMBERS_MOST = 4 };

static void take_point(int n, int count, int k, const double *batch, double *point)
{
  for (int i = 0; batch != NULL && i < n; i++) point[i] = batch[i * count + k];
}

static int value_batch(int count, const double *t, const double *q, const double *v, double *F,
                       void *user)
{
  const declared *of = user;
  double q1[FORCED_N], v1[FORCED_N], F1[FORCED_N];
  int returned = 0;
  for (int k = 0; k < count && returned == 0; k++) {
    take_point(of->n, count, k, q, q1);
    take_point(of->n, count, k, v, v1);
    returned = of->force.value(t[k], q1, v != NULL ? v1 : NULL, F1, NULL);
    for (int i = 0; i < of->n; i++) F[i * count + k] = F1[i];
  }
  return returned;
}

static int jacobian_batch(int count, const double *t, const double *q, const double *v, double *F_q,
                          double *F_v, void *user)
{
  const declared *of = user;
  double q1[FORCED_N], v1[FORCED_N], by_q[NUMBERS_MOST], by_v[NUMBERS_MOST];
  int returned = 0;
  for (int k = 0; k < count && returned == 0; k++) {
    take_point(of->n, count, k, q, q1);
    take_point(of->n, count, k, v, v1);
    returned = of->force.jacobian(t[k], q1, v != NULL ? v1 : NULL, by_q, v != NULL ? by_v : NULL,
                                  NULL);
    for (int i = 0; i < of->n; i++) F_q[i * count + k] = by_q[i];
    for (int i = 0; v != NULL && i < of->n; i++) F_v[i * count + k] = by_v[i];
  }
  return returned;
}

static dvi_force force_of(const declared *of, forced_form form)
{
  dvi_force force = of->force;
  force.name = of->name;
  force.user = (void *)(uintptr_t)of;
  if (form == FORCED_BATCH) {
    force.value = NULL;
    force.jacobian = NULL;
    force.value_batch = value_batch;
    force.jacobian_batch = jacobian_batch;
  } else if (form == FORCED_DIFFERENCED) {
    force.jacobian = NULL;
  }
  return force;
}

void make_forced(forced_kind kind, forced_form form, forced *made)
{
  const declared *of = &table[kind];
  const dvi_force force = force_of(of, form);
  static const dvi_symmetry turn = {.name = "angular momentum", .generator = rotation};
  const dvi_system_terms terms = {.dimension = of->n,
                                  .mass = {.scalar = of->lagrangian == NULL ? 1 : 0},
                                  .lagrangian = of->lagrangian,
                                  .potentials = of->potential,
                                  .potential_count = of->potential != NULL,
                                  .symmetries = of->n == 2 ? &turn : NULL,
                                  .symmetry_count = of->n == 2,
                                  .forces = &force,
                                  .force_count = 1,
                                  .autonomous = of->autonomous};
  *made = (forced){.name = of->name, .n = of->n, .span = of->span};
  for (int i = 0; i < of->n; i++) made->q[i] = of->q[i], made->v[i] = of->v[i];
  ck_assert_msg(dvi_system_create(&terms, &made->system) == DVI_OK, "%s: %s", of->name,
                dvi_last_error());
}

void destroy_forced(forced *made)
{
  dvi_system_destroy(&made->system);
}

/* x = A cos 2t + B sin 2t + e^(-at) (C cos wt + D sin wt) with a = 1/10, w^2 = 1 - a^2. */
static void solve_oscillator(double t, double *q, double *v)
{
  const double c = 0.2, f = 0.5, a = 0.5 * c, w = sqrt(1 - a * a), scale = f / (9 + 4 * c * c),
               A = -2 * c * scale, B = -3 * scale;
  const double C = 1 - A, D = (a * C - 2 * B) / w, e = exp(-a * t), cw = cos(w * t),
               sw = sin(w * t);
  *q = A * cos(2 * t) + B * sin(2 * t) + e * (C * cw + D * sw);
  *v = 2 * (B * cos(2 * t) - A * sin(2 * t)) + e * ((w * D - a * C) * cw - (w * C + a * D) * sw);
}

int forced_exact(forced_kind kind, double *q, double *v)
{
  if (kind == DRIVEN_OSCILLATOR) solve_oscillator(table[kind].span, q, v);
  /* by Gauss collocation of degree 8 in quadruple precision, two steps agreeing to 1e-20 */
  if (kind == DRAGGED_PENDULUM) *q = -0.567065166612010, *v = 0.434877768607500;
  return kind == DRIVEN_OSCILLATOR || kind == DRAGGED_PENDULUM;
}

dvi_integrator *forced_integrator(const forced *model, const char *method)
{
  dvi_integrator *integrator;
  const dvi_integrator_options options = {.size = sizeof options, .method = method, .balances = 1};
  ck_assert_msg(dvi_integrator_create_with(model->system, &options, &integrator) == DVI_OK,
                "%s: %s", model->name, dvi_last_error());
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model->q, model->v) == DVI_OK,
                "%s: %s", model->name, dvi_last_error());
  return integrator;
}
