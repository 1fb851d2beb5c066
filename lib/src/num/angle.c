/* The angle is a + t with the double a = atan2(y, x), and
 *
 *     tan t = (y cos a - x sin a) / (x cos a + y sin a).
 *
 * cos a and sin a come from the series at z = a/64 and from six doublings of
 *
 *     s = sin z, v = 1 - cos z:     sin 2z = 2 s (1 - v),   1 - cos 2z = 2 s^2. */
#include "num/angle.h"

#include <math.h>

#include "num/simd/fused.h"

enum { DOUBLINGS = 6 };

const dvi__twofold dvi__twofold_pi = {3.14159265358979311600, 1.2246467991473531772e-16};

static const dvi__twofold sixth = {1.0 / 6, 9.25185853854297065662e-18}, one = {1, 0};

/* Terms beyond the first two are so small that doubles suffice for them. */
FUSED_INLINE void start(double z, dvi__twofold *s, dvi__twofold *v)
{
  const dvi__twofold square = dvi__exact_product(z, z),
                     cube = dvi__twofold_times(square, (dvi__twofold){z, 0});
  const double w = square.head,
               odd = w / 120 * (1 - w / 42 * (1 - w / 72 * (1 - w / 110 * (1 - w / 156)))),
               even = w / 24 * (1 - w / 30 * (1 - w / 56 * (1 - w / 90 * (1 - w / 132))));
  const dvi__twofold of_cube = dvi__twofold_plus(sixth, (dvi__twofold){-odd, 0}),
                     of_square = dvi__exact_sum(0.5, -even);
  *s = dvi__twofold_less_product((dvi__twofold){z, 0}, cube, of_cube);
  *v = dvi__twofold_times(square, of_square);
}

FUSED_INLINE void turn_unit(double a, dvi__twofold *cosine, dvi__twofold *sine)
{
  dvi__twofold v;
  start(ldexp(a, -DOUBLINGS), sine, &v);
  for (int i = 0; i < DOUBLINGS; i++) {
    const dvi__twofold square = dvi__twofold_times(*sine, *sine),
                       half = dvi__twofold_less_product(*sine, *sine, v);
    *sine = dvi__twofold_scaled(half, 2);
    v = dvi__twofold_scaled(square, 2);
  }
  *cosine = dvi__twofold_plus(one, dvi__twofold_scaled(v, -1));
}

FUSED static dvi__twofold angle_of(dvi__twofold x, dvi__twofold y)
{
  const double a = atan2(y.head, x.head);
  dvi__twofold cosine, sine;
  turn_unit(a, &cosine, &sine);
  const dvi__twofold across = dvi__twofold_less_product(dvi__twofold_times(y, cosine), x, sine);
  const double along = x.head * cosine.head + y.head * sine.head;
  return dvi__exact_sum(a, along > 0 ? across.head / along : 0);
}

dvi__twofold dvi__twofold_angle(dvi__twofold x, dvi__twofold y)
{
  return angle_of(x, y);
}
