/* Sparse symmetric patterns for products that are taken many times. Four rows are multiplied at a
 * time. The entries of each four rows on one diagonal stand side by side, so that products are sums
 * of vectors. Banded matrices and lattices fill their stripes. Missing entries in one are zero. */
#ifndef DVI_NUM_STRIPES_H
#define DVI_NUM_STRIPES_H
#include <stddef.h>

#include "num/pattern.h"

typedef struct dvi__stripes {
  int n, fours; /* numbers of rows and of groups of four rows */
  int reach;    /* largest distance in fours between a row and what it is multiplied with */
  /* numbers of a vector, which are three beside both ends that products read as zeros, n, and some
   * up to a whole four */
  size_t room;
  int *start; /* [fours+1] */
  /* [start[fours]] column of a stripe's first row, which is before the first column or behind the
   * last one if that row has nothing there */
  int *column;
  double *value; /* [4*start[fours]] */
} dvi__stripes;

/* Index at which the elements of a vector begin in its room. */
enum { DVI__STRIPES_MARGIN = 4 };

/* Make the matrix diag(scale) A - shift for the symmetric A with these values. The pattern holds
 * the diagonal. DVI_BAD_SIZE if an int cannot count the numbers, DVI_NO_MEMORY. dvi__stripes_clear
 * frees the remains of a failure, too. */
dvi_status dvi__stripes_fill(const dvi__pattern *pattern, const double *values, const double *scale,
                             double shift, dvi__stripes *stripes);
void dvi__stripes_clear(dvi__stripes *stripes);

/* Chebyshev sums of a matrix Z with spectrum in [-1, 1], of `lanes` vectors, 1 or 2, at once:
 *
 *     y = sum_{k=0}^degree C_k T_k(Z) x,      C_k [lanes x lanes] by rows, in c.
 *
 * The stripes hold G = 2 (Z + 1). Clenshaw's recurrence in the form of Reinsch is exact where
 * G x = 0, and keeps the relative accuracy near there:
 *
 *     d_k = C_k x + G b_{k+1} - d_{k+1},   b_k = d_k - b_{k+1},   y = C_0 x + G b_1/2 - d_1.
 *
 * Source: Oliver 1977. */
typedef struct dvi__clenshaw {
  const dvi__stripes *G;
  int lanes, degree;
  const double *c;   /* [(degree+1)*lanes*lanes] */
  const double *x;   /* [lanes*room] with any numbers in the margins */
  double *d;         /* [lanes*room] sum y */
  double *b, *other; /* [lanes*room] work, with zeros in the margins and behind the last row */
} dvi__clenshaw;

void dvi__stripes_sum(const dvi__clenshaw *sum);

#endif
