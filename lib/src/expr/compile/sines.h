/* Sines and cosines of lanes, those of dvi/sines.h. */
#ifndef DVI_EXPR_COMPILE_SINES_H
#define DVI_EXPR_COMPILE_SINES_H
#include <dvi/sines.h>

#include "expr/compile/lanes.h"
#include "expr/compile/program.h"

/* Compute sine and cosine of `width` plain angles. The others are wrong. */
DVI__EXPR_INLINE void dvi__plain_sines(int width, const double *restrict x, double *restrict sine,
                                       double *restrict cosine)
{
  for (int first = 0; first < width; first += DVI__LANES)
    DVI__EXPR_INDEPENDENT for (int k = first; k < first + DVI__LANES; k++)
    {
      const dvi_reduced_angle angle = dvi_reduce_angle(x[k]);
      const double s = dvi_sine_polynomial(angle.r, angle.tail),
                   c = dvi_cosine_polynomial(angle.r, angle.tail);
      sine[k] = dvi_turned_sine(angle.quarters, s, c);
      cosine[k] = dvi_turned_sine(angle.quarters + 1, s, c);
    }
}

/* Compute one of them, the sine after so many quarter turns more. */
DVI__EXPR_INLINE void dvi__plain_sine(int width, const uint64_t more, const double *restrict x,
                                      double *restrict sine)
{
  for (int first = 0; first < width; first += DVI__LANES)
    DVI__EXPR_INDEPENDENT for (int k = first; k < first + DVI__LANES; k++)
    {
      const dvi_reduced_angle angle = dvi_reduce_angle(x[k]);
      sine[k] = dvi_turned_sine(angle.quarters + more, dvi_sine_polynomial(angle.r, angle.tail),
                                dvi_cosine_polynomial(angle.r, angle.tail));
    }
}

/* Return the number of plain angles. */
DVI__EXPR_INLINE int dvi__count_plain_angles(int width, const double *restrict x)
{
  int plain = 0;
  for (int k = 0; k < width; k++) plain += dvi_angle_is_plain(x[k]);
  return plain;
}

#endif
