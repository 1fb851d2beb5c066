#include "group/turn.h"

#include <math.h>

#include "group/stumpff.h"
#include "group/vector.h"
#include "num/compensated.h"

/* sum of x_i^2 onto *sum, what rounding drops onto *low (Ogita, Rump and Oishi 2005). */
static void add_squares(int count, const double *x, double *sum, double *low)
{
  for (int i = 0; i < count; i++) {
    const double square = x[i] * x[i], next = *sum + square, added = next - *sum;
    *low += __builtin_fma(x[i], x[i], -square) + ((*sum - (next - added)) + (square - added));
    *sum = next;
  }
}

/* tan(x)/x - 1 = x^2 (c_2 - c_3)/c_0 at x = |f|/2 is small: its rounding, the same in all steps of a steady turn, is too. */
void dvi__turn_tangent(const double f[3], double w[3])
{
  double c[4];
  const double square = 0.25 * dvi__dot(f, f);
  dvi__stumpff_four(square, c);
  const double more = square * (c[2] - c[3]) / c[0];
  for (int i = 0; i < 3; i++) w[i] = 0.5 * f[i] + more * (0.5 * f[i]);
}

dvi__turn dvi__turn_of(const double w[3])
{
  double n = 1, n_low = 0;
  add_squares(3, w, &n, &n_low);
  const double s = (double)(float)(2 / n);
  return (dvi__turn){{w[0], w[1], w[2]}, s, (__builtin_fma(-s, n, 2) - s * n_low) / n};
}

dvi__turn dvi__turn_back(const dvi__turn *turn)
{
  return (dvi__turn){{-turn->w[0], -turn->w[1], -turn->w[2]}, turn->s, turn->s_low};
}

void dvi__turn_change(const dvi__turn *turn, const double x[3], double change[3])
{
  double once[3], twice[3];
  dvi__cross(x, turn->w, once);
  dvi__cross(once, turn->w, twice);
  for (int i = 0; i < 3; i++) {
    const double sum = once[i] + twice[i];
    change[i] = turn->s * sum + turn->s_low * sum;
  }
}

void dvi__turn_frame(const dvi__turn *turn, double *R, double *carry)
{
  for (int i = 0; i < 3; i++) {
    double change[3];
    dvi__turn_change(turn, R + 3 * i, change);
    dvi__add_compensated_all(3, R + 3 * i, carry + 3 * i, change);
  }
}

double dvi__swing_cosine(int count, const double *u)
{
  double square = 0;
  for (int i = 0; i < count; i++) square += u[i] * u[i];
  return -square / (1 + sqrt(1 - square));
}

/* (1 + d)^2 + |u|^2 - 1 = 2 d + d^2 + |u|^2 is made 0 to twice the digits, by the larger of both. */
void dvi__swing(int count, double d, const double *u, const double *y, double *change)
{
  double square = 0, low = 0;
  add_squares(count, u, &square, &low);
  const double d_square = d * d, excess = ((2 * d + square) + d_square) + (__builtin_fma(d, d, -d_square) + low);
  const int along = (1 + d) * (1 + d) > square;
  const double more_d = along ? -0.5 * excess / (1 + d) : 0, more_u = along ? 0 : -0.5 * excess / square;
  for (int i = 0; i < count; i++) change[i] = (d * y[i] + u[i]) + (more_d * y[i] + more_u * u[i]);
}

/* mu x y has changed by mu x change; what rounding leaves along y would grow. */
void dvi__swing_momentum(const double mu[3], const double change[3], const double y[3], double p[3])
{
  double turned[3];
  dvi__cross(mu, change, turned);
  for (int i = 0; i < 3; i++) p[i] += turned[i];
  const double along = dvi__dot(p, y) / dvi__dot(y, y);
  for (int i = 0; i < 3; i++) p[i] -= along * y[i];
}
