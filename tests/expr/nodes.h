/* The graph of a test case, and its nodes. */
#ifndef TESTS_EXPR_NODES_H
#define TESTS_EXPR_NODES_H
#include "expr/graph.h"

static dvi__graph graph;

static inline void setup(void)
{
  graph = (dvi__graph){0};
}

static inline void teardown(void)
{
  dvi__graph_free(&graph);
}

static inline dvi__node apply(dvi__op op, dvi__node a, dvi__node b)
{
  return dvi__apply(&graph, op, a, b);
}

static inline dvi__node constant(double value)
{
  return dvi__constant(&graph, value);
}

static inline dvi__node input(int i)
{
  return dvi__input(&graph, i);
}

static inline dvi__node add(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_ADD, a, b);
}

static inline dvi__node subtract(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_SUBTRACT, a, b);
}

static inline dvi__node multiply(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_MULTIPLY, a, b);
}

static inline dvi__node divide(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_DIVIDE, a, b);
}

static inline dvi__node negate(dvi__node a)
{
  return apply(DVI__OP_NEGATE, a, 0);
}

static inline dvi__node power(dvi__node a, double exponent)
{
  return dvi__power(&graph, a, exponent);
}

static inline dvi__node rate_of(dvi__node root, int count, const dvi__node *rate)
{
  dvi__node result;
  dvi__rates(&graph, 1, &root, count, rate, &result);
  return result;
}

#endif
