/* Expressions as a directed graph in which equal parts are one node.
 *
 * A node's operands have smaller numbers than itself, so a loop over numbers visits operands
 * first. Nodes are made only if there is no equal one, after simplifications that keep values up
 * to rounding: constants folded, x+0, x*1, x*0, x-x, -(-x), x^0, x^1; powers of one base joined
 * where the domain is the same, so that 1/norm^3 is one power of the sum of squares; equal terms
 * of a sum or difference joined, 3*x - x; constant factors gathered at one factor of a product,
 * and signs taken out of it; x/c = x*(1/c) for powers of two. Commutative operands are ordered
 * by number; sums of different terms are not reassociated.
 *
 * A condition is a number, 1 or 0, and never negative. What it guards with WHERE stands in front
 * of products, powers and equal guards, so that derivatives are guarded, too: if(x > 0, sqrt(x),
 * 0) has the derivative 0 at x < 0, and not 0 * NaN. */
#ifndef DVI_EXPR_GRAPH_H
#define DVI_EXPR_GRAPH_H
#include "text/arena.h"
#include "text/complaint.h"

typedef int dvi__node;

/* X(identifier, operand count, spelling in C) */
#define DVI__OP_LIST(X)                                                                    \
  X(CONSTANT, 0, "")                                                                       \
  X(INPUT, 0, "")                                                                          \
  X(NEGATE, 1, "-")                                                                        \
  X(SQUARE, 1, "")                                                                         \
  X(POWER, 1, "") /* by `value`: whole, from 3 or to -2, or half an odd number; not 1/2 */ \
  X(SQRT, 1, "sqrt")                                                                       \
  X(EXP, 1, "exp")                                                                         \
  X(LOG, 1, "log")                                                                         \
  X(SIN, 1, "sin")                                                                         \
  X(COS, 1, "cos")                                                                         \
  X(TAN, 1, "tan")                                                                         \
  X(ASIN, 1, "asin")                                                                       \
  X(ACOS, 1, "acos")                                                                       \
  X(ATAN, 1, "atan")                                                                       \
  X(SINH, 1, "sinh")                                                                       \
  X(COSH, 1, "cosh")                                                                       \
  X(TANH, 1, "tanh")                                                                       \
  X(ASINH, 1, "asinh")                                                                     \
  X(ACOSH, 1, "acosh")                                                                     \
  X(ATANH, 1, "atanh")                                                                     \
  X(ABS, 1, "fabs")                                                                        \
  X(SIGN, 1, "") /* -1, 0, 1: the derivative of abs */                                     \
  X(ADD, 2, "+")                                                                           \
  X(SUBTRACT, 2, "-")                                                                      \
  X(MULTIPLY, 2, "*")                                                                      \
  X(DIVIDE, 2, "/")                                                                        \
  X(RAISE, 2, "pow") /* by anything else */                                                \
  X(ATAN2, 2, "atan2")                                                                     \
  X(HYPOT, 2, "hypot") /* of constants; else a square root, whose powers join others */    \
  X(FLOOR, 1, "floor")                                                                     \
  X(POSITIVE, 1, "") /* 1 if a > 0, 0 if a <= 0: what conditions are made of */            \
  X(WHERE, 2, "")    /* b where the condition a is 1; 0 where it is 0, whatever b is */

typedef enum dvi__op {
#define DVI__OP_ENUM(name, operands, spelling) DVI__OP_##name,
  DVI__OP_LIST(DVI__OP_ENUM)
#undef DVI__OP_ENUM
      DVI__OP_COUNT
} dvi__op;

typedef struct dvi__graph_node {
  dvi__op op;
  dvi__node a, b;     /* operands; of an input a is its number, from 0 */
  double value;       /* of a constant; the exponent of a power */
  int never_negative; /* 1: the value is at least 0, or NaN */
  dvi__span span; /* the part of the source that first made it; derivatives point to what they are
                     derivatives of */
} dvi__graph_node;

/* Room in which dvi__tangents works, for as many nodes; between its calls marks are 0 and tangents
 * -1. */
typedef struct dvi__tangent_room {
  int size;
  char *part;
  dvi__node *tangent, *list;
} dvi__tangent_room;

/* Zero: empty, but for `limit`. Grown in memory of its own, freed by dvi__graph_free. Once `failed`
 * is not DVI_OK (DVI_NO_MEMORY, DVI_BAD_SIZE: more nodes than the limit) every call returns node 0
 * and nothing grows: ask once, at the end. */
typedef struct dvi__graph {
  dvi__graph_node *node;
  int count;
  int *table; /* hash table of node numbers */
  int table_size;
  int limit;      /* most nodes; 0: 2000000 */
  dvi__span here; /* the span that new nodes get */
  dvi_status failed;
  dvi__tangent_room room;
} dvi__graph;

/* Of POWER: products are faster than pow so far, and as exact. */
enum { DVI__EXPONENT_MAX = 32 };

void dvi__graph_free(dvi__graph *graph);

dvi__node dvi__constant(dvi__graph *graph, double value);
dvi__node dvi__input(dvi__graph *graph, int number);
/* Any other operation; b is ignored by those of one operand. Of POWER not: see dvi__power. */
dvi__node dvi__apply(dvi__graph *graph, dvi__op op, dvi__node a, dvi__node b);
/* a^exponent for a constant exponent: 1, a, SQUARE, SQRT, POWER, DIVIDE of 1 for -1, or RAISE for
 * what is neither whole nor a half, or beyond DVI__EXPONENT_MAX. */
dvi__node dvi__power(dvi__graph *graph, dvi__node a, double exponent);

/* Conditions, as 1 or 0: not c; both c and d, of which d need not exist where c is 0. */
dvi__node dvi__complement(dvi__graph *graph, dvi__node c);
dvi__node dvi__both(dvi__graph *graph, dvi__node c, dvi__node d);
/* a where c is 1, b where it is 0; what is not taken need not exist there. */
dvi__node dvi__choice(dvi__graph *graph, dvi__node c, dvi__node a, dvi__node b);
/* a > b. */
dvi__node dvi__greater(dvi__graph *graph, dvi__node a, dvi__node b);

/* Whether a node is a constant, and which. */
bool dvi__is_constant(const dvi__graph *graph, dvi__node node, double *value);

/* Derivatives of `root` by inputs 0 .. count-1, by the reverse mode: at most four times the
 * operations of the root. New nodes in the same graph. */
void dvi__gradient(dvi__graph *graph, dvi__node root, int count, dvi__node *gradient);

/* The derivatives of the nodes of[count] by one input, by the forward mode. Nodes of `of` that do
 * not depend on it give the constant 0. Takes as long as what they are made of, however large the
 * graph is. */
void dvi__tangents(dvi__graph *graph, int input, int count, const dvi__node *of,
                   dvi__node *tangent);

/* The total rates of roots, result [root_count]: sum over inputs of a root's derivative times
 * rate[input] (nodes), by the forward mode. */
void dvi__rates(dvi__graph *graph, int root_count, const dvi__node *root, int count,
                const dvi__node *rate, dvi__node *result);

/* Which second derivatives of `root` by inputs (i,j), 0 <= j <= i < count, may differ from zero,
 * without making them: by the first and second order dependences of each node. pairs: (i,j) column
 * by column; *pair_count of them; owned by the caller (dvi__heap_free). DVI_BAD_SIZE: more than
 * 20000000; DVI_NO_MEMORY. */
dvi_status dvi__second_pattern(const dvi__graph *graph, dvi__node root, int count, int (**pairs)[2],
                               int *pair_count);

/* Mark [count], 1: the input occurs in one of the roots. */
void dvi__inputs_used(const dvi__graph *graph, int root_count, const dvi__node *root, int count,
                      char *used);

/* The roots' values [root_count] at the inputs x, one operation after the other; x NULL: no inputs.
 * The first node with a result that is not finite, or -1. Allocates. */
dvi_status dvi__evaluate(const dvi__graph *graph, const double *x, int root_count,
                         const dvi__node *root, double *value, dvi__node *not_finite);

#endif
