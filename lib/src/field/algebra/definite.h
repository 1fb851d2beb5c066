/* Solutions of A x = b with sparse symmetric matrices. Those of small matrices and of meshes in two
 * dimensions have a factor, and large ones in three dimensions conjugate gradients. */
#ifndef DVI_FIELD_ALGEBRA_DEFINITE_H
#define DVI_FIELD_ALGEBRA_DEFINITE_H
#include "field/algebra/conjugate.h"
#include "field/algebra/csr.h"
#include "num/linear.h"

typedef struct dvi__definite {
  dvi__csr matrix;
  dvi__pattern pattern;
  dvi__linear *factor; /* NULL for conjugate gradients and for diagonal matrices */
  int is_diagonal;
  double tolerance; /* of conjugate gradients, 0 for roundoff. Set after the creation */
  /* What else preconditions conjugate gradients, or NULL. Set after the creation. */
  void (*correct)(void *of, double weight, const double *residual, double *z);
  void *of;
  double weight; /* first argument behind `of` */
} dvi__definite;

/* Tell whether a matrix of so many rows is solved with by iteration. */
int dvi__definite_iterates(int64_t rows, int dimension);

/* Prepare solutions with a copy of a positive definite matrix, of a mesh in `dimension` dimensions.
 * DVI_SINGULAR if it is not positive definite. On failure nothing is owned. */
dvi_status dvi__definite_create(const dvi_matrix *A, int dimension, dvi__definite *solver);

/* Prepare solutions with a copy of a regular matrix, by KLU. */
dvi_status dvi__regular_create(const dvi_matrix *A, dvi__definite *solver);

/* Set x [rows] to A^-1 b, where x is not b. `report` may be NULL. */
dvi_status dvi__definite_solve(const dvi__definite *solver, const double *b, double *x,
                               dvi__iteration_report *report);

void dvi__definite_clear(dvi__definite *solver);

#endif
