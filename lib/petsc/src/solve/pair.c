#include "pair.h"

#include <math.h>

#include "vector.h"

/* ---- the Jacobian ---- */

PetscErrorCode dvi__pair_multiply(const dvi__pair *pair, const PetscScalar *D, const PetscScalar *x,
                                  PetscScalar *y)
{
  const PetscInt own = pair->A->own;
  const PetscScalar less = 1 - pair->cosine, sine = pair->sine;
  for (int k = 0; k < 2; k++) PetscCall(dvi__operator_multiply(pair->A, x + k * own, y + k * own));
  for (PetscInt i = 0; i < own; i++) {
    const PetscInt j = own + i;
    const PetscScalar m = pair->mass[i];
    y[i] = y[i] + (D[i] - less * m) * x[i] + sine * m * x[j];
    y[j] = sine * m * x[i] - (y[j] + (D[j] - less * m) * x[j]);
  }
  return 0;
}

/* ---- the preconditioner ---- */

/* Take one cycle for each of the two numbers. */
static PetscErrorCode apply(PC pc, Vec r, Vec z)
{
  dvi__pair *pair;
  const PetscScalar *of_r;
  PetscScalar *of_z, *in;
  const PetscScalar *out;
  PetscCall(PCShellGetContext(pc, &pair));
  const PetscInt own = pair->A->own;
  PetscCall(VecGetArrayRead(r, &of_r));
  PetscCall(VecGetArray(z, &of_z));
  for (int k = 0; k < 2; k++) {
    PetscCall(VecGetArray(pair->in, &in));
    PetscCall(PetscArraycpy(in, of_r + k * own, (size_t)own));
    PetscCall(VecRestoreArray(pair->in, &in));
    PetscCall(PCApply(pair->cycle, pair->in, pair->out));
    PetscCall(VecGetArrayRead(pair->out, &out));
    PetscCall(PetscArraycpy(of_z + k * own, out, (size_t)own));
    PetscCall(VecRestoreArrayRead(pair->out, &out));
  }
  PetscCall(VecRestoreArray(z, &of_z));
  return VecRestoreArrayRead(r, &of_r);
}

/* ---- the scale of right-hand sides ---- */

/* Divide the right-hand side by a power of two near the size of the solution. */
static PetscErrorCode scale_down(KSP ksp, Vec b, Vec x, void *user)
{
  dvi__pair *pair = user;
  const PetscInt own = pair->A->own;
  const PetscScalar *numbers;
  PetscReal most = 0;
  int exponent = 0;
  (void)ksp, (void)x;
  PetscCall(VecGetArrayRead(b, &numbers));
  for (PetscInt i = 0; i < 2 * own; i++)
    most = fmax(most, fabs(numbers[i] / pair->diagonal[i % own]));
  PetscCall(VecRestoreArrayRead(b, &numbers));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, pair->A->comm));
  if (isfinite(most)) (void)frexp(most, &exponent);
  pair->scale = ldexp(1, exponent);
  return VecScale(b, 1 / pair->scale);
}

static PetscErrorCode scale_up(KSP ksp, Vec b, Vec x, void *user)
{
  dvi__pair *pair = user;
  (void)ksp;
  PetscCall(VecScale(b, pair->scale));
  PetscCall(VecScale(x, pair->scale));
  pair->scale = 1;
  return 0;
}

PetscErrorCode dvi__pair_use(dvi__pair *pair, KSP ksp)
{
  PC pc;
  PetscCall(KSPSetPreSolve(ksp, scale_down, pair));
  PetscCall(KSPSetPostSolve(ksp, scale_up, pair));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, pair));
  return PCShellSetApply(pc, apply);
}

/* ---- create ---- */

PetscErrorCode dvi__pair_create(dvi__operator *A, dvi__multigrid *multigrid,
                                const dvi__elliptic *equations, const PetscInt *place,
                                dvi__pair *pair)
{
  const dvi__elliptic *e = equations;
  const size_t own = (size_t)A->own;
  *pair = (dvi__pair){.A = A, .cosine = e->cosine, .sine = e->sine, .scale = 1};
  PetscCall(PetscMalloc2(own, &pair->mass, own, &pair->diagonal));
  for (int64_t i = 0; i < e->unknowns; i++)
    if (place[i] < A->own) pair->mass[place[i]] = e->mass[i];
  for (PetscInt i = 0; i < A->own; i++) pair->diagonal[i] = dvi__operator_entry(A, i, i);
  PetscCall(dvi__vector_create(A->comm, A->own, &pair->in));
  PetscCall(VecDuplicate(pair->in, &pair->out));
  PetscCall(dvi__operator_show(A, &pair->shown));
  PetscCall(PCCreate(A->comm, &pair->cycle));
  PetscCall(PCSetOperators(pair->cycle, pair->shown, pair->shown));
  return dvi__multigrid_use(multigrid, pair->cycle);
}

PetscErrorCode dvi__pair_clear(dvi__pair *pair)
{
  PetscCall(PCDestroy(&pair->cycle));
  PetscCall(MatDestroy(&pair->shown));
  PetscCall(VecDestroy(&pair->in));
  PetscCall(VecDestroy(&pair->out));
  return PetscFree2(pair->mass, pair->diagonal);
}
