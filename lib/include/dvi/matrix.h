/** Sparse matrices by rows, as views of what their owners store. */
#ifndef DVI_MATRIX_H
#define DVI_MATRIX_H
#include <dvi/status.h>
#include <stddef.h>
#include <stdint.h>

/** A view of a sparse matrix by rows. Row i has the entries start[i] .. start[i+1]-1, or with a
 *  constant width the entries i*width .. (i+1)*width-1. All arrays belong to the matrix's owner. */
typedef struct dvi_matrix {
  int64_t rows, columns;
  int width;            /**< entries of every row. 0 if `start` counts them */
  int symmetric;        /**< not 0 if the matrix is symmetric. Both triangles are stored */
  const int64_t *start; /**< [rows+1]. NULL with a width */
  const int *column;    /**< [entries]. NULL for a diagonal matrix, whose width is 1 */
  const int8_t *sign;   /**< [entries] -1 or 1. NULL if the entries are `value` */
  const double *value;  /**< [entries]. NULL if the entries are `sign` */
} dvi_matrix;

/** The arrays that dvi_matrix_copy fills. */
typedef struct dvi_matrix_arrays {
  int by_columns; /**< not 0 for compressed columns (KLU, CHOLMOD), 0 for rows (SciPy, PETSc) */
  int wide;       /**< not 0 if start and index are int64_t, 0 if they are int */
  void *start;    /**< [rows+1], or [columns+1] by columns */
  void *index;    /**< [entries] columns of a row, or rows of a column, ascending */
  double *value;  /**< [entries] */
} dvi_matrix_arrays;

/** Options of eigenvalue problems. Zero means the default. */
typedef struct dvi_modes_options {
  size_t size;   /**< sizeof(dvi_modes_options) */
  int count;     /**< number of modes, default 6 */
  double shift;  /**< eigenvalues nearest to it are found. Default: a little below 0 */
  int dimension; /**< of the mesh behind the matrices. From 3 on large ones are iterated */
} dvi_modes_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Release a matrix that a function whose name ends in _create made, and set the pointer to NULL.
 *  NULL is allowed. Views of what others own are not released. */
void dvi_matrix_destroy(dvi_matrix **matrix);

/** Return the number of stored entries. 0 for NULL. */
int64_t dvi_matrix_entries(const dvi_matrix *matrix);

/** Multiply, y = A x with x [columns] and y [rows], or y = A^T x with x [rows] and y [columns] if
 *  `transposed` is not 0. x and y may not overlap, and no argument may be NULL.
 *
 *  Sums run in the order of the rows and of their entries, so that equal inputs give equal bits. */
void dvi_matrix_multiply(const dvi_matrix *matrix, int transposed, const double *x, double *y);

/** Copy a matrix to arrays of the caller, with entries in ascending order, to take it elsewhere.
 *
 *  @retval DVI_BAD_ARGUMENT  an array is missing
 *  @retval DVI_BAD_SIZE      an int cannot count the entries. Ask for wide arrays
 *  @retval DVI_NO_MEMORY     there is no memory for the transposition */
dvi_status dvi_matrix_copy(const dvi_matrix *matrix, const dvi_matrix_arrays *arrays);

/** Compute eigenvalues of K x = lambda M x, the nearest to a shift, and their vectors, by Lanczos'
 *  method on the inverse of K - shift M (ARPACK; Lehoucq, Sorensen and Yang 1998).
 *
 *  @param      K, M        symmetric, by rows. M is positive definite
 *  @param[out] eigenvalue  [count] ascending
 *  @param[out] vector      [count][rows] with x.M x = 1, and a positive sign of the first entry
 *                          that is at least half of the largest one. May be NULL
 *  @retval DVI_BAD_ARGUMENT   an argument is missing, or the matrices have different sizes
 *  @retval DVI_BAD_SIZE       count is not from 1 to rows, or rows - 1 above 2000 rows
 *  @retval DVI_SINGULAR       K - shift M is singular, or M is not positive definite
 *  @retval DVI_NOT_CONVERGED  the iteration did not converge
 *  @retval DVI_NO_MEMORY      there is no memory */
dvi_status dvi_matrix_modes(const dvi_matrix *K, const dvi_matrix *M,
                            const dvi_modes_options *options, double *eigenvalue, double *vector);

#ifdef __cplusplus
}
#endif
#endif
