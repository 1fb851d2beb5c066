/* The least-squares fit of exponentials. */
#ifndef DVI_FIELD_SPECTRA_FIT_H
#define DVI_FIELD_SPECTRA_FIT_H
#include "field/spectra/pencil.h"

/* Improve the poles z [count], and find c [count*probes] of y_p(m) = sum_k c_kp z_k^m, the standard
 * errors [count] of the real and the imaginary part of log z, and the mean square of what is left.
 * `rounding` is the least size of noise. DVI_SOLVER_FAILED, DVI_NO_MEMORY. */
dvi_status dvi__fit_exponentials(const dvi__exponentials *series, double rounding, int count,
                                 double complex *z, double complex *c, double *error, double *left);

#endif
