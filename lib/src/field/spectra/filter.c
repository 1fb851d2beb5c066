/* Bands of a series, by a finite response.
 *
 * A sum of exponentials c z^n, multiplied by exp(-i middle n), filtered by a finite response w and
 * taken at every D-th sample, is one again, exactly:
 *
 *     y(m) = sum_k w(k) c (z exp(-i middle))^(mD+k) = c G(z) ((z exp(-i middle))^D)^m.
 *
 * No edge of the series disturbs it, because the response never reaches beyond one. w is a sinc
 * below Kaiser's window, whose transition ends where frequencies alias into the passband. Source:
 * Kaiser 1974; for the idea of solving band by band, Mandelshtam and Taylor 1997, sec. II. */
#include "field/spectra/filter.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/spectra/complex_number.h"

static const double pi = 3.14159265358979323846;

/* The modified Bessel function I_0, by its power series of positive terms. */
static double bessel(double x)
{
  double term = 1, sum = 1;
  for (int k = 1; term > 1e-17 * sum; k++) {
    term *= (x / (2 * k)) * (x / (2 * k));
    sum += term;
  }
  return sum;
}

static double sinc(double x)
{
  return x == 0 ? 1 : sin(x) / x;
}

/* Kaiser's formulas for the shape of the window and its length, from the attenuation in decibels
 * and the width of the transition. */
dvi_status dvi__filter_create(int64_t stride, double leak, dvi__filter *filter)
{
  const double decibels = fmax(-20 * log10(leak), 50), shape = 0.1102 * (decibels - 8.7),
               cutoff = pi / (double)stride, transition = 2 * (1 - DVI__PASSBAND) * cutoff;
  const int64_t order = (int64_t)ceil((decibels - 7.95) / (2.285 * transition));
  double sum = 0;
  *filter = (dvi__filter){.taps = stride == 1 ? 1 : order + 1, .stride = stride};
  filter->weight = DVI_NEW(double, filter->taps);
  if (filter->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "spectrum: no memory for a filter of %lld weights",
                     (long long)filter->taps);
  for (int64_t k = 0; k < filter->taps; k++) {
    const double middle = 0.5 * (double)(filter->taps - 1), x = (double)k - middle,
                 part = middle > 0 ? x / middle : 0;
    filter->weight[k] = sinc(cutoff * x) * bessel(shape * sqrt(fmax(1 - part * part, 0)));
    sum += filter->weight[k];
  }
  for (int64_t k = 0; k < filter->taps; k++) filter->weight[k] /= sum;
  return DVI_OK;
}

void dvi__filter_clear(dvi__filter *filter)
{
  dvi__release(filter->weight);
  filter->weight = NULL;
}

int64_t dvi__filter_length(const dvi__filter *filter, int64_t samples)
{
  return (samples - filter->taps) / filter->stride + 1;
}

void dvi__filter_apply(const dvi__filter *filter, double middle, double scale, int64_t length,
                       const double *x, double *room, double complex *y)
{
  double *even = room, *odd = room + filter->taps;
  for (int64_t k = 0; k < filter->taps; k++) {
    even[k] = scale * filter->weight[k] * cos(middle * (double)k);
    odd[k] = -scale * filter->weight[k] * sin(middle * (double)k);
  }
  for (int64_t m = 0; m < length; m++) {
    const double *from = x + m * filter->stride;
    double re = 0, im = 0;
    for (int64_t k = 0; k < filter->taps; k++) {
      re += even[k] * from[k];
      im += odd[k] * from[k];
    }
    y[m] = dvi__complex(re, im) * cexp(dvi__complex(0, -middle * (double)(m * filter->stride)));
  }
}

double complex dvi__filter_gain(const dvi__filter *filter, double complex s)
{
  double complex sum = 0;
  for (int64_t k = 0; k < filter->taps; k++) sum += filter->weight[k] * cexp(s * (double)k);
  return sum;
}
