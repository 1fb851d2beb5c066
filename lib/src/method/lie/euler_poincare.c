/* The reduced form of lie-galerkin: for Lagrangians that every element of the group leaves as they
 * are.
 *
 * Space and quadrature: those of lie-galerkin. With f = g0^{-1} g1 and the discrete Lagrangian l(f)
 * = Ld(e,f) the stationarity conditions are the discrete Euler-Poincare equation and the
 * reconstruction
 *     mu1 = Ad*_f mu0,     g1 = g0 f.
 * f comes from mu0 alone, and nothing of the stored coordinates is formed
 * (system/chart/charted_reduced.c); what is solved has the solution of lie-galerkin. For
 * potentials, and masses that the group does not leave as they are, there is lie-galerkin; for
 * directions, which are no group, too. Order 2s. Source: Marsden, Pekarsky and Shkoller 1999; Leok
 * 2004, sec. 5.3 (with f = g0^{-1} g1). */
#include "method/lie/charted_step.h"

static dvi_status create(dvi__stepper *self)
{
  return dvi__charted_step_create(self, 1);
}

const dvi__method dvi__euler_poincare = {
    .name = "euler-poincare",
    .summary = "lie-galerkin for Lagrangians that the group leaves as they are: free bodies; "
               "solved from the momentum alone; the "
               "keys of galerkin",
    .cite = "MarsdenPekarskyShkoller1999",
    .uses = DVI__CONSTANT_MASS | DVI__FACTORS,
    .refuses = DVI__DIRECTIONS,
    .create = create,
    DVI__CHARTED_OPERATIONS,
};
