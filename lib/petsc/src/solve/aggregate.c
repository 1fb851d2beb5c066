#include "aggregate.h"

#include <math.h>

/* Couplings a_ij below this part of sqrt(a_ii a_jj) are weak (Vanek, Mandel and Brezina 1996). */
static const double weak = 0.02;

/* What is known of an unknown: it is a root, has one nearby, or has a key that decides. Keys are
 * from 1 to 2^32. */
static const double is_root = 0x1p40, is_near = 0;

/* The work on one matrix. */
typedef struct work {
  const dvi__operator *A;
  const PetscReal *square;
  PetscReal *key, *most, *most_of_all; /* [columns] */
} work;

static int is_strong(const work *w, PetscInt row, PetscInt e)
{
  const PetscInt j = w->A->column[e];
  const double a = w->A->value[e];
  return j != row && a * a > weak * weak * w->square[row] * w->square[j];
}

/* Numbers from 0 to 2^32 - 1 in disorder, each of which occurs once (the end of MurmurHash3). */
static double mix(PetscInt number)
{
  uint32_t h = (uint32_t)number;
  h = (h ^ h >> 16) * UINT32_C(0x85ebca6b);
  h = (h ^ h >> 13) * UINT32_C(0xc2b2ae35);
  return h ^ h >> 16;
}

static int has_strong(const work *w, PetscInt row)
{
  for (PetscInt e = w->A->start[row]; e < w->A->start[row + 1]; e++)
    if (is_strong(w, row, e)) return 1;
  return 0;
}

/* Set `most` to the largest key of each unknown and its strong neighbours, with ghosts. */
static PetscErrorCode spread(const work *w, const PetscReal *key, PetscReal *most)
{
  const dvi__operator *A = w->A;
  for (PetscInt i = 0; i < A->rows; i++) {
    most[i] = key[i];
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++)
      if (is_strong(w, i, e)) most[i] = fmax(most[i], key[A->column[e]]);
  }
  return dvi__operator_refresh(A, MPIU_REAL, most);
}

/* Find roots: unknowns with the largest key of all that are two steps away or less. */
static PetscErrorCode find_roots(const work *w)
{
  const dvi__operator *A = w->A;
  PetscInt left = 1;
  for (PetscInt i = 0; i < A->rows; i++)
    w->key[i] = has_strong(w, i) ? 1 + mix(A->number[i]) : is_near;
  PetscCall(dvi__operator_refresh(A, MPIU_REAL, w->key));
  while (left > 0) {
    left = 0;
    PetscCall(spread(w, w->key, w->most));
    PetscCall(spread(w, w->most, w->most_of_all));
    for (PetscInt i = 0; i < A->rows; i++) {
      if (w->key[i] == is_root || w->key[i] == is_near) continue;
      if (w->most_of_all[i] == w->key[i])
        w->key[i] = is_root;
      else if (w->most_of_all[i] == is_root)
        w->key[i] = is_near;
      else
        left++;
    }
    PetscCall(dvi__operator_refresh(A, MPIU_REAL, w->key));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &left, 1, MPIU_INT, MPI_SUM, A->comm));
  }
  return 0;
}

/* ---- members ---- */

/* Number the roots, one process after the other. */
static PetscErrorCode number_roots(const work *w, dvi__aggregates *made)
{
  const dvi__operator *A = w->A;
  PetscInt first = 0;
  PetscMPIInt rank;
  for (PetscInt i = 0; i < A->rows; i++) made->own += w->key[i] == is_root;
  PetscCall(PetscMalloc1((size_t)made->own, &made->root));
  PetscCallMPI(MPI_Comm_rank(A->comm, &rank));
  PetscCallMPI(MPI_Exscan(&made->own, &first, 1, MPIU_INT, MPI_SUM, A->comm));
  PetscCallMPI(MPI_Allreduce(&made->own, &made->total, 1, MPIU_INT, MPI_SUM, A->comm));
  PetscInt next = 0;
  for (PetscInt i = 0; i < A->rows; i++) {
    made->index[i] = -1;
    if (w->key[i] != is_root) continue;
    made->root[next] = i;
    made->index[i] = (rank > 0 ? first : 0) + next++;
  }
  return dvi__operator_refresh(A, MPIU_INT, made->index);
}

/* Let unknowns without an aggregate join that of their strongest neighbour that has one. `before`
 * [columns] is the index before. */
static PetscErrorCode join(const work *w, PetscInt *before, dvi__aggregates *made)
{
  const dvi__operator *A = w->A;
  PetscCall(PetscArraycpy(before, made->index, (size_t)A->columns));
  for (PetscInt i = 0; i < A->rows; i++) {
    double strongest = 0;
    for (PetscInt e = A->start[i]; e < A->start[i + 1] && before[i] < 0; e++) {
      const PetscInt j = A->column[e];
      const double strength = A->value[e] * A->value[e] / w->square[j];
      if (!is_strong(w, i, e) || before[j] < 0 || !(strength > strongest)) continue;
      strongest = strength;
      made->index[i] = before[j];
    }
  }
  return dvi__operator_refresh(A, MPIU_INT, made->index);
}

PetscErrorCode dvi__aggregate(const dvi__operator *A, dvi__aggregates *made)
{
  const size_t count = (size_t)A->columns;
  work w = {.A = A};
  PetscInt *before;
  *made = (dvi__aggregates){.own = 0};
  PetscCall(PetscMalloc2(count, &made->index, count, &made->square));
  PetscCall(PetscMalloc4(count, &w.key, count, &w.most, count, &w.most_of_all, count, &before));
  for (PetscInt i = 0; i < A->rows; i++) made->square[i] = dvi__operator_entry(A, i, i);
  PetscCall(dvi__operator_refresh(A, MPIU_REAL, made->square));
  w.square = made->square;
  PetscCall(find_roots(&w));
  PetscCall(number_roots(&w, made));
  for (int pass = 0; pass < 2; pass++) PetscCall(join(&w, before, made));
  return PetscFree4(w.key, w.most, w.most_of_all, before);
}

PetscErrorCode dvi__aggregates_clear(dvi__aggregates *made)
{
  PetscCall(PetscFree(made->root));
  return PetscFree2(made->index, made->square);
}
