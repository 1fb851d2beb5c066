/* Evaluates graphs of expressions in quadruple precision, as a judge of results in double. It
 * exists only where libquadmath has its header (DVI_HAVE_QUADMATH). */
#ifndef SUPPORT_QUAD_GRAPH_H
#define SUPPORT_QUAD_GRAPH_H
#include "expr/graph.h"

#ifdef DVI_HAVE_QUADMATH
#include <quadmath.h>

typedef __float128 quad;

/* Gives the result of an operation. `number` is the value of a constant, or the exponent of a
 * power. */
quad quad_operate(dvi__op op, double number, quad a, quad b);

/* Bounds the error of a result whose operands have these errors, and which is itself rounded
 * relative to its size by `rounding`. */
quad quad_error(dvi__op op, double number, quad a, quad a_error, quad b, quad b_error,
                quad rounding);

/* Gives values of the nodes 0 to count - 1 of a graph. If `error` is not NULL it gets bounds of the
 * effect of rounding on each value. Constants are rounded, inputs are not. */
void quad_evaluate(const dvi__graph *graph, int count, const quad *x, quad *value, quad *error,
                   quad rounding);
#endif

#endif
