#include "num/fft/complex.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"

/* In units of a turn/(4 n), the angle of 0 to 4 n is reflected into 0 to n/2, an eighth of a
 * turn. */
void dvi__root_of_unity(size_t k, size_t n, double *root)
{
  size_t a = 4 * (k % n);
  const int below = a > 2 * n;
  if (below) a = 4 * n - a;
  const int left = a > n;
  if (left) a = 2 * n - a;
  const int steep = 2 * a > n;
  if (steep) a = n - a;
  const long double quarter = 1.57079632679489661923132169163975144L,
                    angle = quarter * (long double)a / (long double)n;
  const double x = (double)(steep ? sinl(angle) : cosl(angle)),
               y = (double)(steep ? cosl(angle) : sinl(angle));
  root[0] = left ? -x : x;
  root[1] = below ? -y : y;
}

/* Find the passes of a length. Returns 0 if it has other factors. */
static int find_passes(dvi__fourier *t)
{
  static const int radices[] = {4, 2, 3, 5};
  size_t rest = t->n;
  for (int i = 0; i < 4; i++)
    for (; rest % (size_t)radices[i] == 0; rest /= (size_t)radices[i])
      t->radix[t->passes++] = radices[i];
  return rest == 1;
}

dvi_status dvi__fourier_create(size_t n, dvi__fourier **transform)
{
  dvi__fourier *t = *transform = DVI_NEW(dvi__fourier, 1);
  if (t == NULL) return dvi__fail(DVI_NO_MEMORY, "Fourier transform: no memory for its plan");
  t->n = n;
  const dvi_status status = find_passes(t) ? dvi__passes_prepare(t) : dvi__chirp_prepare(t);
  if (status != DVI_OK) dvi__fourier_destroy(transform);
  return status;
}

void dvi__fourier_destroy(dvi__fourier **transform)
{
  dvi__fourier *t = *transform;
  if (t == NULL) return;
  dvi__fourier_destroy(&t->inner);
  dvi__release(t->root);
  dvi__release(t->chirp);
  dvi__release(t->kernel);
  dvi__release(t);
  *transform = NULL;
}

size_t dvi__fourier_work(const dvi__fourier *t)
{
  return t->inner != NULL ? 4 * t->inner->n : 2 * t->n;
}

double *dvi__fourier_transform(const dvi__fourier *t, int sign, double *z, double *work)
{
  return t->inner != NULL ? dvi__chirp_transform(t, sign, z, work)
                          : dvi__passes_transform(t, sign, z, work);
}
