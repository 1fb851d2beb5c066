#include "support/quad/quad_graph.h"

#include <math.h>

#include "expr/graph_make.h"

#ifdef DVI_HAVE_QUADMATH
quad quad_operate(dvi__op op, double number, quad a, quad b)
{
  switch (op) {
  case DVI__OP_CONSTANT:
  case DVI__OP_INPUT: return (quad)number;
  case DVI__OP_NEGATE: return -a;
  case DVI__OP_SQUARE: return a * a;
  case DVI__OP_POWER: return powq(a, (quad)number);
  case DVI__OP_SQRT: return sqrtq(a);
  case DVI__OP_EXP: return expq(a);
  case DVI__OP_LOG: return logq(a);
  case DVI__OP_SIN: return sinq(a);
  case DVI__OP_COS: return cosq(a);
  case DVI__OP_TAN: return tanq(a);
  case DVI__OP_ASIN: return asinq(a);
  case DVI__OP_ACOS: return acosq(a);
  case DVI__OP_ATAN: return atanq(a);
  case DVI__OP_SINH: return sinhq(a);
  case DVI__OP_COSH: return coshq(a);
  case DVI__OP_TANH: return tanhq(a);
  case DVI__OP_ASINH: return asinhq(a);
  case DVI__OP_ACOSH: return acoshq(a);
  case DVI__OP_ATANH: return atanhq(a);
  case DVI__OP_ABS: return fabsq(a);
  case DVI__OP_SIGN: return (quad)((a > 0) - (a < 0));
  case DVI__OP_ADD: return a + b;
  case DVI__OP_SUBTRACT: return a - b;
  case DVI__OP_MULTIPLY: return a * b;
  case DVI__OP_DIVIDE: return a / b;
  case DVI__OP_RAISE: return powq(a, b);
  case DVI__OP_ATAN2: return atan2q(a, b);
  case DVI__OP_HYPOT: return hypotq(a, b);
  case DVI__OP_FLOOR: return floorq(a);
  case DVI__OP_POSITIVE: return a > 0 ? 1 : 0;
  case DVI__OP_WHERE: return a > 0 ? b : 0;
  case DVI__OP_COUNT: break;
  }
  return 0;
}

/* Return the larger distance from a value to those at the two ends of an operand. It is infinite if
 * the operation ends between them, as asin does behind 1. */
static quad spread_of(quad value, quad above, quad below)
{
  const quad up = fabsq(above - value), down = fabsq(below - value);
  return isnanq(value) || !(isnanq(up) || isnanq(down)) ? fmaxq(up, down) : (quad)HUGE_VAL;
}

quad quad_error(dvi__op op, double number, quad a, quad a_error, quad b, quad b_error,
                quad rounding)
{
  const int operands = dvi__operands(op);
  const quad value = quad_operate(op, number, a, b);
  quad error = rounding * fabsq(value);
  if (operands > 0)
    error += spread_of(value, quad_operate(op, number, a + a_error, b),
                       quad_operate(op, number, a - a_error, b));
  if (operands > 1)
    error += spread_of(value, quad_operate(op, number, a, b + b_error),
                       quad_operate(op, number, a, b - b_error));
  return error;
}

void quad_evaluate(const dvi__graph *graph, int count, const quad *x, quad *value, quad *error,
                   quad rounding)
{
  for (int n = 0; n < count; n++) {
    const dvi__graph_node *node = graph->node + n;
    const int operands = dvi__operands(node->op), a = operands > 0 ? node->a : n,
              b = operands > 1 ? node->b : n;
    if (error != NULL) error[n] = 0;
    value[n] = 0;
    value[n] = node->op == DVI__OP_INPUT ? x[node->a]
                                         : quad_operate(node->op, node->value, value[a], value[b]);
    if (error != NULL && node->op != DVI__OP_INPUT)
      error[n] = quad_error(node->op, node->value, value[a], error[a], value[b], error[b],
                            rounding);
  }
}
#endif
