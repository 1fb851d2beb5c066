/* A constant mass M and potentials have L = v.Mv/2 - V(t,q), so that v = M^-1 p. With a vector
 * potential L = v.Mv/2 + A(t,q).v - V(t,q), so that v = M^-1 (p - A). */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/mass.h"

/* A mass beside factors belongs to the charts. */
static int mass_is_declared(const dvi_system_terms *terms)
{
  const dvi_mass *mass = &terms->mass;
  return terms->factors == NULL && terms->holonomic_count == 0 && terms->nonholonomic_count == 0 &&
         (mass->scalar != 0 || mass->diagonal != NULL || mass->values != NULL);
}

static dvi_status prepare_mass(dvi__evaluator *e, dvi__derivatives most)
{
  const dvi_system *system = e->system;
  if (system->mass_diagonal != NULL) return DVI_OK;
  if (system->mass_factor != NULL)
    return dvi__linear_share(system->mass_factor, e->counters, &e->velocity);
  DVI_TRY(dvi__prepare_velocity_hessian(e, most));
  return dvi__linear_factor(e->velocity, system->mass_values);
}

static dvi_status velocity_is_not_finite(double t)
{
  return dvi__fail(DVI_NOT_FINITE, "the velocity M^-1 p at t = %.6g is not finite", t);
}

/* Each number is its own, and needs no room but v. */
static dvi_status velocity_by_diagonal(dvi__evaluator *e, double t, const double *p, double *v)
{
  const double *m = e->system->mass_diagonal;
  for (int i = 0; i < e->system->n; i++)
    if (!isfinite(p[i] / m[i])) return velocity_is_not_finite(t);
  dvi__mass_solve(e, 1, p, v);
  return DVI_OK;
}

static dvi_status velocity_by_mass(dvi__evaluator *e, double t, const double *q, const double *p,
                                   double *v)
{
  const size_t n = (size_t)e->system->n;
  double *found = e->point[1];
  if (e->system->mass_diagonal != NULL && e->system->vector == NULL)
    return velocity_by_diagonal(e, t, p, v);
  memcpy(found, p, n * sizeof *found);
  if (e->system->vector != NULL) {
    DVI_TRY(dvi__vector_potential(e, 1, &t, q, e->point[2]));
    for (size_t i = 0; i < n; i++) found[i] -= e->point[2][i];
  }
  dvi__mass_solve(e, 1, found, found);
  if (dvi__first_not_finite(n, found) >= 0) return velocity_is_not_finite(t);
  memcpy(v, found, n * sizeof *v);
  return DVI_OK;
}

/* p.v - L would lose the digits of A.v, which cancels. */
static dvi_status energy_by_mass(dvi__evaluator *e, double t, const double *q, const double *v,
                                 const double *p, double *E)
{
  return e->system->vector != NULL ? dvi__mass_energy(e, t, q, v, E)
                                   : dvi__energy_of_lagrangian(e, t, q, v, p, E);
}

const dvi__dynamics dvi__dynamics_constant_mass = {
    .name = "constant mass",
    .function = "Lagrangian",
    .equations = DVI__EULER_LAGRANGE,
    .has_kinetic_energy = 1,
    .is_declared = mass_is_declared,
    .declare = dvi__mass_copy,
    .prepare = prepare_mass,
    .velocity = velocity_by_mass,
    .motion = dvi__motion_of_lagrangian,
    .energy = energy_by_mass,
    .value = dvi__value_of_point,
    .forces = dvi__forces_of_point,
    .momentum = dvi__momentum_of_point,
};
