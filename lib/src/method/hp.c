/* Hamilton-Pontryagin integrators: q, v and p are polynomials of their own in a step, tied at its ends by the momenta (q,Q), or by one coordinate and one
 * momentum, or by the coordinates: generating functions of type 1 to 4.
 *
 *     delta { h sum_i b_i [ L(Q_i,V_i) + P_i.(Q'_i - V_i) ] + the ties } = 0,     d the degree
 *     type 1, (q,Q): q of degree d, Lobatto with d+1 points: galerkin, generalised Stoermer-Verlet for d = 1.  Order 2d
 *     type 2, (q,P): q of degree d, collocated at d left Radau points: symplectic Euler for d = 1, L at q0.  Order 2d-1
 *     type 3, (p,Q): the same at right Radau points, L at q1.  Order 2d-1
 *     type 4, (p,P): p of degree d, collocated at d+1 Lobatto points; q by the conjugate tableau: drift, kick, drift for d = 1.  Order 2d
 * Types 1 to 3 are elements of the action (action/action.h), as v follows q there. Type 4 is the pair Lobatto IIIB for q, IIIA for p
 * (action/partitioned.h): v has a value of its own at every point.
 * Source: Leok and Ohsawa 2011; Marsden and West 2001, sec. 2.6 (the pairs). */
#include "core/status.h"
#include "method/element_step.h"
#include "method/partitioned_step.h"

enum { TYPE, DEGREE };
enum { POINTS_MOST = 8 };

static const dvi__key keys[] = {
    {"type", NULL, 1, 4, 1, "of generating functions: 1 (q,Q), 2 (q,P), 3 (p,Q) or 4 (p,P); left out: 1"},
    {"degree", NULL, 1, DVI_DEGREE_MAX - 1, 1, "degree of q, of type 4 of p, 1 to 39 (type 4: to 7); left out: 1"},
    {0},
};

/* Type 4. */
static const dvi__method momentum_centred = {
    .name = "hp",
    .keys = keys,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL,
    DVI__PARTITIONED_OPERATIONS,
};

static dvi_status create_momentum_centred(dvi__stepper *self, int degree)
{
  if (degree >= POINTS_MOST)
    return dvi__fail(DVI_BAD_OPTION, "hp: type=4 has degree+1 points, at most %d; degree=1 to %d is possible", POINTS_MOST,
                     POINTS_MOST - 1);
  if (self->system->lagrangian != NULL && self->system->lagrangian->transformed != NULL)
    return dvi__fail(DVI_UNSUPPORTED, "hp: type=4 has no path whose time could be measured; types 1 to 3 have");
  self->method = &momentum_centred;
  self->order = 2 * degree;
  self->symmetric = 1;
  return dvi__partitioned_step_create(self, DVI__LOBATTO_IIIB_A, degree + 1, DVI__NO_PROJECTION);
}

static dvi_status create(dvi__stepper *self)
{
  static const dvi_rule rule[] = {DVI_LOBATTO, DVI_RADAU_LEFT, DVI_RADAU_RIGHT};
  const int type = self->settings.value[TYPE], degree = self->settings.value[DEGREE];
  if (type == 4) return create_momentum_centred(self, degree);
  const dvi__action_space space = {DVI_LAGRANGE_LOBATTO, degree, rule[type - 1], type == 1 ? degree + 1 : degree};
  return dvi__element_create(self, &space, DVI__SOLVER_AUTO);
}

const dvi__method dvi__hp = {
    .name = "hp",
    .summary = "Hamilton-Pontryagin: generating functions of type 1 to 4; order 2d, of types 2 and 3 2d-1",
    .cite = "LeokOhsawa2011",
    .keys = keys,
    .create = create,
    DVI__ELEMENT_OPERATIONS,
};
