/* Galerkin variational integrators on Lie groups and homogeneous spaces, in natural charts.
 *
 * Space: a chart centred at the step's start, q(tau) = y(xi(tau)) with a polynomial xi of degree s,
 * xi(0) = 0: on SO(3) R0 exp(xi^), on S^2 the great circle of the horizontal lift, on R^n q0 + xi
 * (group/chart.h). Quadrature: any rule with r >= s points.
 *     Ld(q0,q1) = ext over xi of  h sum_j b_j L(y(xi), d/dt y(xi))
 * In the chart that is step/element/action.h; the momentum of xi at the step's end becomes that of
 * the group by the transposed inverse of dexp. A rotation of q0 rotates the whole step, so that
 * momenta of such symmetries are conserved. Order as galerkin's. Source: Leok 2004, sec. 5.3 and
 * 5.4 (with dexp_{-xi}, and its derivative in the variation); Leok and Shingel 2012, sec. 2. */
#include "method/lie/charted_step.h"

static dvi_status create(dvi__stepper *self)
{
  return dvi__charted_step_create(self, 0);
}

const dvi__method dvi__lie_galerkin = {
    .name = "lie-galerkin",
    .summary = "galerkin in natural charts: rotations, rigid motions, directions, angles and "
               "products; order 2s; the keys of galerkin",
    .cite = "LeokShingel2012",
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FACTORS,
    .create = create,
    DVI__CHARTED_OPERATIONS,
};
