/** Effective coefficients of periodic materials.
 *
 *  Where a(x) has a period that is small against all else, the solutions of div (a grad u) = f tend
 *  to those of div (A grad u) = f with a constant tensor A (docs/fields/multiscale.md). The spaces
 *  of the kind msfem (dvi/space.h) need no such limit. */
#ifndef DVI_MULTISCALE_H
#define DVI_MULTISCALE_H
#include <dvi/space.h>

/** A periodic coefficient. Zero means the default. */
typedef struct dvi_effective_options {
  size_t size;          /**< sizeof(dvi_effective_options) */
  const dvi_axis *axis; /**< [axes] a period along each axis: from and to alone are read */
  int axes;             /**< 1 or 2 */
  /** parts of the period along each axis, 1 to 512. Default: 64. On one axis a part has 8 Gauss
   *  points, on two axes the coefficient is taken at the centres of the parts */
  int fine;
  /** the coefficient a(x) > 0 [count] at x, axis by axis [axes*count]. Returns 0, or another number
   *  for a failure. Required */
  int (*coefficient)(int64_t count, const double *x, double *a, void *user);
  void *user;
} dvi_effective_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Compute the effective tensor A of a periodic coefficient:
 *
 *      e . A e = min over periodic w of the mean of a |e + grad w|^2
 *
 *  On one axis A is the harmonic mean of a. On two axes w is bilinear in each part. A is then an
 *  upper bound that falls to its limit as O(fine^-2) for smooth a, and more slowly for
 *  checkerboards, whose gradients are not bounded at corners.
 *
 *  @param[out] tensor  [axes*axes] row by row, symmetric. Unchanged on failure
 *  @retval DVI_BAD_ARGUMENT     an argument is missing, or an axis is empty
 *  @retval DVI_BAD_SIZE         axes or fine is out of range
 *  @retval DVI_BAD_OPTION       the parts do not see the coefficient: with twice as many, the mean
 *                               of 1/a changes by more than a tenth on one axis, or that of a or
 *                               1/a by more than a quarter on two
 *  @retval DVI_CALLBACK_FAILED  the coefficient failed
 *  @retval DVI_NOT_FINITE       the coefficient is not positive and finite
 *  @retval DVI_SINGULAR         the coefficient varies by too many powers of ten
 *  @retval DVI_NO_MEMORY        there is no memory
 *
 *  Source: Bensoussan, Lions and Papanicolaou 1978, ch. 1. */
dvi_status dvi_effective_tensor(const dvi_effective_options *options, double *tensor);

#ifdef __cplusplus
}
#endif
#endif
