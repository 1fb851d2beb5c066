/* Galerkin variational integrators.
 *
 * Space: polynomials of degree s.  Quadrature: any rule with r >= s points c_j, weights b_j.
 *     Ld(q0,q1) = ext over paths q of degree s from q0 to q1 of  h sum_j b_j L(t0 + c_j h,
 *       q(c_j h), q'(c_j h))
 * and p0 = -D1 Ld, p1 = D2 Ld. The rows are those of step/element/action.h. Order min(2s, u,
 * 2(u-s+1)) for a quadrature of order u: Gauss r = s is Gauss collocation, order 2s; Lobatto r =
 * s+1 has 2s, r = s has 2s-2. r < s leaves velocities that no node sees: refused. Source: Marsden
 * and West 2001, sec. 2.2.6; Leok and Shingel 2012; Hall and Leok 2015 (order). */
#include "core/status.h"
#include "method/element/element_step.h"

enum { DEGREE, BASIS, QUADRATURE, NODES, SOLVER };

static const char *basis_name(int index)
{
  return dvi_basis_name((dvi_basis)index);
}

static const char *rule_name(int index)
{
  return dvi_rule_name((dvi_rule)index);
}

static const dvi__key keys[] = {
    {"degree", NULL, 1, DVI_DEGREE_MAX, 2, "degree of the path, 1 to 40; default: 2"},
    {"basis", basis_name, 0, 0, DVI_LAGRANGE_LOBATTO,
     "trial functions: lobatto, gauss, chebyshev-lobatto, equispaced (Lagrange), legendre, "
     "chebyshev (modal); default: lobatto"},
    {"quadrature", rule_name, 0, 0, DVI_GAUSS,
     "gauss, lobatto, radau-left, radau-right, clenshaw-curtis, midpoint, trapezoid, simpson; "
     "default: gauss"},
    {"nodes", NULL, 1, DVI_QUADRATURE_MAX, DVI__LEFT_OUT,
     "quadrature points, at least the degree, at most 80; default: the fewest of order 2 degree "
     "(Gauss: the degree)"},
    DVI__SOLVER_KEY,
    {0},
};

static int fixed_size(dvi_rule rule)
{
  return rule == DVI_MIDPOINT || rule == DVI_TRAPEZOID || rule == DVI_SIMPSON;
}

static dvi_status create(dvi__stepper *self)
{
  int *value = self->settings.value;
  const dvi_rule rule = (dvi_rule)value[QUADRATURE];
  if (value[NODES] == DVI__LEFT_OUT) value[NODES] = dvi__fewest_nodes(rule, value[DEGREE]);
  if (dvi_quadrature_order(rule, value[NODES]) == 0)
    return dvi__fail(DVI_BAD_OPTION, "galerkin: quadrature %s has no rule with %d point%s%s",
                     dvi_rule_name(rule), value[NODES], value[NODES] == 1 ? "" : "s",
                     fixed_size(rule) ? "; leave nodes out" : "; at least 2 are needed");
  if (value[NODES] < value[DEGREE])
    return dvi__fail(DVI_BAD_OPTION,
                     "galerkin: %d quadrature points see at most %d of the %d velocity modes of "
                     "degree %d, the step's equations would "
                     "be singular; nodes must be at least degree",
                     value[NODES], value[NODES], value[DEGREE], value[DEGREE]);
  const dvi__action_space space = {(dvi_basis)value[BASIS], value[DEGREE], rule, value[NODES]};
  return dvi__element_create(self, &space, value[SOLVER]);
}

const dvi__method dvi__galerkin = {
    .name = "galerkin",
    .summary = "polynomials of any degree s, any quadrature; order 2s if the quadrature's order is "
               "2s or more",
    .cite = "LeokShingel2012",
    .keys = keys,
    .uses = DVI__ELEMENT_TERMS,
    .create = create,
    DVI__ELEMENT_OPERATIONS,
};
