/* The operations of turn.h on local numbers. They are compiled into the functions of one turn and
 * into loops over members of ensembles, whose lanes have the bits of one turn. */
#ifndef DVI_GROUP_TURN_CORE_H
#define DVI_GROUP_TURN_CORE_H
#include <math.h>

#include "group/turn.h"
#include "group/vector.h"
#include "num/simd/fused.h"

FUSED_INLINE dvi__turn dvi__turn_made(const double w[3])
{
  dvi__twofold n = {1, 0};
  for (int i = 0; i < 3; i++) n = dvi__twofold_sum(n, dvi__exact_product(w[i], w[i]));
  const double s = (double)(float)(2 / n.head);
  return (dvi__turn){{w[0], w[1], w[2]}, s, (__builtin_fma(-s, n.head, 2) - s * n.tail) / n.head};
}

FUSED_INLINE void dvi__turn_changed(const dvi__turn *turn, const double x[3], double change[3])
{
  double once[3], twice[3];
  dvi__cross(x, turn->w, once);
  dvi__cross(once, turn->w, twice);
  for (int i = 0; i < 3; i++) {
    const double sum = once[i] + twice[i];
    change[i] = turn->s * sum + turn->s_low * sum;
  }
}

FUSED_INLINE void dvi__twofold_cross(const dvi__twofold a[3], const dvi__twofold b[3],
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
FUSED_INLINE void dvi__twofold_cross_by(const dvi__twofold a[3], const double b[3],
                                        dvi__twofold product[3])
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
FUSED_INLINE void dvi__turn_twofold(const dvi__turn *turn, dvi__twofold x[3])
{
  dvi__twofold z[3], moved[3];
  dvi__twofold_cross_by(x, turn->w, z);
  for (int i = 0; i < 3; i++) z[i] = dvi__twofold_sum(x[i], z[i]);
  dvi__twofold_cross_by(z, turn->w, moved);
  for (int i = 0; i < 3; i++) {
    dvi__twofold change = dvi__exact_product(turn->s, moved[i].head);
    change.tail += turn->s * moved[i].tail + turn->s_low * moved[i].head;
    x[i] = dvi__twofold_sum(x[i], change);
  }
}

/* Turn a row with its compensation. */
FUSED_INLINE void dvi__turn_row(const dvi__turn *turn, double *x, double *compensation)
{
  dvi__twofold row[3];
  dvi__twofold_get(3, x, compensation, row);
  dvi__turn_twofold(turn, row);
  dvi__twofold_put(3, row, x, compensation);
}

/* Compute a.b + c to relative rounding accuracy even where almost everything cancels. */
FUSED_INLINE double dvi__twofold_dot(const dvi__twofold a[3], const dvi__twofold b[3], double c)
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
FUSED_INLINE void dvi__turn_angular_of(const double *y, const double *y_compensation,
                                       const double *p, const double *p_compensation,
                                       dvi__twofold mu[3])
{
  dvi__twofold at[3], momentum[3];
  dvi__twofold_get(3, y, y_compensation, at);
  dvi__twofold_get(3, p, p_compensation, momentum);
  dvi__twofold_cross(at, momentum, mu);
  const double above = dvi__twofold_dot(at, at, -1);
  for (int i = 0; i < 3; i++) mu[i] = dvi__exact_sum(mu[i].head, mu[i].tail - above * mu[i].head);
}

/* mu is orthogonal to y but for the rounding of both. mu x y would lose the component of mu along
 * y, which is the same in all steps of a steady turn. So y is corrected. */
FUSED_INLINE void dvi__turn_orthogonal(const dvi__twofold mu[3], double most, dvi__twofold y[3])
{
  const double square = mu[0].head * mu[0].head + mu[1].head * mu[1].head + mu[2].head * mu[2].head,
               along = dvi__twofold_dot(mu, y, 0);
  const int near = fabs(along) < most * sqrt(square);
  for (int i = 0; i < 3; i++) {
    const double moved = y[i].tail - along / square * mu[i].head;
    y[i].tail = near ? moved : y[i].tail;
  }
}

FUSED_INLINE void dvi__turn_momentum_of(const dvi__twofold mu[3], double most, double *y,
                                        double *y_compensation, double *p, double *p_compensation)
{
  dvi__twofold at[3], momentum[3];
  dvi__twofold_get(3, y, y_compensation, at);
  dvi__turn_orthogonal(mu, most, at);
  dvi__twofold_cross(mu, at, momentum);
  dvi__twofold_put(3, at, y, y_compensation);
  dvi__twofold_put(3, momentum, p, p_compensation);
}

#endif
