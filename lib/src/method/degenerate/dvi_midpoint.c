/* Degenerate variational integrator, midpoint. The vector x holds the coordinates of the varying
 * components of alpha, y the other coordinates, and X = (x0+x1)/2.
 *
 *     Ld(x0,Y,x1) = alpha(X,Y).(x1-x0) - h H(t0+h/2,X,Y),     stationary in Y
 *     p0 = -D Ld/D x0,   p1 = D Ld/D x1 = alpha(x1,y1)
 *
 * This is dvrk with one node. The order is 2, and the method is symmetric and symplectic. Source:
 * Ellison, Finn, Burby, Kraus, Qin and Tang 2018; Kraus 2017. */
#include "method/degenerate/darboux_step.h"

static dvi_status dvi_midpoint_create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__GAUSS_STAGES, 1);
}

const dvi__method dvi__dvi_midpoint = {
    .name = "dvi-midpoint",
    .summary = "midpoint rule; order 2; one-forms with half of their components constant",
    .cite = "Ellison2018",
    .create = dvi_midpoint_create,
    DVI__DARBOUX_OPERATIONS,
};
