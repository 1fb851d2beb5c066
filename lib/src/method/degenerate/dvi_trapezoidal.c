/* Degenerate variational integrator, trapezoidal: x = (coordinates of alpha's varying half), y =
 * (the others), P = alpha(x0,Y) = alpha(x1,Z).
 *
 *     Ld(x0,x1) = P.(x1-x0) - h/2 H(t0,x0,Y) - h/2 H(t1,x1,Z),     stationary in P;  p0 = -D Ld/D x0,  p1 = D Ld/D x1 = alpha(x1,y1)
 * Half a step of dvi-a and half a step of dvi-b; Stoermer-Verlet in (x, alpha). Order 2, symmetric,
 * symplectic. Source: Kraus 2017; Ellison, Finn, Burby, Kraus, Qin and Tang 2018. That both ends
 * share one momentum is ours: with Y and Z free, the step is singular where H is linear in
 * alpha. */
#include "method/degenerate/darboux_step.h"

static dvi_status create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__TRAPEZOIDAL_PAIR, 2);
}

const dvi__method dvi__dvi_trapezoidal = {
    .name = "dvi-trapezoidal",
    .summary = "Stoermer-Verlet of p = alpha(q); order 2; one-forms with half of their components "
               "constant",
    .cite = "Ellison2018",
    DVI__DARBOUX_OPERATIONS,
};
