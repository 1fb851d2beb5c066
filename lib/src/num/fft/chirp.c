/* Bluestein's transform, whose length is any number. With j k = (j^2 + k^2 - (k-j)^2)/2 the sum is
 * a convolution, made by transforms of a length M >= 2 n - 1 of small factors:
 *
 *     X_k = c_k sum_j (x_j c_j) conj(c_(k-j)),      c_j = exp(i pi j^2/n).
 *
 * The transform with sign -1 is the conjugate one of the conjugate numbers. Source: Bluestein, A
 * linear filtering approach to the computation of discrete Fourier transform, 1970. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/fft/complex.h"
#include "num/fft/fft.h"

static void multiply(const double *x, const double *y, double *product)
{
  const double re = x[0] * y[0] - x[1] * y[1], im = x[0] * y[1] + x[1] * y[0];
  product[0] = re;
  product[1] = im;
}

/* Fill the kernel conj(c_j)/M, for j from 1-n to n-1 at its place modulo M. */
static void fill_kernel(const dvi__fourier *t, double *kernel)
{
  const size_t M = t->inner->n;
  const double scale = 1 / (double)M;
  for (size_t j = 0; j < t->n; j++) {
    double *one = kernel + 2 * j, *other = kernel + 2 * (j == 0 ? 0 : M - j);
    one[0] = other[0] = scale * t->chirp[2 * j];
    one[1] = other[1] = -scale * t->chirp[2 * j + 1];
  }
}

static void transform_kernel(const dvi__fourier *t, double *work)
{
  fill_kernel(t, t->kernel);
  const double *result = dvi__fourier_transform(t->inner, 1, t->kernel, work);
  if (result != t->kernel) memcpy(t->kernel, result, 2 * t->inner->n * sizeof(double));
}

dvi_status dvi__chirp_prepare(dvi__fourier *t)
{
  DVI_TRY(dvi__fourier_create((size_t)dvi__fft_length(2 * (int)t->n - 1), &t->inner));
  const size_t M = t->inner->n;
  t->chirp = DVI_NEW(double, 2 * t->n);
  t->kernel = DVI_NEW(double, 2 * M);
  double *work = DVI_NEW(double, 2 * M);
  if (t->chirp == NULL || t->kernel == NULL || work == NULL) {
    dvi__release(work);
    return dvi__fail(DVI_NO_MEMORY, "Fourier transform: no memory for a chirp of %zu", t->n);
  }
  for (size_t j = 0; j < t->n; j++)
    dvi__root_of_unity(j * j % (2 * t->n), 2 * t->n, t->chirp + 2 * j);
  transform_kernel(t, work);
  dvi__release(work);
  return DVI_OK;
}

/* Put x_j c_j, followed by zeros, into the place of the convolution. */
static void put_numbers(const dvi__fourier *t, int sign, const double *z, double *place)
{
  for (size_t j = 0; j < 2 * t->n; j += 2)
    multiply((double[2]){z[j], sign * z[j + 1]}, t->chirp + j, place + j);
  memset(place + 2 * t->n, 0, 2 * (t->inner->n - t->n) * sizeof(double));
}

double *dvi__chirp_transform(const dvi__fourier *t, int sign, double *z, double *work)
{
  const size_t M = t->inner->n;
  put_numbers(t, sign, z, work);
  double *at = dvi__fourier_transform(t->inner, 1, work, work + 2 * M);
  for (size_t j = 0; j < 2 * M; j += 2) multiply(at + j, t->kernel + j, at + j);
  at = dvi__fourier_transform(t->inner, -1, at, at == work ? work + 2 * M : work);
  for (size_t j = 0; j < 2 * t->n; j += 2) {
    multiply(at + j, t->chirp + j, z + j);
    z[j + 1] *= sign;
  }
  return z;
}
