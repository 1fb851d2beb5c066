/* Rows of numbers at the stages of a step on phase space, as lanes of vectors. */
#ifndef DVI_STEP_HAMILTONIAN_ROWS_H
#define DVI_STEP_HAMILTONIAN_ROWS_H
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "num/simd/width.h"

/* Rows are whole blocks. */
enum { BLOCK = 4 };

typedef double block __attribute__((vector_size(BLOCK * sizeof(double))));
typedef int64_t block_mask __attribute__((vector_size(BLOCK * sizeof(int64_t))));

/* The largest of changes and of the numbers that they lead to, 0 before. Changes that are not
 * finite make the largest one infinite. */
typedef struct largest {
  double change, whole;
} largest;

/* The same, lane by lane. */
typedef struct largest_lanes {
  block change, whole, not_finite;
} largest_lanes;

INLINE double larger(double x, double y)
{
  return x > y ? x : y;
}

/* Replace most by the magnitude of x where that is larger. */
INLINE void take_larger(const block *x, block *most)
{
  const block_mask magnitude = (block_mask)*x & INT64_MAX;
  const block_mask is_larger = (block_mask)((block)magnitude > *most);
  *most = (block)((is_larger & magnitude) | (~is_larger & (block_mask)*most));
}

INLINE void note_change(const block *change, const block *next, largest_lanes *most)
{
  take_larger(change, &most->change);
  take_larger(next, &most->whole);
  most->not_finite += 0.0 * *change;
}

INLINE void add_largest(const largest_lanes *lanes, largest *most)
{
  for (int k = 0; k < BLOCK; k++) {
    if (lanes->change[k] > most->change) most->change = lanes->change[k];
    if (lanes->whole[k] > most->whole) most->whole = lanes->whole[k];
    if (!(lanes->not_finite[k] == 0)) most->change = HUGE_VAL;
  }
}

/* Add factor_i x_i to y_i for a row of lanes. */
INLINE void add_row(int lanes, const double *factor, const double *x, double *y)
{
  for (int i = 0; i < lanes; i += BLOCK) {
    block by, at, sum;
    memcpy(&by, factor + i, sizeof by);
    memcpy(&at, x + i, sizeof at);
    memcpy(&sum, y + i, sizeof sum);
    sum += by * at;
    memcpy(y + i, &sum, sizeof sum);
  }
}

/* Add the products of factors and rows, `count` of them, to y. */
INLINE void add_rows(int count, int lanes, const double *factor, const double *rows, int step,
                     double *y)
{
  for (int i = 0; i < lanes; i += BLOCK) {
    block sum;
    memcpy(&sum, y + i, sizeof sum);
    for (int k = 0; k < count; k++) {
      block row;
      memcpy(&row, rows + k * step + i, sizeof row);
      sum += factor[k] * row;
    }
    memcpy(y + i, &sum, sizeof sum);
  }
}

/* Set y to the product of a table of columns [d][lanes] and a row. */
INLINE void row_product(int d, int lanes, const double *table, const double *x, double *y)
{
  const block zero = {0};
  for (int i = 0; i < lanes; i += BLOCK) memcpy(y + i, &zero, sizeof zero);
  add_rows(d, lanes, x, table, lanes, y);
}

/* Set dot to the sum over the components of gradient times `along`, at all stages. */
INLINE void derivative_along(int z, int lanes, const double *gradient, const double *along,
                             double *dot)
{
  for (int i = 0; i < lanes; i += BLOCK) {
    block sum = {0};
    for (int c = 0; c < z; c++) {
      block by, at;
      memcpy(&by, gradient + c * lanes + i, sizeof by);
      memcpy(&at, along + c * lanes + i, sizeof at);
      sum += by * at;
    }
    memcpy(dot + i, &sum, sizeof sum);
  }
}

INLINE double sum_of_products(int d, const double *x, const double *y)
{
  double sum = 0;
  for (int i = 0; i < d; i++) sum += x[i] * y[i];
  return sum;
}

#endif
