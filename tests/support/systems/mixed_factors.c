#include "support/systems/mixed_factors.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

/* ---- V = sum_i a_i q_i + q_i^2/2 + b_i q_i q_(i+3) ---- */

static double single_weight(int i)
{
  return 0.3 * sin(1.7 * i + 0.4);
}

static double pair_weight(int i)
{
  return 0.4 * cos(2.3 * i + 0.9);
}

static int mixed_value(double t, const double *q, double *V, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  *V = 0;
  for (int i = 0; i < n; i++)
    *V += single_weight(i) * q[i] + q[i] * q[i] / 2 +
          (i + 3 < n ? pair_weight(i) * q[i] * q[i + 3] : 0);
  return 0;
}

static int mixed_gradient(double t, const double *q, double *V_q, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  for (int i = 0; i < n; i++)
    V_q[i] = single_weight(i) + q[i] + (i + 3 < n ? pair_weight(i) * q[i + 3] : 0) +
             (i >= 3 ? pair_weight(i - 3) * q[i - 3] : 0);
  return 0;
}

/* ---- the systems ---- */

static const double inertia_of_some[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9},
                    centre[] = {.1, -.2, .15};

enum { WEDGED_Q = 11 };

/* Sets the masses beside those of the factors. */
static void fill_wedged_mass(double *M)
{
  M[0] = .3;
  M[WEDGED_Q + 1] = .5;
  M[2 * WEDGED_Q + 6] = M[6 * WEDGED_Q + 2] = .1;
  M[10] = M[10 * WEDGED_Q] = .05;
}

static const dvi_factor factors[MIXED_KINDS][3] = {
    {{.kind = DVI_S2, .mass = .8},
     {.kind = DVI_U1, .mass = .7},
     {.kind = DVI_SE3, .mass = 2, .inertia = inertia_of_some, .centre = centre}},
    {{.kind = DVI_RN, .size = 2, .mass = 1.2}, {.kind = DVI_U1, .mass = .7}},
    {{.kind = DVI_U1, .mass = .7}, {.kind = DVI_SO3, .inertia = inertia_of_some}},
};

static const double starts[MIXED_KINDS][2][BODY_Q] = {
    {{.6, 0, .8, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, .3, .1, 0}, {0, 1, 0, .8, 1, .3, -.4, .1, 0, .2}},
    {{.3, -.2, 1, 0}, {.5, .2, .8}},
    {{1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {.8, 1, .3, -.4}},
};

static void create_mixed_system(const dvi_system_terms *terms, const double *q, const double *v,
                                body *model)
{
  *model = (body){.name = "cells", .factors = terms->factors, .factor_count = terms->factor_count};
  ck_assert_msg(dvi_system_create(terms, &model->system) == DVI_OK, "%s", dvi_last_error());
  model->nq = dvi_system_nq(model->system);
  model->nv = dvi_system_nv(model->system);
  memcpy(model->q, q, (size_t)model->nq * sizeof *q);
  memcpy(model->v, v, (size_t)model->nv * sizeof *v);
}

void make_mixed_factors(mixed_kind kind, body *model)
{
  static int size[MIXED_KINDS] = {17, 4, WEDGED_Q};
  double M[WEDGED_Q * WEDGED_Q] = {0};
  const dvi_potential potential = {
      .value = mixed_value, .gradient = mixed_gradient, .user = &size[kind]};
  dvi_system_terms terms = {.factors = factors[kind],
                            .factor_count = kind == LOOSE ? 3 : 2,
                            .potentials = &potential,
                            .potential_count = 1,
                            .autonomous = 1};
  fill_wedged_mass(M);
  if (kind == WEDGED) terms.mass.values = M;
  create_mixed_system(&terms, starts[kind][0], starts[kind][1], model);
}

void make_free_body(const double *inertia, const double *Omega, body *model)
{
  const double upright[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia};
  create_mixed_system(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1},
                      upright, Omega, model);
  model->factors = NULL;
  model->factor_count = 0;
}
