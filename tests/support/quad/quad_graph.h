/* Graphs of expressions in quadruple precision: a judge of what is computed in double. Only where
 * libquadmath has its header (DVI_HAVE_QUADMATH). */
#ifndef SUPPORT_QUAD_GRAPH_H
#define SUPPORT_QUAD_GRAPH_H
#include "expr/graph.h"

#ifdef DVI_HAVE_QUADMATH
#include <quadmath.h>

typedef __float128 quad;

/* The result of an operation; `number` is the value of a constant, or the exponent of a power. */
quad quad_operate(dvi__op op, double number, quad a, quad b);

/* Bounds the error of a result of which the operands have these errors, and which is itself rounded
 * to so much of its size. */
quad quad_error(dvi__op op, double number, quad a, quad a_error, quad b, quad b_error,
                quad rounding);

/* Values of the nodes 0 to count - 1 of a graph; with `error` not NULL, bounds for what that
 * rounding makes of each; constants are rounded, inputs are not. */
void quad_evaluate(const dvi__graph *graph, int count, const quad *x, quad *value, quad *error,
                   quad rounding);
#endif

#endif
