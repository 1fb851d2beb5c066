#include "support/walls.h"

#include <math.h>

#include "support/suite.h"

static const double g = 9.81;

/* ---- what moves ---- */

static int pendulum(double t, const double *q, double *V, void *user)
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

/* The weight of the last coordinate. `user` points to the number of coordinates. */
static int weight(double t, const double *q, double *V, void *user)
{
  (void)t;
  *V = g * q[*(const int *)user - 1];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const int n = *(const int *)user;
  (void)t, (void)q;
  for (int i = 0; i < n; i++) V_q[i] = i == n - 1 ? g : 0;
  return 0;
}

static int push(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = g * q[1] - 3 * q[0];
  return 0;
}

static int push_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  V_q[0] = -3, V_q[1] = g;
  return 0;
}

static int polar(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) / 2 - g * q[0] * sin(q[1]);
  return 0;
}

static int polar_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                          void *user)
{
  (void)t, (void)user;
  L_q[0] = q[0] * v[1] * v[1] - g * sin(q[1]);
  L_q[1] = -g * q[0] * cos(q[1]);
  L_v[0] = v[0];
  L_v[1] = q[0] * q[0] * v[1];
  return 0;
}

static int fast(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)q, (void)user;
  if (!(fabs(v[0]) < 1)) return 1;
  *L = -sqrt(1 - v[0] * v[0]);
  return 0;
}

static int fast_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  (void)t, (void)q, (void)user;
  if (!(fabs(v[0]) < 1)) return 1;
  L_q[0] = 0;
  L_v[0] = v[0] / sqrt(1 - v[0] * v[0]);
  return 0;
}

/* ---- gaps c + a.q + b |q|^2 + r t + s sin(t) ---- */

typedef struct wall {
  double c, a[2], b, r;
  int n;
  double s;
} wall;

static int wall_gap(double t, const double *q, double *phi, void *user)
{
  const wall *w = user;
  *phi = w->c + w->r * t + w->s * sin(t);
  for (int i = 0; i < w->n; i++) *phi += (w->a[i] + w->b * q[i]) * q[i];
  return 0;
}

static int wall_gradient(double t, const double *q, double *phi_q, void *user)
{
  const wall *w = user;
  (void)t;
  for (int i = 0; i < w->n; i++) phi_q[i] = w->a[i] + 2 * w->b * q[i];
  return 0;
}

static int wall_rate(double t, const double *q, double *phi_t, void *user)
{
  const wall *w = user;
  (void)q;
  *phi_t = w->r + w->s * cos(t);
  return 0;
}

typedef struct place {
  int n, count;
  wall wall[2];
} place;

static place places[] = {
    [WALLS_PENDULUM] = {1, 1, {{0.8, {-1}, 0, 0, 1, 0}}},
    [WALLS_CIRCLE] = {2, 1, {{1, {0}, -1, 0, 2, 0}}},
    [WALLS_POLAR] = {2, 1, {{1, {-1, 0}, 0, 0, 2, 0}}},
    [WALLS_DROP] = {1, 1, {{0, {1}, 0, 0, 1, 0}}},
    [WALLS_CHANNEL] = {1, 2, {{0, {1}, 0, 0, 1, 0}, {1, {-1}, 0, 0, 1, 0}}},
    [WALLS_MOVING] = {1, 1, {{0, {1}, 0, -0.5, 1, 0}}},
    [WALLS_FAST] = {1, 2, {{0, {1}, 0, 0, 1, 0}, {1, {-1}, 0, 0, 1, 0}}},
    [WALLS_WEDGE] = {2, 2, {{0, {0, 1}, 0, 0, 2, 0}, {0, {0.6, -0.8}, 0, 0, 2, 0}}},
    [WALLS_CORNER] = {2, 2, {{0, {1, 0}, 0, 0, 2, 0}, {0, {0, 1}, 0, 0, 2, 0}}},
    [WALLS_STONE] = {2, 1, {{-1, {0}, 1, 0, 2, 0}}},
    [WALLS_HILL] = {2, 1, {{-1, {0}, 1, 0, 2, 0}}},
    [WALLS_ROUND] = {2, 1, {{-1, {1, 0}, 0, 0, 2, 0}}},
    [WALLS_PRESSED] = {1, 1, {{-0.3, {1}, 0, 0, 1, 0}}},
    [WALLS_TABLE] = {2, 2, {{0, {0, 1}, 0, 0, 2, 0}, {1, {-1, 0}, 0, 0, 2, 0}}},
    [WALLS_SLOPE] = {2, 2, {{0, {0.3, 1}, 0, 0, 2, 0}, {1, {-1, 0}, 0, 0, 2, 0}}},
    [WALLS_RAMP] = {2, 2, {{0, {0, 1}, 0, 0, 2, 0}, {1, {-1, 0.5}, 0, 0, 2, 0}}},
    [WALLS_NOOK] = {2, 2, {{0, {0, 1}, 0, 0, 2, 0}, {1, {-1, 0}, 0, 0, 2, 0}}},
    [WALLS_LIFT] = {1, 1, {{0, {1}, 0, 0, 1, -1}}},
};

static dvi_contact contact_of(wall *w, const char *name, double restitution, int hold)
{
  return (dvi_contact){.name = name,
                       .gap = wall_gap,
                       .gradient = wall_gradient,
                       .rate = w->r != 0 || w->s != 0 ? wall_rate : NULL,
                       .restitution = restitution,
                       .hold = hold,
                       .user = w};
}

static dvi_system *create_place(walls_place which, double restitution, int hold)
{
  static const char *const name[] = {"first", "second"};
  static const dvi_potential of_pendulum = {
      .value = pendulum, .gradient = pendulum_gradient, .hessian = pendulum_hessian};
  static const dvi_potential of_push = {.value = push, .gradient = push_gradient, .quadratic = 1};
  static const dvi_lagrangian of_polar = {.value = polar, .gradient = polar_gradient},
                              of_fast = {.value = fast, .gradient = fast_gradient};
  place *at = &places[which];
  const dvi_potential of_weight = {
      .value = weight, .gradient = weight_gradient, .quadratic = 1, .user = &at->n};
  dvi_contact contact[2];
  dvi_system_terms terms = {.dimension = at->n,
                            .contacts = contact,
                            .contact_count = at->count,
                            .autonomous = which != WALLS_MOVING && which != WALLS_LIFT};
  dvi_system *system;
  for (int k = 0; k < at->count; k++)
    contact[k] = contact_of(&at->wall[k], name[k], restitution, hold);
  if (which == WALLS_POLAR || which == WALLS_ROUND) terms.lagrangian = &of_polar;
  if (which == WALLS_FAST) terms.lagrangian = &of_fast;
  if (terms.lagrangian == NULL) terms.mass.scalar = 1;
  if (which == WALLS_PENDULUM || which == WALLS_PRESSED)
    terms.potentials = &of_pendulum, terms.potential_count = 1;
  if (which == WALLS_CIRCLE || which == WALLS_DROP || which == WALLS_HILL || which == WALLS_TABLE ||
      which == WALLS_SLOPE || which == WALLS_RAMP || which == WALLS_LIFT)
    terms.potentials = &of_weight, terms.potential_count = 1;
  if (which == WALLS_NOOK) terms.potentials = &of_push, terms.potential_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

dvi_system *create_walls(walls_place which, double restitution)
{
  return create_place(which, restitution, 0);
}

dvi_system *create_holding_walls(walls_place which, double restitution)
{
  return create_place(which, restitution, 1);
}
