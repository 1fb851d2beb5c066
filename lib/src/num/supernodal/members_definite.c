#include "num/supernodal/members_definite.h"

#include <stddef.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"

/* Row k of L has its columns in[first[k]] to in[first[k+1]-1], in the order in which they are
 * eliminated, and its entries at the places `at` in L. */
struct dvi__members_definite {
  int n;
  int *order, *place;   /* [n] permutation and its inverse */
  int *start, *row;     /* pattern of the matrix */
  int *first, *in, *at; /* [n+1], [entries of L] */
  int *column, *below;  /* [n+1], [entries of L] the columns of L and their rows */
  int *diagonal;        /* [n] entry A_kk of column k of L */
  double *L, *D, *y;    /* [entries of L*capacity], [n*capacity], [n*capacity] */
  int *indices;         /* storage of all lists */
};

/* ---- create ---- */

/* Find the columns of row k of L, from the elimination tree of the rows before, which grows. They
 * are written from the end of stack[n] on, as LDL does. Returns where they begin. */
static int find_row(const dvi__members_definite *f, int k, int *parent, int *flag, int *stack)
{
  int top = f->n;
  parent[k] = -1;
  flag[k] = k;
  for (int p = f->start[f->order[k]]; p < f->start[f->order[k] + 1]; p++) {
    int length = 0;
    for (int i = f->place[f->row[p]]; i < k && flag[i] != k; i = parent[i]) {
      if (parent[i] < 0) parent[i] = k;
      stack[length++] = i;
      flag[i] = k;
    }
    while (length > 0) stack[--top] = stack[--length];
  }
  return top;
}

/* List the rows of L, and count its columns into column[k+1]. */
static void list_rows(dvi__members_definite *f, int *work)
{
  int *parent = work, *flag = work + f->n, *stack = work + 2 * f->n;
  for (int k = 0; k < f->n; k++) flag[k] = -1;
  for (int k = 0; k < f->n; k++) {
    const int top = find_row(f, k, parent, flag, stack);
    f->first[k + 1] = f->first[k];
    for (int i = top; i < f->n; i++) {
      f->in[f->first[k + 1]++] = stack[i];
      f->column[stack[i] + 1]++;
    }
    for (int p = f->start[f->order[k]]; p < f->start[f->order[k] + 1]; p++)
      if (f->row[p] == f->order[k]) f->diagonal[k] = p;
  }
}

/* List the columns of L. Their rows ascend, because rows come one after the other. */
static void list_columns(dvi__members_definite *f, int *length)
{
  for (int k = 0; k < f->n; k++) f->column[k + 1] += f->column[k];
  memset(length, 0, (size_t)f->n * sizeof *length);
  for (int k = 0; k < f->n; k++)
    for (int e = f->first[k]; e < f->first[k + 1]; e++) {
      f->at[e] = f->column[f->in[e]] + length[f->in[e]]++;
      f->below[f->at[e]] = k;
    }
}

static int lay_out(dvi__members_definite *f, int entries)
{
  const int n = f->n, most = n * (n - 1) / 2;
  int *at = f->indices = DVI_NEW(int, (size_t)(5 * n + 3 + entries + 3 * most));
  if (at == NULL) return 0;
  f->order = at;
  f->place = f->order + n;
  f->diagonal = f->place + n;
  f->start = f->diagonal + n;
  f->first = f->start + n + 1;
  f->column = f->first + n + 1;
  f->row = f->column + n + 1;
  f->in = f->row + entries;
  f->at = f->in + most;
  f->below = f->at + most;
  return 1;
}

static int definite_allocate(dvi__members_definite *f, const int *start, const int *row,
                             const int *order, size_t capacity)
{
  int work[3 * DVI__MEMBERS_DEFINITE_MOST];
  const size_t n = (size_t)f->n;
  if (!lay_out(f, start[n])) return 0;
  memcpy(f->order, order, n * sizeof *order);
  memcpy(f->start, start, (n + 1) * sizeof *start);
  memcpy(f->row, row, (size_t)start[n] * sizeof *row);
  for (int k = 0; k < f->n; k++) f->place[order[k]] = k;
  list_rows(f, work);
  list_columns(f, work);
  f->L = DVI_NEW(double, (size_t)f->column[n] * capacity + 1);
  f->D = DVI_NEW(double, n *capacity);
  f->y = DVI_NEW(double, n *capacity);
  return f->L != NULL && f->D != NULL && f->y != NULL;
}

dvi_status dvi__members_definite_create(int n, const int *start, const int *row, const int *order,
                                        int capacity, dvi__members_definite **factor)
{
  dvi__members_definite *f = *factor = DVI_NEW(dvi__members_definite, 1);
  if (f != NULL) f->n = n;
  if (f != NULL && definite_allocate(f, start, row, order, (size_t)capacity)) return DVI_OK;
  dvi__members_definite_destroy(factor);
  return dvi__fail(DVI_NO_MEMORY, "no memory for factors of %d members", capacity);
}

void dvi__members_definite_destroy(dvi__members_definite **factor)
{
  dvi__members_definite *f = *factor;
  if (f == NULL) return;
  dvi__release(f->indices);
  dvi__release(f->L);
  dvi__release(f->D);
  dvi__release(f->y);
  dvi__release(f);
  *factor = NULL;
}

/* ---- factor ---- */

/* Gather row k of the matrix, as far as it is left of the diagonal, and the diagonal. */
static inline void gather_row(const dvi__members_definite *f, size_t width, int k,
                              const double *values)
{
  for (int e = f->first[k]; e < f->first[k + 1]; e++)
    memset(f->y + (size_t)f->in[e] * width, 0, width * sizeof(double));
  memset(f->D + (size_t)k * width, 0, width * sizeof(double));
  for (int p = f->start[f->order[k]]; p < f->start[f->order[k] + 1]; p++) {
    const int i = f->place[f->row[p]];
    if (i > k) continue;
    const double *restrict from = values + (size_t)p * width;
    double *restrict to = (i < k ? f->y : f->D) + (size_t)i * width;
    for (size_t l = 0; l < width; l++) to[l] += from[l];
  }
}

/* Eliminate entry e of row k of L. */
static inline void eliminate_entry(const dvi__members_definite *f, size_t width, int k, int e)
{
  const int i = f->in[e];
  const double *restrict y = f->y + (size_t)i * width, *restrict D = f->D + (size_t)i * width;
  double *restrict own = f->L + (size_t)f->at[e] * width, *restrict left = f->D + (size_t)k * width;
  for (int p = f->column[i]; p < f->at[e]; p++) {
    const double *restrict L = f->L + (size_t)p * width;
    double *restrict to = f->y + (size_t)f->below[p] * width;
    for (size_t l = 0; l < width; l++) to[l] -= L[l] * y[l];
  }
  for (size_t l = 0; l < width; l++) own[l] = y[l] / D[l];
  for (size_t l = 0; l < width; l++) left[l] -= own[l] * y[l];
}

WIDE static void members_factor(const dvi__members_definite *f, size_t width, const double *values,
                                double *restrict least)
{
  for (size_t l = 0; l < width; l++) least[l] = 1;
  for (int k = 0; k < f->n; k++) {
    gather_row(f, width, k, values);
    for (int e = f->first[k]; e < f->first[k + 1]; e++) eliminate_entry(f, width, k, e);
    const double *restrict D = f->D + (size_t)k * width, *restrict A = values +
                                                                       (size_t)f->diagonal[k] *
                                                                           width;
    for (size_t l = 0; l < width; l++) {
      const double left = D[l] / A[l];
      least[l] = left >= least[l] ? least[l] : left;
    }
  }
}

void dvi__members_definite_factor(dvi__members_definite *factor, int width, const double *values,
                                  double *least)
{
  members_factor(factor, (size_t)width, values, least);
}

/* ---- solve ---- */

static inline void subtract_product(size_t width, const double *restrict L,
                                    const double *restrict x, double *restrict to)
{
  for (size_t l = 0; l < width; l++) to[l] -= L[l] * x[l];
}

WIDE static void members_solve(const dvi__members_definite *f, size_t width, double *b)
{
  double *const y = f->y;
  const size_t bytes = width * sizeof(double);
  for (int k = 0; k < f->n; k++)
    memcpy(y + (size_t)k * width, b + (size_t)f->order[k] * width, bytes);
  for (int k = 0; k < f->n; k++)
    for (int p = f->column[k]; p < f->column[k + 1]; p++)
      subtract_product(width, f->L + (size_t)p * width, y + (size_t)k * width,
                       y + (size_t)f->below[p] * width);
  for (size_t i = 0; i < (size_t)f->n * width; i++) y[i] /= f->D[i];
  for (int k = f->n - 1; k >= 0; k--)
    for (int p = f->column[k]; p < f->column[k + 1]; p++)
      subtract_product(width, f->L + (size_t)p * width, y + (size_t)f->below[p] * width,
                       y + (size_t)k * width);
  for (int k = 0; k < f->n; k++)
    memcpy(b + (size_t)f->order[k] * width, y + (size_t)k * width, bytes);
}

void dvi__members_definite_solve(dvi__members_definite *factor, int width, double *b)
{
  members_solve(factor, (size_t)width, b);
}
