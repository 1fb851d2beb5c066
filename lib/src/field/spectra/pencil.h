/* The poles of a sum of exponentials. */
#ifndef DVI_FIELD_SPECTRA_PENCIL_H
#define DVI_FIELD_SPECTRA_PENCIL_H
#include <complex.h>
#include <dvi/status.h>

/* Series y_p(m) = sum_k c_pk z_k^m, m = 0 .. length-1, of the same poles z_k. */
typedef struct dvi__exponentials {
  int length, probes;
  double complex *y; /* [probes*length] */
} dvi__exponentials;

/* The most poles that series can tell apart, about P/(P+1) of their length for P of them. */
int dvi__poles_most(int length, int probes);

/* Find the poles z [dvi__poles_most(length, probes)], as many as there are singular values above
 * `floor`, and above those of noise, of the Hankel matrices of all probes. DVI_SOLVER_FAILED,
 * DVI_NO_MEMORY. */
dvi_status dvi__find_poles(const dvi__exponentials *series, double floor, int *count,
                           double complex *z);

/* Return the root of the sum of squares of singular values of Hankel matrices of numbers of size
 * 1. */
double dvi__hankel_size(int length, int probes);

#endif
