/* Products with a field's matrices on the shares of MPI's processes, and of vectors, have every bit
 * of those of the whole mesh. Usage: mpirun -np N operators */
#include <dvi/field.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "num/accumulator.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include "operator.h"
#include "vector.h"

static int failures;

static void expect(int holds, const char *what)
{
  if (holds) return;
  failures++;
  (void)fprintf(stderr, "operators: %s (%s)\n", what, dvi_last_error());
}

/* Numbers that do not depend on the division. */
static double number_at(int64_t cell, int of)
{
  return sin((double)(7 * cell + 3 * of)) * exp(sin((double)cell));
}

/* Count the own unknowns whose numbers are not those of the whole mesh. */
static int64_t count_wrong(const dvi__operator *A, const double *y, const double *whole)
{
  int64_t wrong = 0;
  for (PetscInt i = 0; i < A->rows; i++)
    wrong += memcmp(y + i, whole + A->number[i], sizeof *y) != 0;
  return wrong;
}

/* Give K x of all cells. */
static void multiply_whole(const dvi_field *field, int64_t cells, double *product)
{
  int64_t n;
  dvi_matrix K;
  const int *cell = dvi_field_unknowns(field, &n);
  double *x = calloc((size_t)(2 * n), sizeof *x);
  (void)dvi_field_matrix(field, DVI_FIELD_STIFFNESS, &K);
  for (int64_t i = 0; i < n; i++) x[i] = number_at(cell[i], 0);
  dvi_matrix_multiply(&K, 0, x, x + n);
  for (int64_t c = 0; c < cells; c++) product[c] = 0;
  for (int64_t i = 0; i < n; i++) product[cell[i]] = x[n + i];
  free(x);
}

static double exact_product(int64_t cells, const double *x, const double *y)
{
  dvi__accumulator sum = {.terms = 0};
  dvi__accumulate_products(&sum, cells, x, y, NULL);
  return dvi__accumulator_value(&sum);
}

static PetscErrorCode check_operator(dvi__operator *A, int64_t cells, const double *product)
{
  Mat K;
  Vec x, y, *more;
  PetscScalar *numbers, dot, length;
  PetscCall(dvi__operator_show(A, &K));
  PetscCall(MatCreateVecs(K, &x, &y));
  PetscCall(VecGetArray(x, &numbers));
  for (PetscInt i = 0; i < A->rows; i++) numbers[i] = number_at(A->number[i], 0);
  PetscCall(VecRestoreArray(x, &numbers));
  PetscCall(MatMult(K, x, y));
  PetscCall(VecGetArray(y, &numbers));
  expect(count_wrong(A, numbers, product) == 0, "a product has other bits");
  PetscCall(VecRestoreArray(y, &numbers));
  PetscCall(VecDuplicateVecs(y, 2, &more));
  PetscCall(VecCopy(y, more[1]));
  PetscCall(VecDot(more[1], y, &dot));
  PetscCall(VecNorm(more[1], NORM_2, &length));
  expect(dot == exact_product(cells, product, product), "an inner product has other bits");
  expect(length == sqrt(dot), "a norm has other bits");
  PetscCall(VecDestroyVecs(2, &more));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  return MatDestroy(&K);
}

static void check_share(const dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh),
                        const char *partitioner)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  dvi_mesh *share;
  dvi_division *division;
  dvi_matrix K;
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division");
  dvi_field *whole = make(mesh), *field = make(share);
  const int degree = dvi_field_degree(field);
  const int64_t cells = dvi_mesh_count(mesh, degree);
  double *product = calloc((size_t)cells, sizeof *product);
  dvi__unknowns unknowns = {.share = share, .degree = degree};
  dvi__operator A = {0};
  multiply_whole(whole, cells, product);
  unknowns.cell = dvi_field_unknowns(field, &unknowns.count);
  (void)dvi_field_matrix(field, DVI_FIELD_STIFFNESS, &K);
  expect(dvi__operator_of_share(PETSC_COMM_WORLD, &unknowns, &K, &A) == 0, "no operator");
  expect(check_operator(&A, cells, product) == 0, "PETSc failed");
  (void)dvi__operator_clear(&A);
  free(product);
  dvi_field_destroy(&whole);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
}

int main(int argc, char **argv)
{
  const dvi_generator_options box = {.cells = {5, 4, 3}, .grading = {1.2, 1, 1.4}};
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  dvi_mesh *staggered = with_core_and_exit(staggered_mesh(8, 9), NULL),
           *boxes = with_core_and_exit(generated("box", box), NULL);
  check_share(staggered, driven_wave, "blocks");
  check_share(staggered, driven_wave, "ptscotch");
  check_share(boxes, cavity_field, "blocks");
  check_share(boxes, cavity_field, "ptscotch");
  dvi_mesh_destroy(&staggered);
  dvi_mesh_destroy(&boxes);
  (void)PetscFinalize();
  return failures > 0;
}
