/* Derivatives of reciprocals of functions that overflow.
 *
 * The chain rule for 1/cosh(a) multiplies 1/cosh^2(a), which is 0 beyond a = 710, by sinh(a), which
 * is infinite there. The logarithmic derivative is bounded,
 *
 *     (cosh^-m)' = -m cosh^-m tanh,        (sinh^-m)' = -m sinh^-m / tanh,
 *     ((c + k cosh)^-m)' = -m (c + k cosh)^-m tanh / (1 + c/(k cosh)),
 *     ((c + k exp)^-m)'  = -m (c + k exp)^-m / (1 + (c/k) exp(-a)),
 *
 * and its factors decay in the same sense, so that derivatives of all orders are finite. They keep
 * their relative precision where they are small. */
#include "expr/graph_decay.h"

#include "expr/graph_make.h"

enum { NONE = -1 };

/* offset + factor * of */
typedef struct shifted {
  double offset, factor;
  dvi__node of;
} shifted;

static shifted split_factor(const dvi__graph *graph, double offset, double sign, dvi__node n)
{
  const dvi__graph_node *node = graph->node + n;
  double c;
  if (node->op == DVI__OP_NEGATE) return (shifted){offset, -sign, node->a};
  if (node->op == DVI__OP_MULTIPLY && dvi__is_constant(graph, node->a, &c))
    return (shifted){offset, sign * c, node->b};
  if (node->op == DVI__OP_MULTIPLY && dvi__is_constant(graph, node->b, &c))
    return (shifted){offset, sign * c, node->a};
  return (shifted){offset, sign, n};
}

static shifted split_sum(const dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node *node = graph->node + n;
  const double sign = node->op == DVI__OP_SUBTRACT ? -1 : 1;
  double c;
  if (node->op != DVI__OP_ADD && node->op != DVI__OP_SUBTRACT) return split_factor(graph, 0, 1, n);
  if (dvi__is_constant(graph, node->a, &c)) return split_factor(graph, c, sign, node->b);
  if (dvi__is_constant(graph, node->b, &c)) return split_factor(graph, sign * c, 1, node->a);
  return (shifted){0, 1, n};
}

/* Return 1/(1 + c n). */
static dvi__node inverse_of_one_and(dvi__graph *graph, double c, dvi__node n)
{
  return dvi__power(graph, dvi__add(graph, dvi__constant(graph, 1), dvi__scale(graph, c, n)), -1);
}

/* Return the logarithmic derivative of a sum by the operand of its function, or NONE. It is bounded
 * where the sum overflows. */
static dvi__node logarithmic_slope(dvi__graph *graph, shifted sum)
{
  const dvi__graph_node function = graph->node[sum.of];
  const double ratio = sum.offset / sum.factor;
  if (function.op == DVI__OP_EXP && ratio != 0)
    return inverse_of_one_and(graph, ratio,
                              dvi__apply(graph, DVI__OP_EXP, dvi__negate(graph, function.a), 0));
  if (function.op == DVI__OP_SINH && ratio == 0)
    return dvi__power(graph, dvi__apply(graph, DVI__OP_TANH, function.a, 0), -1);
  if (function.op != DVI__OP_COSH) return NONE;
  const dvi__node tangent = dvi__apply(graph, DVI__OP_TANH, function.a, 0);
  return ratio == 0
             ? tangent
             : dvi__multiply(graph, tangent,
                             inverse_of_one_and(graph, ratio, dvi__power(graph, sum.of, -1)));
}

bool dvi__decays(dvi__graph *graph, dvi__node n, dvi__decay *decay)
{
  const dvi__graph_node node = graph->node[n];
  double exponent = node.value;
  dvi__node base = node.a;
  if (node.op == DVI__OP_DIVIDE) {
    exponent = -1;
    base = node.b;
  } else if (node.op == DVI__OP_RAISE) {
    if (!dvi__is_constant(graph, node.b, &exponent)) return false;
  } else if (node.op != DVI__OP_POWER) {
    return false;
  }
  if (!(exponent < 0) || graph->failed != DVI_OK) return false;
  const shifted sum = split_sum(graph, base);
  const dvi__node slope = logarithmic_slope(graph, sum);
  if (slope == NONE) return false;
  *decay = (dvi__decay){graph->node[sum.of].a, dvi__scale(graph, exponent, slope)};
  return true;
}
