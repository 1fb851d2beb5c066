#include "support/systems/cells.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

/* ---- V = sum_i a_i q_i + q_i^2/2 + b_i q_i q_(i+3) ---- */

static double alone(int i)
{
  return 0.3 * sin(1.7 * i + 0.4);
}

static double between(int i)
{
  return 0.4 * cos(2.3 * i + 0.9);
}

static int mixed_value(double t, const double *q, double *V, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  *V = 0;
  for (int i = 0; i < n; i++)
    *V += alone(i) * q[i] + q[i] * q[i] / 2 + (i + 3 < n ? between(i) * q[i] * q[i + 3] : 0);
  return 0;
}

static int mixed_gradient(double t, const double *q, double *V_q, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  for (int i = 0; i < n; i++)
    V_q[i] = alone(i) + q[i] + (i + 3 < n ? between(i) * q[i + 3] : 0) +
             (i >= 3 ? between(i - 3) * q[i - 3] : 0);
  return 0;
}

/* ---- the systems ---- */

static const double inertia_of_some[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9},
                    centre[] = {.1, -.2, .15};

enum { WEDGED_Q = 11 };

/* The masses beside the factors' own. */
static void wedge(double *M)
{
  M[0] = .3;
  M[WEDGED_Q + 1] = .5;
  M[2 * WEDGED_Q + 6] = M[6 * WEDGED_Q + 2] = .1;
  M[10] = M[10 * WEDGED_Q] = .05;
}

static const dvi_factor factors[CELLS][3] = {
    {{.kind = DVI_S2, .mass = .8},
     {.kind = DVI_U1, .mass = .7},
     {.kind = DVI_SE3, .mass = 2, .inertia = inertia_of_some, .centre = centre}},
    {{.kind = DVI_RN, .size = 2, .mass = 1.2}, {.kind = DVI_U1, .mass = .7}},
    {{.kind = DVI_U1, .mass = .7}, {.kind = DVI_SO3, .inertia = inertia_of_some}},
};

static const double starts[CELLS][2][BODY_Q] = {
    {{.6, 0, .8, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, .3, .1, 0}, {0, 1, 0, .8, 1, .3, -.4, .1, 0, .2}},
    {{.3, -.2, 1, 0}, {.5, .2, .8}},
    {{1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {.8, 1, .3, -.4}},
};

static void finish(const dvi_system_terms *terms, const double *q, const double *v, body *of)
{
  *of = (body){.name = "cells", .factors = terms->factors, .factor_count = terms->factor_count};
  ck_assert_msg(dvi_system_create(terms, &of->system) == DVI_OK, "%s", dvi_last_error());
  of->nq = dvi_system_nq(of->system);
  of->nv = dvi_system_nv(of->system);
  memcpy(of->q, q, (size_t)of->nq * sizeof *q);
  memcpy(of->v, v, (size_t)of->nv * sizeof *v);
}

void make_cells(cells_kind kind, body *of)
{
  static int size[CELLS] = {17, 4, WEDGED_Q};
  double M[WEDGED_Q * WEDGED_Q] = {0};
  const dvi_potential potential = {
      .value = mixed_value, .gradient = mixed_gradient, .user = &size[kind]};
  dvi_system_terms terms = {.factors = factors[kind],
                            .factor_count = kind == LOOSE ? 3 : 2,
                            .potentials = &potential,
                            .potential_count = 1,
                            .autonomous = 1};
  wedge(M);
  if (kind == WEDGED) terms.mass.values = M;
  finish(&terms, starts[kind][0], starts[kind][1], of);
}

void make_free_body(const double *inertia, const double *Omega, body *of)
{
  const double upright[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia};
  finish(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1}, upright,
         Omega, of);
  of->factors = NULL;
  of->factor_count = 0;
}
