/* Degenerate variational integrator A is symplectic Euler for alpha(q).v - H(q). The vector x holds
 * the coordinates of the varying components of alpha, y the other coordinates.
 *
 *     Ld(x0,Y,x1) = alpha(x0,Y).(x1-x0) - h H(t0,x0,Y),     stationary in Y
 *     p0 = -D Ld/D x0,   p1 = D Ld/D x1 = alpha(x0,Y) = alpha(x1,y1)
 *
 * The order is 1. The method is symplectic, and its adjoint is dvi-b. Source: Ellison, Finn, Burby,
 * Kraus, Qin and Tang 2018. */
#include "method/degenerate/darboux_step.h"

static dvi_status dvi_a_create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__EULER_A, 1);
}

const dvi__method dvi__dvi_a = {
    .name = "dvi-a",
    .summary =
        "symplectic Euler at the start; order 1; one-forms with half of their components constant",
    .cite = "Ellison2018",
    .create = dvi_a_create,
    DVI__DARBOUX_OPERATIONS,
};
