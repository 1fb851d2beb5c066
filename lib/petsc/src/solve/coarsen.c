/* Smoothed aggregation: P = (I - omega D^-1 A) P_0, where a column of P_0 is 1 on the unknowns of
 * an aggregate (Vanek, Mandel and Brezina 1996). A row of P is computed by the owner of the
 * unknown. */
#include "coarsen.h"

#include <math.h>

#include "aggregate.h"

PetscErrorCode dvi__bound_of_jacobi(const dvi__operator *A, PetscReal *bound)
{
  *bound = 0;
  for (PetscInt i = 0; i < A->rows; i++) {
    PetscReal sum = 0;
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++) sum += fabs(A->value[e]);
    *bound = fmax(*bound, sum / dvi__operator_entry(A, i, i));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bound, 1, MPIU_REAL, MPI_MAX, A->comm));
  return 0;
}

/* Add to the entry of an aggregate in a row with `count` entries. Returns how many it has then. */
static PetscInt add(PetscInt *aggregate, PetscScalar *weight, PetscInt count, PetscInt which,
                    PetscScalar term)
{
  for (PetscInt k = 0; k < count; k++) {
    if (aggregate[k] != which) continue;
    weight[k] += term;
    return count;
  }
  aggregate[count] = which;
  weight[count] = term;
  return count + 1;
}

/* What a row of P is made of. */
typedef struct work {
  const dvi__operator *A;
  const dvi__aggregates *aggregates;
  PetscReal omega;
} work;

/* Give row i of P, and how many entries it has. */
static PetscInt make_row(const work *w, PetscInt i, PetscInt *aggregate, PetscScalar *weight)
{
  const dvi__operator *A = w->A;
  const PetscInt *of = w->aggregates->index;
  PetscInt count = 0;
  if (of[i] >= 0) count = add(aggregate, weight, count, of[i], 1);
  for (PetscInt e = A->start[i]; e < A->start[i + 1] && of[i] >= 0; e++) {
    const PetscInt j = A->column[e];
    if (of[j] < 0) continue;
    count = add(aggregate, weight, count, of[j],
                -w->omega * A->value[e] / w->aggregates->square[i]);
  }
  return count;
}

/* Make own rows of P, and take those of ghosts from their owners. */
static PetscErrorCode make_rows(const work *w, dvi__rows *made)
{
  const dvi__operator *A = w->A;
  PetscInt longest = 1, width = 1, *aggregate;
  PetscScalar *weight;
  for (PetscInt i = 0; i < A->rows; i++) longest = PetscMax(longest, A->start[i + 1] - A->start[i]);
  PetscCall(PetscMalloc2((size_t)longest + 1, &aggregate, (size_t)longest + 1, &weight));
  for (PetscInt i = 0; i < A->rows; i++) width = PetscMax(width, make_row(w, i, aggregate, weight));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &width, 1, MPIU_INT, MPI_MAX, A->comm));
  PetscCall(dvi__rows_allocate(A, w->aggregates->own, width, made));
  for (PetscInt i = 0; i < A->rows; i++) {
    const size_t count = (size_t)make_row(w, i, aggregate, weight),
                 place = (size_t)i * (size_t)width;
    PetscCall(PetscArraycpy(made->column + place, aggregate, count));
    PetscCall(PetscArraycpy(made->weight + place, weight, count));
  }
  PetscCall(PetscFree2(aggregate, weight));
  return dvi__rows_tell(A, made);
}

/* Numbers of own aggregates are those of their roots, and the diagonal is near theirs. */
static PetscErrorCode make(const work *w, dvi__rows *rows, dvi__coarser *made)
{
  const dvi__aggregates *g = w->aggregates;
  PetscReal *square;
  PetscCall(make_rows(w, rows));
  PetscCall(PetscMalloc1((size_t)g->own, &square));
  for (PetscInt k = 0; k < g->own; k++) {
    rows->number[k] = w->A->number[g->root[k]];
    square[k] = g->square[g->root[k]];
  }
  PetscCall(dvi__product(w->A, rows, square, made));
  return PetscFree(square);
}

PetscErrorCode dvi__coarsen(const dvi__operator *A, PetscReal bound, dvi__coarser *made)
{
  dvi__aggregates aggregates = {0};
  dvi__rows rows = {0};
  PetscInt total = A->rows;
  const work w = {.A = A, .aggregates = &aggregates, .omega = 4 / (3 * bound)};
  *made = (dvi__coarser){.total = 0};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_INT, MPI_SUM, A->comm));
  PetscCall(dvi__aggregate(A, &aggregates));
  made->total = aggregates.total;
  if (made->total > 0 && made->total <= total / 2) PetscCall(make(&w, &rows, made));
  PetscCall(dvi__rows_clear(&rows));
  return dvi__aggregates_clear(&aggregates);
}
