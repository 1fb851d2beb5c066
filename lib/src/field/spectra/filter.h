/* Filters that cut a band out of a long series. */
#ifndef DVI_FIELD_SPECTRA_FILTER_H
#define DVI_FIELD_SPECTRA_FILTER_H
#include <complex.h>
#include <dvi/status.h>
#include <stdint.h>

/* The part of pi/stride on either side of a band's middle that passes whole. */
#define DVI__PASSBAND 0.6

typedef struct dvi__filter {
  int64_t taps, stride;
  double *weight; /* [taps] of sum 1. One tap for the stride 1, which filters nothing */
} dvi__filter;

/* Make a low-pass filter for samples that are `stride` apart. What their distance would alias into
 * the passband is smaller by the factor `leak`. DVI_NO_MEMORY. */
dvi_status dvi__filter_create(int64_t stride, double leak, dvi__filter *filter);
void dvi__filter_clear(dvi__filter *filter);

/* The number of samples after the filter. */
int64_t dvi__filter_length(const dvi__filter *filter, int64_t samples);

/* Set y [length] to the samples x around the frequency `middle` (radians a sample), times `scale`:
 * y(m) = sum_k weight(k) x(n) exp(-i middle n), n = m stride + k. room [2*taps]. */
void dvi__filter_apply(const dvi__filter *filter, double middle, double scale, int64_t length,
                       const double *x, double *room, double complex *y);

/* By what the filter multiplies exp(s n), with the frequency counted from the middle. */
double complex dvi__filter_gain(const dvi__filter *filter, double complex s);

#endif
