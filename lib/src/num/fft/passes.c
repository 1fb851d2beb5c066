/* Transforms by passes of radix 4, 2, 3 and 5, after Stockham: with n = s L, L = r m and w the
 * first root of unity of order L, one pass is
 *
 *     y(q, r p + j) = w^(p j) sum_k x(q, p + m k) exp(2 pi i j k/r),    q < s, p < m,  j, k < r,
 *
 * of numbers x(q, l) at q + s l. The next pass has s r in place of s, and m in place of L. The last
 * one leaves the sums in their order. A complex number is one vector of two, so that all targets
 * make the same operations. Source: Van Loan, Computational Frameworks for the FFT, 1992, sec.
 * 1.7. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/fft/complex.h"
#include "num/simd/width.h"

typedef double complex_number __attribute__((vector_size(2 * sizeof(double))));

static const double sin_60 = 0.86602540378443864676, cos_72 = 0.30901699437494742410,
                    sin_72 = 0.95105651629515357212, cos_144 = -0.80901699437494742410,
                    sin_144 = 0.58778525229247312917;

/* Give sign i z. */
INLINE complex_number turned(const int sign, const complex_number z)
{
  return (complex_number){-sign * z[1], sign * z[0]};
}

/* Give z w, or z times the conjugate of w. */
INLINE complex_number times(const int sign, const complex_number z, const double *w)
{
  return z * w[0] + turned(sign, z) * w[1];
}

INLINE void combine_two(complex_number *z)
{
  const complex_number difference = z[0] - z[1];
  z[0] = z[0] + z[1];
  z[1] = difference;
}

INLINE void combine_three(const int sign, complex_number *z)
{
  const complex_number sum = z[1] + z[2], across = turned(sign, (z[1] - z[2]) * sin_60),
                       along = z[0] - 0.5 * sum;
  z[0] = z[0] + sum;
  z[1] = along + across;
  z[2] = along - across;
}

INLINE void combine_four(const int sign, complex_number *z)
{
  const complex_number even = z[0] + z[2], odd = z[1] + z[3], along = z[0] - z[2],
                       across = turned(sign, z[1] - z[3]);
  z[0] = even + odd;
  z[1] = along + across;
  z[2] = even - odd;
  z[3] = along - across;
}

INLINE void combine_five(const int sign, complex_number *z)
{
  const complex_number near = z[1] + z[4], far = z[2] + z[3], d = z[1] - z[4], e = z[2] - z[3];
  const complex_number along = z[0] + (cos_72 * near + cos_144 * far),
                       across = turned(sign, sin_72 * d + sin_144 * e),
                       along_2 = z[0] + (cos_144 * near + cos_72 * far),
                       across_2 = turned(sign, sin_144 * d - sin_72 * e);
  z[0] = z[0] + (near + far);
  z[1] = along + across;
  z[2] = along_2 + across_2;
  z[3] = along_2 - across_2;
  z[4] = along - across;
}

INLINE void combine(const int radix, const int sign, complex_number *z)
{
  if (radix == 2)
    combine_two(z);
  else if (radix == 3)
    combine_three(sign, z);
  else if (radix == 4)
    combine_four(sign, z);
  else
    combine_five(sign, z);
}

/* Combine the numbers of one p. `from` and `to` are the distances between terms of x and of y.
 * Without roots they are all 1. */
INLINE void pass_over_q(const int radix, const int sign, size_t s, size_t from, size_t to,
                        const double *root, const double *restrict x, double *restrict y)
{
  for (size_t q = 0; q < 2 * s; q += 2) {
    complex_number z[5];
    for (int k = 0; k < radix; k++) memcpy(&z[k], x + q + from * (size_t)k, sizeof *z);
    combine(radix, sign, z);
    for (int k = 1; k < radix && root != NULL; k++) z[k] = times(sign, z[k], root + 2 * k - 2);
    for (int k = 0; k < radix; k++) memcpy(y + q + to * (size_t)k, &z[k], sizeof *z);
  }
}

INLINE void pass_by(const int radix, const int sign, size_t s, size_t m, const double *root,
                    const double *restrict x, double *restrict y)
{
  const size_t r = (size_t)radix;
  pass_over_q(radix, sign, s, 2 * s * m, 2 * s, NULL, x, y);
  for (size_t p = 1; p < m; p++)
    pass_over_q(radix, sign, s, 2 * s * m, 2 * s, root + 2 * (r - 1) * p, x + 2 * s * p,
                y + 2 * s * r * p);
}

/* Make one pass. The first one, s = 1, has no loop over q. */
INLINE void pass(const int sign, int radix, size_t s, size_t m, const double *root, const double *x,
                 double *y)
{
  if (radix == 4 && s == 1)
    pass_by(4, sign, 1, m, root, x, y);
  else if (radix == 4)
    pass_by(4, sign, s, m, root, x, y);
  else if (radix == 2)
    pass_by(2, sign, s, m, root, x, y);
  else if (radix == 3)
    pass_by(3, sign, s, m, root, x, y);
  else
    pass_by(5, sign, s, m, root, x, y);
}

INLINE double *all_passes(const dvi__fourier *t, const int sign, double *z, double *work)
{
  const double *root = t->root;
  size_t s = 1;
  for (int i = 0; i < t->passes; i++) {
    const size_t r = (size_t)t->radix[i], m = t->n / s / r;
    pass(sign, t->radix[i], s, m, root, z, work);
    root += 2 * (r - 1) * m;
    s *= r;
    double *const before = z;
    z = work;
    work = before;
  }
  return z;
}

double *dvi__passes_transform(const dvi__fourier *t, int sign, double *z, double *work)
{
  return sign > 0 ? all_passes(t, 1, z, work) : all_passes(t, -1, z, work);
}

dvi_status dvi__passes_prepare(dvi__fourier *t)
{
  size_t count = 0, L = t->n;
  for (int i = 0; i < t->passes; L /= (size_t)t->radix[i++]) count += L - L / (size_t)t->radix[i];
  double *root = t->root = DVI_NEW(double, 2 * count);
  if (root == NULL) return dvi__fail(DVI_NO_MEMORY, "Fourier transform: no memory for %zu", t->n);
  L = t->n;
  for (int i = 0; i < t->passes; i++) {
    const size_t r = (size_t)t->radix[i], m = L / r;
    for (size_t p = 0; p < m; p++)
      for (size_t j = 1; j < r; j++, root += 2) dvi__root_of_unity(p * j, L, root);
    L = m;
  }
  return DVI_OK;
}
