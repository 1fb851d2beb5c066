#include "step/degenerate/stage_inverse.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"

enum { LANES = DVI__STAGE_LANES, BLOCK = 4, MOST_UNKNOWNS = 32 };

/* Pivots of a matrix near 1 are near 1. */
static const double least_pivot = 1.0 / 16, largest_pivot = 16;

typedef double block __attribute__((vector_size(BLOCK * sizeof(double)), aligned(8), may_alias));

struct dvi__stage_inverse {
  int n, m, has_end, unknowns, stride;            /* a column has `stride` numbers, whole blocks */
  double moved[LANES][LANES], back[LANES][LANES]; /* G and G^-1 by columns */
  double sign[LANES];
  double unit[LANES][LANES], inner[LANES]; /* the matrix 1; 1 for stages before the end */
  double of_start[LANES], of_end[LANES];   /* G^-1 of 1 in all rows, and in the last one */
  dvi__stage_entry *given, *turned;        /* [n*n] by columns: entries, and -Omega^-1 times them */
  double *Omega;                           /* [n*n] -Omega^-1 by columns */
  double *inverse;                         /* [stride*unknowns + LANES] by columns */
};

/* ---- create ---- */

static void exchange_columns(int n, double *x, double *y)
{
  for (int i = 0; i < n; i++) {
    const double kept = x[i];
    x[i] = y[i];
    y[i] = kept;
  }
}

/* Replace a full matrix [n*n] by its inverse, with exchanges of columns. Returns 0 if it is
 * singular. */
static int invert_full(int n, double *A)
{
  int from[MOST_UNKNOWNS];
  for (int k = 0; k < n; k++) {
    double *column = A + k * n;
    from[k] = k;
    for (int j = k + 1; j < n; j++)
      if (fabs(A[j * n + k]) > fabs(A[from[k] * n + k])) from[k] = j;
    if (from[k] != k) exchange_columns(n, column, A + from[k] * n);
    const double pivot = column[k];
    if (!(fabs(pivot) > 0)) return 0;
    column[k] = 1;
    for (int i = 0; i < n; i++) column[i] /= pivot;
    for (int j = 0; j < n; j++) {
      const double factor = A[j * n + k];
      if (j == k) continue;
      A[j * n + k] = 0;
      for (int i = 0; i < n; i++) A[j * n + i] -= factor * column[i];
    }
  }
  for (int k = n - 1; k >= 0; k--)
    for (int j = 0; j < n && from[k] != k; j++)
      exchange_columns(1, &A[j * n + k], &A[j * n + from[k]]);
  return 1;
}

/* Fill the constant tables. Returns 0 if G is singular. */
static int stage_inverse_fill_tables(dvi__stage_inverse *s, const dvi__stage_tableau *tableau)
{
  const int m = s->m;
  double packed[LANES * LANES];
  for (int l = 0; l < m; l++)
    for (int k = 0; k < m; k++) packed[l * m + k] = s->moved[l][k] = tableau->moved[l][k];
  if (!invert_full(m, packed)) return 0;
  for (int k = 0; k < m; k++) {
    const int is_end = s->has_end && k == m - 1;
    s->sign[k] = is_end ? -1 : 1;
    s->inner[k] = !is_end;
    s->unit[k][k] = 1;
    for (int l = 0; l < m; l++) {
      s->back[l][k] = packed[l * m + k];
      s->of_start[k] += packed[l * m + k];
    }
    s->of_end[k] = packed[(m - 1) * m + k];
  }
  return 1;
}

static int stage_inverse_allocate(dvi__stage_inverse *s)
{
  const size_t n = (size_t)s->n, unknowns = (size_t)s->unknowns;
  s->stride = (s->unknowns + BLOCK - 1) / BLOCK * BLOCK;
  s->given = DVI_NEW(dvi__stage_entry, n * n);
  s->turned = DVI_NEW(dvi__stage_entry, n * n);
  s->Omega = DVI_NEW(double, n *n);
  s->inverse = DVI_NEW(double, (size_t)s->stride *unknowns + LANES);
  return s->given != NULL && s->turned != NULL && s->Omega != NULL && s->inverse != NULL;
}

dvi_status dvi__stage_inverse_create(int n, const dvi__stage_tableau *tableau,
                                     dvi__stage_inverse **inverse)
{
  *inverse = NULL;
  if (tableau->stages > LANES || n > MOST_UNKNOWNS / tableau->stages) return DVI_OK;
  dvi__stage_inverse *s = DVI_NEW(dvi__stage_inverse, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  s->n = n;
  s->m = tableau->stages;
  s->has_end = tableau->has_end;
  s->unknowns = s->n * s->m;
  const int is_regular = stage_inverse_fill_tables(s, tableau),
            is_allocated = is_regular && stage_inverse_allocate(s);
  if (is_allocated) *inverse = s;
  if (!is_allocated) dvi__stage_inverse_destroy(&s);
  return is_allocated || !is_regular
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "no memory for the inverse of %d stages", tableau->stages);
}

void dvi__stage_inverse_destroy(dvi__stage_inverse **inverse)
{
  dvi__stage_inverse *s = *inverse;
  if (s == NULL) return;
  dvi__release(s->given);
  dvi__release(s->turned);
  dvi__release(s->Omega);
  dvi__release(s->inverse);
  dvi__release(s);
  *inverse = NULL;
}

dvi__stage_entry *dvi__stage_inverse_entry(dvi__stage_inverse *s, int i, int j)
{
  return s->given + j * s->n + i;
}

/* ---- the matrix ---- */

/* Compute -Omega^-1. Returns 0 if Omega is singular. */
static int fill_two_form(const dvi__stage_inverse *s, int count, const double *weight)
{
  for (int at = 0; at < s->n * s->n; at++) {
    const dvi__stage_entry *of = s->given + at;
    double sum = 0;
    for (int k = 0; k < count; k++) sum += weight[k] * (of->A[k] - of->B[k]);
    s->Omega[at] = sum;
  }
  return invert_full(s->n, s->Omega);
}

INLINE void add_multiple(double by, const double *x, double *sum)
{
  for (int k = 0; k < LANES; k += BLOCK) *(block *)(sum + k) += by * *(const block *)(x + k);
}

/* Multiply the entries by -Omega^-1. */
INLINE void turn_entries(const dvi__stage_inverse *s)
{
  const int n = s->n;
  memset(s->turned, 0, (size_t)(n * n) * sizeof *s->turned);
  for (int j = 0; j < n; j++)
    for (int l = 0; l < n; l++) {
      const dvi__stage_entry *of = s->given + j * n + l;
      for (int i = 0; i < n; i++) {
        dvi__stage_entry *turned = s->turned + j * n + i;
        const double by = s->Omega[l * n + i];
        add_multiple(by, of->A, turned->A);
        add_multiple(by, of->B, turned->B);
        add_multiple(by, of->K, turned->K);
        turned->a += by * of->a;
        turned->c += by * of->c;
      }
    }
}

/* Write the rows of a component in the column of unknown l of another one, LANES numbers. */
INLINE void write_rows(const dvi__stage_inverse *s, const dvi__stage_entry *of, int l, double *rows)
{
  const int m = s->m, last = m - 1;
  const double *moved = s->moved[l];
  block sum[LANES / BLOCK] = {{0}, {0}};
  for (int r = 0; r < m; r++) add_multiple(of->A[r] * moved[r], s->back[r], (double *)sum);
  if (s->has_end) {
    const double is_last = l == last;
    add_multiple(-(is_last * of->a + of->c * moved[last]), s->of_start, (double *)sum);
    add_multiple(-(is_last * of->B[last] + of->K[last] * moved[last]), s->of_end, (double *)sum);
  }
  for (int k = 0; k < LANES; k += BLOCK) {
    const block pushed = *(const block *)(of->K + k) * *(const block *)(moved + k) +
                         *(const block *)(of->B + k) * *(const block *)(s->unit[l] + k);
    *(block *)(rows + k) = sum[k / BLOCK] - pushed * *(const block *)(s->inner + k);
  }
}

/* Write the matrix. Lanes beyond the stages of a component are 0, and those of the next one, or of
 * the next column, replace them. */
INLINE void write_matrix(const dvi__stage_inverse *s)
{
  for (int j = 0; j < s->n; j++)
    for (int l = 0; l < s->m; l++)
      for (int i = 0; i < s->n; i++)
        write_rows(s, s->turned + j * s->n + i, l,
                   s->inverse + (j * s->m + l) * s->stride + i * s->m);
}

/* Invert the matrix of columns of `blocks` blocks (Gauss and Jordan), without exchanges. Returns 0
 * if a pivot is far from 1. */
INLINE int invert_near_one(const dvi__stage_inverse *s, const int blocks)
{
  for (int k = 0; k < s->unknowns; k++) {
    double *column = s->inverse + k * blocks * BLOCK;
    const double pivot = column[k], by = 1 / pivot;
    if (!(pivot > least_pivot && pivot < largest_pivot)) return 0;
    for (int i = 0; i < blocks; i++) ((block *)column)[i] *= by;
    column[k] = 1 + by; /* leaves -factor * by of the factor in row k */
    for (int j = 0; j < s->unknowns; j++) {
      double *other = s->inverse + j * blocks * BLOCK;
      const double factor = j != k ? other[k] : 0;
      for (int i = 0; i < blocks; i++) ((block *)other)[i] -= factor * ((const block *)column)[i];
    }
    column[k] = by;
  }
  return 1;
}

INLINE int invert_in_blocks(const dvi__stage_inverse *s)
{
  switch (s->stride / BLOCK) {
  case 1: return invert_near_one(s, 1);
  case 2: return invert_near_one(s, 2);
  case 3: return invert_near_one(s, 3);
  case 4: return invert_near_one(s, 4);
  case 5: return invert_near_one(s, 5);
  case 6: return invert_near_one(s, 6);
  case 7: return invert_near_one(s, 7);
  default: return invert_near_one(s, MOST_UNKNOWNS / BLOCK);
  }
}

WIDE static int write_and_invert(const dvi__stage_inverse *s)
{
  turn_entries(s);
  write_matrix(s);
  return invert_in_blocks(s);
}

int dvi__stage_inverse_begin(dvi__stage_inverse *s, int count, const double *weight)
{
  return fill_two_form(s, count, weight) && write_and_invert(s);
}

/* ---- solve ---- */

WIDE static void stage_inverse_times(const dvi__stage_inverse *s, double *r)
{
  const int m = s->m, n = s->n;
  double back[MOST_UNKNOWNS * LANES] = {0}, x[MOST_UNKNOWNS + LANES], y[MOST_UNKNOWNS];
  for (int i = 0; i < n; i++)
    for (int l = 0; l < m; l++)
      add_multiple(s->sign[l] * r[i * m + l], s->back[l], back + i * LANES);
  for (int i = 0; i < n; i++) {
    block sum[LANES / BLOCK] = {{0}, {0}};
    for (int l = 0; l < n; l++) add_multiple(s->Omega[l * n + i], back + l * LANES, (double *)sum);
    memcpy(x + i * m, sum, sizeof sum);
  }
  for (int at = 0; at < s->stride; at += BLOCK) {
    block sum = {0};
    for (int c = 0; c < s->unknowns; c++)
      sum += x[c] * *(const block *)(s->inverse + c * s->stride + at);
    memcpy(y + at, &sum, sizeof sum);
  }
  memcpy(r, y, (size_t)s->unknowns * sizeof *r);
}

void dvi__stage_inverse_solve(dvi__stage_inverse *s, double *r)
{
  stage_inverse_times(s, r);
}
