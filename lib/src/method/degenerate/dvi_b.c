/* Degenerate variational integrator B: the adjoint of dvi-a, x = (coordinates of alpha's varying
 * half), y = (the others).
 *
 *     Ld(x0,Y,x1) = alpha(x1,Y).(x1-x0) - h H(t1,x1,Y),     stationary in Y;  p0 = -D Ld/D x0 = alpha(x1,Y),  p1 = D Ld/D x1 = alpha(x1,y1)
 * Order 1, symplectic.  Source: Ellison, Finn, Burby, Kraus, Qin and Tang 2018. */
#include "method/degenerate/darboux_step.h"

static dvi_status create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__EULER_B, 1);
}

const dvi__method dvi__dvi_b = {
    .name = "dvi-b",
    .summary =
        "symplectic Euler at the end; order 1; one-forms with half of their components constant",
    .cite = "Ellison2018",
    DVI__DARBOUX_OPERATIONS,
};
