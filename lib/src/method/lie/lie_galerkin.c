/* Galerkin variational integrators on Lie groups and homogeneous spaces, in natural charts.
 *
 * The space is a chart centred at the start of the step, q(tau) = y(xi(tau)), with a polynomial xi
 * of degree s and xi(0) = 0. This is R0 exp(xi^) on SO(3), the great circle of the horizontal lift
 * on S^2, and q0 + xi on R^n (group/chart.h). The quadrature is any rule with r >= s points.
 *     Ld(q0,q1) = ext over xi of  h sum_j b_j L(y(xi), d/dt y(xi))
 *
 * In the chart this is step/element/action.h. The transposed inverse of dexp maps the momentum of
 * xi at the end of the step to that of the group. A rotation of q0 rotates the whole step, so that
 * momenta of such symmetries are conserved. The order is that of galerkin. Source: Leok 2004, sec.
 * 5.3 and 5.4 (with dexp_{-xi}, and its derivative in the variation); Leok and Shingel 2012, sec.
 * 2. */
#include "method/lie/charted_step.h"

static dvi_status lie_galerkin_create(dvi__stepper *self)
{
  return dvi__charted_step_create(self, 0);
}

const dvi__method dvi__lie_galerkin = {
    .name = "lie-galerkin",
    .summary = "galerkin in natural charts: rotations, rigid motions, directions, angles and "
               "products; order 2s; the keys of galerkin",
    .cite = "LeokShingel2012",
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FACTORS | DVI__HOLONOMIC | DVI__FORCES |
            DVI__DAMPING,
    .create = lie_galerkin_create,
    DVI__CHARTED_OPERATIONS,
};
