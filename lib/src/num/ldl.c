/* A sparse factor A = P^T L D L^T P of a positive definite matrix, without exchanges, which it does
 * not need. Columns are ordered by approximate minimum degree. SuiteSparse's LDL and AMD, once
 * analysed, take no memory from the heap. Source: Davis 2005 (Algorithm 849). */
#include <amd.h>
#include <ldl.h>
#include <math.h>
#include <stdint.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"

typedef struct definite {
  int *order, *place;                   /* [n] permutation and its inverse */
  int *parent, *length, *flag, *column; /* [n] elimination tree and work */
  int *diagonal;                        /* [n] entries of the matrix on its diagonal, in order */
  int *start, *row;                     /* pattern of L */
  double *L, *D, *y;
  double condition;
} definite;

static void ldl_destroy(void *factor)
{
  definite *f = factor;
  if (f == NULL) return;
  dvi__release(f->order);
  dvi__release(f->row);
  dvi__release(f->L);
  dvi__release(f->D);
  dvi__release(f);
}

static dvi_status refuse_memory(int n)
{
  return dvi__fail(DVI_NO_MEMORY, "LDL: no memory for %d columns", n);
}

static dvi_status ldl_lay_out(definite *f, size_t n)
{
  int *at = f->order = DVI_NEW(int, 8 * n + 1);
  f->D = DVI_NEW(double, 2 * n);
  if (at == NULL || f->D == NULL) return refuse_memory((int)n);
  f->place = at + n;
  f->parent = at + 2 * n;
  f->length = at + 3 * n;
  f->flag = at + 4 * n;
  f->column = at + 5 * n;
  f->diagonal = at + 6 * n;
  f->start = at + 7 * n;
  f->y = f->D + n;
  return DVI_OK;
}

static dvi_status ldl_analyse(definite *f, const dvi__pattern *A)
{
  const int n = A->columns;
  DVI_TRY(ldl_lay_out(f, (size_t)n));
  if (amd_order(n, A->start, A->row, f->order, NULL, NULL) != AMD_OK) return refuse_memory(n);
  ldl_symbolic(n, A->start, A->row, f->start, f->parent, f->length, f->flag, f->order, f->place);
  f->row = DVI_NEW(int, f->start[n]);
  f->L = DVI_NEW(double, f->start[n]);
  if (f->start[n] > 0 && (f->row == NULL || f->L == NULL)) return refuse_memory(n);
  for (int k = 0; k < n; k++) f->diagonal[k] = dvi__pattern_find(A, f->order[k], f->order[k]);
  return DVI_OK;
}

static dvi_status ldl_create(const dvi__factor_form *form, void **factor)
{
  definite *f = *factor = DVI_NEW(definite, 1);
  if (f == NULL) return refuse_memory(form->pattern->columns);
  const dvi_status status = ldl_analyse(f, form->pattern);
  if (status == DVI_OK) return DVI_OK;
  ldl_destroy(f);
  *factor = NULL;
  return status;
}

/* D_k is what the rows before leave of A_kk. Their ratio does not depend on the scales of rows. */
static double find_condition(const definite *f, int n, const double *values)
{
  double least = 1;
  for (int k = 0; k < n; k++) {
    const double left = f->D[k] / values[f->diagonal[k]];
    if (!(f->D[k] > 0 && left >= least)) least = f->D[k] > 0 ? left : 0;
  }
  return least;
}

static dvi_status ldl_factor(void *factor, const dvi__pattern *A, const double *values)
{
  definite *f = factor;
  const int n = A->columns;
  double *entries = (double *)(uintptr_t)values; /* LDL's interface lacks const, but only reads */
  const int done = ldl_numeric(n, A->start, A->row, entries, f->start, f->parent, f->length, f->row,
                               f->L, f->D, f->y, f->column, f->flag, f->order, f->place);
  f->condition = done == n ? find_condition(f, n, values) : 0;
  if (f->condition >= DVI__LEAST_RCOND) return DVI_OK;
  return dvi__fail(DVI_SINGULAR, "LDL: the %d x %d matrix is not positive definite", n, n);
}

static dvi_status ldl_solve(void *factor, const dvi__pattern *A, double *b)
{
  definite *f = factor;
  const int n = A->columns;
  ldl_perm(n, f->y, b, f->order);
  ldl_lsolve(n, f->y, f->start, f->row, f->L);
  ldl_dsolve(n, f->y, f->D);
  ldl_ltsolve(n, f->y, f->start, f->row, f->L);
  ldl_permt(n, b, f->y, f->order);
  return DVI_OK;
}

static int ldl_sign(const void *factor, const dvi__pattern *A)
{
  (void)factor, (void)A;
  return 1;
}

static int ldl_is_definite(const void *factor, const dvi__pattern *A, int sign)
{
  (void)factor, (void)A;
  return sign > 0;
}

static double ldl_condition(const void *factor)
{
  return ((const definite *)factor)->condition;
}

/* Column k of L with its c entries takes c (c + 1) multiplications and additions each. */
static dvi__linear_cost ldl_cost(const void *factor, const dvi__pattern *A)
{
  const definite *f = factor;
  double operations = 0;
  for (int k = 0; k < A->columns; k++) {
    const double entries = f->start[k + 1] - f->start[k];
    operations += entries * (entries + 2);
  }
  return (dvi__linear_cost){(double)f->start[A->columns] + A->columns, operations};
}

const dvi__factor_kind dvi__definite_factor = {.name = "sparse LDL^T (LDL)",
                                               .scale_free = 1,
                                               .create = ldl_create,
                                               .destroy = ldl_destroy,
                                               .refactor = ldl_factor,
                                               .solve = ldl_solve,
                                               .sign = ldl_sign,
                                               .is_definite = ldl_is_definite,
                                               .condition = ldl_condition,
                                               .cost = ldl_cost};
