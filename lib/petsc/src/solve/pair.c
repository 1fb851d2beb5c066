#include "pair.h"

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

PetscErrorCode dvi__pair_use(dvi__pair *pair, KSP ksp)
{
  PC pc;
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
  *pair = (dvi__pair){.A = A, .cosine = e->cosine, .sine = e->sine};
  PetscCall(PetscMalloc1(own, &pair->mass));
  for (int64_t i = 0; i < e->unknowns; i++)
    if (place[i] < A->own) pair->mass[place[i]] = e->mass[i];
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
  return PetscFree(pair->mass);
}
