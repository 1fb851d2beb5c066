#include "boundary/inertia.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* LAPACK's Fortran interface. Character arguments carry a hidden length that gfortran passes
 * last. */
extern void dsytrf_(const char *triangle, const int *n, double *a, const int *lda, int *pivot,
                    double *work, const int *lwork, int *info, size_t triangle_length);
extern void dsytrs_(const char *triangle, const int *n, const int *sides, const double *a,
                    const int *lda, const int *pivot, double *b, const int *ldb, int *info,
                    size_t triangle_length);
extern void dgemm_(const char *trans_a, const char *trans_b, const int *m, const int *n,
                   const int *k, const double *alpha, const double *a, const int *lda,
                   const double *b, const int *ldb, const double *beta, double *c, const int *ldc,
                   size_t trans_a_length, size_t trans_b_length);

/* A complement with a pivot so much smaller than the matrix, which is scaled to ones, spoils as
 * many digits of the next one. The two are factored together. */
static const double least_pivot = 1e-4;
enum { MOST_TOGETHER = 3 };

/* State of the elimination. `together` blocks from block k on stand in D. The blocks eliminated
 * before have added `update` to block k, `far` to its coupling with the last block, and `last` to
 * that block. B couples block k with the next one, F with the last one. All are by columns with
 * `stride` rows. */
typedef struct elimination {
  const dvi__pattern *pattern;
  const double *values;
  double *scale; /* [size] scale of rows and columns, powers of two */
  int size, block, blocks, stride;
  double *D, *B, *F, *X, *update, *far, *last, *work;
  int *pivot;
} elimination;

static int block_first(const elimination *e, int k)
{
  return k < e->blocks ? k * e->block : e->size;
}

static int blocks_width(const elimination *e, int k, int together)
{
  return block_first(e, k + together) - block_first(e, k);
}

static size_t block_square(const elimination *e)
{
  return (size_t)e->stride * (size_t)e->stride;
}

/* Gather the entries in the rows of blocks i to i+rows-1 and the columns of block j to
 * j+columns-1. */
static void inertia_gather(const elimination *e, int i, int rows, int j, int columns, double *to)
{
  const int first = block_first(e, i), end = block_first(e, i + rows);
  memset(to, 0, block_square(e) * sizeof(double));
  for (int c = 0; c < blocks_width(e, j, columns); c++) {
    const int column = block_first(e, j) + c;
    for (int at = e->pattern->start[column]; at < e->pattern->start[column + 1]; at++) {
      const int row = e->pattern->row[at];
      if (row >= first && row < end)
        to[(size_t)c * (size_t)e->stride + (size_t)(row - first)] = e->values[at] * e->scale[row] *
                                                                    e->scale[column];
    }
  }
}

/* Add `part` to a matrix from (row, column) on. */
static void inertia_add(const elimination *e, const double *part, int row, int column, double *to)
{
  for (size_t c = 0; c < (size_t)e->block; c++)
    for (size_t r = 0; r < (size_t)e->block; r++)
      to[((size_t)column + c) * (size_t)e->stride + (size_t)row + r] +=
          part[c * (size_t)e->stride + r];
}

/* Assemble the blocks with the updates of the blocks before. The last block, if it is among them,
 * is coupled with block k by eliminated blocks, too. LAPACK reads the lower triangle alone. */
static void inertia_assemble(elimination *e, int k, int together)
{
  const int last = e->blocks - 1, to_last = block_first(e, last) - block_first(e, k);
  inertia_gather(e, k, together, k, together, e->D);
  inertia_add(e, e->update, 0, 0, e->D);
  if (k + together <= last) return;
  inertia_add(e, e->last, to_last, to_last, e->D);
  for (size_t c = 0; k < last && c < (size_t)e->block; c++)
    for (size_t r = 0; r < (size_t)e->block; r++)
      e->D[c * (size_t)e->stride + (size_t)to_last + r] += e->far[r * (size_t)e->stride + c];
}

/* Give the smallest pivot of the factor, and count the negative ones. A 2 x 2 pivot has one of each
 * sign. */
static double count_pivots(const elimination *e, int size, long *negative)
{
  double least = HUGE_VAL;
  for (int c = 0; c < size; c++) {
    const double *at = e->D + (size_t)c * (size_t)e->stride + (size_t)c;
    if (e->pivot[c] > 0) {
      *negative += at[0] < 0;
      least = fmin(least, fabs(at[0]));
      continue;
    }
    const double a = at[0], b = at[1], d = at[e->stride + 1];
    ++*negative;
    least = fmin(least, fabs(a * d - b * b) / (fabs(a) + fabs(b) + fabs(d)));
    c++;
  }
  return least;
}

/* Factor blocks from k on, as many together as necessary. */
static dvi_status inertia_factor(elimination *e, int k, int *together, long *negative)
{
  const int length = 64 * e->stride,
            most = e->blocks - k < MOST_TOGETHER ? e->blocks - k : MOST_TOGETHER;
  for (*together = 1;; ++*together) {
    int info = 0;
    long found = 0;
    inertia_assemble(e, k, *together);
    const int size = blocks_width(e, k, *together);
    dsytrf_("L", &size, e->D, &e->stride, e->pivot, e->work, &length, &info, 1);
    const double least = info == 0 ? count_pivots(e, size, &found) : 0;
    if (!(least > least_pivot) && *together < most) continue;
    *negative += found;
    if (least > 0) return DVI_OK;
    return dvi__fail(DVI_SINGULAR, "inertia: the Schur complement of block %d is singular", k);
  }
}

/* Subtract A^T X, rows x columns, with the factored blocks' `inner` rows. */
static void subtract_product(const elimination *e, int rows, int columns, int inner,
                             const double *A, double *to)
{
  const double minus = -1, one = 1;
  dgemm_("T", "N", &rows, &columns, &inner, &minus, A, &e->stride, e->X, &e->stride, &one, to,
         &e->stride, 1, 1);
}

/* Set X = D^-1 A. */
static void inertia_solve(const elimination *e, int size, int columns, const double *A)
{
  int info;
  memcpy(e->X, A, block_square(e) * sizeof(double));
  dsytrs_("L", &size, &columns, e->D, &e->stride, e->pivot, e->X, &e->stride, &info, 1);
}

/* Update the next block and the last one by the factored blocks k to next-1. */
static void update_next_blocks(elimination *e, int k, int next)
{
  const int last = e->blocks - 1, size = blocks_width(e, k, next - k),
            next_size = blocks_width(e, next, 1), last_size = blocks_width(e, last, 1);
  inertia_gather(e, k, next - k, last, 1, e->F);
  inertia_add(e, e->far, 0, 0, e->F);
  if (next == last)
    memcpy(e->B, e->F, block_square(e) * sizeof(double));
  else
    inertia_gather(e, k, next - k, next, 1, e->B);
  memset(e->update, 0, block_square(e) * sizeof(double));
  memset(e->far, 0, block_square(e) * sizeof(double));
  inertia_solve(e, size, next_size, e->B);
  subtract_product(e, next_size, next_size, size, e->B, e->update);
  if (next == last) return;
  inertia_solve(e, size, last_size, e->F);
  subtract_product(e, next_size, last_size, size, e->B, e->far);
  subtract_product(e, last_size, last_size, size, e->F, e->last);
}

/* Scale columns to size one. The roots are the scale of both sides, which leaves the signs of
 * eigenvalues as they are. */
static void inertia_equilibrate(const elimination *e)
{
  for (int column = 0; column < e->size; column++) {
    double found = 0;
    for (int at = e->pattern->start[column]; at < e->pattern->start[column + 1]; at++)
      if (e->pattern->row[at] < e->size) found = fmax(found, fabs(e->values[at]));
    e->scale[column] = found > 0 ? ldexp(1.0, -ilogb(found) / 2) : 1.0;
  }
}

static dvi_status inertia_eliminate(elimination *e, long *negative)
{
  inertia_equilibrate(e);
  for (int k = 0, together; k < e->blocks; k += together) {
    DVI_TRY(inertia_factor(e, k, &together, negative));
    if (k + together < e->blocks) update_next_blocks(e, k, k + together);
  }
  return DVI_OK;
}

dvi_status dvi__inertia(const dvi__pattern *pattern, const double *values, int size, int block,
                        long *negative)
{
  enum { ARRAYS = 7 };
  const int stride = MOST_TOGETHER * block;
  const size_t each = (size_t)stride * (size_t)stride;
  double *memory = DVI_NEW(double, ARRAYS *each + 64 * (size_t)stride);
  elimination e = {
      .pattern = pattern, .values = values, .size = size, .block = block, .stride = stride};
  e.pivot = DVI_NEW(int, stride);
  e.scale = DVI_NEW(double, size);
  double **const array[ARRAYS] = {&e.D, &e.B, &e.F, &e.X, &e.update, &e.far, &e.last};
  dvi_status status = DVI_NO_MEMORY;
  *negative = 0;
  if (memory != NULL && e.pivot != NULL && e.scale != NULL) {
    e.blocks = (size + block - 1) / block;
    for (size_t k = 0; k < ARRAYS; k++) *array[k] = memory + k * each;
    e.work = memory + ARRAYS * each;
    status = inertia_eliminate(&e, negative);
  } else {
    (void)dvi__fail(status, "inertia: no memory for blocks of %d", block);
  }
  dvi__release(memory);
  dvi__release(e.pivot);
  dvi__release(e.scale);
  return status;
}
