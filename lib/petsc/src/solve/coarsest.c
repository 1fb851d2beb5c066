#include "coarsest.h"

#include <math.h>

/* The part of an entry of the diagonal below which its pivot is only rounding. */
static const double vanishing = 0x1p-26;

/* Find how the processes' unknowns, one process after the other, follow by their numbers. */
static PetscErrorCode find_order(dvi__coarsest *made)
{
  const dvi__operator *A = made->A;
  PetscMPIInt ranks, rank, own = (PetscMPIInt)A->rows;
  PetscInt *number, *place;
  PetscCallMPI(MPI_Comm_size(A->comm, &ranks));
  PetscCallMPI(MPI_Comm_rank(A->comm, &rank));
  PetscCall(PetscMalloc2((size_t)ranks, &made->counts, (size_t)ranks, &made->offsets));
  PetscCallMPI(MPI_Allgather(&own, 1, MPI_INT, made->counts, 1, MPI_INT, A->comm));
  for (PetscMPIInt r = 0; r < ranks; r++) {
    made->offsets[r] = (PetscMPIInt)made->total;
    made->total += made->counts[r];
  }
  made->first = made->offsets[rank];
  const size_t total = (size_t)made->total;
  PetscCall(PetscMalloc1(total, &made->order));
  PetscCall(PetscMalloc2(total, &number, total, &place));
  PetscCallMPI(MPI_Allgatherv(A->number, own, MPIU_INT, number, made->counts, made->offsets,
                              MPIU_INT, A->comm));
  for (PetscInt i = 0; i < made->total; i++) place[i] = i;
  PetscCall(PetscSortIntWithArray(made->total, number, place));
  for (PetscInt i = 0; i < made->total; i++) made->order[place[i]] = i;
  return PetscFree2(number, place);
}

/* Put the matrix together. Each entry is one process's, and the others add 0. */
static PetscErrorCode gather(dvi__coarsest *made)
{
  const dvi__operator *A = made->A;
  const PetscInt n = made->total;
  for (PetscInt i = 0; i < A->rows; i++)
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++)
      made->factor[made->order[A->index[i]] * n + made->order[A->index[A->column[e]]]] =
          A->value[e];
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, made->factor, (int)(n * n), MPIU_SCALAR, MPI_SUM, A->comm));
  return 0;
}

/* Replace the lower triangle by Cholesky's factor. A pivot that is left out is infinite. */
static void factorize(PetscInt n, PetscScalar *L)
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscScalar diagonal = L[i * n + i];
    for (PetscInt k = 0; k <= i; k++) {
      PetscScalar sum = L[i * n + k];
      for (PetscInt m = 0; m < k; m++) sum -= L[i * n + m] * L[k * n + m];
      if (k < i)
        L[i * n + k] = sum / L[k * n + k];
      else
        L[i * n + i] = sum > vanishing * diagonal ? sqrt(sum) : (PetscScalar)INFINITY;
    }
  }
}

PetscErrorCode dvi__coarsest_create(const dvi__operator *A, dvi__coarsest *made)
{
  *made = (dvi__coarsest){.A = A};
  PetscCall(find_order(made));
  const size_t total = (size_t)made->total;
  PetscCall(PetscCalloc1(total * total, &made->factor));
  PetscCall(PetscMalloc2(total, &made->x, total, &made->all));
  PetscCall(gather(made));
  factorize(made->total, made->factor);
  return 0;
}

PetscErrorCode dvi__coarsest_solve(dvi__coarsest *c, const PetscScalar *b, PetscScalar *x)
{
  const PetscInt n = c->total;
  const PetscScalar *L = c->factor;
  PetscScalar *y = c->x;
  PetscCallMPI(MPI_Allgatherv(b, (PetscMPIInt)c->A->rows, MPIU_SCALAR, c->all, c->counts,
                              c->offsets, MPIU_SCALAR, c->A->comm));
  for (PetscInt i = 0; i < n; i++) y[c->order[i]] = c->all[i];
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt k = 0; k < i; k++) y[i] -= L[i * n + k] * y[k];
    y[i] /= L[i * n + i];
  }
  for (PetscInt i = n - 1; i >= 0; i--) {
    y[i] /= L[i * n + i];
    for (PetscInt k = 0; k < i; k++) y[k] -= L[i * n + k] * y[i];
  }
  for (PetscInt i = 0; i < c->A->rows; i++) x[i] = y[c->order[c->first + i]];
  return 0;
}

PetscErrorCode dvi__coarsest_clear(dvi__coarsest *made)
{
  PetscCall(PetscFree2(made->counts, made->offsets));
  PetscCall(PetscFree(made->order));
  PetscCall(PetscFree(made->factor));
  return PetscFree2(made->x, made->all);
}
