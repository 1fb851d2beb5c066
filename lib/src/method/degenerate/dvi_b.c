/* Degenerate variational integrator B is the adjoint of dvi-a. The vector x holds the coordinates
 * of the varying components of alpha, y the other coordinates.
 *
 *     Ld(x0,Y,x1) = alpha(x1,Y).(x1-x0) - h H(t1,x1,Y),     stationary in Y
 *     p0 = -D Ld/D x0 = alpha(x1,Y),   p1 = D Ld/D x1 = alpha(x1,y1)
 *
 * The order is 1, and the method is symplectic. Source: Ellison, Finn, Burby, Kraus, Qin and Tang
 * 2018. */
#include "method/degenerate/darboux_step.h"

static dvi_status dvi_b_create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__EULER_B, 1);
}

const dvi__method dvi__dvi_b = {
    .name = "dvi-b",
    .summary =
        "symplectic Euler at the end; order 1; one-forms with half of their components constant",
    .cite = "Ellison2018",
    .create = dvi_b_create,
    DVI__DARBOUX_OPERATIONS,
};
