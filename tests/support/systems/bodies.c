#include "support/systems/bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

/* ---- potentials: V = sum c q_i q_j, or c q_i where there is no j ---- */

typedef struct form_term {
  int i, j;
  double c;
} form_term;

enum { ALONE = -1, TERMS_MOST = 12 };

typedef struct quadratic_form {
  int n, count;
  form_term terms[TERMS_MOST];
} quadratic_form;

static int form_value(double t, const double *q, double *V, void *user)
{
  const quadratic_form *f = user;
  (void)t;
  *V = 0;
  for (int k = 0; k < f->count; k++)
    *V += f->terms[k].c * q[f->terms[k].i] * (f->terms[k].j == ALONE ? 1 : q[f->terms[k].j]);
  return 0;
}

static int form_gradient(double t, const double *q, double *V_q, void *user)
{
  const quadratic_form *f = user;
  (void)t;
  memset(V_q, 0, (size_t)f->n * sizeof *V_q);
  for (int k = 0; k < f->count; k++) {
    const form_term *term = &f->terms[k];
    V_q[term->i] += term->c * (term->j == ALONE ? 1 : q[term->j]);
    if (term->j != ALONE) V_q[term->j] += term->c * q[term->i];
  }
  return 0;
}

static int form_hessian(double t, const double *q, double *V_qq, void *user)
{
  const quadratic_form *f = user;
  (void)t;
  (void)q;
  memset(V_qq, 0, (size_t)(f->n * f->n) * sizeof *V_qq);
  for (int k = 0; k < f->count; k++) {
    const form_term *term = &f->terms[k];
    if (term->j == ALONE) continue;
    V_qq[term->i * f->n + term->j] += term->c;
    V_qq[term->j * f->n + term->i] += term->c;
  }
  return 0;
}

/* ---- symmetry: turns about the vertical ---- */

static int body_vertical(const double *q, double *xi, void *user)
{
  (void)user;
  memcpy(xi, q + 6, 3 * sizeof *xi);
  return 0;
}

static int motion_vertical(const double *q, double *xi, void *user)
{
  const double shift[] = {-q[10], q[9], 0};
  memcpy(xi + 3, shift, sizeof shift);
  return body_vertical(q, xi, user);
}

static int directions_vertical(const double *q, double *xi, void *user)
{
  const double turned[] = {-q[1], q[0], 0, -q[4], q[3], 0};
  (void)user;
  memcpy(xi, turned, sizeof turned);
  return 0;
}

/* ---- the systems ---- */

static const double free_inertia[] = {3, 0, 0, 0, 2, 0, 0, 0, 1.5},
                    pendulum_inertia[] = {.13, 0, 0, 0, .28, 0, 0, 0, .17},
                    top_inertia[] = {15.234375, 0, 0, 0, .46875, 0, 0, 0, 15.234375},
                    motion_inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9},
                    centre[] = {.1, -.2, .15};

/* A mass between two coordinates, such as m l^2. */
typedef struct coupling {
  int i, j;
  double mass;
} coupling;

typedef struct description {
  const char *name;
  dvi_factor factors[4];
  int factor_count, dimension;
  quadratic_form potential;
  coupling couplings[6];
  int (*vertical)(const double *q, double *xi, void *user);
  double q[BODY_Q], v[BODY_V];
} description;

#define UPRIGHT 1, 0, 0, 0, 1, 0, 0, 0, 1

static description table[BODIES] = {
    {.name = "free body",
     .factors = {{.kind = DVI_SO3, .inertia = free_inertia}},
     .factor_count = 1,
     .dimension = 9,
     .vertical = body_vertical,
     .q = {UPRIGHT},
     .v = {.5, -.5, .4}},
    {.name = "pendulum-3d",
     .factors = {{.kind = DVI_SO3, .inertia = pendulum_inertia}},
     .factor_count = 1,
     .dimension = 9,
     .potential = {9, 1, {{8, ALONE, -2.943}}},
     .vertical = body_vertical,
     .q = {UPRIGHT},
     .v = {4.14, 4.14, 4.14}},
    {.name = "heavy top",
     .factors = {{.kind = DVI_SO3, .inertia = top_inertia}},
     .factor_count = 1,
     .dimension = 9,
     .potential = {9, 1, {{7, ALONE, 147.15}}},
     .vertical = body_vertical,
     .q = {UPRIGHT},
     .v = {0, 150, -4.61538}},
    {.name = "free motion",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = motion_inertia, .centre = centre}},
     .factor_count = 1,
     .dimension = 12,
     .vertical = motion_vertical,
     .q = {UPRIGHT, .3},
     .v = {1, .3, -.4, .1, -.2, .5}},
    {.name = "motion",
     .factors = {{.kind = DVI_SE3, .mass = 2, .inertia = motion_inertia, .centre = centre}},
     .factor_count = 1,
     .dimension = 12,
     .potential = {12, 5, {{9, 9, .5}, {10, 10, 1}, {11, 11, 1.5}, {2, 9, .3}, {7, ALONE, 1.2}}},
     .q = {UPRIGHT, .3},
     .v = {1, .3, -.4, .1, -.2, .5}},
    {.name = "directions",
     .factors = {{.kind = DVI_S2, .mass = .002}, {.kind = DVI_S2, .mass = .001}},
     .factor_count = 2,
     .dimension = 6,
     .potential = {6, 2, {{2, ALONE, .1962}, {5, ALONE, .0981}}},
     .couplings = {{0, 3, .001}, {1, 4, .001}, {2, 5, .001}},
     .vertical = directions_vertical,
     .q = {.866, 0, .5, 0, 0, 1},
     .v = {0, 1, 0, .5, 0, 0}},
    {.name = "angle",
     .factors = {{.kind = DVI_U1, .mass = .7}},
     .factor_count = 1,
     .dimension = 2,
     .potential = {2, 1, {{0, ALONE, -1}}},
     .q = {1, 0},
     .v = {1.3}},
    {.name = "product",
     .factors = {{.kind = DVI_S2, .mass = .06},
                 {.kind = DVI_S2, .mass = .03},
                 {.kind = DVI_SE3, .mass = 2, .inertia = motion_inertia, .centre = centre},
                 {.kind = DVI_U1, .mass = .7}},
     .factor_count = 4,
     .dimension = 20,
     .potential = {20,
                   8,
                   {{2, ALONE, .2},
                    {5, ALONE, .1},
                    {15, 15, .5},
                    {16, 16, 1},
                    {17, 17, 1.5},
                    {8, 15, .3},
                    {11, 2, .2},
                    {18, 14, .4}}},
     .couplings =
         {{0, 3, .03}, {1, 4, .03}, {2, 5, .03}, {0, 15, .004}, {1, 16, .004}, {2, 17, .004}},
     .q = {.866, 0, .5, 0, 0, 1, UPRIGHT, .3, 0, 0, 1, 0},
     .v = {0, 1, 0, .5, 0, 0, 1, .3, -.4, .1, 0, 0, .8}},
};

void make_body(body_kind kind, body *model)
{
  const description *d = &table[kind];
  double mass[BODY_Q * BODY_Q] = {0};
  const dvi_potential potential = {.name = "form",
                                   .value = form_value,
                                   .gradient = form_gradient,
                                   .hessian = form_hessian,
                                   .user = (void *)&d->potential};
  const dvi_symmetry symmetry = {.name = "vertical momentum", .generator = d->vertical};
  dvi_system_terms terms = {.factors = d->factors,
                            .factor_count = d->factor_count,
                            .potentials = d->potential.count > 0 ? &potential : NULL,
                            .potential_count = d->potential.count > 0,
                            .symmetries = d->vertical != NULL ? &symmetry : NULL,
                            .symmetry_count = d->vertical != NULL,
                            .autonomous = 1};
  for (int k = 0; k < 6; k++)
    if (d->couplings[k].mass != 0)
      mass[d->couplings[k].i * d->dimension + d->couplings[k].j] =
          mass[d->couplings[k].j * d->dimension + d->couplings[k].i] = d->couplings[k].mass;
  if (d->couplings[0].mass != 0) terms.mass.values = mass;
  *model = (body){.name = d->name, .factors = d->factors, .factor_count = d->factor_count};
  ck_assert_msg(dvi_system_create(&terms, &model->system) == DVI_OK, "%s: %s", d->name,
                dvi_last_error());
  model->nq = dvi_system_nq(model->system);
  model->nv = dvi_system_nv(model->system);
  memcpy(model->q, d->q, sizeof model->q);
  memcpy(model->v, d->v, sizeof model->v);
  ck_assert_msg(dvi_system_project(model->system, model->q) == DVI_OK, "%s", dvi_last_error());
}

void destroy_body(body *model)
{
  dvi_system_destroy(&model->system);
}

dvi_integrator *body_integrator(const body *model, const char *method)
{
  dvi_integrator *made;
  ck_assert_msg(dvi_integrator_create(model->system, method, &made) == DVI_OK, "%s, %s: %s",
                model->name, method, dvi_last_error());
  ck_assert_msg(dvi_integrator_start_velocity(made, 0, model->q, model->v) == DVI_OK, "%s, %s: %s",
                model->name, method, dvi_last_error());
  return made;
}

/* ---- the chain ---- */

static const double spring_constant = 0.3, mass_of_link = 0.1;

static int chain_value(double t, const double *q, double *V, void *user)
{
  const direction_chain *linked = user;
  const int n = 3 * linked->links;
  (void)t;
  *V = 0;
  for (int i = 2; i < n; i += 3) *V += q[i];
  for (int i = 3; i < n; i++) *V -= spring_constant * q[i] * q[i - 3];
  return 0;
}

static int chain_gradient(double t, const double *q, double *V_q, void *user)
{
  const direction_chain *linked = user;
  const int n = 3 * linked->links;
  (void)t;
  for (int i = 0; i < n; i++)
    V_q[i] = (i % 3 == 2) -
             spring_constant * ((i >= 3 ? q[i - 3] : 0) + (i + 3 < n ? q[i + 3] : 0));
  return 0;
}

static int chain_hessian(double t, const double *q, double *V_qq, void *user)
{
  const direction_chain *linked = user;
  (void)t;
  (void)q;
  for (int e = 0; e < 6 * (linked->links - 1); e++) V_qq[e] = -spring_constant;
  return 0;
}

static void *allocate(size_t count, size_t size)
{
  void *made = calloc(count, size);
  ck_assert_ptr_nonnull(made);
  return made;
}

/* Lists the pattern. Coordinate j couples to those of the links before and after. */
static void chain_pattern(direction_chain *linked)
{
  const int n = 3 * linked->links;
  int entries = 0;
  for (int j = 0; j < n; j++) {
    if (j >= 3) linked->row[entries++] = j - 3;
    if (j + 3 < n) linked->row[entries++] = j + 3;
    linked->start[j + 1] = entries;
  }
}

void make_direction_chain(int links, direction_chain *linked)
{
  const size_t n = 3 * (size_t)links;
  dvi_factor *factors = allocate((size_t)links, sizeof *factors);
  *linked = (direction_chain){.links = links,
                              .start = allocate(n + 1, sizeof(int)),
                              .row = allocate(2 * n, sizeof(int)),
                              .q = allocate(n, sizeof(double)),
                              .v = allocate(n, sizeof(double))};
  chain_pattern(linked);
  const dvi_potential potential = {.name = "chain",
                                   .value = chain_value,
                                   .gradient = chain_gradient,
                                   .hessian = chain_hessian,
                                   .qq = {linked->start, linked->row},
                                   .user = linked};
  for (int i = 0; i < links; i++) {
    const double angle = 0.1 * i;
    factors[i] = (dvi_factor){.kind = DVI_S2, .mass = mass_of_link};
    linked->q[3 * i] = sin(angle), linked->q[3 * i + 2] = -cos(angle);
    linked->v[3 * i + 1] = 0.5 * cos(angle);
  }
  const dvi_system_terms terms = {.factors = factors,
                                  .factor_count = links,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &linked->system) == DVI_OK, "%s", dvi_last_error());
  free(factors);
  ck_assert_int_eq(dvi_system_project(linked->system, linked->q), DVI_OK);
}

void destroy_direction_chain(direction_chain *linked)
{
  dvi_system_destroy(&linked->system);
  free(linked->start);
  free(linked->row);
  free(linked->q);
  free(linked->v);
}
