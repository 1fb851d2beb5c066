/* The general Lagrangian g [L(q, w/g) + E0] of a time transform (transformed.h). It is a kind of
 * its own, because some functions of a general Lagrangian are missing. */
#include "system/evaluate/dynamics.h"

static int is_never_declared(const dvi_system_terms *terms)
{
  (void)terms;
  return 0;
}

const dvi__dynamics dvi__dynamics_time_transformed = {
    .name = "time-transformed Lagrangian",
    .function = "Lagrangian",
    .equations = DVI__EULER_LAGRANGE,
    .searches_velocity = 1,
    .has_kinetic_energy = 1,
    .no_taylor = "a time-transformed system has no Taylor coefficients, and derivatives beyond the "
                 "second are needed; take "
                 "step control, or a method by values, as galerkin",
    .is_declared = is_never_declared,
    .prepare = dvi__prepare_velocity_hessian,
    .velocity = dvi__search_velocity,
    .regular = dvi__velocity_hessian_is_regular,
    .motion = dvi__motion_of_lagrangian,
    .energy = dvi__energy_of_lagrangian,
    .value = dvi__value_of_point,
    .forces = dvi__forces_of_point,
    .momentum = dvi__momentum_of_point,
};
