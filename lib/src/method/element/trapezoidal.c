/* Trapezoidal variational rule.
 *
 * Space: straight line from q0 to q1.  Quadrature: trapezoid.
 *   Ld(q0,q1) = h/2 L(t0, q0, (q1-q0)/h) + h/2 L(t1, q1, (q1-q0)/h)
 * Stoermer-Verlet for any Lagrangian. For a constant mass the two agree, and verlet is the cheaper
 * one. Order 2, symmetric, symplectic. Source: Marsden and West 2001, sec. 2.3.1. */
#include "method/element/element_step.h"

enum { SOLVER };

static const dvi__key trapezoidal_keys[] = {DVI__SOLVER_KEY, {0}};

static dvi_status trapezoidal_create(dvi__stepper *self)
{
  const dvi__action_space space = {
      .basis = DVI_LAGRANGE_LOBATTO, .degree = 1, .rule = DVI_TRAPEZOID, .nodes = 2};
  return dvi__element_create(self, &space, self->settings.value[SOLVER]);
}

const dvi__method dvi__trapezoidal = {
    .name = "trapezoidal",
    .summary = "Stoermer-Verlet for any Lagrangian: straight line, trapezoid; order 2; implicit",
    .cite = "MarsdenWest2001",
    .keys = trapezoidal_keys,
    .uses = DVI__ELEMENT_TERMS | DVI__HOLONOMIC | DVI__CONTACT | DVI__DAMPING,
    .create = trapezoidal_create,
    DVI__ELEMENT_OPERATIONS,
    .keep_lengths = dvi__element_keep_lengths,
};
