/* Dense linear systems of changing size. */
#ifndef DVI_NUM_DENSE_H
#define DVI_NUM_DENSE_H

/* Replace b [n] by A^-1 b, and A [n*n], column by column, by its factors, by LAPACK. pivot [n] is
 * work. Return 0 if A is singular. */
int dvi__dense_solve(int n, double *A, int *pivot, double *b);

#endif
