/* Complex transforms of one length, for the real ones of fft.c. Complex numbers are real and
 * imaginary parts in turn. */
#ifndef DVI_NUM_FFT_COMPLEX_H
#define DVI_NUM_FFT_COMPLEX_H
#include <dvi/status.h>
#include <stddef.h>

enum { DVI__FFT_FACTORS = 32 };

typedef struct dvi__fourier {
  size_t n;
  int passes, radix[DVI__FFT_FACTORS]; /* a length without other factors than 2, 3 and 5 */
  double *root;                        /* roots of unity of the passes */
  struct dvi__fourier *inner; /* any other length: the convolution's transform, else NULL */
  double *chirp;              /* [2 n] exp(i pi j^2/n) */
  double *kernel;             /* [2 inner->n] transform of the conjugate chirp */
} dvi__fourier;

/* Make a transform of n > 0 points. DVI_NO_MEMORY. */
dvi_status dvi__fourier_create(size_t n, dvi__fourier **transform);
void dvi__fourier_destroy(dvi__fourier **transform);

/* Return the doubles of work that it needs, at least 2 n. */
size_t dvi__fourier_work(const dvi__fourier *transform);

/* Set z [2 n] to Z_k = sum_j z_j exp(sign 2 pi i j k/n), unscaled, with sign -1 or 1. Returns the
 * place of the result, which is z or work. */
double *dvi__fourier_transform(const dvi__fourier *transform, int sign, double *z, double *work);

/* Give exp(2 pi i k/n) for k, n >= 0, right to the last digit. */
void dvi__root_of_unity(size_t k, size_t n, double *root);

/* ---- passes.c: lengths of factors 2, 3 and 5 ---- */

/* Make the passes' roots. DVI_NO_MEMORY. */
dvi_status dvi__passes_prepare(dvi__fourier *transform);
double *dvi__passes_transform(const dvi__fourier *transform, int sign, double *z, double *work);

/* ---- chirp.c: any other length ---- */

/* Make the chirp and its transform, with the inner transform. DVI_NO_MEMORY. */
dvi_status dvi__chirp_prepare(dvi__fourier *transform);
double *dvi__chirp_transform(const dvi__fourier *transform, int sign, double *z, double *work);

#endif
