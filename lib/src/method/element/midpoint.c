/* Implicit midpoint rule.
 *
 * Space: straight line from q0 to q1.  Quadrature: midpoint.
 *     Ld(q0,q1) = h L(t0 + h/2, (q0+q1)/2, (q1-q0)/h)
 * Order 2, symmetric, symplectic, conserves quadratic invariants. Source: Marsden and West 2001,
 * sec. 2.3.2. */
#include "method/element/element_step.h"

enum { SOLVER };

static const dvi__key midpoint_keys[] = {DVI__SOLVER_KEY, {0}};

static dvi_status midpoint_create(dvi__stepper *self)
{
  const dvi__action_space space = {
      .basis = DVI_LAGRANGE_LOBATTO, .degree = 1, .rule = DVI_MIDPOINT, .nodes = 1};
  return dvi__element_create(self, &space, self->settings.value[SOLVER]);
}

const dvi__method dvi__midpoint = {
    .name = "midpoint",
    .summary = "implicit midpoint rule: straight line, midpoint; order 2; any Lagrangian",
    .cite = "MarsdenWest2001",
    .keys = midpoint_keys,
    .uses = DVI__ELEMENT_TERMS | DVI__HOLONOMIC | DVI__CONTACT | DVI__DAMPING,
    .create = midpoint_create,
    DVI__ELEMENT_OPERATIONS,
    .keep_lengths = dvi__element_keep_lengths,
};
