#include "field/multisymplectic/solver.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/algebra/definite.h"

/* Residuals of conjugate gradients, for solutions with all digits, and in Newton's iteration. */
static const double roundoff = 1e-15, part_of_a_step = 1e-5;

static dvi_status make_iteration(const dvi__pattern *pattern, dvi__lattice_solver *solver)
{
  solver->start = DVI_NEW(int64_t, pattern->columns + 1);
  solver->work = DVI_NEW(double, 6 * (size_t)pattern->columns);
  if (solver->start == NULL || solver->work == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for %d unknowns", pattern->columns);
  for (int i = 0; i <= pattern->columns; i++) solver->start[i] = pattern->start[i];
  solver->rows = (dvi_matrix){.rows = pattern->rows,
                              .columns = pattern->columns,
                              .symmetric = 1,
                              .start = solver->start,
                              .column = pattern->row,
                              .value = solver->values};
  return DVI_OK;
}

dvi_status dvi__lattice_solver_make(const dvi__lattice_solver_terms *terms,
                                    dvi__lattice_solver *solver)
{
  const dvi__pattern *pattern = terms->pattern;
  const int is_diagonal = dvi__pattern_entries(pattern) == pattern->columns,
            iterates = dvi__definite_iterates(pattern->columns, terms->axes);
  *solver = (dvi__lattice_solver){.tolerance = terms->is_exact ? roundoff : part_of_a_step};
  solver->values = DVI_NEW(double, dvi__pattern_entries(pattern));
  if (solver->values == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for a matrix of %d unknowns",
                     pattern->columns);
  if (terms->is_symmetric && !is_diagonal && iterates) return make_iteration(pattern, solver);
  return dvi__linear_create(pattern,
                            terms->is_symmetric ? DVI__LINEAR_DEFINITE : DVI__LINEAR_SPARSE, NULL,
                            &solver->factor);
}

void dvi__lattice_solver_clear(dvi__lattice_solver *solver)
{
  dvi__linear_destroy(&solver->factor);
  dvi__release(solver->start);
  dvi__release(solver->values);
  dvi__release(solver->work);
  *solver = (dvi__lattice_solver){0};
}

dvi_status dvi__lattice_solver_renew(dvi__lattice_solver *solver)
{
  const dvi_matrix *A = &solver->rows;
  if (solver->factor != NULL) return dvi__linear_factor(solver->factor, solver->values);
  for (int64_t i = 0; i < A->rows; i++)
    for (int64_t e = A->start[i]; e < A->start[i + 1]; e++)
      if (A->column[e] == i && !(A->value[e] > 0))
        return dvi__fail(DVI_SINGULAR, "matrix: entry %lld of the diagonal is %g, not positive",
                         (long long)i, A->value[e]);
  return DVI_OK;
}

dvi_status dvi__lattice_solver_solve(dvi__lattice_solver *solver, double *b)
{
  const size_t n = (size_t)solver->rows.rows;
  if (solver->factor != NULL) return dvi__linear_solve(solver->factor, b);
  dvi__products products = dvi__products_of(&solver->rows);
  products.work = solver->work;
  DVI_TRY(dvi__conjugate_gradients(&products, solver->tolerance, b, solver->work + 5 * n, NULL));
  memcpy(b, solver->work + 5 * n, n * sizeof *b);
  return DVI_OK;
}
