/* Inverses of small full matrices, by columns (Gauss and Jordan). The bits are the same on every
 * instruction set. */
#ifndef DVI_NUM_SIMD_SMALL_INVERSE_H
#define DVI_NUM_SIMD_SMALL_INVERSE_H
#include "num/simd/abreast.h"

/* Most columns, and most of a matrix near 1. */
enum { DVI__SMALL_INVERSE_MOST = 96, DVI__NEAR_ONE_MOST = 32 };

/* Replace A [n*n], by columns or by rows, by its inverse, with exchanges. Gives the sign of its
 * determinant, 0 if it is singular. */
int dvi__small_invert(int n, double *A);

/* Give the length of a column of a matrix that is near 1, which is whole blocks of numbers. */
int dvi__near_one_stride(int n);

/* Replace A [stride*n], near 1, by its inverse, without exchanges. Rows from n on are of no
 * account. Returns 0 if a pivot is far from 1; then A is spoilt. */
int dvi__near_one_invert(int n, double *A);

/* Do so with the matrices [n*n] of several members, in the same operations, for even n. `regular`
 * becomes 0 for members with a pivot far from 1. */
void dvi__near_one_invert_abreast(int n, dvi__abreast *A, int regular[DVI__ABREAST]);

/* Replace x [n] by the product of such an inverse and x. */
void dvi__near_one_times(int n, const double *inverse, double *x);

#endif
