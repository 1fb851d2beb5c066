/* Degenerate variational integrator, trapezoidal. The vector x holds the coordinates of the varying
 * components of alpha, y the other coordinates, and P = alpha(x0,Y) = alpha(x1,Z).
 *
 *     Ld(x0,x1) = P.(x1-x0) - h/2 H(t0,x0,Y) - h/2 H(t1,x1,Z),     stationary in P
 *     p0 = -D Ld/D x0,   p1 = D Ld/D x1 = alpha(x1,y1)
 *
 * This is half a step of dvi-a and half a step of dvi-b, or Stoermer-Verlet in (x, alpha). The
 * order is 2, and the method is symmetric and symplectic. Source: Kraus 2017; Ellison, Finn, Burby,
 * Kraus, Qin and Tang 2018. The common momentum P of both ends is our choice. With Y and Z free,
 * the step would be singular where H is linear in alpha. */
#include "method/degenerate/darboux_step.h"

static dvi_status dvi_trapezoidal_create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__TRAPEZOIDAL_PAIR, 2);
}

const dvi__method dvi__dvi_trapezoidal = {
    .name = "dvi-trapezoidal",
    .summary = "Stoermer-Verlet of p = alpha(q); order 2; one-forms with half of their components "
               "constant",
    .cite = "Ellison2018",
    .create = dvi_trapezoidal_create,
    DVI__DARBOUX_OPERATIONS,
};
