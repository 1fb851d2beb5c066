/* The parts of a function space that densities use: values and derivatives at quadrature points as
 * linear operators, sparse matrices or Fourier transforms. */
#ifndef DVI_FIELD_SPACE_SPACE_H
#define DVI_FIELD_SPACE_SPACE_H
#include <dvi/space.h>

#include "field/algebra/csr.h"

/* Tell if the operators of the space are transforms. Otherwise they are sparse matrices. */
int dvi__space_is_fourier(const dvi_space *space);

/* Tell if each point belongs to one function, which is 1 there while the others are 0. Values at
 * the points are coefficients then, and the mass is diagonal. An end of two cells is two points,
 * because derivatives from both sides differ there. */
int dvi__space_is_nodal(const dvi_space *space);

/* A derivative of the field at the points, as an operator on coefficients. */
typedef struct dvi__space_operator {
  const dvi_space *space;
  int order[DVI_AXES_MAX];
  dvi__csr matrix; /* [points x functions], and no rows for Fourier spaces */
} dvi__space_operator;

/* Make an operator. DVI_UNSUPPORTED if the space has no such derivative. */
dvi_status dvi__operator_make(const dvi_space *space, const int *order, dvi__space_operator *made);
void dvi__operator_clear(dvi__space_operator *made);

/* Give the doubles that `work` of the next functions needs. 0 for sparse ones. */
int64_t dvi__operator_work(const dvi_space *space);

/* values [points] = B U, and U [functions] += B^T values. Neither takes memory. */
void dvi__operator_apply(const dvi__space_operator *B, const double *U, double *values,
                         double *work);
void dvi__operator_add_transposed(const dvi__space_operator *B, const double *values, double *U,
                                  double *work);

/* A derivative of function i of a Fourier space is `factor` times function `other`. */
typedef struct dvi__fourier_image {
  int64_t other;
  double factor;
} dvi__fourier_image;
dvi__fourier_image dvi__fourier_derivative(const dvi_space *space, const int *order, int64_t i);

/* Give, for a sparse space, the row that evaluates a derivative of the field at a point x, with at
 * most `most` entries. `*count` is 0 outside of the domain. For a Fourier space the row is full. */
dvi_status dvi__space_row(const dvi_space *space, const int *order, const double *x, int64_t most,
                          int *column, double *value, int64_t *count);

/* Return the most entries that such a row has. */
int64_t dvi__space_row_entries(const dvi_space *space);

#endif
