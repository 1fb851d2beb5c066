#include "scale.h"

#include <math.h>

/* The largest and smallest exponents of a factor whose reciprocal is a normal number, too. */
enum { LARGEST = 1021 };

/* Find the power of two from which no number of the right-hand side, over the diagonal, is far. */
static PetscErrorCode find_factor(dvi__scale *scale, Vec b)
{
  const PetscScalar *numbers;
  PetscReal most = 0;
  PetscInt rows;
  int exponent = 0;
  PetscCall(VecGetLocalSize(b, &rows));
  PetscCall(VecGetArrayRead(b, &numbers));
  for (PetscInt i = 0; i < rows; i++)
    most = fmax(most, fabs(numbers[i] / scale->diagonal[i % scale->own]));
  PetscCall(VecRestoreArrayRead(b, &numbers));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, scale->comm));
  if (isfinite(most)) (void)frexp(most, &exponent);
  scale->factor = ldexp(1, PetscMax(-LARGEST, PetscMin(exponent, LARGEST)));
  return 0;
}

static PetscErrorCode scale_down(KSP ksp, Vec b, Vec x, void *user)
{
  dvi__scale *scale = user;
  (void)ksp, (void)x;
  PetscCall(find_factor(scale, b));
  return VecScale(b, 1 / scale->factor);
}

static PetscErrorCode scale_up(KSP ksp, Vec b, Vec x, void *user)
{
  dvi__scale *scale = user;
  (void)ksp;
  PetscCall(VecScale(b, scale->factor));
  PetscCall(VecScale(x, scale->factor));
  scale->factor = 1;
  return 0;
}

PetscErrorCode dvi__scale_use(dvi__scale *scale, KSP ksp)
{
  PetscCall(KSPSetPreSolve(ksp, scale_down, scale));
  return KSPSetPostSolve(ksp, scale_up, scale);
}

PetscErrorCode dvi__scale_create(const dvi__operator *A, dvi__scale *scale)
{
  *scale = (dvi__scale){.comm = A->comm, .own = A->own, .factor = 1};
  PetscCall(PetscMalloc1((size_t)A->own, &scale->diagonal));
  for (PetscInt i = 0; i < A->own; i++) scale->diagonal[i] = dvi__operator_entry(A, i, i);
  return 0;
}

PetscErrorCode dvi__scale_clear(dvi__scale *scale)
{
  return PetscFree(scale->diagonal);
}
