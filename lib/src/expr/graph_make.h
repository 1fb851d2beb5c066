/* Functions shared by the files of the graph. */
#ifndef DVI_EXPR_GRAPH_MAKE_H
#define DVI_EXPR_GRAPH_MAKE_H
#include "expr/graph.h"

/* Find or make exactly this node. Nothing is simplified. */
dvi__node dvi__make(dvi__graph *graph, dvi__op op, dvi__node a, dvi__node b, double value);

/* Return c * n, simplified. */
dvi__node dvi__scale(dvi__graph *graph, double c, dvi__node n);

/* Return true if an operation is constant between its jumps. */
static inline bool dvi__is_step(dvi__op op)
{
  return op == DVI__OP_SIGN || op == DVI__OP_FLOOR || op == DVI__OP_POSITIVE;
}

/* Return how many operands an operation has. */
int dvi__operands(dvi__op op);

/* Apply an operation to numbers, by libm. `value` is the exponent of a power. */
double dvi__operate(dvi__op op, double value, double a, double b);

void dvi__tangent_room_free(dvi__tangent_room *room);

/* Mark by 1 all parts of the roots, [*size], up to the last root. The caller owns the marks. NULL
 * if there is no memory. */
char *dvi__parts(const dvi__graph *graph, int root_count, const dvi__node *root, int *size);

/* Mark by 1 the parts of the roots among the first `size` nodes at the values `at`. A part that a
 * condition turns off is not marked. */
void dvi__mark_taken(const dvi__graph *graph, const double *at, int root_count,
                     const dvi__node *root, int size, char *part);

/* Shorter names for the operations. */
static inline dvi__node dvi__add(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return dvi__apply(graph, DVI__OP_ADD, a, b);
}

static inline dvi__node dvi__subtract(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return dvi__apply(graph, DVI__OP_SUBTRACT, a, b);
}

static inline dvi__node dvi__multiply(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return dvi__apply(graph, DVI__OP_MULTIPLY, a, b);
}

static inline dvi__node dvi__divide(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return dvi__apply(graph, DVI__OP_DIVIDE, a, b);
}

static inline dvi__node dvi__negate(dvi__graph *graph, dvi__node a)
{
  return dvi__apply(graph, DVI__OP_NEGATE, a, 0);
}

static inline dvi__node dvi__where(dvi__graph *graph, dvi__node condition, dvi__node n)
{
  return dvi__apply(graph, DVI__OP_WHERE, condition, n);
}

static inline dvi__node dvi__square(dvi__graph *graph, dvi__node a)
{
  return dvi__apply(graph, DVI__OP_SQUARE, a, 0);
}

#endif
