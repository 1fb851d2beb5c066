/* The reduced form of lie-galerkin, for Lagrangians that are invariant under the group.
 *
 * Space and quadrature are those of lie-galerkin. With f = g0^{-1} g1 and the discrete Lagrangian
 * l(f) = Ld(e,f) the stationarity conditions are the discrete Euler-Poincare equation and the
 * reconstruction
 *     mu1 = Ad*_f mu0,     g1 = g0 f.
 *
 * The equation determines f from mu0 alone and does not use the stored coordinates
 * (system/chart/charted_reduced.c). Its solution is that of lie-galerkin. Potentials, masses that
 * are not invariant, and directions, which are no group, need lie-galerkin. The order is 2s.
 * Source: Marsden, Pekarsky and Shkoller 1999; Leok 2004, sec. 5.3 (with f = g0^{-1} g1). */
#include "method/lie/charted_step.h"

static dvi_status euler_poincare_create(dvi__stepper *self)
{
  return dvi__charted_step_create(self, 1);
}

const dvi__method dvi__euler_poincare = {
    .name = "euler-poincare",
    .summary = "lie-galerkin for Lagrangians that the group leaves as they are: free bodies; "
               "solved from the momentum alone; the keys of galerkin",
    .cite = "MarsdenPekarskyShkoller1999",
    .uses = DVI__CONSTANT_MASS | DVI__FACTORS,
    .refuses = DVI__DIRECTIONS,
    .create = euler_poincare_create,
    DVI__CHARTED_OPERATIONS,
};
