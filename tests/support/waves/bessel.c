/* Minimal solutions by Miller's backward recurrence, dominant ones by the forward one (Gautschi
 * 1967). Formulas from Abramowitz and Stegun 1964, chapters 9 and 10. */
#include "support/waves/bessel.h"

enum { ROOM = 512 };

/* The order from which the backward recurrence starts. Its error is the square of the ratio of the
 * minimal to the dominant solution there, far below roundoff. */
static int first_order(int most, quad size)
{
  const quad order = size > most ? size : most;
  return (int)(order + 60 + 4 * quad_sqrt(order));
}

/* Set f to multiples of a solution of f_{n-1} + f_{n+1} = (step*n + shift) f_n / z. */
static void recur_backward(int first, int step, int shift, quad_complex z, quad_complex f[ROOM])
{
  f[first] = qc(0, 0);
  f[first - 1] = qc(1, 0);
  for (int n = first - 1; n > 0; n--) {
    const quad_complex ratio = qc_divide(qc(step * n + shift, 0), z);
    f[n - 1] = qc_subtract(qc_multiply(ratio, f[n]), f[n + 1]);
  }
}

/* exp(-iz) = J_0 + 2 sum_n (-i)^n J_n, with the sign for which this is large (9.1.41). */
void bessel_j(int most, quad_complex z, quad_complex *J)
{
  quad_complex f[ROOM];
  if (qc_size(z) == 0) {
    for (int n = 0; n <= most; n++) J[n] = qc(n == 0, 0);
    return;
  }
  const int first = first_order(most, qc_size(z)), sign = z.im >= 0 ? -1 : 1;
  recur_backward(first, 2, 0, z, f);
  quad_complex sum = f[0], turn = qc(2, 0);
  for (int n = 1; n < first; n++) {
    turn = qc_multiply(turn, qc(0, sign));
    sum = qc_add(sum, qc_multiply(turn, f[n]));
  }
  const quad_complex factor = qc_divide(qc_exp(qc(-sign * z.im, sign * z.re)), sum);
  for (int n = 0; n <= most; n++) J[n] = qc_multiply(factor, f[n]);
}

/* Neumann's series for the orders 0 and 1 (9.1.88). */
static quad neumann_series(int order, quad x, int terms, const quad_complex *J)
{
  const quad pi = quad_acos(-1), euler = quad_parse("0.577215664901532860606512090082402431", 0);
  quad sum = (quad_log(x / 2) + euler - order) * J[order].re;
  for (int k = 1; k < terms; k++)
    sum -= (k % 2 == 0 ? 1 : -1) * (quad)(order + 2 * k) / ((quad)k * (order + k)) *
           J[order + 2 * k].re;
  return (2 * sum - (order == 1 ? 2 / x * J[0].re : 0)) / pi;
}

void bessel_y(int most, quad x, quad *Y)
{
  quad_complex J[ROOM];
  const int last = first_order(2, x);
  bessel_j(last, qc(x, 0), J);
  Y[0] = neumann_series(0, x, (last - 1) / 2, J);
  if (most > 0) Y[1] = neumann_series(1, x, (last - 1) / 2, J);
  for (int n = 1; n < most; n++) Y[n + 1] = 2 * n / x * Y[n] - Y[n - 1];
}

void spherical_j(int most, quad_complex z, quad_complex *j)
{
  quad_complex f[ROOM];
  const quad_complex zero = qc_divide(qc_sin(z), z),
                     one = qc_divide(qc_subtract(zero, qc_cos(z)), z);
  recur_backward(first_order(most, qc_size(z)), 2, 1, z, f);
  const quad_complex factor = qc_size(f[0]) > qc_size(f[1]) ? qc_divide(zero, f[0])
                                                            : qc_divide(one, f[1]);
  for (int n = 0; n <= most; n++) j[n] = qc_multiply(factor, f[n]);
}

void spherical_y(int most, quad x, quad *y)
{
  y[0] = -quad_cos(x) / x;
  if (most > 0) y[1] = (y[0] - quad_sin(x)) / x;
  for (int n = 1; n < most; n++) y[n + 1] = (2 * n + 1) / x * y[n] - y[n - 1];
}

quad_complex bessel_slope(const quad_complex *f, int n)
{
  if (n == 0) return qc_scale(-1, f[1]);
  return qc_scale(0.5, qc_subtract(f[n - 1], f[n + 1]));
}

/* ---- roots ---- */

/* Halve the interval to nine digits, which the secant method then doubles nearly each time. */
static quad root_between(root_function *f, const void *user, quad low, quad high)
{
  const int positive = f(low, user) > 0;
  for (int i = 0; i < 30; i++) {
    const quad middle = (low + high) / 2;
    if ((f(middle, user) > 0) == positive)
      low = middle;
    else
      high = middle;
  }
  quad x = low, y = high, f_x = f(x, user), f_y = f(y, user);
  for (int i = 0; i < 6 && f_x != f_y; i++) {
    const quad next = y - f_y * (y - x) / (f_y - f_x);
    x = y;
    f_x = f_y;
    y = next;
    f_y = f(y, user);
  }
  return y;
}

void find_roots(root_function *f, const void *user, quad from, quad apart, int most, quad *root)
{
  int found = 0;
  for (quad x = from; found < most; x += apart)
    if ((f(x, user) > 0) != (f(x + apart, user) > 0))
      root[found++] = root_between(f, user, x, x + apart);
}
