/* Galerkin variational integrators.
 *
 * Space: polynomials of degree s.  Quadrature: any rule with r >= s points c_j, weights b_j.
 *   Ld(q0,q1) = ext over paths q of degree s from q0 to q1 of
 *               h sum_j b_j L(t0 + c_j h, q(c_j h), q'(c_j h))
 * and p0 = -D1 Ld, p1 = D2 Ld. The rows are those of step/element/action.h.
 *
 * Order min(2s, u, 2(u-s+1)) for a quadrature of order u. Gauss with r = s is Gauss collocation of
 * order 2s. Lobatto with r = s+1 has order 2s, and with r = s order 2s-2. r < s is refused, because
 * it leaves velocities that no node sees.
 *
 * Source: Marsden and West 2001, sec. 2.2.6; Leok and Shingel 2012; Hall and Leok 2015 (order). */
#include "core/status.h"
#include "method/element/element_step.h"

enum { DEGREE, BASIS, QUADRATURE, NODES, SOLVER };

static const char *galerkin_basis_name(int index)
{
  return dvi_basis_name((dvi_basis)index);
}

static const char *galerkin_rule_name(int index)
{
  return dvi_rule_name((dvi_rule)index);
}

static const dvi__key galerkin_keys[] = {
    {"degree", NULL, 1, DVI_DEGREE_MAX, 2, "degree of the path, 1 to 40; default: 2"},
    {"basis", galerkin_basis_name, 0, 0, DVI_LAGRANGE_LOBATTO,
     "trial functions: lobatto, gauss, chebyshev-lobatto, equispaced (Lagrange), legendre, "
     "chebyshev (modal); default: lobatto"},
    {"quadrature", galerkin_rule_name, 0, 0, DVI_GAUSS,
     "gauss, lobatto, radau-left, radau-right, clenshaw-curtis, midpoint, trapezoid, simpson; "
     "default: gauss"},
    {"nodes", NULL, 1, DVI_QUADRATURE_MAX, DVI__LEFT_OUT,
     "quadrature points, at least the degree, at most 80; default: the fewest of order 2 degree "
     "(Gauss: the degree)"},
    DVI__SOLVER_KEY,
    {0},
};

static int has_fixed_size(dvi_rule rule)
{
  return rule == DVI_MIDPOINT || rule == DVI_TRAPEZOID || rule == DVI_SIMPSON;
}

typedef struct galerkin_options {
  int degree, nodes, solver;
  dvi_basis basis;
  dvi_rule rule;
} galerkin_options;

/* Read the options. The number of nodes that is chosen here becomes part of the specification. */
static galerkin_options galerkin_read_options(dvi__settings *settings)
{
  int *value = settings->value;
  galerkin_options o = {.degree = value[DEGREE],
                        .nodes = value[NODES],
                        .solver = value[SOLVER],
                        .basis = (dvi_basis)value[BASIS],
                        .rule = (dvi_rule)value[QUADRATURE]};
  if (o.nodes == DVI__LEFT_OUT) o.nodes = value[NODES] = dvi__fewest_nodes(o.rule, o.degree);
  return o;
}

static dvi_status galerkin_create(dvi__stepper *self)
{
  const galerkin_options o = galerkin_read_options(&self->settings);
  if (dvi_quadrature_order(o.rule, o.nodes) == 0)
    return dvi__fail(DVI_BAD_OPTION, "galerkin: quadrature %s has no rule with %d point%s%s",
                     dvi_rule_name(o.rule), o.nodes, o.nodes == 1 ? "" : "s",
                     has_fixed_size(o.rule) ? "; leave nodes out" : "; at least 2 are needed");
  if (o.nodes < o.degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "galerkin: %d quadrature points see at most %d of the %d velocity modes of "
                     "degree %d, the step's equations would be singular; nodes must be at least "
                     "degree",
                     o.nodes, o.nodes, o.degree, o.degree);
  const dvi__action_space space = {
      .basis = o.basis, .degree = o.degree, .rule = o.rule, .nodes = o.nodes};
  return dvi__element_create(self, &space, o.solver);
}

const dvi__method dvi__galerkin = {
    .name = "galerkin",
    .summary = "polynomials of any degree s, any quadrature; order 2s if the quadrature's order is "
               "2s or more",
    .cite = "LeokShingel2012",
    .keys = galerkin_keys,
    .uses = DVI__ELEMENT_TERMS | DVI__HOLONOMIC | DVI__CONTACT | DVI__DAMPING,
    .create = galerkin_create,
    DVI__ELEMENT_OPERATIONS,
    .keep_lengths = dvi__element_keep_lengths,
};
