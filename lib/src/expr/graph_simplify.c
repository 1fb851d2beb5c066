/* Simplification of operations as they are applied. Values stay the same up to rounding.
 *
 * Every node is seen as factor * rest, and rest as base^exponent. Constant factors are gathered at
 * one factor of a product, where they are most likely to be shared. In the pull s*d of two bodies
 * that is the power s of their distance, not the components of d. */
#include <math.h>

#include "expr/graph_make.h"

typedef struct scaled {
  double factor;
  dvi__node rest;
} scaled;

typedef struct powered {
  dvi__node base;
  double exponent;
} powered;

static const dvi__graph_node *node_at(const dvi__graph *graph, dvi__node n)
{
  return graph->node + n;
}

static scaled scaled_of(const dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node *node = node_at(graph, n);
  double c;
  if (node->op == DVI__OP_NEGATE) return (scaled){-1, node->a};
  if (node->op == DVI__OP_MULTIPLY && dvi__is_constant(graph, node->a, &c))
    return (scaled){c, node->b};
  if (node->op == DVI__OP_MULTIPLY && dvi__is_constant(graph, node->b, &c))
    return (scaled){c, node->a};
  return (scaled){1, n};
}

static powered powered_of(const dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node *node = node_at(graph, n);
  double c;
  switch (node->op) {
  case DVI__OP_SQUARE: return (powered){node->a, 2};
  case DVI__OP_SQRT: return (powered){node->a, 0.5};
  case DVI__OP_POWER: return (powered){node->a, node->value};
  case DVI__OP_DIVIDE:
    return dvi__is_constant(graph, node->a, &c) && c == 1 ? (powered){node->b, -1}
                                                          : (powered){n, 1};
  default: return (powered){n, 1};
  }
}

static int is_whole(double x)
{
  return x == floor(x);
}

/* Return true for factors that are gathered. They are far from the ends of the range, so that
 * partial products are, too. */
static int is_moderate(double c)
{
  return fabs(c) >= 1e-100 && fabs(c) <= 1e100;
}

/* Return true for exponents that a power may have. */
static int is_exponent(double x)
{
  return is_whole(2 * x) && fabs(x) <= DVI__EXPONENT_MAX;
}

/* Return true if x^e x^f = x^(e+f) wherever the left side is finite, and the right side is not
 * finite elsewhere. */
static int powers_join(const dvi__graph *graph, dvi__node x, double e, double f)
{
  const double sum = e + f;
  if (sum == 0 || !is_exponent(sum)) return 0;
  if ((e < 0) != (f < 0) && sum > 0) return 0;
  return is_whole(e) || is_whole(f) || node_at(graph, x)->never_negative;
}

/* Make a product with its operands ordered by number. */
static dvi__node make_product(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return a < b ? dvi__make(graph, DVI__OP_MULTIPLY, a, b, 0)
               : dvi__make(graph, DVI__OP_MULTIPLY, b, a, 0);
}

static dvi__node make_sum(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return a < b ? dvi__make(graph, DVI__OP_ADD, a, b, 0) : dvi__make(graph, DVI__OP_ADD, b, a, 0);
}

/* Return c * n for n without a factor of its own. A scaled factor of a product takes c. */
static dvi__node scale_rest(dvi__graph *graph, double c, dvi__node n)
{
  const dvi__graph_node node = *node_at(graph, n);
  if (node.op == DVI__OP_WHERE) return dvi__where(graph, node.a, dvi__scale(graph, c, node.b));
  if (node.op == DVI__OP_MULTIPLY) {
    const scaled a = scaled_of(graph, node.a), b = scaled_of(graph, node.b);
    if (a.factor != 1 && is_moderate(c * a.factor))
      return dvi__multiply(graph, dvi__scale(graph, c * a.factor, a.rest), node.b);
    if (b.factor != 1 && is_moderate(c * b.factor))
      return dvi__multiply(graph, node.a, dvi__scale(graph, c * b.factor, b.rest));
  }
  return make_product(graph, dvi__constant(graph, c), n);
}

dvi__node dvi__scale(dvi__graph *graph, double c, dvi__node n)
{
  if (graph->failed != DVI_OK) return 0;
  double constant;
  if (c == 0) return dvi__constant(graph, 0);
  if (c == 1) return n;
  if (c == -1) return dvi__negate(graph, n);
  if (dvi__is_constant(graph, n, &constant) && isfinite(c * constant))
    return dvi__constant(graph, c * constant);
  const scaled own = scaled_of(graph, n);
  if (own.factor == 1) return scale_rest(graph, c, n);
  if (!is_moderate(c * own.factor)) return make_product(graph, dvi__constant(graph, c), n);
  return dvi__scale(graph, c * own.factor, own.rest);
}

static dvi__node simplify_negate(dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node node = *node_at(graph, n);
  const scaled own = scaled_of(graph, n);
  if (node.op == DVI__OP_WHERE) return dvi__where(graph, node.a, dvi__negate(graph, node.b));
  if (node.op == DVI__OP_SUBTRACT) return dvi__subtract(graph, node.b, node.a);
  if (own.factor == -1) return own.rest;
  if (own.factor != 1) return make_product(graph, dvi__constant(graph, -own.factor), own.rest);
  return dvi__make(graph, DVI__OP_NEGATE, n, 0, 0);
}

/* Return true if one condition guards both parts. They are added, or subtracted, under it. */
static bool share_guard(const dvi__graph *graph, dvi__node a, dvi__node b)
{
  return node_at(graph, a)->op == DVI__OP_WHERE && node_at(graph, b)->op == DVI__OP_WHERE &&
         node_at(graph, a)->a == node_at(graph, b)->a;
}

static dvi__node simplify_add(dvi__graph *graph, dvi__node a, dvi__node b)
{
  const scaled x = scaled_of(graph, a), y = scaled_of(graph, b);
  double c;
  if (share_guard(graph, a, b))
    return dvi__where(graph, node_at(graph, a)->a,
                      dvi__add(graph, node_at(graph, a)->b, node_at(graph, b)->b));
  if (dvi__is_constant(graph, a, &c) && c == 0) return b;
  if (dvi__is_constant(graph, b, &c) && c == 0) return a;
  if (x.rest == y.rest && isfinite(x.factor + y.factor))
    return dvi__scale(graph, x.factor + y.factor, x.rest);
  if (y.factor < 0) return dvi__subtract(graph, a, dvi__scale(graph, -y.factor, y.rest));
  if (x.factor < 0) return dvi__subtract(graph, b, dvi__scale(graph, -x.factor, x.rest));
  return make_sum(graph, a, b);
}

static dvi__node simplify_subtract(dvi__graph *graph, dvi__node a, dvi__node b)
{
  const scaled x = scaled_of(graph, a), y = scaled_of(graph, b);
  double c;
  if (share_guard(graph, a, b))
    return dvi__where(graph, node_at(graph, a)->a,
                      dvi__subtract(graph, node_at(graph, a)->b, node_at(graph, b)->b));
  if (dvi__is_constant(graph, a, &c) && c == 0) return dvi__negate(graph, b);
  if (dvi__is_constant(graph, b, &c) && c == 0) return a;
  if (x.rest == y.rest && isfinite(x.factor - y.factor))
    return dvi__scale(graph, x.factor - y.factor, x.rest);
  if (y.factor < 0) return dvi__add(graph, a, dvi__scale(graph, -y.factor, y.rest));
  if (x.factor == -1) return dvi__negate(graph, dvi__add(graph, x.rest, b));
  return dvi__make(graph, DVI__OP_SUBTRACT, a, b, 0);
}

/* Rank how likely a factor is shared among products. */
static int factor_rank(const dvi__graph *graph, dvi__node n)
{
  switch (node_at(graph, n)->op) {
  case DVI__OP_INPUT: return 0;
  case DVI__OP_ADD:
  case DVI__OP_SUBTRACT: return 1;
  case DVI__OP_MULTIPLY: return 2;
  default: return 3;
  }
}

/* Return c x y. */
static dvi__node scaled_product(dvi__graph *graph, double c, dvi__node x, dvi__node y)
{
  if (c == 1) return dvi__multiply(graph, x, y);
  if (c < 0) return dvi__negate(graph, scaled_product(graph, -c, x, y));
  return factor_rank(graph, x) >= factor_rank(graph, y)
             ? make_product(graph, dvi__scale(graph, c, x), y)
             : make_product(graph, x, dvi__scale(graph, c, y));
}

static dvi__node simplify_multiply(dvi__graph *graph, dvi__node a, dvi__node b)
{
  double c;
  if (dvi__is_constant(graph, a, &c)) return dvi__scale(graph, c, b);
  if (dvi__is_constant(graph, b, &c)) return dvi__scale(graph, c, a);
  if (a == b) return dvi__power(graph, a, 2);
  const dvi__graph_node left = *node_at(graph, a), right = *node_at(graph, b);
  if (left.op == DVI__OP_WHERE) return dvi__where(graph, left.a, dvi__multiply(graph, left.b, b));
  if (right.op == DVI__OP_WHERE)
    return dvi__where(graph, right.a, dvi__multiply(graph, a, right.b));
  const scaled x = scaled_of(graph, a), y = scaled_of(graph, b);
  const double factor = x.factor * y.factor;
  if (!is_moderate(factor)) return make_product(graph, a, b);
  const powered p = powered_of(graph, x.rest), q = powered_of(graph, y.rest);
  if (p.base == q.base && powers_join(graph, p.base, p.exponent, q.exponent))
    return dvi__scale(graph, factor, dvi__power(graph, p.base, p.exponent + q.exponent));
  if (x.factor == 1 && y.factor == 1) return make_product(graph, a, b);
  return scaled_product(graph, factor, x.rest, y.rest);
}

/* Return a / c. The division stays but for powers of two, whose reciprocals are exact. */
static dvi__node divide_by_constant(dvi__graph *graph, dvi__node a, double c)
{
  int exponent;
  if (fabs(frexp(c, &exponent)) == 0.5 && isnormal(1 / c)) return dvi__scale(graph, 1 / c, a);
  return dvi__make(graph, DVI__OP_DIVIDE, a, dvi__constant(graph, c), 0);
}

static dvi__node simplify_divide(dvi__graph *graph, dvi__node a, dvi__node b)
{
  double c;
  const dvi__graph_node guarded = *node_at(graph, a);
  if (guarded.op == DVI__OP_WHERE)
    return dvi__where(graph, guarded.a, dvi__divide(graph, guarded.b, b));
  if (dvi__is_constant(graph, b, &c)) return divide_by_constant(graph, a, c);
  if (dvi__is_constant(graph, a, &c) && c == 0) return a;
  const scaled x = scaled_of(graph, a), y = scaled_of(graph, b);
  const powered p = powered_of(graph, x.rest), q = powered_of(graph, y.rest);
  const double factor = x.factor / y.factor;
  if (p.base == q.base && is_moderate(factor) &&
      powers_join(graph, p.base, p.exponent, -q.exponent))
    return dvi__scale(graph, factor, dvi__power(graph, p.base, p.exponent - q.exponent));
  if (q.exponent != 1) {
    const dvi__node numerator = dvi__divide(graph, a, dvi__constant(graph, y.factor));
    return dvi__multiply(graph, numerator, dvi__power(graph, q.base, -q.exponent));
  }
  if (y.factor == -1) return dvi__negate(graph, dvi__divide(graph, a, y.rest));
  if (x.factor == -1) return dvi__negate(graph, dvi__divide(graph, x.rest, b));
  if (!dvi__is_constant(graph, a, &c) || !is_moderate(c / y.factor))
    return dvi__make(graph, DVI__OP_DIVIDE, a, b, 0);
  return dvi__scale(graph, c / y.factor,
                    dvi__make(graph, DVI__OP_DIVIDE, dvi__constant(graph, 1), y.rest, 0));
}

static dvi__node make_power(dvi__graph *graph, dvi__node a, double exponent)
{
  if (exponent == 2) return dvi__make(graph, DVI__OP_SQUARE, a, 0, 0);
  if (exponent == 0.5) return dvi__make(graph, DVI__OP_SQRT, a, 0, 0);
  if (exponent == -1) return dvi__make(graph, DVI__OP_DIVIDE, dvi__constant(graph, 1), a, 0);
  return dvi__make(graph, DVI__OP_POWER, a, 0, exponent);
}

/* Return (x^k)^exponent for a node that is a power. It is one power, if that has the same
 * domain. */
static dvi__node power_of_power(dvi__graph *graph, dvi__node n, powered x, double exponent)
{
  const double total = x.exponent * exponent;
  const int keeps_domain = is_whole(x.exponent) || !is_whole(total) ||
                           node_at(graph, x.base)->never_negative;
  if (!is_exponent(total) || !keeps_domain) return make_power(graph, n, exponent);
  const int even = is_whole(x.exponent / 2) && !is_whole(exponent);
  return dvi__power(graph, even ? dvi__apply(graph, DVI__OP_ABS, x.base, 0) : x.base, total);
}

dvi__node dvi__power(dvi__graph *graph, dvi__node a, double exponent)
{
  if (graph->failed != DVI_OK) return 0;
  double base;
  if (dvi__is_constant(graph, a, &base) && isfinite(pow(base, exponent)))
    return dvi__constant(graph, pow(base, exponent));
  if (exponent == 0) return dvi__constant(graph, 1);
  if (exponent == 1) return a;
  const dvi__graph_node guarded = *node_at(graph, a);
  if (guarded.op == DVI__OP_WHERE && exponent > 0)
    return dvi__where(graph, guarded.a, dvi__power(graph, guarded.b, exponent));
  if (!is_exponent(exponent))
    return dvi__make(graph, DVI__OP_RAISE, a, dvi__constant(graph, exponent), 0);
  const scaled x = scaled_of(graph, a);
  const double factor = pow(x.factor, exponent);
  if (x.factor != 1 && is_whole(exponent) && is_moderate(factor))
    return dvi__scale(graph, factor, dvi__power(graph, x.rest, exponent));
  const powered p = powered_of(graph, a);
  if (p.exponent != 1) return power_of_power(graph, a, p, exponent);
  if (node_at(graph, a)->op == DVI__OP_ABS && is_whole(exponent / 2))
    return dvi__power(graph, node_at(graph, a)->a, exponent);
  return make_power(graph, a, exponent);
}

static dvi__node simplify_absolute(dvi__graph *graph, dvi__node n)
{
  const scaled x = scaled_of(graph, n);
  if (node_at(graph, n)->never_negative) return n;
  if (x.factor != 1)
    return dvi__scale(graph, fabs(x.factor), dvi__apply(graph, DVI__OP_ABS, x.rest, 0));
  return dvi__make(graph, DVI__OP_ABS, n, 0, 0);
}

/* Apply a function of one operand. Signs are taken out. */
static dvi__node simplify_function(dvi__graph *graph, dvi__op op, dvi__node a)
{
  const dvi__graph_node node = *node_at(graph, a);
  if (node.op != DVI__OP_NEGATE) return dvi__make(graph, op, a, 0, 0);
  switch (op) {
  case DVI__OP_COS:
  case DVI__OP_COSH: return dvi__make(graph, op, node.a, 0, 0);
  case DVI__OP_SIN:
  case DVI__OP_TAN:
  case DVI__OP_ASIN:
  case DVI__OP_ATAN:
  case DVI__OP_SINH:
  case DVI__OP_TANH:
  case DVI__OP_ASINH:
  case DVI__OP_ATANH:
  case DVI__OP_SIGN: return dvi__negate(graph, dvi__make(graph, op, node.a, 0, 0));
  default: return dvi__make(graph, op, a, 0, 0);
  }
}

/* Guard b by a condition. The condition may be known, or may guard b already. */
static dvi__node simplify_where(dvi__graph *graph, dvi__node condition, dvi__node n)
{
  const dvi__graph_node node = *node_at(graph, n);
  double c;
  if (dvi__is_constant(graph, condition, &c) && isfinite(c))
    return c > 0 ? n : dvi__constant(graph, 0);
  if (dvi__is_constant(graph, n, &c) && c == 0) return n;
  if (node.op == DVI__OP_WHERE && node.a == condition) return n;
  return dvi__make(graph, DVI__OP_WHERE, condition, n, 0);
}

dvi__node dvi__complement(dvi__graph *graph, dvi__node c)
{
  const dvi__graph_node node = *node_at(graph, c);
  double one;
  if (node.op == DVI__OP_SUBTRACT && dvi__is_constant(graph, node.a, &one) && one == 1)
    return node.b;
  return dvi__subtract(graph, dvi__constant(graph, 1), c);
}

dvi__node dvi__both(dvi__graph *graph, dvi__node c, dvi__node d)
{
  return dvi__where(graph, c, d);
}

dvi__node dvi__choice(dvi__graph *graph, dvi__node c, dvi__node a, dvi__node b)
{
  if (a == b) return a;
  return dvi__add(graph, dvi__where(graph, c, a), dvi__where(graph, dvi__complement(graph, c), b));
}

dvi__node dvi__greater(dvi__graph *graph, dvi__node a, dvi__node b)
{
  return dvi__apply(graph, DVI__OP_POSITIVE, dvi__subtract(graph, a, b), 0);
}

/* Fold an operation on constants, if it has a value. */
static bool fold_constants(const dvi__graph *graph, dvi__op op, dvi__node a, dvi__node b,
                           double *value)
{
  double x, y = 0;
  if (!dvi__is_constant(graph, a, &x)) return false;
  if (dvi__operands(op) == 2 && !dvi__is_constant(graph, b, &y)) return false;
  *value = dvi__operate(op, 0, x, y);
  return isfinite(*value);
}

dvi__node dvi__apply(dvi__graph *graph, dvi__op op, dvi__node a, dvi__node b)
{
  if (graph->failed != DVI_OK) return 0;
  double c;
  if (fold_constants(graph, op, a, b, &c)) return dvi__constant(graph, c);
  switch (op) {
  case DVI__OP_NEGATE: return simplify_negate(graph, a);
  case DVI__OP_SQUARE: return dvi__power(graph, a, 2);
  case DVI__OP_SQRT: return dvi__power(graph, a, 0.5);
  case DVI__OP_ABS: return simplify_absolute(graph, a);
  case DVI__OP_ADD: return simplify_add(graph, a, b);
  case DVI__OP_SUBTRACT: return simplify_subtract(graph, a, b);
  case DVI__OP_MULTIPLY: return simplify_multiply(graph, a, b);
  case DVI__OP_DIVIDE: return simplify_divide(graph, a, b);
  case DVI__OP_RAISE:
    return dvi__is_constant(graph, b, &c) ? dvi__power(graph, a, c) : dvi__make(graph, op, a, b, 0);
  case DVI__OP_ATAN2: return dvi__make(graph, op, a, b, 0);
  case DVI__OP_WHERE: return simplify_where(graph, a, b);
  case DVI__OP_HYPOT:
    return dvi__power(graph, dvi__add(graph, dvi__square(graph, a), dvi__square(graph, b)), 0.5);
  default: return simplify_function(graph, op, a);
  }
}
