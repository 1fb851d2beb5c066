#include "vector.h"

#include <math.h>

/* The table of a vector's operations has no public names beyond a few (VecSetOperation). */
#include <petsc/private/vecimpl.h>

/* ---- sums over all processes ---- */

PetscErrorCode dvi__sum_of_world(MPI_Comm comm, dvi__accumulator *sum, PetscScalar *value)
{
  dvi__accumulator_carry(sum);
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, sum->number, DVI__SUM_NUMBERS, MPI_INT64_T, MPI_SUM, comm));
  *value = dvi__accumulator_value(sum);
  return 0;
}

static PetscErrorCode dot(Vec x, Vec y, PetscScalar *value)
{
  const PetscScalar *a, *b;
  dvi__accumulator sum = {.terms = 0};
  PetscCall(VecGetArrayRead(x, &a));
  PetscCall(VecGetArrayRead(y, &b));
  dvi__accumulate_products(&sum, x->map->n, a, b, NULL);
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCall(VecRestoreArrayRead(y, &b));
  return dvi__sum_of_world(PetscObjectComm((PetscObject)x), &sum, value);
}

static PetscErrorCode dots(Vec x, PetscInt count, const Vec y[], PetscScalar *value)
{
  for (PetscInt k = 0; k < count; k++) PetscCall(dot(x, y[k], value + k));
  return 0;
}

static PetscErrorCode largest(Vec x, PetscReal *value)
{
  const PetscScalar *a;
  *value = 0;
  PetscCall(VecGetArrayRead(x, &a));
  for (PetscInt i = 0; i < x->map->n; i++) *value = fabs(a[i]) > *value ? fabs(a[i]) : *value;
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE, MPI_MAX, PetscObjectComm((PetscObject)x)));
  return 0;
}

static PetscErrorCode sum_of_sizes(Vec x, PetscReal *value)
{
  const PetscScalar *a;
  dvi__accumulator sum = {.terms = 0};
  PetscCall(VecGetArrayRead(x, &a));
  for (PetscInt i = 0; i < x->map->n; i++) dvi__accumulate(&sum, fabs(a[i]));
  PetscCall(VecRestoreArrayRead(x, &a));
  return dvi__sum_of_world(PetscObjectComm((PetscObject)x), &sum, value);
}

/* Where squares vanish or overflow, take those of numbers that a power of two brings near 1. */
static PetscErrorCode norm_by_scale(Vec x, PetscReal *value)
{
  const PetscScalar *a;
  PetscReal most;
  int exponent;
  dvi__accumulator sum = {.terms = 0};
  PetscCall(largest(x, &most));
  *value = most;
  if (most == 0 || !isfinite(most)) return 0;
  (void)frexp(most, &exponent);
  PetscCall(VecGetArrayRead(x, &a));
  for (PetscInt i = 0; i < x->map->n; i++) {
    const PetscScalar scaled = ldexp(a[i], -exponent);
    dvi__accumulate(&sum, scaled * scaled);
  }
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCall(dvi__sum_of_world(PetscObjectComm((PetscObject)x), &sum, value));
  *value = ldexp(sqrt(*value), exponent);
  return 0;
}

static PetscErrorCode norm_of_squares(Vec x, PetscReal *value)
{
  PetscCall(dot(x, x, value));
  if (*value < 0x1p-900 || isinf(*value)) return norm_by_scale(x, value);
  *value = sqrt(*value);
  return 0;
}

static PetscErrorCode norm(Vec x, NormType type, PetscReal *value)
{
  if (type == NORM_INFINITY) return largest(x, value);
  if (type == NORM_1) return sum_of_sizes(x, value);
  if (type == NORM_1_AND_2) {
    PetscCall(sum_of_sizes(x, value));
    value++;
  }
  return norm_of_squares(x, value);
}

/* ---- sums of vectors, number by number ---- */

/* w = a x + b y + c w. A factor 0 leaves its vector out, whose numbers may be none. */
typedef struct combination {
  Vec w, x, y; /* y may be NULL */
  PetscScalar a, b, c;
} combination;

static PetscErrorCode combine(const combination *of)
{
  const PetscScalar *x, *y = NULL;
  PetscScalar *w;
  const PetscInt n = of->w->map->n;
  PetscCall(VecGetArrayRead(of->x, &x));
  if (of->y != NULL) PetscCall(VecGetArrayRead(of->y, &y));
  PetscCall(VecGetArray(of->w, &w));
  for (PetscInt i = 0; i < n; i++) {
    PetscScalar sum = of->a * x[i];
    if (y != NULL) sum += of->b * y[i];
    if (of->c != 0) sum += of->c * w[i];
    w[i] = sum;
  }
  PetscCall(VecRestoreArray(of->w, &w));
  if (of->y != NULL) PetscCall(VecRestoreArrayRead(of->y, &y));
  return VecRestoreArrayRead(of->x, &x);
}

static PetscErrorCode axpy(Vec y, PetscScalar a, Vec x)
{
  return combine(&(combination){.w = y, .x = x, .a = a, .c = 1});
}

static PetscErrorCode axpby(Vec y, PetscScalar a, PetscScalar b, Vec x)
{
  return combine(&(combination){.w = y, .x = x, .a = a, .c = b});
}

static PetscErrorCode aypx(Vec y, PetscScalar b, Vec x)
{
  return combine(&(combination){.w = y, .x = x, .a = 1, .c = b});
}

static PetscErrorCode waxpy(Vec w, PetscScalar a, Vec x, Vec y)
{
  return combine(&(combination){.w = w, .x = x, .y = y, .a = a, .b = 1});
}

static PetscErrorCode axpbypcz(Vec z, PetscScalar a, PetscScalar b, PetscScalar c, Vec x, Vec y)
{
  return combine(&(combination){.w = z, .x = x, .y = y, .a = a, .b = b, .c = c});
}

static PetscErrorCode maxpy(Vec y, PetscInt count, const PetscScalar *a, Vec *x)
{
  for (PetscInt k = 0; k < count; k++) PetscCall(axpy(y, a[k], x[k]));
  return 0;
}

static PetscErrorCode scale(Vec x, PetscScalar factor)
{
  PetscScalar *a;
  PetscCall(VecGetArray(x, &a));
  for (PetscInt i = 0; i < x->map->n; i++) a[i] *= factor;
  return VecRestoreArray(x, &a);
}

/* ---- create ---- */

static PetscErrorCode duplicate_many(Vec x, PetscInt count, Vec *vectors[])
{
  PetscCall(PetscMalloc1((size_t)count, vectors));
  for (PetscInt k = 0; k < count; k++) PetscCall(VecDuplicate(x, *vectors + k));
  return 0;
}

PetscErrorCode dvi__vector_create(MPI_Comm comm, PetscInt rows, Vec *vector)
{
  PetscCall(VecCreate(comm, vector));
  PetscCall(VecSetSizes(*vector, rows, PETSC_DETERMINE));
  PetscCall(VecSetType(*vector, VECMPI));
  struct _VecOps *const ops = (*vector)->ops; /* which duplicates copy */
  ops->duplicatevecs = duplicate_many;
  ops->dot = ops->tdot = dot;
  ops->mdot = ops->mtdot = dots;
  ops->norm = norm;
  ops->scale = scale;
  ops->axpy = axpy;
  ops->axpby = axpby;
  ops->aypx = aypx;
  ops->waxpy = waxpy;
  ops->axpbypcz = axpbypcz;
  ops->maxpy = maxpy;
  return 0;
}
