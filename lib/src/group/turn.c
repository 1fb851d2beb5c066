#include "group/turn.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "group/stumpff.h"
#include "group/vector.h"
#include "num/compensated.h"
#include "num/simd/fused.h"

/* The correction tan(x)/x - 1 = x^2 (c_2 - c_3)/c_0 at x = |f|/2 is small. So is its rounding,
 * which is the same in all steps of a steady turn. At half a turn cos(x) may be rounded to 0. An
 * angle whose square overflows has no digits and gives no turn. */
void dvi__turn_tangent(const double f[3], double w[3])
{
  double c[4];
  const double square = 0.25 * dvi__dot(f, f);
  dvi__stumpff_four(square, c);
  const double more = isinf(square)
                          ? -1
                          : square * (c[2] - c[3]) / (c[0] != 0 ? c[0] : 0.5 * DBL_EPSILON);
  for (int i = 0; i < 3; i++) w[i] = 0.5 * f[i] + more * (0.5 * f[i]);
}

FUSED static dvi__turn turn_of(const double w[3])
{
  dvi__twofold n = {1, 0};
  for (int i = 0; i < 3; i++) n = dvi__twofold_sum(n, dvi__exact_product(w[i], w[i]));
  const double s = (double)(float)(2 / n.head);
  return (dvi__turn){{w[0], w[1], w[2]}, s, (__builtin_fma(-s, n.head, 2) - s * n.tail) / n.head};
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

FUSED_INLINE void cross_twofold(const dvi__twofold a[3], const dvi__twofold b[3],
                                dvi__twofold product[3])
{
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const dvi__twofold ahead = dvi__exact_product(a[j].head, b[k].head),
                       back = dvi__exact_product(-a[k].head, b[j].head);
    const double tails = (a[j].tail * b[k].head - a[k].tail * b[j].head) +
                         (a[j].head * b[k].tail - a[k].head * b[j].tail);
    product[i] = dvi__twofold_sum(ahead, back);
    product[i].tail += tails;
  }
}

/* Compute a x b for b without tails. */
FUSED_INLINE void cross_by(const dvi__twofold a[3], const double b[3], dvi__twofold product[3])
{
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const dvi__twofold ahead = dvi__exact_product(a[j].head, b[k]),
                       back = dvi__exact_product(-a[k].head, b[j]);
    const double tails = a[j].tail * b[k] - a[k].tail * b[j];
    product[i] = dvi__twofold_sum(ahead, back);
    product[i].tail += tails;
  }
}

/* Turn a row by x^T F = x^T + s z^T w^,  z^T = x^T (I + w^). */
FUSED_INLINE void turn_row(const dvi__turn *turn, double *head, double *low)
{
  dvi__twofold x[3], z[3], moved[3];
  dvi__twofold_get(3, head, low, x);
  cross_by(x, turn->w, z);
  for (int i = 0; i < 3; i++) z[i] = dvi__twofold_sum(x[i], z[i]);
  cross_by(z, turn->w, moved);
  for (int i = 0; i < 3; i++) {
    dvi__twofold change = dvi__exact_product(turn->s, moved[i].head);
    change.tail += turn->s * moved[i].tail + turn->s_low * moved[i].head;
    x[i] = dvi__twofold_sum(x[i], change);
  }
  dvi__twofold_put(3, x, head, low);
}

FUSED static void turn_rows(const dvi__turn *turn, int count, double *x, double *compensation)
{
  const dvi__turn by =
      *turn; /* a copy, because the compiler cannot know that no store changes it */
  int at = 0;
  for (; at + 3 <= count; at += 3) turn_row(&by, x + at, compensation + at);
  if (at == count) return;
  double head[3] = {0}, low[3] = {0};
  const size_t bytes = (size_t)(count - at) * sizeof(double);
  memcpy(head, x + at, bytes);
  memcpy(low, compensation + at, bytes);
  turn_row(&by, head, low);
  memcpy(x + at, head, bytes);
  memcpy(compensation + at, low, bytes);
}

/* Compute a.b + c to relative rounding accuracy even where almost everything cancels. */
FUSED_INLINE double dot_twofold(const dvi__twofold a[3], const dvi__twofold b[3], double c)
{
  dvi__twofold sum = {c, 0};
  for (int i = 0; i < 3; i++) {
    dvi__twofold product = dvi__exact_product(a[i].head, b[i].head);
    product.tail += a[i].head * b[i].tail + a[i].tail * b[i].head;
    sum = dvi__twofold_sum(sum, product);
  }
  return sum.head + sum.tail;
}

/* y is a unit vector but for rounding. So 1/|y|^2 is 1 less the excess of |y|^2 above 1. */
FUSED static void angular_of_direction(const double *y, const double *y_compensation,
                                       const double *p, const double *p_compensation,
                                       dvi__twofold mu[3])
{
  dvi__twofold at[3], momentum[3];
  dvi__twofold_get(3, y, y_compensation, at);
  dvi__twofold_get(3, p, p_compensation, momentum);
  cross_twofold(at, momentum, mu);
  const double above = dot_twofold(at, at, -1);
  for (int i = 0; i < 3; i++) mu[i] = dvi__exact_sum(mu[i].head, mu[i].tail - above * mu[i].head);
}

/* mu is orthogonal to y but for the rounding of both. mu x y would lose the component of mu along
 * y, which is the same in all steps of a steady turn. So y is corrected. */
FUSED_INLINE void make_orthogonal(const dvi__twofold mu[3], double most, dvi__twofold y[3])
{
  const double square = mu[0].head * mu[0].head + mu[1].head * mu[1].head + mu[2].head * mu[2].head,
               along = dot_twofold(mu, y, 0);
  if (!(fabs(along) < most * sqrt(square))) return;
  for (int i = 0; i < 3; i++) y[i].tail -= along / square * mu[i].head;
}

FUSED static void momentum_of(const dvi__twofold mu[3], double most, double *y,
                              double *y_compensation, double *p, double *p_compensation)
{
  dvi__twofold at[3], momentum[3];
  dvi__twofold_get(3, y, y_compensation, at);
  make_orthogonal(mu, most, at);
  cross_twofold(mu, at, momentum);
  dvi__twofold_put(3, at, y, y_compensation);
  dvi__twofold_put(3, momentum, p, p_compensation);
}

/* clang does not export a function that is compiled more than once. */
dvi__turn dvi__turn_of(const double w[3])
{
  return turn_of(w);
}

void dvi__turn_rows(const dvi__turn *turn, int count, double *x, double *compensation)
{
  turn_rows(turn, count, x, compensation);
}

void dvi__turn_angular(const double *y, const double *y_compensation, const double *p,
                       const double *p_compensation, dvi__twofold mu[3])
{
  angular_of_direction(y, y_compensation, p, p_compensation, mu);
}

void dvi__turn_momentum(const dvi__twofold mu[3], double most, double *y, double *y_compensation,
                        double *p, double *p_compensation)
{
  momentum_of(mu, most, y, y_compensation, p, p_compensation);
}
