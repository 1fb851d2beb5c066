/* Numbers at several nodes side by side, and vectors in space of them. */
#ifndef DVI_GROUP_CHART_LANES_H
#define DVI_GROUP_CHART_LANES_H
#include <stddef.h>

#include "num/simd/width.h"

enum { DVI__LANES = 4 };
typedef double dvi__lane __attribute__((vector_size(DVI__LANES * sizeof(double))));

/* Lanes among other numbers. memcpy would copy them by halves through memory, and the first sum of
 * them would wait there. */
typedef double dvi__lane_at
    __attribute__((vector_size(DVI__LANES * sizeof(double)), aligned(sizeof(double)), may_alias));

/* Copy `rows` rows, which are `stride` apart, of `some` nodes. Lanes without a node are 0. */
INLINE void load_rows(int rows, const double *from, size_t stride, int some, dvi__lane *x)
{
  for (int i = 0; i < rows; i++, from += stride) {
    x[i] = (dvi__lane){0};
    if (some == DVI__LANES) {
      x[i] = *(const dvi__lane_at *)from;
    } else {
      x[i][0] = from[0];
      if (some > 1) x[i][1] = from[1];
      if (some > 2) x[i][2] = from[2];
    }
  }
}

INLINE void store_rows(int rows, const dvi__lane *x, size_t stride, int some, double *to)
{
  for (int i = 0; i < rows; i++, to += stride) {
    to[0] = x[i][0];
    if (some > 1) to[1] = x[i][1];
    if (some > 2) to[2] = x[i][2];
    if (some > 3) to[3] = x[i][3];
  }
}

INLINE void lanes_dot(const dvi__lane *a, const dvi__lane *b, dvi__lane *product)
{
  *product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Compute product = a x b, which may be neither a nor b. */
INLINE void lanes_cross(const dvi__lane *a, const dvi__lane *b, dvi__lane *product)
{
  product[0] = a[1] * b[2] - a[2] * b[1];
  product[1] = a[2] * b[0] - a[0] * b[2];
  product[2] = a[0] * b[1] - a[1] * b[0];
}

/* Compute dexp_{sign xi} v = v + sign c_2 xi x v + c_3 xi x (xi x v), which is not v, and the two
 * products. */
INLINE void lanes_dexp(const dvi__lane *c, double sign, const dvi__lane *xi, const dvi__lane *v,
                       dvi__lane *once, dvi__lane *twice, dvi__lane *sum)
{
  lanes_cross(xi, v, once);
  lanes_cross(xi, once, twice);
  for (int i = 0; i < 3; i++) sum[i] = v[i] + (sign * c[2] * once[i] + c[3] * twice[i]);
}

/* Compute R^T v. */
INLINE void lanes_turn_back(const dvi__lane *R, const dvi__lane *v, dvi__lane *turned)
{
  for (int i = 0; i < 3; i++) turned[i] = R[i] * v[0] + R[3 + i] * v[1] + R[6 + i] * v[2];
}

#endif
