/* LU factors of small full matrices, P A = L U, where calls of LAPACK cost more than the numbers.
 * Columns are padded to blocks of four rows. The operations are those of the reference LAPACK, in
 * the same order for each number, and so are the bits, on every instruction set. */
#ifndef DVI_NUM_SIMD_SMALL_LU_H
#define DVI_NUM_SIMD_SMALL_LU_H

/* Largest size, and numbers in a block. */
enum { DVI__SMALL_LU_MOST = 96, DVI__SMALL_LU_BLOCK = 4 };

typedef struct dvi__small_lu {
  int n, stride;    /* stride is n, rounded up to whole blocks */
  double *upper;    /* [stride*stride] by columns: A, then U without its diagonal; else 0 */
  double *lower;    /* [stride*stride] by columns: L without its diagonal; else 0 */
  double *diagonal; /* [stride] that of U */
  int *pivot;       /* [n] row that was exchanged with row k in step k */
} dvi__small_lu;

/* Give the length of a column. */
int dvi__small_lu_stride(int n);

/* Factor the matrix in `upper`, with columns padded by zeros. Gives the smallest pivot relative to
 * the largest one, 0 if there is no factor. */
double dvi__small_lu_factor(const dvi__small_lu *lu);

/* Replace b [n] by A^-1 b. */
void dvi__small_lu_solve(const dvi__small_lu *lu, double *b);

#endif
