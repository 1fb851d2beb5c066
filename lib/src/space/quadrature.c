/* Quadrature rules on the unit interval.
 *
 * The Gaussian families differ only in the ends that are nodes. Seen from one end, let `here` be 1
 * if that end is a node and `there` 1 if the other end is. The nodes are these ends and the zeros,
 * in the distance y from this end, of
 *
 *     here there                                        weight
 *      0     0    Gauss    P_n                          4 y (1-y) / (n (P_n - P_{n-1}))^2
 *      1     0    Radau    P_n - P_{n-1}                (1-y) / (n P_{n-1})^2
 *      0     1    Radau    P_n + P_{n-1}                y / (n P_{n-1})^2
 *      1     1    Lobatto  (1-x^2) P'_{n-1} / (n-1)     1 / (n (n-1) P_{n-1}^2)
 *
 * with P_k = P_k(x), x = 1 - 2y. The free zeros are those of the Jacobi polynomial P^(here,there).
 * Every node is computed from its nearer end. So symmetric rules come out symmetric to the last
 * bit, and small nodes keep their relative accuracy. Source: Davis and Rabinowitz 1984, sec. 2.7.
 *
 * All work is done in long double. With 64 bits of mantissa or more the rounded results are right
 * to 2 ulp. Where long double is the same as double, a few ulp are lost, most in the inner
 * Clenshaw-Curtis weights at large n. */
#include "space/quadrature.h"

#include <math.h>
#include <stddef.h>

#include "core/status.h"
#include "space/legendre.h"

/* Convert a count for use in formulas. */
#define REAL(n) ((long double)(n))

/* Flags of the ends that are nodes, seen from the end from which distances count. */
typedef struct ends {
  int here, there;
} ends;

static long double circle_number(void)
{
  return 4 * atanl(1);
}

/* Compute Newton's step, the function whose zeros are the free nodes over its derivative in y. */
static long double newton_step(ends e, int n, long double y)
{
  long double value[DVI__QUADRATURE_MOST + 1], difference[DVI__QUADRATURE_MOST + 1];
  dvi__legendre(n, y, value, difference);
  const long double P = value[n], D = difference[n], S = 2 * P - D;
  if (e.here && e.there)
    return (2 * y * value[n - 1] - difference[n - 1]) / (2 * REAL(n) * value[n - 1]);
  if (e.here) return -D * (1 - y) / (REAL(n) * S);
  if (e.there) return S * y / (REAL(n) * D);
  return -P * 2 * y * (1 - y) / (REAL(n) * (2 * y * P - D));
}

/* Compute the distance of free node k = 1, 2, ... from the end. The first guess is the asymptotic
 * one of the Jacobi polynomials. Newton's method squares the error, so that the step after one
 * below 1e-12 would be below roundoff. */
static long double free_node(ends e, int n, int k)
{
  const long double half_angle = circle_number() * (REAL(2 * k + e.here) - 0.5L) /
                                 (2 * REAL(2 * n + 1 - e.here - e.there));
  const int most_steps = 10;
  long double y = sinl(half_angle) * sinl(half_angle);
  for (int i = 0; i < most_steps; i++) {
    const long double step = newton_step(e, n, y);
    y -= step;
    if (fabsl(step) <= 1e-12L * y) break;
  }
  return y;
}

static long double gaussian_weight(ends e, int n, long double y)
{
  long double value[DVI__QUADRATURE_MOST + 1], difference[DVI__QUADRATURE_MOST + 1];
  dvi__legendre(n, y, value, difference);
  const long double P = value[n - 1], nD = REAL(n) * difference[n];
  if (e.here && e.there) return 1 / (REAL(n) * REAL(n - 1) * P * P);
  if (e.here || e.there) return (e.here ? 1 - y : y) / (REAL(n) * REAL(n) * P * P);
  return 4 * y * (1 - y) / (nD * nD);
}

/* Compute node i counted from the end. Return false if the node is nearer to the other end. */
static int from_here(ends e, int n, int i, long double *y, long double *weight)
{
  const int k = i + 1 - e.here;
  const int beyond_middle = 4 * k + 2 * e.here - 1 - (2 * n + 1 - e.here - e.there);
  if (beyond_middle > 0) return 0;
  *y = k == 0 ? 0 : beyond_middle == 0 ? 0.5L : free_node(e, n, k);
  *weight = gaussian_weight(e, n, *y);
  return 1;
}

static void gaussian_rule(ends left, int n, long double *node, long double *weight)
{
  const ends right = {.here = left.there, .there = left.here};
  for (int i = 0; i < n; i++) {
    if (from_here(left, n, i, &node[i], &weight[i])) continue;
    long double from_the_end = 0;
    from_here(right, n, n - 1 - i, &from_the_end, &weight[i]);
    node[i] = 1 - from_the_end;
  }
}

/* Sum the cosines of an inner weight. The angle is reduced to [0, pi] by whole numbers, without
 * error. */
static long double clenshaw_curtis_weight(int intervals, int j)
{
  long double sum = 1;
  for (int k = 1; 2 * k <= intervals; k++) {
    const int turn = k * j % intervals, angle = 2 * turn > intervals ? intervals - turn : turn;
    const long double both = 2 * k == intervals ? 1 : 2;
    sum -= both / REAL(4 * k * k - 1) * cosl(2 * circle_number() * REAL(angle) / REAL(intervals));
  }
  return sum / REAL(intervals);
}

/* Compute Chebyshev points of the second kind, sin^2(pi j / 2N). Source: Trefethen 2008. */
static void clenshaw_curtis(int n, long double *node, long double *weight)
{
  const int N = n - 1;
  for (int j = 0; 2 * j <= N; j++) {
    const long double sine = sinl(circle_number() * REAL(j) / REAL(2 * N));
    node[j] = 2 * j == N ? 0.5L : sine * sine;
    weight[j] = j == 0 ? 0.5L / REAL(N % 2 ? N * N : N * N - 1) : clenshaw_curtis_weight(N, j);
    if (2 * j < N) node[N - j] = 1 - node[j];
    weight[N - j] = weight[j];
  }
}

static const struct rule {
  const char *name;
  int fewest, most;
} rules[] = {
    [DVI_GAUSS] = {"gauss", 1, DVI_QUADRATURE_MAX},
    [DVI_LOBATTO] = {"lobatto", 2, DVI_QUADRATURE_MAX},
    [DVI_RADAU_LEFT] = {"radau-left", 1, DVI_QUADRATURE_MAX},
    [DVI_RADAU_RIGHT] = {"radau-right", 1, DVI_QUADRATURE_MAX},
    [DVI_CLENSHAW_CURTIS] = {"clenshaw-curtis", 2, DVI_QUADRATURE_MAX},
    [DVI_MIDPOINT] = {"midpoint", 1, 1},
    [DVI_TRAPEZOID] = {"trapezoid", 2, 2},
    [DVI_SIMPSON] = {"simpson", 3, 3},
};

/* A caller may pass any number as an enum. */
static int rule_is_known(dvi_rule rule)
{
  return (int)rule >= 0 && (size_t)rule < sizeof rules / sizeof *rules;
}

/* `most` is the limit of rules of any size. */
static dvi_status check_rule(dvi_rule rule, int n, int most, int outputs)
{
  if (!rule_is_known(rule))
    return dvi__fail(DVI_BAD_ARGUMENT, "quadrature: there is no rule with number %d", (int)rule);
  if (!outputs)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "quadrature: the array for the nodes or for the weights is NULL");
  if (rules[rule].most < DVI_QUADRATURE_MAX) most = rules[rule].most;
  if (n < rules[rule].fewest || n > most)
    return dvi__fail(DVI_BAD_SIZE, "quadrature: %d points asked of %s, %d to %d possible", n,
                     rules[rule].name, rules[rule].fewest, most);
  return DVI_OK;
}

dvi_status dvi__quadrature_long(dvi_rule rule, int n, long double *node, long double *weight)
{
  DVI_TRY(check_rule(rule, n, DVI__QUADRATURE_MOST, node && weight));
  switch (rule) {
  case DVI_GAUSS:
  case DVI_MIDPOINT: gaussian_rule((ends){.here = 0, .there = 0}, n, node, weight); break;
  case DVI_RADAU_LEFT: gaussian_rule((ends){.here = 1, .there = 0}, n, node, weight); break;
  case DVI_RADAU_RIGHT: gaussian_rule((ends){.here = 0, .there = 1}, n, node, weight); break;
  case DVI_LOBATTO:
  case DVI_TRAPEZOID:
  case DVI_SIMPSON: gaussian_rule((ends){.here = 1, .there = 1}, n, node, weight); break;
  case DVI_CLENSHAW_CURTIS: clenshaw_curtis(n, node, weight); break;
  }
  return DVI_OK;
}

dvi_status dvi_quadrature(dvi_rule rule, int n, double *node, double *weight)
{
  long double node_long[DVI_QUADRATURE_MAX] = {0}, weight_long[DVI_QUADRATURE_MAX] = {0};
  DVI_TRY(check_rule(rule, n, DVI_QUADRATURE_MAX, node && weight));
  DVI_TRY(dvi__quadrature_long(rule, n, node_long, weight_long));
  for (int i = 0; i < n; i++) {
    node[i] = (double)node_long[i];
    weight[i] = (double)weight_long[i];
  }
  return DVI_OK;
}

int dvi_quadrature_order(dvi_rule rule, int n)
{
  if (!rule_is_known(rule) || n < rules[rule].fewest || n > rules[rule].most) return 0;
  switch (rule) {
  case DVI_GAUSS:
  case DVI_MIDPOINT: return 2 * n;
  case DVI_RADAU_LEFT:
  case DVI_RADAU_RIGHT: return 2 * n - 1;
  case DVI_LOBATTO:
  case DVI_TRAPEZOID:
  case DVI_SIMPSON: return 2 * n - 2;
  case DVI_CLENSHAW_CURTIS: return n % 2 ? n + 1 : n;
  }
  return 0;
}

const char *dvi_rule_name(dvi_rule rule)
{
  return rule_is_known(rule) ? rules[rule].name : NULL;
}
