/* A sparse factor A = P^T L D L^T P of a positive definite matrix, without exchanges, which it does
 * not need. Columns are ordered by approximate minimum degree. SuiteSparse's LDL and AMD, once
 * analysed, take no memory from the heap. Where L has many operations for each entry, the columns
 * are taken in dense blocks. Source: Davis 2005 (Algorithm 849).
 *
 * Seconds of a factor and of a solution for the lumped bilinear waves of imex, on one core, with
 * Debian 12's SuiteSparse 5.12 and its reference BLAS (METIS does no better than AMD there):
 *
 *     net, unknowns                 KLU           CHOLMOD           LDL          supernodes
 *     316 x 316, n =  99 856        1.2, 0.025    0.47, 0.015       0.47, 0.013  0.13, 0.010
 *     1000 x 1000, n = 1 000 000    44, 0.31      15, 0.22          22, 0.20     4.1, 0.13
 */
#include <amd.h>
#include <ldl.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"
#include "num/supernodal/supernodes.h"

/* Operations for each entry of L beyond which dense blocks are faster. */
enum { DENSE_FROM = 40 };

typedef struct definite {
  int *order, *place;                   /* [n] permutation and its inverse */
  int *parent, *length, *flag, *column; /* [n] elimination tree and work */
  int *diagonal;                        /* [n] entries of the matrix on its diagonal, in order */
  int *start, *row;                     /* pattern of L */
  double *L, *D;
  double *y;               /* [2 n] work of solutions */
  dvi__supernodes *blocks; /* NULL, or what stands for `row` and L */
  double condition;
  int is_shared; /* all but y belongs to another factor */
} definite;

static void ldl_destroy(void *factor)
{
  definite *f = factor;
  if (f == NULL) return;
  dvi__release(f->y);
  if (f->is_shared) {
    dvi__release(f);
    return;
  }
  dvi__release(f->order);
  dvi__release(f->row);
  dvi__release(f->L);
  dvi__release(f->D);
  dvi__supernodes_destroy(&f->blocks);
  dvi__release(f);
}

static dvi_status refuse_memory(int n)
{
  return dvi__fail(DVI_NO_MEMORY, "LDL: no memory for %d columns", n);
}

static dvi_status ldl_lay_out(definite *f, size_t n)
{
  int *at = f->order = DVI_NEW(int, 8 * n + 1);
  f->D = DVI_NEW(double, n);
  f->y = DVI_NEW(double, 2 * n);
  if (at == NULL || f->D == NULL || f->y == NULL) return refuse_memory((int)n);
  f->place = at + n;
  f->parent = at + 2 * n;
  f->length = at + 3 * n;
  f->flag = at + 4 * n;
  f->column = at + 5 * n;
  f->diagonal = at + 6 * n;
  f->start = at + 7 * n;
  return DVI_OK;
}

/* Column k of L with its c entries takes c (c + 1) multiplications and additions each. */
static double count_operations(const definite *f, int n)
{
  double operations = 0;
  for (int k = 0; k < n; k++) operations += f->length[k] * (f->length[k] + 2.0);
  return operations;
}

static void count_columns(definite *f, const dvi__pattern *A)
{
  ldl_symbolic(A->columns, A->start, A->row, f->start, f->parent, f->length, f->flag, f->order,
               f->place);
}

/* Blocks need a postorder. It changes no entry of L but their order. */
static dvi_status make_blocks(definite *f, const dvi__pattern *A)
{
  const int n = A->columns;
  int *work = DVI_NEW(int, 4 * (size_t)n);
  if (work == NULL) return refuse_memory(n);
  int *const order = work + 3 * (size_t)n;
  dvi__elimination_postorder(n, f->parent, order, work);
  for (int k = 0; k < n; k++) work[k] = f->order[order[k]];
  memcpy(f->order, work, (size_t)n * sizeof *work);
  dvi__release(work);
  count_columns(f, A);
  const dvi__elimination e = {n, A->start, A->row, f->order, f->place, f->parent, f->length};
  return dvi__supernodes_create(&e, &f->blocks);
}

static dvi_status make_columns(definite *f, int n)
{
  f->row = DVI_NEW(int, f->start[n]);
  f->L = DVI_NEW(double, f->start[n]);
  return f->start[n] > 0 && (f->row == NULL || f->L == NULL) ? refuse_memory(n) : DVI_OK;
}

dvi_status dvi__definite_order(const dvi__pattern *A, int *order)
{
  const int n = A->columns;
  return amd_order(n, A->start, A->row, order, NULL, NULL) == AMD_OK ? DVI_OK : refuse_memory(n);
}

static dvi_status ldl_analyse(definite *f, const dvi__pattern *A)
{
  const int n = A->columns;
  DVI_TRY(ldl_lay_out(f, (size_t)n));
  DVI_TRY(dvi__definite_order(A, f->order));
  count_columns(f, A);
  DVI_TRY(count_operations(f, n) > DENSE_FROM * (double)f->start[n] ? make_blocks(f, A)
                                                                    : make_columns(f, n));
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

dvi_status dvi__definite_share(const void *factored, const dvi__pattern *pattern, void **factor)
{
  definite *f = *factor = DVI_NEW(definite, 1);
  if (f == NULL) return refuse_memory(pattern->columns);
  *f = *(const definite *)factored;
  f->is_shared = 1;
  f->y = DVI_NEW(double, 2 * (size_t)pattern->columns);
  if (f->y != NULL) return DVI_OK;
  ldl_destroy(f);
  *factor = NULL;
  return refuse_memory(pattern->columns);
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
  const int done = f->blocks != NULL ? dvi__supernodes_factor(f->blocks, values, f->D)
                                     : ldl_numeric(n, A->start, A->row, entries, f->start,
                                                   f->parent, f->length, f->row, f->L, f->D, f->y,
                                                   f->column, f->flag, f->order, f->place);
  f->condition = done == n ? find_condition(f, n, values) : 0;
  if (f->condition >= DVI__LEAST_RCOND) return DVI_OK;
  return dvi__fail(DVI_SINGULAR, "LDL: the %d x %d matrix is not positive definite", n, n);
}

static dvi_status ldl_solve(void *factor, const dvi__pattern *A, double *b)
{
  definite *f = factor;
  const int n = A->columns;
  ldl_perm(n, f->y, b, f->order);
  if (f->blocks != NULL) {
    dvi__supernodes_solve(f->blocks, f->D, f->y, f->y + n);
  } else {
    ldl_lsolve(n, f->y, f->start, f->row, f->L);
    ldl_dsolve(n, f->y, f->D);
    ldl_ltsolve(n, f->y, f->start, f->row, f->L);
  }
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

static dvi__linear_cost ldl_cost(const void *factor, const dvi__pattern *A)
{
  const definite *f = factor;
  const double entries = f->blocks != NULL ? dvi__supernodes_entries(f->blocks)
                                           : (double)f->start[A->columns];
  return (dvi__linear_cost){entries + A->columns, count_operations(f, A->columns)};
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
