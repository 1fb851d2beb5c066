#include "support/friction/damped.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"
#include "support/systems/forced.h"

static int plane_value(double t, const double *q, double *V, void *user)
{
  const double r = q[0] * q[0] + q[1] * q[1];
  (void)t, (void)user;
  *V = r / 2 + r * r / 4;
  return 0;
}

static int plane_gradient(double t, const double *q, double *V_q, void *user)
{
  const double r = q[0] * q[0] + q[1] * q[1];
  (void)t, (void)user;
  for (int i = 0; i < 2; i++) V_q[i] = (1 + r) * q[i];
  return 0;
}

static int plane_turn(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  return 0;
}

static int curved_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = (1 + q[0] * q[0]) * v[0] * v[0] / 2 - q[0] * q[0] / 2;
  return 0;
}

static int curved_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                           void *user)
{
  (void)t, (void)user;
  *L_q = q[0] * v[0] * v[0] - q[0];
  *L_v = (1 + q[0] * q[0]) * v[0];
  return 0;
}

static int drive(double t, const double *q, const double *v, double *F, void *user)
{
  (void)q, (void)user;
  F[0] = sin(2 * t) / 5 - v[0] / 10;
  return 0;
}

/* The weight of a rotation R (entry zz), and of a direction below it. */
static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -q[8] + q[11] / 2 - q[12] / 4;
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, DAMPED_NQ * sizeof *V_q);
  V_q[8] = -1;
  V_q[11] = 0.5;
  V_q[12] = -0.25;
  return 0;
}

/* Turns of the body alone about the vertical. */
static int body_turn(const double *q, double *xi, void *user)
{
  (void)user;
  memset(xi, 0, DAMPED_NV * sizeof *xi);
  for (int i = 0; i < 3; i++) xi[i] = q[6 + i];
  return 0;
}

static const dvi_potential plane = {.name = "V", .value = plane_value, .gradient = plane_gradient};
static const dvi_potential weight = {
    .name = "weight", .value = weight_value, .gradient = weight_gradient};
static const dvi_lagrangian curved = {.value = curved_value, .gradient = curved_gradient};
static const dvi_force driven = {.name = "drive", .value = drive};
static const dvi_symmetry plane_symmetry = {.name = "J", .generator = plane_turn};
static const dvi_symmetry body_symmetry = {.name = "J", .generator = body_turn};
static const double inertia[9] = {1, 0, 0, 0, 2, 0, 0, 0, 2.5};
static const dvi_factor factors[] = {{.kind = DVI_SO3, .inertia = inertia},
                                     {.kind = DVI_S2, .mass = 1.5},
                                     {.kind = DVI_RN, .size = 1, .mass = 0.8}};

static dvi_system_terms terms_of(damped_kind kind)
{
  switch (kind) {
  case DAMPED_OSCILLATOR:
    return (dvi_system_terms){
        .dimension = 1, .mass = {.scalar = 1}, .potentials = &unit_spring, .potential_count = 1};
  case DAMPED_PLANE:
    return (dvi_system_terms){.dimension = 2,
                              .mass = {.scalar = 1.25},
                              .potentials = &plane,
                              .potential_count = 1,
                              .symmetries = &plane_symmetry,
                              .symmetry_count = 1};
  case DAMPED_DRIVE:
    return (dvi_system_terms){
        .dimension = 1, .lagrangian = &curved, .forces = &driven, .force_count = 1};
  default:
    return (dvi_system_terms){.factors = factors,
                              .factor_count = 3,
                              .potentials = kind == DAMPED_TOP ? &weight : NULL,
                              .potential_count = kind == DAMPED_TOP,
                              .symmetries = &body_symmetry,
                              .symmetry_count = 1};
  }
}

void make_damped(damped_kind kind, double gamma, damped *made)
{
  static const char *const names[] = {"oscillator", "plane", "drive", "top", "free top"};
  static const double start[3][DAMPED_NQ] = {
      {1, 0.3}, {1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6, 0.6, 0, 0.8, 0.2}, {0.9}};
  static const double velocity[3][DAMPED_NV] = {
      {0.2, 0.7}, {0.7, -0.4, 1.1, 0.4, 0.9, -0.3, 0.5}, {0.4}};
  const int at = kind >= DAMPED_TOP ? 1 : kind == DAMPED_DRIVE ? 2 : 0;
  dvi_system_terms terms = terms_of(kind);
  terms.damping = gamma;
  *made = (damped){.name = names[kind], .gamma = gamma};
  ck_assert_msg(dvi_system_create(&terms, &made->system) == DVI_OK, "%s", dvi_last_error());
  made->nq = dvi_system_nq(made->system);
  made->nv = dvi_system_nv(made->system);
  memcpy(made->q, start[at], sizeof made->q);
  memcpy(made->v, velocity[at], sizeof made->v);
}

void destroy_damped(damped *made)
{
  dvi_system_destroy(&made->system);
}

dvi_integrator *damped_integrator(const damped *model, const char *method)
{
  const dvi_integrator_options options = {.size = sizeof options, .method = method, .balances = 1};
  dvi_integrator *integrator;
  ck_assert_msg(dvi_integrator_create_with(model->system, &options, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model->q, model->v) == DVI_OK, "%s",
                dvi_last_error());
  return integrator;
}
