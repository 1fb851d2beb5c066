/* Sines and cosines of lanes, those of dvi/sines.h. */
#ifndef DVI_EXPR_COMPILE_SINES_H
#define DVI_EXPR_COMPILE_SINES_H
#include <dvi/sines.h>

#include "expr/compile/lanes.h"
#include "expr/compile/program.h"

/* Return the sum over the lanes. */
DVI__EXPR_INLINE int dvi__sum_lanes(const uint64_t *count)
{
  uint64_t sum = 0;
  for (int k = 0; k < DVI__LANES; k++) sum += count[k];
  return (int)sum;
}

/* Compute sine and cosine of `width` plain angles. The others are wrong. Returns the number of
 * plain ones. */
DVI__EXPR_INLINE int dvi__plain_sines(int width, const double *restrict x, double *restrict sine,
                                      double *restrict cosine)
{
  uint64_t plain[DVI__LANES] = {0};
  for (int first = 0; first < width; first += DVI__LANES)
    DVI__EXPR_INDEPENDENT for (int k = 0; k < DVI__LANES; k++)
    {
      const dvi_reduced_angle angle = dvi_reduce_angle(x[first + k]);
      const double s = dvi_sine_polynomial(angle.r, angle.tail),
                   c = dvi_cosine_polynomial(angle.r, angle.tail);
      plain[k] += (uint64_t)dvi_angle_is_plain(x[first + k]);
      sine[first + k] = dvi_turned_sine(angle.quarters, s, c);
      cosine[first + k] = dvi_turned_sine(angle.quarters + 1, s, c);
    }
  return dvi__sum_lanes(plain);
}

/* Compute one of them, the sine after so many quarter turns more. */
DVI__EXPR_INLINE int dvi__plain_sine(int width, const uint64_t more, const double *restrict x,
                                     double *restrict sine)
{
  uint64_t plain[DVI__LANES] = {0};
  for (int first = 0; first < width; first += DVI__LANES)
    DVI__EXPR_INDEPENDENT for (int k = 0; k < DVI__LANES; k++)
    {
      const dvi_reduced_angle angle = dvi_reduce_angle(x[first + k]);
      plain[k] += (uint64_t)dvi_angle_is_plain(x[first + k]);
      sine[first + k] = dvi_turned_sine(angle.quarters + more,
                                        dvi_sine_polynomial(angle.r, angle.tail),
                                        dvi_cosine_polynomial(angle.r, angle.tail));
    }
  return dvi__sum_lanes(plain);
}

#endif
