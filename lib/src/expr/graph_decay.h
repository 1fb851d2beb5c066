/* Reciprocal powers of functions that overflow. */
#ifndef DVI_EXPR_GRAPH_DECAY_H
#define DVI_EXPR_GRAPH_DECAY_H
#include "expr/graph.h"

/* A node that is a reciprocal power of c + k exp(a), c + k cosh(a) or k sinh(a), with constants c
 * and k. Its derivative by a is `slope` times the node, and the slope is finite for all a. */
typedef struct dvi__decay {
  dvi__node inner; /* a */
  dvi__node slope;
} dvi__decay;

/* Return true if node n decays in this sense. A quotient of any numerator does, and then the slope
 * is that of its denominator's reciprocal. */
bool dvi__decays(dvi__graph *graph, dvi__node n, dvi__decay *decay);

#endif
