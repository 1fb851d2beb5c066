/* Nonholonomic constraints A(t,q) v + a(t,q) = 0 by the discrete principle of Lagrange and
 * d'Alembert.
 *
 * Space: straight line from q0 to q1.  Quadrature: midpoint.
 *     Ld(q0,q1) = h L(t0 + h/2, (q0+q1)/2, (q1-q0)/h)
 *     p0 + D1 Ld + f- = h/2 A(t0,q0)^T lambda,     A_d (q1 - q0) + h a_d = 0,
 *     p1 = D2 Ld + f+ - h/2 A(t1,q1)^T mu,         A(t1,q1) v1 + a(t1,q1) = 0,
 * where A_d and a_d are A and a at (t0 + h/2, (q0+q1)/2), or the means of their values at both ends
 * (step/element/nonholonomic_rows.c). Order 2, symmetric, A v + a = 0 at both ends. Not symplectic,
 * as the motion itself is not. Source: Cortes and Martinez 2001, sec. 3; McLachlan and Perlmutter
 * 2006, sec. 3. */
#include "core/status.h"
#include "method/element/element_step.h"

enum { ROWS, SOLVER };

static const char *rows_name(int index)
{
  static const char *const name[] = {[DVI__MIDDLE_ROWS] = "midpoint", [DVI__MEAN_ROWS] = "average"};
  return index >= 0 && index <= DVI__MEAN_ROWS ? name[index] : NULL;
}

static const dvi__key nonholonomic_keys[] = {
    {"rows", rows_name, 0, 0, DVI__MEAN_ROWS,
     "where a step takes A and a: at its midpoint, or the average of both ends; default: average"},
    DVI__SOLVER_KEY,
    {0}};

static dvi_status nonholonomic_create(dvi__stepper *self)
{
  const dvi__action_space space = {
      .basis = DVI_LAGRANGE_LOBATTO, .degree = 1, .rule = DVI_MIDPOINT, .nodes = 1};
  DVI_TRY(dvi__element_create(self, &space, self->settings.value[SOLVER]));
  return dvi__element_constrain_velocities(self, (dvi__velocity_rule)self->settings.value[ROWS]);
}

const dvi__method dvi__nonholonomic = {
    .name = "nonholonomic",
    .summary = "rolling and skates, A(t,q) v + a = 0: straight line, midpoint; order 2, symmetric",
    .cite = "CortesMartinez2001",
    .keys = nonholonomic_keys,
    .uses = DVI__ELEMENT_TERMS | DVI__HOLONOMIC | DVI__NONHOLONOMIC,
    .needs = DVI__NONHOLONOMIC,
    .create = nonholonomic_create,
    DVI__ELEMENT_OPERATIONS,
};
