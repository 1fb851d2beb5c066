#include "step/degenerate/stage_inverse_struct.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/small_inverse.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"

enum { LANES = DVI__STAGE_LANES, BLOCK = 4, MOST_UNKNOWNS = DVI__NEAR_ONE_MOST };

typedef double block __attribute__((vector_size(BLOCK * sizeof(double)), aligned(8), may_alias));

/* ---- create ---- */

/* Fill the constant tables. Returns 0 if G is singular. */
static int stage_inverse_fill_tables(dvi__stage_inverse *s, const dvi__stage_tableau *tableau)
{
  const int m = s->m;
  double packed[LANES * LANES];
  for (int l = 0; l < m; l++)
    for (int k = 0; k < m; k++) packed[l * m + k] = s->moved[l][k] = tableau->moved[l][k];
  if (dvi__small_invert(m, packed) == 0) return 0;
  for (int k = 0; k < m; k++) {
    const int is_end = s->has_end && k == m - 1;
    s->sign[k] = is_end ? -1 : 1;
    s->unit[k][k] = !is_end;
    for (int l = 0; l < m; l++) s->inner[l][k] = is_end ? 0 : s->moved[l][k];
    for (int l = 0; l < m; l++) {
      s->back[l][k] = packed[l * m + k];
      s->of_start[k] += packed[l * m + k];
    }
    s->of_end[k] = packed[(m - 1) * m + k];
  }
  for (int l = 0; l < m; l++)
    for (int k = 0; k < m; k++) {
      for (int r = 0; r < m; r++) s->path[l][r][k] = s->back[r][k] * s->moved[l][r];
      s->path_of_start[l][k] = -s->of_start[k] * s->moved[l][m - 1];
      s->path_of_end[l][k] = -s->of_end[k] * s->moved[l][m - 1];
    }
  return 1;
}

static int stage_inverse_allocate(dvi__stage_inverse *s)
{
  const size_t n = (size_t)s->n, unknowns = (size_t)s->unknowns;
  s->stride = dvi__near_one_stride(s->unknowns);
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
  return dvi__small_invert(s->n, s->Omega) != 0;
}

INLINE void add_multiple(double by, const double *x, double *sum)
{
  for (int k = 0; k < LANES; k += BLOCK) *(block *)(sum + k) += by * *(const block *)(x + k);
}

/* Multiply the entries by -Omega^-1. */
INLINE void turn_entry(const dvi__stage_inverse *s, int i, int j)
{
  const int n = s->n;
  dvi__stage_entry sum = {.a = 0};
  for (int l = 0; l < n; l++) {
    const dvi__stage_entry *of = s->given + j * n + l;
    const double by = s->Omega[l * n + i];
    add_multiple(by, of->A, sum.A);
    add_multiple(by, of->B, sum.B);
    add_multiple(by, of->K, sum.K);
    sum.a += by * of->a;
    sum.c += by * of->c;
  }
  s->turned[j * n + i] = sum;
}

/* Write the rows of a component in column l of another one, LANES numbers. */
INLINE void write_rows(const dvi__stage_inverse *s, const dvi__stage_entry *of, int l, double *rows)
{
  const int m = s->m, last = m - 1;
  block sum[LANES / BLOCK] = {{0}, {0}};
  for (int r = 0; r < m; r++) add_multiple(of->A[r], s->path[l][r], (double *)sum);
  if (s->has_end) {
    add_multiple(of->c, s->path_of_start[l], (double *)sum);
    add_multiple(of->K[last], s->path_of_end[l], (double *)sum);
  }
  if (s->has_end && l == last) {
    add_multiple(-of->a, s->of_start, (double *)sum);
    add_multiple(-of->B[last], s->of_end, (double *)sum);
  }
  for (int k = 0; k < LANES; k += BLOCK)
    *(block *)(rows + k) = sum[k / BLOCK] -
                           (*(const block *)(of->K + k) * *(const block *)(s->inner[l] + k) +
                            *(const block *)(of->B + k) * *(const block *)(s->unit[l] + k));
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

WIDE static void turn_and_write(const dvi__stage_inverse *s)
{
  for (int j = 0; j < s->n; j++)
    for (int i = 0; i < s->n; i++) turn_entry(s, i, j);
  write_matrix(s);
}

int dvi__stage_inverse_begin(dvi__stage_inverse *s, int count, const double *weight)
{
  if (!fill_two_form(s, count, weight)) return 0;
  turn_and_write(s);
  return dvi__near_one_invert(s->unknowns, s->inverse);
}

/* ---- solve ---- */

/* Multiply by -Omega^-1 G^-1. */
WIDE static void turn_stage_rows(const dvi__stage_inverse *s, const double *r, double *x)
{
  const int m = s->m, n = s->n;
  double back[MOST_UNKNOWNS * LANES];
  for (int i = 0; i < n; i++) {
    block sum[LANES / BLOCK] = {{0}, {0}};
    for (int l = 0; l < m; l++) add_multiple(s->sign[l] * r[i * m + l], s->back[l], (double *)sum);
    memcpy(back + i * LANES, sum, sizeof sum);
  }
  for (int i = 0; i < n; i++) {
    block sum[LANES / BLOCK] = {{0}, {0}};
    for (int l = 0; l < n; l++) add_multiple(s->Omega[l * n + i], back + l * LANES, (double *)sum);
    memcpy(x + i * m, sum, sizeof sum);
  }
}

void dvi__stage_inverse_solve(dvi__stage_inverse *s, double *r)
{
  double x[MOST_UNKNOWNS + LANES];
  turn_stage_rows(s, r, x);
  dvi__near_one_times(s->unknowns, s->inverse, x);
  memcpy(r, x, (size_t)s->unknowns * sizeof *r);
}
