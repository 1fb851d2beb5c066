/* One element of every kind of system and of many spaces, and its path by the public basis. */
#ifndef TESTS_STEP_ELEMENT_H
#define TESTS_STEP_ELEMENT_H
#include <math.h>
#include <string.h>

#include "step/element/action.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum { DEGREE_MOST = 8, NODES_MOST = 12, UNKNOWNS_MOST = SITES * DEGREE_MOST };

static const double t0 = 0.4, h = 0.3;
static behaviour quiet;

/* ---- systems ---- */

enum {
  SCALAR_MASS,
  DIAGONAL_MASS,
  SPARSE_MASS,
  GENERAL,
  MIXED,
  DENSE_POTENTIAL,
  DENSE_GENERAL,
  SYSTEMS
};

/* The dense kinds leave Hessian and pattern out, so every entry may be nonzero, and the library
 * takes differences. */
static inline dvi_system *create_system(int kind)
{
  static const double diagonal[SITES] = {1, 2, 0.5, 3, 1.5, 0.7};
  dvi_lagrangian lagrangian = rotors(&quiet, BATCH);
  dvi_potential potentials[2] = {springs(&quiet, ONE_POINT), wells(&quiet, BATCH)};
  dvi_system_terms terms = {.dimension = SITES, .potentials = potentials, .potential_count = 2};
  if (kind == DENSE_POTENTIAL) potentials[0].hessian = NULL, potentials[0].qq = (dvi_pattern){0};
  if (kind == DENSE_GENERAL)
    lagrangian.hessian_batch = NULL,
    lagrangian.qq = lagrangian.qv = lagrangian.vv = (dvi_pattern){0};
  if (kind == GENERAL || kind == DENSE_GENERAL) terms.potentials = NULL, terms.potential_count = 0;
  if (kind == GENERAL || kind == MIXED || kind == DENSE_GENERAL)
    terms.lagrangian = &lagrangian;
  else if (kind == DIAGONAL_MASS)
    terms.mass.diagonal = diagonal;
  else if (kind == SPARSE_MASS)
    terms.mass = (dvi_mass){.values = tridiagonal_mass, .pattern = tridiagonal};
  else
    terms.mass.scalar = 1.3;
  return make_system(&terms);
}

/* ---- spaces ---- */

enum { BASES = DVI_CHEBYSHEV + 1 };

/* Degrees, rules and nodes. The rules are short, just enough, or long. */
static const dvi__action_space rules[] = {
    {0, 1, DVI_MIDPOINT, 1}, {0, 1, DVI_TRAPEZOID, 2},   {0, 2, DVI_GAUSS, 2},
    {0, 2, DVI_SIMPSON, 3},  {0, 3, DVI_LOBATTO, 3},     {0, 3, DVI_RADAU_LEFT, 4},
    {0, 4, DVI_GAUSS, 6},    {0, 4, DVI_RADAU_RIGHT, 4}, {0, 5, DVI_CLENSHAW_CURTIS, 7},
};
enum { RULES = sizeof rules / sizeof *rules };

/* The kind of system and the rule of a looped test, which also loops over the bases. */
static inline void for_every_basis(void (*check)(int kind, dvi__action_space space), int index)
{
  dvi__action_space space = rules[index % RULES];
  for (int basis = 0; basis < BASES; basis++) {
    space.basis = (dvi_basis)basis;
    check(index / RULES, space);
  }
}

/* ---- the element and its definition ---- */

typedef struct element {
  dvi_system *system;
  dvi__action *action;
  dvi_counters counters;
  dvi__action_space space;
  double q0[SITES], p0[SITES], Y[UNKNOWNS_MOST];
} element;

static inline void make_element(int kind, dvi__action_space space, element *e)
{
  *e = (element){.system = create_system(kind), .space = space};
  ck_assert_msg(dvi__action_create(e->system, &space, &e->counters, &e->action) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi__action_unknowns(e->action), SITES * space.degree);
  memcpy(e->q0, generic_q, sizeof e->q0);
  memcpy(e->p0, generic_v, sizeof e->p0);
  for (int i = 0; i < SITES; i++)
    for (int k = 0; k < space.degree; k++)
      e->Y[i * space.degree + k] = h * (generic_v[i] + 0.3 * cos(2 * i + 5 * k)) / (1 + k);
  dvi__action_place(e->action, t0, h, e->q0, e->p0);
}

static inline void free_element(element *e)
{
  dvi__action_destroy(&e->action);
  dvi_system_destroy(&e->system);
}

/* Requires DVI_OK. Check's assertions write a record each, and these calls come by the million. */
static inline void require_ok(dvi_status status)
{
  if (status != DVI_OK) ck_abort_msg("%s", dvi_last_error());
}

/* psi_k = phi_k - phi_k(0) and its derivative, k = 1..degree. */
static inline void evaluate_trial(const dvi__action_space *space, double tau, double *psi,
                                  double *dpsi)
{
  double start[DEGREE_MOST + 1], value[DEGREE_MOST + 1], derivative[DEGREE_MOST + 1];
  require_ok(dvi_basis_evaluate(space->basis, space->degree, 0, start, NULL));
  require_ok(dvi_basis_evaluate(space->basis, space->degree, tau, value, derivative));
  for (int k = 0; k < space->degree; k++) {
    psi[k] = value[k + 1] - start[k + 1];
    dpsi[k] = derivative[k + 1];
  }
}

static inline void path(const element *e, const double *q0, const double *Y, double tau, double *q,
                        double *v)
{
  double psi[DEGREE_MOST], dpsi[DEGREE_MOST];
  evaluate_trial(&e->space, tau, psi, dpsi);
  for (int i = 0; i < SITES; i++) {
    q[i] = q0[i];
    v[i] = 0;
    for (int k = 0; k < e->space.degree; k++) {
      q[i] += psi[k] * Y[i * e->space.degree + k];
      v[i] += dpsi[k] * Y[i * e->space.degree + k] / h;
    }
  }
}

#endif
