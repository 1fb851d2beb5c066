/* Expressions as a directed graph in which equal parts are one node.
 *
 * A node's operands have smaller numbers than itself, so that a loop over numbers visits operands
 * first. A node is made only if there is no equal one, after simplifications that keep values up to
 * rounding.
 *
 *   - Constants are folded, as are x+0, x*1, x*0, x-x, -(-x), x^0, x^1.
 *   - Powers of one base are joined where the domain is the same, so that 1/norm^3 is one power of
 *     the sum of squares.
 *   - Equal terms of a sum or difference are joined, 3*x - x.
 *   - Constant factors are gathered at one factor of a product, and signs are taken out of it.
 *   - x/c is x*(1/c) for powers of two.
 *
 * Commutative operands are ordered by number. Sums of different terms are not reassociated.
 *
 * A condition is a number, 1 or 0, and never negative. A guard WHERE stands in front of products,
 * powers and equal guards, so that derivatives are guarded, too. So if(x > 0, sqrt(x), 0) has the
 * derivative 0 at x < 0, and not 0 * NaN. */
#ifndef DVI_EXPR_GRAPH_H
#define DVI_EXPR_GRAPH_H
#include "text/arena.h"
#include "text/complaint.h"

typedef int dvi__node;

/* X(identifier, operand count, spelling in C) */
#define DVI__OP_LIST(X)                                                                   \
  X(CONSTANT, 0, "")                                                                      \
  X(INPUT, 0, "")                                                                         \
  X(NEGATE, 1, "-")                                                                       \
  X(SQUARE, 1, "")                                                                        \
  X(POWER, 1, "") /* `value` is whole, from 3 or to -2, or half an odd number, not 1/2 */ \
  X(SQRT, 1, "sqrt")                                                                      \
  X(EXP, 1, "exp")                                                                        \
  X(LOG, 1, "log")                                                                        \
  X(SIN, 1, "dvi_sin")                                                                    \
  X(COS, 1, "dvi_cos")                                                                    \
  X(TAN, 1, "tan")                                                                        \
  X(ASIN, 1, "asin")                                                                      \
  X(ACOS, 1, "acos")                                                                      \
  X(ATAN, 1, "atan")                                                                      \
  X(SINH, 1, "sinh")                                                                      \
  X(COSH, 1, "cosh")                                                                      \
  X(TANH, 1, "tanh")                                                                      \
  X(ASINH, 1, "asinh")                                                                    \
  X(ACOSH, 1, "acosh")                                                                    \
  X(ATANH, 1, "atanh")                                                                    \
  X(ABS, 1, "fabs")                                                                       \
  X(SIGN, 1, "") /* -1, 0, 1, the derivative of abs */                                    \
  X(ADD, 2, "+")                                                                          \
  X(SUBTRACT, 2, "-")                                                                     \
  X(MULTIPLY, 2, "*")                                                                     \
  X(DIVIDE, 2, "/")                                                                       \
  X(RAISE, 2, "pow") /* any other exponent */                                             \
  X(ATAN2, 2, "atan2")                                                                    \
  X(HYPOT, 2, "hypot") /* of constants, else a square root, whose powers join others */   \
  X(FLOOR, 1, "floor")                                                                    \
  X(POSITIVE, 1, "") /* 1 if a > 0, 0 if a <= 0, the base of conditions */                \
  X(WHERE, 2, "")    /* b where the condition a is 1, and 0 where a is 0 for any b */

typedef enum dvi__op {
#define DVI__OP_ENUM(name, operands, spelling) DVI__OP_##name,
  DVI__OP_LIST(DVI__OP_ENUM)
#undef DVI__OP_ENUM
      DVI__OP_COUNT
} dvi__op;

typedef struct dvi__graph_node {
  dvi__op op;
  dvi__node a, b;     /* operands, or a is the number of an input, from 0 */
  double value;       /* of a constant, or the exponent of a power */
  int never_negative; /* 1 if the value is at least 0, or NaN */
  dvi__span span;     /* place in the source, for a derivative that of its function */
} dvi__graph_node;

/* Work space of dvi__tangents, for as many nodes. Between its calls marks are 0 and tangents -1. */
typedef struct dvi__tangent_room {
  int size;
  char *part;
  dvi__node *tangent, *list;
} dvi__tangent_room;

/* A graph of zeros, but for `limit`, is empty. It grows in memory of its own, which dvi__graph_free
 * frees. After a failure `failed` is DVI_NO_MEMORY, or DVI_BAD_SIZE for more nodes than the limit.
 * Every call then returns node 0 and nothing grows. It is enough to ask once, at the end. */
typedef struct dvi__graph {
  dvi__graph_node *node;
  int count;
  int *table; /* hash table of node numbers */
  int table_size;
  int limit;      /* most nodes (default 2000000) */
  dvi__span here; /* the span that new nodes get */
  dvi_status failed;
  dvi__tangent_room room;
} dvi__graph;

/* The largest exponent of POWER. Up to it products are faster than pow, and as exact. */
enum { DVI__EXPONENT_MAX = 32 };

void dvi__graph_free(dvi__graph *graph);

dvi__node dvi__constant(dvi__graph *graph, double value);
dvi__node dvi__input(dvi__graph *graph, int number);
/* Apply any other operation but POWER, which dvi__power makes. Operations of one operand ignore
 * b. */
dvi__node dvi__apply(dvi__graph *graph, dvi__op op, dvi__node a, dvi__node b);
/* Return a^exponent for a constant exponent. The result is 1, a, SQUARE, SQRT, POWER or, for -1, a
 * DIVIDE of 1. It is RAISE for an exponent that is neither whole nor a half, or beyond
 * DVI__EXPONENT_MAX. */
dvi__node dvi__power(dvi__graph *graph, dvi__node a, double exponent);

/* Return a condition, 1 or 0. dvi__complement is not c. dvi__both is c and d, where d need not
 * exist if c is 0. */
dvi__node dvi__complement(dvi__graph *graph, dvi__node c);
dvi__node dvi__both(dvi__graph *graph, dvi__node c, dvi__node d);
/* Return a where c is 1, b where c is 0. The other one need not exist there. */
dvi__node dvi__choice(dvi__graph *graph, dvi__node c, dvi__node a, dvi__node b);
/* Return the condition a > b. */
dvi__node dvi__greater(dvi__graph *graph, dvi__node a, dvi__node b);

/* Return true if a node is a constant, and set its value. */
bool dvi__is_constant(const dvi__graph *graph, dvi__node node, double *value);

/* Derive `root` by inputs 0 .. count-1, by the reverse mode. This takes at most four times the
 * operations of the root. New nodes are in the same graph. */
void dvi__gradient(dvi__graph *graph, dvi__node root, int count, dvi__node *gradient);

/* Derive the nodes of[count] by one input, by the forward mode. Nodes of `of` that do not depend on
 * it give the constant 0. The time depends on the parts of these nodes, not on the size of the
 * graph. */
void dvi__tangents(dvi__graph *graph, int input, int count, const dvi__node *of,
                   dvi__node *tangent);

/* Derive roots along the rates of inputs, result [root_count], by the forward mode. A result is the
 * sum over inputs of the root's derivative times rate[input], which are nodes. */
void dvi__rates(dvi__graph *graph, int root_count, const dvi__node *root, int count,
                const dvi__node *rate, dvi__node *result);

/* Find which second derivatives of `root` by inputs (i,j), 0 <= j <= i < count, may differ from
 * zero. Nothing is derived, since the first and second order dependences of each node suffice. The
 * *pair_count pairs (i,j) stand column by column. The caller frees them (dvi__heap_free).
 * DVI_BAD_SIZE for more than 20000000, DVI_NO_MEMORY. */
dvi_status dvi__second_pattern(const dvi__graph *graph, dvi__node root, int count, int (**pairs)[2],
                               int *pair_count);

/* Mark [count] by 1 the inputs that occur in one of the roots. */
void dvi__inputs_used(const dvi__graph *graph, int root_count, const dvi__node *root, int count,
                      char *used);

/* Compute the roots' values [root_count] at the inputs x, one operation after the other. x is NULL
 * if there are no inputs. not_finite is the first node with a result that is not finite, or -1.
 * Allocates. */
dvi_status dvi__evaluate(const dvi__graph *graph, const double *x, int root_count,
                         const dvi__node *root, double *value, dvi__node *not_finite);

#endif
