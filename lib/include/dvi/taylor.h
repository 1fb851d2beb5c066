/** The arithmetic of truncated power series, for writing the `taylor` callbacks of a system
 *  (dvi/system.h).
 *
 *  A series of degree d is an array of d+1 coefficients, a(s) = a[0] + a[1] s + ... + a[d] s^d.
 *  These are coefficients, not derivatives. a[k] is the k-th derivative over k!. Every function
 *  here computes the first d+1 coefficients of its result exactly, up to rounding, in at most 2 d^2
 *  multiplications. The result may not be one of the arguments. Where a function has no series (a
 *  division by a series that begins with 0, the root of one that begins below 0) the result is not
 *  finite, which the library finds and names.
 *
 *  A potential V = -1/|q| in the plane, for example (without its Hessian):
 *
 *      double x[DVI_TAYLOR_MAX + 1], y[...], square[...], inverse[...], force[...];
 *      dvi_taylor_get(degree, 2, q, 0, x);
 *      dvi_taylor_get(degree, 2, q, 1, y);
 *      dvi_taylor_multiply(degree, x, x, square);
 *      dvi_taylor_add_product(degree, y, y, square);
 *      dvi_taylor_power(degree, square, -0.5, inverse);       1/r
 *      dvi_taylor_power(degree, square, -1.5, cube);          1/r^3
 *      dvi_taylor_put(degree, 1, inverse, -1, 0, V);
 *      dvi_taylor_multiply(degree, x, cube, force);
 *      dvi_taylor_put(degree, 2, force, 1, 0, V_q);
 *
 *  Source: Griewank and Walther 2008 (Evaluating Derivatives, 2nd ed., SIAM), sec. 13.2. */
#ifndef DVI_TAYLOR_H
#define DVI_TAYLOR_H
#include <math.h>

/** The highest degree that the library asks a `taylor` callback for. Arrays of one more number hold
 *  every series. */
#define DVI_TAYLOR_MAX 40

#ifdef __cplusplus
extern "C" {
#endif

/** Extract the series of component i of n, x[k] = q[k*n + i]. */
static inline void dvi_taylor_get(int degree, int n, const double *q, int i, double *x)
{
  x[0] = q[i];
  for (int k = 1; k <= degree; k++) x[k] = q[k * n + i];
}

/** Store a series, times a factor, as component i of n, q[k*n + i] = factor x[k]. Nothing happens
 *  if q is NULL, so a callback need not test which results are wanted. */
static inline void dvi_taylor_put(int degree, int n, const double *x, double factor, int i,
                                  double *q)
{
  for (int k = 0; q && k <= degree; k++) q[k * n + i] = factor * x[k];
}

/** Compute c = alpha a + beta b. */
static inline void dvi_taylor_combine(int degree, double alpha, const double *a, double beta,
                                      const double *b, double *c)
{
  c[0] = alpha * a[0] + beta * b[0];
  for (int k = 1; k <= degree; k++) c[k] = alpha * a[k] + beta * b[k];
}

/** Return coefficient k of a b. */
static inline double dvi_taylor_product(int k, const double *a, const double *b)
{
  double sum = 0;
  for (int j = 0; j <= k; j++) sum += a[j] * b[k - j];
  return sum;
}

/** Compute c = a b. */
static inline void dvi_taylor_multiply(int degree, const double *a, const double *b, double *c)
{
  c[0] = a[0] * b[0];
  for (int k = 1; k <= degree; k++) c[k] = dvi_taylor_product(k, a, b);
}

/** Compute c = c + a b. */
static inline void dvi_taylor_add_product(int degree, const double *a, const double *b, double *c)
{
  for (int k = 0; k <= degree; k++) c[k] += dvi_taylor_product(k, a, b);
}

/** Compute c = a / b. b[0] may not be 0. */
static inline void dvi_taylor_divide(int degree, const double *a, const double *b, double *c)
{
  c[0] = a[0] / b[0];
  for (int k = 1; k <= degree; k++) {
    double sum = a[k];
    for (int j = 0; j < k; j++) sum -= c[j] * b[k - j];
    c[k] = sum / b[0];
  }
}

/** Compute c = sqrt(a) from c c = a. Requires a[0] > 0. */
static inline void dvi_taylor_square_root(int degree, const double *a, double *c)
{
  c[0] = sqrt(a[0]);
  for (int k = 1; k <= degree; k++) {
    double sum = a[k];
    for (int j = 1; j < k; j++) sum -= c[j] * c[k - j];
    c[k] = sum / (2 * c[0]);
  }
}

/** Compute c = a^r for any real r from a c' = r a' c. a[0] is not 0, and positive unless r is
 *  whole. */
static inline void dvi_taylor_power(int degree, const double *a, double r, double *c)
{
  c[0] = pow(a[0], r);
  for (int k = 1; k <= degree; k++) {
    double sum = 0;
    for (int j = 1; j <= k; j++) sum += (r * j - (k - j)) * a[j] * c[k - j];
    c[k] = sum / (k * a[0]);
  }
}

/** Compute c = exp(a) from c' = a' c. */
static inline void dvi_taylor_exp(int degree, const double *a, double *c)
{
  c[0] = exp(a[0]);
  for (int k = 1; k <= degree; k++) {
    double sum = 0;
    for (int j = 1; j <= k; j++) sum += j * a[j] * c[k - j];
    c[k] = sum / k;
  }
}

/** Compute c = log(a) from a c' = a'. Requires a[0] > 0. */
static inline void dvi_taylor_log(int degree, const double *a, double *c)
{
  c[0] = log(a[0]);
  for (int k = 1; k <= degree; k++) {
    double sum = 0;
    for (int j = 1; j < k; j++) sum += j * c[j] * a[k - j];
    c[k] = (a[k] - sum / k) / a[0];
  }
}

/** Compute the trigonometric functions sin(a) and cos(a) from sine' = a' cosine and
 *  cosine' = -a' sine. */
static inline void dvi_taylor_sin_cos(int degree, const double *a, double *sine, double *cosine)
{
  sine[0] = sin(a[0]);
  cosine[0] = cos(a[0]);
  for (int k = 1; k <= degree; k++) {
    double along = 0, against = 0;
    for (int j = 1; j <= k; j++) {
      along += j * a[j] * cosine[k - j];
      against += j * a[j] * sine[k - j];
    }
    sine[k] = along / k;
    cosine[k] = -against / k;
  }
}

/** Compute the hyperbolic functions sinh(a) and cosh(a) from sine' = a' cosine and
 *  cosine' = a' sine. */
static inline void dvi_taylor_sinh_cosh(int degree, const double *a, double *sine, double *cosine)
{
  sine[0] = sinh(a[0]);
  cosine[0] = cosh(a[0]);
  for (int k = 1; k <= degree; k++) {
    double up = 0, down = 0;
    for (int j = 1; j <= k; j++) {
      up += j * a[j] * cosine[k - j];
      down += j * a[j] * sine[k - j];
    }
    sine[k] = up / k;
    cosine[k] = down / k;
  }
}

/** Compute the integral c of a/b that begins with c0, from b c' = a. a is of degree - 1, b[0] is
 *  not 0.
 *
 *  The function gives atan, asin and others with a simple derivative. atan(x) is the integral for
 *  a = x' and b = 1 + x^2. */
static inline void dvi_taylor_integrate_quotient(int degree, const double *a, const double *b,
                                                 double c0, double *c)
{
  c[0] = c0;
  for (int k = 1; k <= degree; k++) {
    double sum = a[k - 1];
    for (int j = 1; j < k; j++) sum -= j * c[j] * b[k - j];
    c[k] = sum / (k * b[0]);
  }
}

/** Compute the derivative c[k] = (k+1) a[k+1], of degree - 1, where `degree` is that of a. */
static inline void dvi_taylor_differentiate(int degree, const double *a, double *c)
{
  for (int k = 0; k < degree; k++) c[k] = (k + 1) * a[k + 1];
}

#ifdef __cplusplus
}
#endif
#endif
