/* Real transforms of an even number n = 2 m of points are complex ones of the m numbers
 * z_j = x_(2j) + i x_(2j+1). With their sums Z_k, w = exp(2 pi i/n), and
 *
 *     E_k = (Z_k + conj Z_(m-k))/2, O_k = -i (Z_k - conj Z_(m-k))/2, c_k + i s_k = E_k + w^k O_k,
 *
 * and the sums of m-k are the conjugate of E_k - w^k O_k. An odd number of points has a complex
 * transform of its own. Source: Cooley, Lewis and Welch, The fast Fourier transform algorithm,
 * 1970. */
#include "num/fft/fft.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/fft/complex.h"

struct dvi__fft {
  size_t n;
  dvi__fourier *complex; /* of n/2 points for an even n, else of n */
  double *root;          /* [2 (n/4 + 1)] exp(2 pi i k/n) for an even n, else NULL */
};

/* ---- plan ---- */

static dvi_status fft_fill(dvi__fft *plan)
{
  const size_t n = plan->n;
  DVI_TRY(dvi__fourier_create(n % 2 == 0 ? n / 2 : n, &plan->complex));
  if (n % 2 != 0) return DVI_OK;
  plan->root = DVI_NEW(double, 2 * (n / 4 + 1));
  if (plan->root == NULL)
    return dvi__fail(DVI_NO_MEMORY, "Fourier transform: no memory for %zu", n);
  for (size_t k = 0; k <= n / 4; k++) dvi__root_of_unity(k, n, plan->root + 2 * k);
  return DVI_OK;
}

dvi_status dvi__fft_create(int n, dvi__fft **plan)
{
  *plan = NULL;
  if (n < 1 || n > DVI__FFT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "Fourier transform: %d points asked, 1 to %d possible", n,
                     (int)DVI__FFT_MAX);
  *plan = DVI_NEW(dvi__fft, 1);
  if (*plan == NULL) return dvi__fail(DVI_NO_MEMORY, "Fourier transform: no memory for its plan");
  (*plan)->n = (size_t)n;
  const dvi_status status = fft_fill(*plan);
  if (status != DVI_OK) dvi__fft_destroy(plan);
  return status;
}

void dvi__fft_destroy(dvi__fft **plan)
{
  if (*plan == NULL) return;
  dvi__fourier_destroy(&(*plan)->complex);
  dvi__release((*plan)->root);
  dvi__release(*plan);
  *plan = NULL;
}

/* Odd lengths keep n complex numbers there, even ones n real numbers. */
int dvi__fft_work(const dvi__fft *plan)
{
  const size_t kept = plan->n % 2 == 0 ? plan->n : 2 * plan->n;
  return (int)(kept + dvi__fourier_work(plan->complex));
}

int dvi__fft_length(int n)
{
  for (;; n++) {
    int rest = n;
    while (rest > 1 && rest % 2 == 0) rest /= 2;
    while (rest > 1 && rest % 3 == 0) rest /= 3;
    while (rest > 1 && rest % 5 == 0) rest /= 5;
    if (rest == 1) return n;
  }
}

/* ---- transforms ---- */

/* Give the sums of k and m-k from Z_k and Z_(m-k), the last two arguments. */
static void part(const double *w, const double *Z, const double *back, double *sum,
                 double *sum_back)
{
  const double E[2] = {0.5 * (Z[0] + back[0]), 0.5 * (Z[1] - back[1])},
               O[2] = {0.5 * (Z[1] + back[1]), 0.5 * (back[0] - Z[0])},
               wO[2] = {w[0] * O[0] - w[1] * O[1], w[0] * O[1] + w[1] * O[0]};
  sum[0] = E[0] + wO[0];
  sum[1] = E[1] + wO[1];
  sum_back[0] = E[0] - wO[0];
  sum_back[1] = wO[1] - E[1];
}

static void analyse_even(const dvi__fft *plan, double *x, double *work)
{
  const size_t n = plan->n, m = n / 2;
  double *Z = dvi__fourier_transform(plan->complex, 1, x, work);
  if (Z == x) Z = memcpy(work, x, n * sizeof(double));
  x[0] = Z[0] + Z[1];
  x[n - 1] = Z[0] - Z[1];
  for (size_t k = 1; k <= m / 2; k++)
    part(plan->root + 2 * k, Z + 2 * k, Z + n - 2 * k, x + 2 * k - 1, x + n - 2 * k - 1);
}

void dvi__fft_analyse(const dvi__fft *plan, double *x, double *work)
{
  const size_t n = plan->n;
  if (plan->root != NULL) {
    analyse_even(plan, x, work);
    return;
  }
  for (size_t j = 0; j < n; j++) {
    work[2 * j] = x[j];
    work[2 * j + 1] = 0;
  }
  const double *sum = dvi__fourier_transform(plan->complex, 1, work, work + 2 * n);
  x[0] = sum[0];
  memcpy(x + 1, sum + 2, (n - 1) * sizeof(double));
}

/* Give Z_k and Z_(m-k) from the coefficients A of k and B of m-k:
 *     2 Z_k = A + conj B + i conj(w^k) (A - conj B),
 *     2 Z_(m-k) = conj[A + conj B - i conj(w^k) (A - conj B)]. */
static void join(const double *w, const double *A, const double *B, double *Z, double *back)
{
  const double E[2] = {0.5 * (A[0] + B[0]), 0.5 * (A[1] - B[1])},
               O[2] = {0.5 * (A[0] - B[0]), 0.5 * (A[1] + B[1])},
               wO[2] = {w[1] * O[0] - w[0] * O[1], w[0] * O[0] + w[1] * O[1]};
  Z[0] = E[0] + wO[0];
  Z[1] = E[1] + wO[1];
  back[0] = E[0] - wO[0];
  back[1] = wO[1] - E[1];
}

static void synthesise_even(const dvi__fft *plan, double *x, double *work)
{
  const size_t n = plan->n, m = n / 2;
  work[0] = x[0] + x[n - 1];
  work[1] = x[0] - x[n - 1];
  for (size_t k = 1; k <= m / 2; k++)
    join(plan->root + 2 * k, x + 2 * k - 1, x + n - 2 * k - 1, work + 2 * k, work + n - 2 * k);
  const size_t own = dvi__fourier_work(plan->complex);
  const double *result = dvi__fourier_transform(plan->complex, -1, work, own > n ? work + n : x);
  if (result != x) memcpy(x, result, n * sizeof(double));
}

void dvi__fft_synthesise(const dvi__fft *plan, double *x, double *work)
{
  const size_t n = plan->n;
  if (plan->root != NULL) {
    synthesise_even(plan, x, work);
    return;
  }
  memset(work, 0, 2 * n * sizeof(double));
  work[0] = x[0];
  memcpy(work + 2, x + 1, (n - 1) * sizeof(double));
  const double *sum = dvi__fourier_transform(plan->complex, -1, work, work + 2 * n);
  for (size_t j = 0; j < n; j++) x[j] = sum[2 * j];
}
