/* Hamilton-Pontryagin integrators. In each step q, v and p are polynomials of their own. The
 * momenta tie them at the ends of a step for (q,Q), one coordinate and one momentum for (q,P) and
 * (p,Q), and the coordinates for (p,P). These are the generating functions of types 1 to 4.
 *
 *     delta { h sum_i b_i [ L(Q_i,V_i) + P_i.(Q'_i - V_i) ] + the ties } = 0,     d the degree
 *     type 1, (q,Q): q of degree d, Lobatto with d+1 points: galerkin; generalised Stoermer-Verlet
 *                    for d = 1.  Order 2d
 *     type 2, (q,P): q of degree d, collocated at d left Radau points: symplectic Euler for d = 1,
 *                    L at q0.  Order 2d-1
 *     type 3, (p,Q): the same at right Radau points, L at q1.  Order 2d-1
 *     type 4, (p,P): p of degree d, collocated at d+1 Lobatto points; q by the conjugate tableau:
 *                    drift, kick, drift for d = 1.  Order 2d
 *
 * Types 1 to 3 are elements of the action (step/element/action.h), because v follows from q there.
 * With the same quadrature they take the same steps. Type 4 is the pair Lobatto IIIB for q and IIIA
 * for p, or Gauss (step/degenerate/partitioned.h), where v has an independent value at every point.
 *
 * For degenerate Lagrangians alpha(q).v - H(q), types 2 and 3 use the same rows. The momentum p is
 * carried, and differs from alpha(q) by O(h^d) or O(h^(d+1)). This distance is a second solution
 * beside the motion, the parasite. A quadrature of order 2d or more gives the parasite the
 * multiplier (-1)^d in every gauge. Radau's quadrature, of order 2d-1, gives (-1)^(d-1) times the
 * multipliers of Dalpha^-T Dalpha. These lie on the unit circle if the symmetric part of Dalpha is
 * definite (x.Dalpha x = mu x.Dalpha^T x), and mostly not otherwise. At 1 the parasite adds up, and
 * the order is d-1. This happens for even d where the symmetric part is 0, and for odd d where only
 * the symmetric part remains. Source: Leok and Ohsawa 2011; Marsden and West 2001, sec. 2.6 (the
 * pairs). The parasite is our observation. */
#include "core/status.h"
#include "method/degenerate/carried_step.h"
#include "method/element/element_step.h"
#include "method/degenerate/partitioned_step.h"

enum { TYPE, DEGREE, QUADRATURE };
enum { POINTS_MOST = 8 };

static const char *hp_rule_name(int index)
{
  return dvi_rule_name((dvi_rule)index);
}

static const dvi__key keys[] = {
    {"type", NULL, 1, 4, 1,
     "of generating functions: 1 (q,Q), 2 (q,P), 3 (p,Q) or 4 (p,P); default: 1"},
    {"degree", NULL, 1, DVI_DEGREE_MAX - 1, 1,
     "degree of q, of type 4 of p, 1 to 39 (type 4: to 7); default: 1"},
    {"quadrature", hp_rule_name, 0, 0, DVI__LEFT_OUT,
     "one of galerkin's, of type 4 lobatto or gauss; default: lobatto, of type 2 radau-left, of "
     "type 3 radau-right"},
    {0},
};

/* ---- type 4 ---- */

static const dvi__method momentum_centred = {
    .name = "hp",
    .keys = keys,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL,
    DVI__PARTITIONED_OPERATIONS,
};

static dvi_status create_momentum_centred(dvi__stepper *self, int degree, dvi_rule rule)
{
  if (rule != DVI_LOBATTO && rule != DVI_GAUSS)
    return dvi__fail(
        DVI_BAD_OPTION,
        "hp: type=4 has a conjugate pair of tableaux for lobatto and gauss, not for quadrature=%s",
        dvi_rule_name(rule));
  if (degree >= POINTS_MOST)
    return dvi__fail(DVI_BAD_OPTION,
                     "hp: type=4 has degree+1 points, at most %d; degree=1 to %d is possible",
                     POINTS_MOST, POINTS_MOST - 1);
  if (self->system->lagrangian != NULL && self->system->lagrangian->computed != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "hp: type=4 has no path whose time could be measured; types 1 to 3 have");
  self->method = &momentum_centred;
  self->order = 2 * degree;
  self->symmetric = 1;
  return rule == DVI_GAUSS
             ? dvi__partitioned_step_create(self, DVI__GAUSS, degree, DVI__NO_PROJECTION)
             : dvi__partitioned_step_create(self, DVI__LOBATTO_IIIB_A, degree + 1,
                                            DVI__NO_PROJECTION);
}

/* ---- degenerate Lagrangians ---- */

static const dvi__method carried = {
    .name = "hp",
    .keys = keys,
    .uses = DVI__ONE_FORM | DVI__POTENTIAL,
    DVI__CARRIED_OPERATIONS,
};

static dvi_status refuse_form(int type)
{
  return type == 1
             ? dvi__fail(
                   DVI_UNSUPPORTED,
                   "hp: type=1 cannot use a one-form: it wants q given at both ends, and equations "
                   "of motion of first order join a q to no other but its own; type=2 and 3 can")
             : dvi__fail(DVI_UNSUPPORTED,
                         "hp: type=4 cannot use a one-form: it takes alpha(q) = p at points where "
                         "q does not move, and is not consistent; type=2 and 3 can");
}

/* Set the order, which the parasite limits. The parasite starts from p = alpha(q) and costs any
 * higher order of the quadrature. */
static dvi_status create_carried(dvi__stepper *self, const dvi__action_space *space)
{
  const int d = space->degree, u = dvi_quadrature_order(space->rule, space->nodes);
  if (u < 2 * d - 1)
    return dvi__fail(DVI_BAD_OPTION,
                     "hp: quadrature=%s with %d points has order %d, and does not integrate even a "
                     "constant two-form with degree %d; order %d is needed",
                     dvi_rule_name(space->rule), space->nodes, u, d, 2 * d - 1);
  self->method = &carried;
  self->order = u >= 2 * d && d % 2 == 1 ? d + 1 : d;
  /* with a linear alpha, Omega (q1 - q-1) = 2 h H_q(q0), and sin(theta) = h omega */
  if (d == 1 && u < 2) self->stable = 1;
  self->symmetric = dvi__symmetric_rule(space->rule);
  return dvi__carried_step_create(self, space, u >= 2 * d ? 0 : d % 2 == 1 ? 1 : -1);
}

/* ---- create ---- */

/* Choose the number of points. Radau's rules take as many points as there are velocities. Other
 * rules take the fewest points of order 2 degree. */
static int nodes_of(dvi_rule rule, int degree)
{
  return rule == DVI_RADAU_LEFT || rule == DVI_RADAU_RIGHT ? degree
                                                           : dvi__fewest_nodes(rule, degree);
}

static dvi_status hp_create(dvi__stepper *self)
{
  static const dvi_rule by_type[] = {DVI_LOBATTO, DVI_RADAU_LEFT, DVI_RADAU_RIGHT, DVI_LOBATTO};
  int *chosen = &self->settings.value[QUADRATURE];
  const int type = self->settings.value[TYPE], degree = self->settings.value[DEGREE],
            degenerate = (self->system->terms & DVI__ONE_FORM) != 0;
  if (*chosen == DVI__LEFT_OUT) *chosen = (int)by_type[type - 1];
  const dvi_rule rule = (dvi_rule)*chosen;
  if (degenerate && (type == 1 || type == 4)) return refuse_form(type);
  if (type == 4 && self->system->force_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "hp: type=4 cannot use forces without a potential; type=1, 2 and 3 can");
  if (type == 4 && self->system->vector != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "hp: type=4 cannot use a vector potential A(t,q).v; type=1, 2 and 3 can");
  if (type == 4) return create_momentum_centred(self, degree, rule);
  const dvi__action_space space = {.basis = DVI_LAGRANGE_LOBATTO,
                                   .degree = degree,
                                   .rule = rule,
                                   .nodes = nodes_of(rule, degree)};
  if (space.nodes < degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "hp: quadrature=%s has %d point%s, which leave%s velocities of degree %d "
                     "unseen; degree=%d is possible with it",
                     dvi_rule_name(rule), space.nodes, space.nodes == 1 ? "" : "s",
                     space.nodes == 1 ? "s" : "", degree, space.nodes);
  return degenerate ? create_carried(self, &space)
                    : dvi__element_create(self, &space, DVI__SOLVER_AUTO);
}

const dvi__method dvi__hp = {
    .name = "hp",
    .summary =
        "Hamilton-Pontryagin: generating functions of type 1 to 4; order 2d, of types 2 and 3 2d-1",
    .cite = "LeokOhsawa2011",
    .keys = keys,
    .uses = DVI__ELEMENT_TERMS | DVI__ONE_FORM,
    .create = hp_create,
    DVI__ELEMENT_OPERATIONS,
};
