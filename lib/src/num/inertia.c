#include "num/inertia.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* LAPACK's Fortran interface; character arguments carry a hidden length that gfortran passes last. */
extern void dsytrf_(const char *triangle, const int *n, double *a, const int *lda, int *pivot, double *work, const int *lwork,
                    int *info, size_t triangle_length);
extern void dsytrs_(const char *triangle, const int *n, const int *sides, const double *a, const int *lda, const int *pivot,
                    double *b, const int *ldb, int *info, size_t triangle_length);
extern void dgemm_(const char *trans_a, const char *trans_b, const int *m, const int *n, const int *k, const double *alpha,
                   const double *a, const int *lda, const double *b, const int *ldb, const double *beta, double *c, const int *ldc,
                   size_t trans_a_length, size_t trans_b_length);

/* The elimination: block k stands in D with what was eliminated before; B couples it with the next one, F with the last one. All by columns with `block`
 * rows. */
typedef struct elimination {
  const dvi__pattern *pattern;
  const double *values;
  int size, block, blocks;
  double *D, *B, *F, *X, *next_D, *next_F, *last, *work;
  int *pivot;
} elimination;

static int block_size(const elimination *e, int k)
{
  return k + 1 < e->blocks ? e->block : e->size - k * e->block;
}

/* to += the entries in the rows of block i and the columns of block j. */
static void gather(const elimination *e, int i, int j, double *to)
{
  const int first = i * e->block, end = first + block_size(e, i);
  for (int c = 0; c < block_size(e, j); c++) {
    const int column = j * e->block + c;
    for (int at = e->pattern->start[column]; at < e->pattern->start[column + 1]; at++) {
      const int row = e->pattern->row[at];
      if (row >= first && row < end) to[(size_t)c * (size_t)e->block + (size_t)(row - first)] += e->values[at];
    }
  }
}

static void clear(const elimination *e, double *block)
{
  memset(block, 0, (size_t)e->block * (size_t)e->block * sizeof(double));
}

/* C -= A^T X. */
static void subtract_product(const elimination *e, int rows, int columns, int inner, const double *A, const double *X, double *C)
{
  const double minus = -1, one = 1;
  dgemm_("T", "N", &rows, &columns, &inner, &minus, A, &e->block, X, &e->block, &one, C, &e->block, 1, 1);
}

/* A 2 x 2 pivot has one negative eigenvalue. Returns 0 if D is singular. */
static int factor(const elimination *e, int size, long *negative)
{
  const int length = 64 * e->block;
  int info = 0;
  dsytrf_("L", &size, e->D, &e->block, e->pivot, e->work, &length, &info, 1);
  for (int c = 0; c < size && info == 0; c++) {
    const int pair = e->pivot[c] < 0;
    *negative += pair || e->D[(size_t)c * (size_t)e->block + (size_t)c] < 0;
    c += pair;
  }
  return info == 0;
}

/* X = D^-1 A. */
static void solve(const elimination *e, int size, int columns, const double *A)
{
  int info;
  memcpy(e->X, A, (size_t)columns * (size_t)e->block * sizeof(double));
  dsytrs_("L", &size, &columns, e->D, &e->block, e->pivot, e->X, &e->block, &info, 1);
}

/* Block k is factored: what it leaves to the next block and to the last one. */
static void pass_on(elimination *e, int k)
{
  const int last = e->blocks - 1, next_size = block_size(e, k + 1), last_size = block_size(e, last);
  clear(e, e->next_D);
  clear(e, e->next_F);
  solve(e, e->block, next_size, e->B);
  subtract_product(e, next_size, next_size, e->block, e->B, e->X, e->next_D);
  if (k + 1 < last) {
    solve(e, e->block, last_size, e->F);
    subtract_product(e, next_size, last_size, e->block, e->B, e->X, e->next_F);
    subtract_product(e, last_size, last_size, e->block, e->F, e->X, e->last);
  }
  double *D = e->D, *F = e->F;
  e->D = e->next_D;
  e->next_D = D;
  e->F = e->next_F;
  e->next_F = F;
}

static dvi_status eliminate(elimination *e, long *negative)
{
  const int last = e->blocks - 1;
  if (last > 1) gather(e, 0, last, e->F);
  for (int k = 0; k <= last; k++) {
    gather(e, k, k, e->D);
    for (size_t i = 0; k == last && i < (size_t)e->block * (size_t)e->block; i++) e->D[i] += e->last[i];
    if (!factor(e, block_size(e, k), negative))
      return dvi__fail(DVI_SINGULAR, "inertia: the Schur complement of block %d is singular", k);
    if (k == last) break;
    clear(e, e->B);
    gather(e, k, k + 1, e->B);
    /* The next block is the last one: both couplings are one. */
    for (size_t i = 0; k + 1 == last && i < (size_t)e->block * (size_t)e->block; i++) e->B[i] += e->F[i];
    pass_on(e, k);
  }
  return DVI_OK;
}

dvi_status dvi__inertia(const dvi__pattern *pattern, const double *values, int size, int block, long *negative)
{
  enum { ARRAYS = 7 };
  const size_t square = (size_t)block * (size_t)block;
  double *memory = DVI_NEW(double, ARRAYS *square + 64 * (size_t)block);
  elimination e = {.pattern = pattern, .values = values, .size = size, .block = block, .pivot = DVI_NEW(int, block)};
  double **const array[ARRAYS] = {&e.D, &e.B, &e.F, &e.X, &e.next_D, &e.next_F, &e.last};
  dvi_status status = DVI_NO_MEMORY;
  *negative = 0;
  if (memory != NULL && e.pivot != NULL) {
    e.blocks = (size + block - 1) / block;
    for (size_t k = 0; k < ARRAYS; k++) *array[k] = memory + k * square;
    e.work = memory + ARRAYS * square;
    status = eliminate(&e, negative);
  } else {
    (void)dvi__fail(status, "inertia: no memory for blocks of %d", block);
  }
  dvi__release(memory);
  dvi__release(e.pivot);
  return status;
}
