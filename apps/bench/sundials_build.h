/** The build of the linked SUNDIALS. Ratios to its codes mean nothing without it. */
#ifndef SUNDIALS_BUILD_H
#define SUNDIALS_BUILD_H
#include <stdio.h>

/** Measure how many times as long a sum of vectors of SUNDIALS takes as the same loop compiled with
 * this program. NaN without memory, or if this program was compiled without optimisation or with a
 * sanitizer. */
double sundials_sum_ratio(void);

/** Print the version of SUNDIALS, the folder that it was linked from, whether it was compiled with
 * optimisation, and the measured ratio. */
void sundials_build_print(FILE *stream);
#endif
