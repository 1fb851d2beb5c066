/* Galerkin variational integrators on products of spheres, through horizontal lifts.
 *
 * The space is q(tau) = exp(theta(tau)^) q0 with a polynomial theta of degree s in the plane
 * orthogonal to q0, and theta(0) = 0. This is the horizontal lift to SO(3). Of all rotations that
 * lead to the same path it takes those without spin. Each direction has two unknowns for each
 * function. The quadrature is any rule with r >= s points. Angles and coordinates of R^n may be
 * added, as for hinges and carts.
 *     Ld(q0,q1) = ext over theta of  h sum_j b_j L(q, dq/dt)
 *
 * This is the chart of a direction in lie-galerkin, xi = B^T (q0 x theta) (group/chart.h). This
 * method has no other chart, and refuses rigid bodies. The order is 2s, and |q| = 1 holds without a
 * multiplier. Source: Leok 2004, sec. 5.4; Leok and Shingel 2012, sec. 2. */
#include "method/lie/charted_step.h"

static dvi_status sphere_galerkin_create(dvi__stepper *self)
{
  return dvi__charted_step_create(self, 0);
}

const dvi__method dvi__sphere_galerkin = {
    .name = "sphere-galerkin",
    .summary = "galerkin on products of spheres by horizontal lifts: directions, with angles and "
               "R^n beside them; the keys of galerkin",
    .cite = "LeokShingel2012",
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FACTORS | DVI__HOLONOMIC | DVI__FORCES |
            DVI__DAMPING,
    .refuses = DVI__ROTATIONS,
    .create = sphere_galerkin_create,
    DVI__CHARTED_OPERATIONS,
};
