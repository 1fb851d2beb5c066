/* Solutions of (M + c H_0) x = b with complex numbers c, in which methods are implicit. */
#ifndef DVI_FIELD_SCHROEDINGER_SHIFTED_H
#define DVI_FIELD_SCHROEDINGER_SHIFTED_H
#include <complex.h>
#undef I /* a name of arguments elsewhere */

#include "field/schroedinger/schroedinger.h"

typedef struct dvi__shifted dvi__shifted;

/* A complex number of its parts. The standard's CMPLX is hidden from clang by glibc. */
static inline double complex dvi__of_parts(double re, double im)
{
  const union {
    double part[2];
    double complex whole;
  } number = {{re, im}};
  return number.whole;
}

/* Make solvers for some numbers c. */
dvi_status dvi__shifted_create(const dvi_schroedinger *s, int shifts, dvi__shifted **made);
void dvi__shifted_destroy(dvi__shifted **shifted);

/* Prepare all solvers. H_0 has the potential V [points], and for fourier the middle of its range
 * alone, so that iterations must do the rest. Without V it is the kinetic energy. DVI_SINGULAR. */
dvi_status dvi__shifted_factor(dvi__shifted *shifted, const double complex *c, const double *V);

/* Overwrite b, an amplitude [2*free], by the solution for number j. */
void dvi__shifted_solve(dvi__shifted *shifted, int j, double *b);

#endif
