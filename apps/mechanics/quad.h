/** Numbers of 113 bits, where the compiler has them, and common operations on them. */
#ifndef QUAD_H
#define QUAD_H
#include <float.h>
#include <stdbool.h>

#if LDBL_MANT_DIG == 113
#define QUAD_EXISTS
typedef long double quad;
#elif defined(__SIZEOF_FLOAT128__)
#define QUAD_EXISTS
typedef __float128 quad;
#endif

#ifdef QUAD_EXISTS
/** Return the largest |x_i|, and the largest |a_i - b_i|, of n numbers. NaN is ignored. */
double quad_largest(int n, const quad *x);
double quad_distance(int n, const quad *a, const quad *b);

/** Invert A [n][n], which is overwritten. Returns false if it is singular. */
bool quad_invert(int n, quad *A, quad *inverse);
#endif

#endif
