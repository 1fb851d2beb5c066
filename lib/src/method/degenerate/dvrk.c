/* Degenerate variational Runge-Kutta methods with Gauss's tableau. The vector x holds the
 * coordinates of the varying components of alpha, y the other coordinates.
 *
 *     Ld = sum_i b_i [ alpha(X_i,Y_i).W_i - h H(X_i,Y_i) ],   X_i = x0 + sum_j a_ij W_j,
 *     stationary in W and Y under x1 = x0 + sum_i b_i W_i
 *
 * This is Gauss collocation in the canonical coordinates (x, alpha), with y in the place of alpha.
 * The order is 2s. The method is symmetric and symplectic, and needs no projection. Source: Kraus
 * 2017, arXiv:1708.07356; Ellison, Finn, Burby, Kraus, Qin and Tang 2018. */
#include "method/degenerate/darboux_step.h"

enum { NODES };

static const dvi__key keys[] = {
    {"nodes", NULL, 1, 6, 2, "the stages, 1 to 6; default: 2"},
    {0},
};

static dvi_status dvrk_create(dvi__stepper *self)
{
  return dvi__darboux_step_create(self, DVI__GAUSS_STAGES, self->settings.value[NODES]);
}

const dvi__method dvi__dvrk = {
    .name = "dvrk",
    .summary = "Gauss stages; order 2s; one-forms with half of their components constant",
    .cite = "Ellison2018",
    .keys = keys,
    .create = dvrk_create,
    DVI__DARBOUX_OPERATIONS,
};
