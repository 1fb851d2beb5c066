#include "support/systems/machines.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

/* ---- weights: V = sum g m z of bodies, points and directions ---- */

enum { WEIGHTS_MOST = 4 };

typedef struct weights {
  int n, count, at[WEIGHTS_MOST];
  double c[WEIGHTS_MOST];
} weights;

static int weights_value(double t, const double *q, double *V, void *user)
{
  const weights *w = user;
  (void)t;
  *V = 0;
  for (int k = 0; k < w->count; k++) *V += w->c[k] * q[w->at[k]];
  return 0;
}

static int weights_gradient(double t, const double *q, double *V_q, void *user)
{
  const weights *w = user;
  (void)t, (void)q;
  memset(V_q, 0, (size_t)w->n * sizeof *V_q);
  for (int k = 0; k < w->count; k++) V_q[w->at[k]] += w->c[k];
  return 0;
}

static int weights_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user;
  return 0;
}

/* ---- a constraint that is no joint: two directions at a constant angle ---- */

static const double cosine_of_cone = 0.3;

static int cone_value(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  *phi = q[0] * q[3] + q[1] * q[4] + q[2] * q[5] - cosine_of_cone;
  return 0;
}

static int cone_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 6; i++) phi_q[i] = q[(i + 3) % 6];
  return 0;
}

/* ---- the machines ---- */

static const double light[] = {.02, 0, 0, 0, .02, 0, 0, 0, .02},
                    pendulum_at_centre[] = {.04, 0, 0, 0, .19, 0, 0, 0, .17},
                    skew[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9},
                    other[] = {.7, 0, .1, 0, .9, 0, .1, 0, 1.1};

#define UPRIGHT 1, 0, 0, 0, 1, 0, 0, 0, 1
#define GROUND DVI_GROUND

typedef struct description {
  const char *name;
  dvi_factor factors[3];
  int factor_count;
  dvi_joint joints[3];
  int joint_count;
  weights weights;
  double q[BODY_Q], v[BODY_V], span;
} description;

static const description table[MACHINES] = {
    {.name = "ball pendulum",
     .factors = {{.kind = DVI_SE3, .mass = 1, .inertia = pendulum_at_centre}},
     .factor_count = 1,
     .joints = {{.name = "pivot", .kind = DVI_BALL, .body = {GROUND, 0}}},
     .joint_count = 1,
     .weights = {12, 1, {11}, {9.81}},
     .q = {UPRIGHT, 0, 0, -.3},
     .v = {.5, -.5, .4},
     .span = .25},
    {.name = "hinge pendulum",
     .factors = {{.kind = DVI_SE3, .mass = 1, .inertia = light}},
     .factor_count = 1,
     .joints = {{.name = "hinge", .kind = DVI_HINGE, .body = {0, GROUND}, .axis = {2, 0, 0}}},
     .joint_count = 1,
     .weights = {12, 1, {11}, {9.81}},
     .q = {1, 0, 0, 0, -.4161468365471424, -.9092974268256817, 0, .9092974268256817,
           -.4161468365471424, 0, .27278922804770451, .12484405096414272},
     .v = {.3},
     .span = .3},
    {.name = "Cardan shaft",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = skew},
                 {.kind = DVI_SE3, .mass = 1, .inertia = other}},
     .factor_count = 2,
     .joints = {{.name = "bearing", .kind = DVI_HINGE, .body = {GROUND, 0}, .axis = {.6, 0, .8}},
                {.name = "cross",
                 .kind = DVI_UNIVERSAL,
                 .body = {0, 1},
                 .at = {.4, 0, .6},
                 .axis = {0, 1, 0},
                 .second_axis = {.8, 0, -.6}}},
     .joint_count = 2,
     .weights = {24, 2, {11, 23}, {9.81 * 2, 9.81}},
     .q = {UPRIGHT, .2, 0, .3, UPRIGHT, .6, .1, 1},
     .v = {.6, 0, .8, 0, 0, 0, .3, .5, .1},
     .span = .5},
    {.name = "swing on a slider",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = skew},
                 {.kind = DVI_SE3, .mass = 1, .inertia = other}},
     .factor_count = 2,
     .joints = {{.name = "rail", .kind = DVI_SLIDER, .body = {GROUND, 0}, .axis = {.8, .6, 0}},
                {.name = "hook", .kind = DVI_BALL, .body = {0, 1}, .at = {.1, .2, -.3}}},
     .joint_count = 2,
     .weights = {24, 2, {11, 23}, {9.81 * 2, 9.81}},
     .q = {UPRIGHT, 0, 0, 0, UPRIGHT, .5, .3, -1},
     .v = {0, 0, 0, .4, .3, 0, .5, -.4, .3},
     .span = .5},
    {.name = "puck",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = skew},
                 {.kind = DVI_RN, .size = 3, .mass = .5}},
     .factor_count = 2,
     .joints = {{.name = "table", .kind = DVI_PLANAR, .body = {GROUND, 0}, .axis = {.6, 0, .8}},
                {.name = "string",
                 .kind = DVI_DISTANCE,
                 .body = {1, 0},
                 .at = {.5, .5, -.7},
                 .to = {.1, .2, -.1}}},
     .joint_count = 2,
     .weights = {15, 2, {11, 14}, {9.81 * 2, 9.81 * .5}},
     .q = {UPRIGHT, 0, 0, 0, .5, .5, -.7},
     .v = {.6, 0, .8, .4, .3, -.3, .1, .2, .3},
     .span = .5},
    {.name = "welded",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = skew},
                 {.kind = DVI_SE3, .mass = 1, .inertia = other}},
     .factor_count = 2,
     .joints = {{.name = "pivot", .kind = DVI_BALL, .body = {0, GROUND}, .at = {0, .1, .5}},
                {.name = "seam", .kind = DVI_WELD, .body = {0, 1}, .at = {.2, .2, .2}}},
     .joint_count = 2,
     .weights = {24, 2, {11, 23}, {9.81 * 2, 9.81}},
     .q = {UPRIGHT, 0, 0, 0, .8, -.6, 0, .6, .8, 0, 0, 0, 1, .5, .3, -.6},
     .v = {.5, -.5, .4, 0, 0, 0, .5, -.4, .3},
     .span = .6},
    {.name = "free pair",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = skew},
                 {.kind = DVI_SE3, .mass = 1, .inertia = other}},
     .factor_count = 2,
     .joints = {{.name = "knee", .kind = DVI_BALL, .body = {0, 1}, .at = {.3, -.2, .4}}},
     .joint_count = 1,
     .weights = {24, 0, {0}, {0}},
     .q = {UPRIGHT, 0, 0, 0, .8, -.6, 0, .6, .8, 0, 0, 0, 1, .5, .3, .9},
     .v = {.5, -.5, .4, .2, .1, .3, .5, -.9, .8, 0, .1, .4},
     .span = 1},
    {.name = "cone",
     .factors = {{.kind = DVI_S2, .mass = 1}, {.kind = DVI_S2, .mass = .6}},
     .factor_count = 2,
     .weights = {6, 2, {2, 5}, {9.81, 9.81 * .6}},
     .q = {.6, 0, -.8, -.14, .9539392014169456, -.48},
     .v = {.8, .3, .6, .1, .2, .3},
     .span = .4},
};

/* Gives the position and velocity of a start that is projected onto the constraints. */
static void start_on_constraints(body *model)
{
  const dvi_start_options project = {.project = 1};
  dvi_integrator *made;
  double p[BODY_V];
  ck_assert_msg(dvi_integrator_create(model->system, "lie-galerkin:degree=1", &made) == DVI_OK,
                "%s: %s", model->name, dvi_last_error());
  ck_assert_int_eq(dvi_system_project(model->system, model->q), DVI_OK);
  for (int c = 0; c < 2 && model->factors[c].kind == DVI_S2; c++) {
    double along = 0, *q = model->q + 3 * c, *v = model->v + 3 * c;
    for (int i = 0; i < 3; i++) along += q[i] * v[i];
    for (int i = 0; i < 3; i++) v[i] -= along * q[i];
  }
  ck_assert_msg(dvi_system_momentum(model->system, 0, model->q, model->v, p) == DVI_OK, "%s: %s",
                model->name, dvi_last_error());
  ck_assert_msg(dvi_integrator_start_with(made, 0, model->q, p, &project) == DVI_OK, "%s: %s",
                model->name, dvi_last_error());
  memcpy(model->q, dvi_integrator_q(made), (size_t)model->nq * sizeof *model->q);
  ck_assert_int_eq(
      dvi_system_velocity(model->system, 0, model->q, dvi_integrator_p(made), model->v), DVI_OK);
  dvi_integrator_destroy(&made);
}

void make_machine(machine_kind kind, machine *made)
{
  static weights acting[MACHINES];
  static const int none[BODY_Q + 1] = {0};
  const description *d = &table[kind];
  const dvi_holonomic cone = {
      .name = "cone", .count = 1, .value = cone_value, .gradient = cone_gradient};
  acting[kind] = d->weights;
  const dvi_potential potential = {.name = "weights",
                                   .value = weights_value,
                                   .gradient = weights_gradient,
                                   .hessian = weights_hessian,
                                   .qq = {none, none},
                                   .user = &acting[kind]};
  *made = (machine){.span = d->span};
  dvi_system_terms terms = {.factors = d->factors,
                            .factor_count = d->factor_count,
                            .potentials = &potential,
                            .potential_count = 1,
                            .holonomics = &cone,
                            .holonomic_count = 1,
                            .autonomous = 1};
  if (d->joint_count > 0) {
    ck_assert_msg(dvi_joints_create(d->factors, d->factor_count, d->joints, d->joint_count, d->q,
                                    &made->joints) == DVI_OK,
                  "%s: %s", d->name, dvi_last_error());
    terms.holonomics = dvi_joints_constraints(made->joints);
  }
  made->body = (body){.name = d->name, .factors = d->factors, .factor_count = d->factor_count};
  ck_assert_msg(dvi_system_create(&terms, &made->body.system) == DVI_OK, "%s: %s", d->name,
                dvi_last_error());
  made->body.nq = dvi_system_nq(made->body.system);
  made->body.nv = dvi_system_nv(made->body.system);
  memcpy(made->body.q, d->q, sizeof made->body.q);
  memcpy(made->body.v, d->v, sizeof made->body.v);
  start_on_constraints(&made->body);
}

void destroy_machine(machine *made)
{
  dvi_system_destroy(&made->body.system);
  dvi_joints_destroy(&made->joints);
}
