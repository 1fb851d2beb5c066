/* Full complex matrices, column by column, by LAPACK. */
#ifndef DVI_FIELD_SPECTRA_COMPLEX_MATRIX_H
#define DVI_FIELD_SPECTRA_COMPLEX_MATRIX_H
#include <complex.h>
#include <dvi/status.h>

/* Replace A [rows*columns], rows >= columns, by the triangle R of A = Q R and below it the vectors
 * of its reflections. factor [columns] and work [64*columns]. */
void dvi__complex_qr(int rows, int columns, double complex *A, double complex *factor,
                     double complex *work);

/* Replace B [rows*sides] by Q^H B, of a factorization by dvi__complex_qr. work [64*sides]. */
void dvi__complex_reflect(int rows, int columns, const double complex *A,
                          const double complex *factor, int sides, double complex *B,
                          double complex *work);

/* Replace B [columns of R by sides, each column `lead` behind the last] by R^-1 B, of the upper
 * triangle of A, whose columns are `rows` apart. Return 0 if R is singular. */
int dvi__complex_back(int rows, int columns, const double complex *A, int lead, int sides,
                      double complex *B);

/* Find the singular values s [n], descending, of a square A [n*n], which is destroyed, and the
 * conjugated right vectors, the rows of V^H [n*n]. DVI_SOLVER_FAILED, DVI_NO_MEMORY. */
dvi_status dvi__complex_svd(int n, double complex *A, double *s, double complex *VH);

/* Find the eigenvalues z [n] of A [n*n], which is destroyed. DVI_SOLVER_FAILED, DVI_NO_MEMORY. */
dvi_status dvi__complex_eigenvalues(int n, double complex *A, double complex *z);

/* Find the eigenvalues lambda [n], ascending, of a Hermitian A [n*n], and replace A by its vectors.
 * DVI_SOLVER_FAILED, DVI_NO_MEMORY. */
dvi_status dvi__complex_hermitian(int n, double complex *A, double *lambda);

#endif
