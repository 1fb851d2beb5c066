/* Galerkin variational integrators on products of spheres, through horizontal lifts.
 *
 * Space: q(tau) = exp(theta(tau)^) q0 with a polynomial theta of degree s in the plane orthogonal
 * to q0, theta(0) = 0: the horizontal lift to SO(3), so that of rotations that lead to the same
 * path none but those without spin are taken. Two unknowns a direction and function. Quadrature:
 * any rule with r >= s points. Angles and coordinates of R^n may stand beside: hinges and carts.
 *     Ld(q0,q1) = ext over theta of  h sum_j b_j L(q, dq/dt)
 * That is lie-galerkin's chart of a direction, xi = B^T (q0 x theta) (group/chart.h); this method
 * is the one that has no other, and refuses bodies that turn. Order 2s; |q| = 1 without a
 * multiplier. Source: Leok 2004, sec. 5.4; Leok and Shingel 2012, sec. 2. */
#include "method/lie/charted_step.h"

static dvi_status create(dvi__stepper *self)
{
  return dvi__charted_step_create(self, 0);
}

const dvi__method dvi__sphere_galerkin = {
    .name = "sphere-galerkin",
    .summary = "galerkin on products of spheres by horizontal lifts: directions, with angles and "
               "R^n beside them; the keys of galerkin",
    .cite = "LeokShingel2012",
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FACTORS,
    .refuses = DVI__ROTATIONS,
    .create = create,
    DVI__CHARTED_OPERATIONS,
};
