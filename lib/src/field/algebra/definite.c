#include "field/algebra/definite.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* Largest numbers of unknowns for a factor. The factor of a mesh grows as n log n in two dimensions
 * and as n^(4/3) in three, its operations as n^(3/2) and n^2. */
enum { MOST_IN_PLANE = 1000000, MOST_IN_SPACE = 15000 };

static const double roundoff = 1e-15;

void dvi__definite_clear(dvi__definite *solver)
{
  dvi__linear_destroy(&solver->factor);
  dvi__release(solver->pattern.start);
  dvi__csr_clear(&solver->matrix);
  *solver = (dvi__definite){0};
}

/* The matrix is symmetric: its rows are its columns. */
static dvi_status lay_out_pattern(dvi__definite *solver)
{
  const dvi__csr *A = &solver->matrix;
  if (A->start[A->rows] > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "matrix: an int cannot count %lld entries of a factor",
                     (long long)A->start[A->rows]);
  solver->pattern = (dvi__pattern){.rows = (int)A->rows,
                                   .columns = (int)A->columns,
                                   .start = DVI_NEW(int, A->rows + 1),
                                   .row = A->column};
  if (solver->pattern.start == NULL) return dvi__fail(DVI_NO_MEMORY, "matrix: no memory");
  for (int64_t i = 0; i <= A->rows; i++) solver->pattern.start[i] = (int)A->start[i];
  return DVI_OK;
}

static dvi_status make_factor(dvi__definite *solver, dvi__linear_kind kind)
{
  DVI_TRY(lay_out_pattern(solver));
  DVI_TRY(dvi__linear_create(&solver->pattern, kind, NULL, &solver->factor));
  return dvi__linear_factor(solver->factor, solver->matrix.value);
}

static dvi_status check_diagonal(const dvi__csr *A)
{
  for (int64_t i = 0; i < A->rows; i++) {
    const int64_t at = dvi__csr_find(A, i, (int)i);
    if (at < 0 || !(A->value[at] > 0))
      return dvi__fail(DVI_SINGULAR, "matrix: entry %lld of the diagonal is %g, not positive",
                       (long long)i, at < 0 ? 0.0 : A->value[at]);
  }
  return DVI_OK;
}

static dvi_status keep(dvi_status status, dvi__definite *solver)
{
  if (status != DVI_OK) dvi__definite_clear(solver);
  return status;
}

int dvi__definite_iterates(int64_t rows, int dimension)
{
  return rows > (dimension > 2 ? MOST_IN_SPACE : MOST_IN_PLANE);
}

dvi_status dvi__definite_create(const dvi_matrix *A, int dimension, dvi__definite *solver)
{
  *solver = (dvi__definite){.is_diagonal = A->column == NULL};
  DVI_TRY(dvi__csr_copy(A, &solver->matrix));
  dvi_status status = check_diagonal(&solver->matrix);
  if (status == DVI_OK && !dvi__definite_iterates(A->rows, dimension) && !solver->is_diagonal)
    status = make_factor(solver, DVI__LINEAR_DEFINITE);
  return keep(status, solver);
}

dvi_status dvi__regular_create(const dvi_matrix *A, dvi__definite *solver)
{
  *solver = (dvi__definite){0};
  DVI_TRY(dvi__csr_copy(A, &solver->matrix));
  return keep(make_factor(solver, DVI__LINEAR_SPARSE), solver);
}

static dvi_status times(void *of, const double *x, double *y)
{
  const dvi_matrix A = dvi__csr_view(&((const dvi__definite *)of)->matrix, 1);
  dvi_matrix_multiply(&A, 0, x, y);
  return DVI_OK;
}

static void precondition(void *of, const double *r, double *z)
{
  const dvi__definite *solver = of;
  const dvi_matrix A = dvi__csr_view(&solver->matrix, 1);
  dvi__gauss_seidel(&A, r, z);
  if (solver->correct != NULL) solver->correct(solver->of, solver->weight, r, z);
}

dvi_status dvi__definite_solve(const dvi__definite *solver, const double *b, double *x,
                               dvi__iteration_report *report)
{
  const dvi_matrix A = dvi__csr_view(&solver->matrix, 1);
  if (report != NULL) *report = (dvi__iteration_report){0};
  if (solver->is_diagonal) {
    for (int64_t i = 0; i < A.rows; i++) x[i] = b[i] / A.value[i];
    return DVI_OK;
  }
  if (solver->factor == NULL) {
    const dvi__products products = {
        .size = A.rows, .times = times, .precondition = precondition, .of = (void *)solver};
    return dvi__conjugate_gradients(&products, solver->tolerance > 0 ? solver->tolerance : roundoff,
                                    b, x, report);
  }
  memcpy(x, b, (size_t)A.rows * sizeof *x);
  return dvi__linear_solve(solver->factor, x);
}
