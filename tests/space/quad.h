/* An independent judge in quadruple precision: nodes by bracketing and the secant rule, weights by
 * the textbook formulas on [-1,1] or by integrating the cardinal polynomials, trial functions by
 * their products. Roundoff here is 1e-34, so nothing is done to avoid cancellation. */
#ifndef TEST_SPACE_QUAD_H
#define TEST_SPACE_QUAD_H
#ifdef DVI_HAVE_QUADMATH
#include <quadmath.h>

#include <dvi/basis.h>
#include <dvi/quadrature.h>

typedef __float128 quad;

static inline quad quad_pi(void)
{
  return acosq(-1);
}

/* P_n(x), P_{n-1}(x) and P_n'(x). */
static inline quad quad_legendre(int n, quad x, quad *previous, quad *slope)
{
  quad P = 1, before = 0, dP = 0, dbefore = 0;
  for (int k = 0; k < n; k++) {
    const quad next = ((2 * k + 1) * x * P - k * before) / (k + 1);
    const quad dnext = dbefore + (2 * k + 1) * P;
    before = P;
    P = next;
    dbefore = dP;
    dP = dnext;
  }
  if (previous) *previous = before;
  if (slope) *slope = dP;
  return P;
}

/* The function on [-1,1] whose inner zeros are the rule's free nodes. */
static inline quad quad_node_function(dvi_rule rule, int n, quad x)
{
  quad previous, slope, P = quad_legendre(n, x, &previous, NULL);
  switch ((int)rule) {
  case DVI_GAUSS: return P;
  case DVI_RADAU_LEFT: return (P + previous) / (1 + x);
  case DVI_RADAU_RIGHT: return (P - previous) / (1 - x);
  default: (void)quad_legendre(n - 1, x, NULL, &slope); return slope;
  }
}

static inline quad quad_zero(dvi_rule rule, int n, quad low, quad high)
{
  quad at_low = quad_node_function(rule, n, low);
  for (int i = 0; i < 6; i++) {
    const quad middle = (low + high) / 2, at_middle = quad_node_function(rule, n, middle);
    if ((at_low < 0) == (at_middle < 0)) {
      low = middle;
      at_low = at_middle;
    } else {
      high = middle;
    }
  }
  quad at_high = quad_node_function(rule, n, high);
  for (int i = 0; i < 10 && at_high != at_low; i++) {
    const quad next = high - at_high * (high - low) / (at_high - at_low);
    low = high;
    at_low = at_high;
    high = next;
    at_high = quad_node_function(rule, n, high);
  }
  return high;
}

/* Nodes of a Gaussian rule on [-1,1]: the ends that it takes and the sign changes between. */
static inline void quad_gaussian_nodes(dvi_rule rule, int n, quad *x)
{
  const int left = rule == DVI_LOBATTO || rule == DVI_RADAU_LEFT,
            right = rule == DVI_LOBATTO || rule == DVI_RADAU_RIGHT;
  const int cells = 4 * n + 1;
  int found = 0;
  if (left) x[found++] = -1;
  for (int i = 1; i < cells - 1 && found < n - right; i++) {
    const quad low = -cosq(i * quad_pi() / cells), high = -cosq((i + 1) * quad_pi() / cells);
    if ((quad_node_function(rule, n, low) < 0) != (quad_node_function(rule, n, high) < 0))
      x[found++] = quad_zero(rule, n, low, high);
  }
  if (right) x[found++] = 1;
}

static inline quad quad_gaussian_weight(dvi_rule rule, int n, quad x)
{
  quad slope, previous;
  (void)quad_legendre(n, x, &previous, &slope);
  switch ((int)rule) {
  case DVI_GAUSS: return 2 / ((1 - x * x) * slope * slope);
  case DVI_RADAU_LEFT: return (1 - x) / (n * n * previous * previous);
  case DVI_RADAU_RIGHT: return (1 + x) / (n * n * previous * previous);
  default: return 2 / (n * (n - 1) * previous * previous);
  }
}

/* phi_k of the nodes x[count] at t, and its derivative. */
static inline quad quad_cardinal(int count, const quad *x, int k, quad t, quad *slope)
{
  quad value = 1, sum = 0;
  for (int j = 0; j < count; j++)
    if (j != k) value *= (t - x[j]) / (x[k] - x[j]);
  for (int m = 0; slope && m < count; m++) {
    quad product = 1;
    for (int j = 0; j < count; j++)
      if (j != k) product *= (j == m ? 1 : t - x[j]) / (x[k] - x[j]);
    if (m != k) sum += product;
  }
  if (slope) *slope = sum;
  return value;
}

/* Nodes and weights on [0,1]. */
static inline void quad_rule(dvi_rule rule, int n, quad *node, quad *weight)
{
  quad gauss[DVI_QUADRATURE_MAX];
  if (rule != DVI_CLENSHAW_CURTIS) {
    quad_gaussian_nodes(rule, n, node);
    for (int i = 0; i < n; i++) weight[i] = quad_gaussian_weight(rule, n, node[i]) / 2;
  } else {
    const int half = n / 2 + 1; /* exact for the cardinal polynomials' degree n-1 */
    quad_gaussian_nodes(DVI_GAUSS, half, gauss);
    for (int j = 0; j < n; j++) node[j] = -cosq(j * quad_pi() / (n - 1));
    for (int j = 0; j < n; j++) {
      weight[j] = 0;
      for (int i = 0; i < half; i++)
        weight[j] += quad_gaussian_weight(DVI_GAUSS, half, gauss[i]) / 2 *
                     quad_cardinal(n, node, j, gauss[i], NULL);
    }
  }
  for (int i = 0; i < n; i++) node[i] = (1 + node[i]) / 2;
}

#endif
#endif
