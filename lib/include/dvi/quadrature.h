/** Quadrature rules on the unit interval. */
#ifndef DVI_QUADRATURE_H
#define DVI_QUADRATURE_H
#include <dvi/status.h>

/** Most points that a rule can have. */
#define DVI_QUADRATURE_MAX 80

/** The families of rules. Midpoint, trapezoid and Simpson have one size each, 1, 2 and 3 points. */
typedef enum dvi_rule {
  DVI_GAUSS,
  DVI_LOBATTO,
  DVI_RADAU_LEFT,
  DVI_RADAU_RIGHT,
  DVI_CLENSHAW_CURTIS,
  DVI_MIDPOINT,
  DVI_TRAPEZOID,
  DVI_SIMPSON
} dvi_rule;

#ifdef __cplusplus
extern "C" {
#endif

/** Compute nodes and weights. The integral of f over [0,1] is about sum_i weight[i] f(node[i]).
 *
 *  @param      rule    the rule
 *  @param      n       number of points, 1 to DVI_QUADRATURE_MAX (Lobatto and Clenshaw-Curtis from
 *                      2)
 *  @param[out] node    [n], ascending, in [0,1]
 *  @param[out] weight  [n], positive, sum 1
 *  @retval DVI_OK            node and weight hold the rule, each number right to 2 ulp (a few ulp
 *                            where long double is not longer than double)
 *  @retval DVI_BAD_SIZE      n is outside the rule's range. Nothing is written
 *  @retval DVI_BAD_ARGUMENT  unknown rule or NULL array. Nothing is written
 *
 *  Gauss, Lobatto and Radau rules are computed by Newton's method on the Legendre recurrence in the
 *  distance from the nearer end (Davis and Rabinowitz 1984, sec. 2.7). Lobatto and Radau nodes are
 *  those of Hairer, Lubich and Wanner 2006, sec. II.1.4. Clenshaw-Curtis is computed by its cosine
 *  sum (Trefethen 2008). */
dvi_status dvi_quadrature(dvi_rule rule, int n, double *node, double *weight);

/** Return the order of a rule. The rule is exact for polynomials of a degree below its order.
 *
 *  The orders are Gauss 2n, Radau 2n-1, Lobatto 2n-2, Clenshaw-Curtis n (n+1 for odd n), midpoint
 *  2, trapezoid 2, Simpson 4.
 *  @return the order, or 0 if the rule or n is out of range. */
int dvi_quadrature_order(dvi_rule rule, int n);

/** Return the rule's name as method specifications spell it ("gauss", "radau-left", ...). NULL if
 *  the rule is out of range. */
const char *dvi_rule_name(dvi_rule rule);

#ifdef __cplusplus
}
#endif
#endif
