/* Skew-symmetric matrices. */
#ifndef DVI_NUM_PFAFFIAN_H
#define DVI_NUM_PFAFFIAN_H
#include <stddef.h>

/* Give the sign of the Pfaffian, whose square is the determinant, of the skew-symmetric A [n*n]
 * with n even. The sign is 1, -1, or 0 if A is singular. A is overwritten. */
int dvi__pfaffian_sign(size_t n, double *A);

#endif
