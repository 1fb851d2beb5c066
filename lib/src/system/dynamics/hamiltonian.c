/* A Hamiltonian H(t,q,p) on phase space has q' = H_p, p' = -H_q. All functions of the evaluator
 * give H and its derivatives. p takes the place of v. */
#include "system/dynamics/hamiltonian.h"

#include <string.h>

#include "core/status.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/term/declare.h"

const char dvi__no_taylor_of_hamiltonian[] =
    "a Hamiltonian has no taylor callback, and derivatives beyond the second are needed; take a "
    "tableau, and a "
    "quadrature by values";

dvi_status dvi__declare_hamiltonian(const dvi_system_terms *terms, dvi_system *system,
                                    dvi__term term)
{
  static const char *const part[] = {"Hamiltonian: d2H/dq2", "Hamiltonian: d2H/dqdp",
                                     "Hamiltonian: d2H/dp2"};
  const dvi_hamiltonian *given = terms->hamiltonian;
  const dvi_lagrangian function = {.value = given->value,
                                   .gradient = given->gradient,
                                   .hessian = given->hessian,
                                   .qq = given->qq,
                                   .qv = given->qp,
                                   .vv = given->pp,
                                   .user = given->user};
  if (given->value == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the Hamiltonian has no %s callback",
                     given->value == NULL ? "value" : "gradient");
  system->terms |= term;
  return dvi__declare_function(system, &function, "Hamiltonian", part);
}

dvi_status dvi__hamiltonian_vector_field(dvi__evaluator *e, double t, const double *q,
                                         const double *p, double *qdot, double *pdot)
{
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, p, pdot, qdot));
  for (int i = 0; i < e->system->n; i++) pdot[i] = -pdot[i];
  return DVI_OK;
}

dvi_status dvi__energy_of_hamiltonian(dvi__evaluator *e, double t, const double *q, const double *v,
                                      const double *p, double *E)
{
  (void)v;
  return dvi__lagrangian_value(e, 1, &t, q, p, E);
}

static int hamiltonian_is_declared(const dvi_system_terms *terms)
{
  return terms->hamiltonian != NULL && terms->constraint == NULL;
}

static dvi_status declare_free_hamiltonian(const dvi_system_terms *terms, dvi_system *system)
{
  return dvi__declare_hamiltonian(terms, system, DVI__HAMILTONIAN);
}

static dvi_status prepare_nothing(dvi__evaluator *e, dvi__derivatives most)
{
  (void)e, (void)most;
  return DVI_OK;
}

static dvi_status hamiltonian_velocity(dvi__evaluator *e, double t, const double *q,
                                       const double *p, double *v)
{
  double *found = e->velocity_search;
  const size_t n = (size_t)e->system->n;
  DVI_TRY(dvi__hamiltonian_vector_field(e, t, q, p, found, found + n));
  memcpy(v, found, n * sizeof *v);
  return DVI_OK;
}

static dvi_status hamiltonian_motion(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v, double *pdot, double *multiplier)
{
  (void)multiplier;
  return dvi__hamiltonian_vector_field(e, t, q, p, v, pdot);
}

const dvi__dynamics dvi__dynamics_hamiltonian = {
    .name = "Hamiltonian",
    .function = "Hamiltonian",
    .equations = DVI__HAMILTON,
    .by_momentum = 1,
    .no_taylor = dvi__no_taylor_of_hamiltonian,
    .is_declared = hamiltonian_is_declared,
    .declare = declare_free_hamiltonian,
    .prepare = prepare_nothing,
    .velocity = hamiltonian_velocity,
    .motion = hamiltonian_motion,
    .energy = dvi__energy_of_hamiltonian,
    .value = dvi__value_of_point,
    .forces = dvi__forces_of_point,
    .momentum = dvi__momentum_of_point,
};
