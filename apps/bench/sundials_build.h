/** The build of the linked SUNDIALS. Ratios to its codes mean nothing without it. */
#ifndef SUNDIALS_BUILD_H
#define SUNDIALS_BUILD_H
#include <stdio.h>

/** Print the version of SUNDIALS, the folder that it was linked from, whether it was compiled with
 * optimisation, and the measured ratio. */
void sundials_build_print(FILE *stream);
#endif
