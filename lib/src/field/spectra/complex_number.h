/* Complex numbers from their parts. */
#ifndef DVI_FIELD_SPECTRA_COMPLEX_NUMBER_H
#define DVI_FIELD_SPECTRA_COMPLEX_NUMBER_H
#include <complex.h>

/* CMPLX of the standard, which glibc hides from clang. */
static inline double complex dvi__complex(double re, double im)
{
  const union {
    double part[2];
    double complex whole;
  } number = {{re, im}};
  return number.whole;
}

#endif
