/* Smoothed aggregation: P = (I - omega D^-1 A) P_0, where a column of P_0 is 1 on the unknowns of
 * an aggregate (Vanek, Mandel and Brezina 1996). A row of P is computed by the owner of the
 * unknown.
 *
 * An entry of P^T A P is a sum over unknowns of several processes. Its terms are brought near 1 by
 * powers of two, and rounded to multiples of 2^-38 of the largest one. Sums of up to 2^15 of them
 * are exact, so that PETSc may add them up in any order. */
#include "coarsen.h"

#include <math.h>
#include <petscsf.h>
#include <string.h>

#include "aggregate.h"

enum { PLACES = 38 };

/* What of a coarser diagonal is only rounding: the unknown is a whole component without fixed
 * values, and its equation is left out. */
static const double vanishing = 0x1p-20;

typedef struct work {
  const dvi__operator *A;
  dvi__aggregates aggregates;
  PetscInt width; /* most entries in a row of P */
  /* [columns*width] rows of P, of ghosts, too. -1 for places without an entry */
  PetscInt *aggregate;
  PetscScalar *weight;
  PetscInt count, *index;          /* aggregates in these rows: PETSc's numbers, ascending */
  PetscReal *factor;               /* [count] powers of two */
  PetscInt *exponent;              /* [own aggregates] of these */
  PetscInt *start, *place;         /* [rows+1], and columns of A P, places in `index` */
  PetscScalar *value;              /* of A P */
  PetscInt *member_start, *member; /* [count+1], and rows*width + k of the entries of P^T */
} work;

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

/* ---- P ---- */

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

/* Give row i of P, and how many entries it has. */
static PetscInt make_row(const work *w, PetscReal omega, PetscInt i, PetscInt *aggregate,
                         PetscScalar *weight)
{
  const dvi__operator *A = w->A;
  const PetscInt *of = w->aggregates.index;
  PetscInt count = 0;
  if (of[i] >= 0) count = add(aggregate, weight, count, of[i], 1);
  for (PetscInt e = A->start[i]; e < A->start[i + 1] && of[i] >= 0; e++) {
    const PetscInt j = A->column[e];
    if (of[j] < 0) continue;
    count = add(aggregate, weight, count, of[j], -omega * A->value[e] / w->aggregates.square[i]);
  }
  return count;
}

/* Take the rows of ghosts from their owners. */
static PetscErrorCode tell_rows(work *w)
{
  MPI_Datatype numbers, values;
  PetscCallMPI(MPI_Type_contiguous((int)w->width, MPIU_INT, &numbers));
  PetscCallMPI(MPI_Type_contiguous((int)w->width, MPIU_SCALAR, &values));
  PetscCallMPI(MPI_Type_commit(&numbers));
  PetscCallMPI(MPI_Type_commit(&values));
  PetscCall(dvi__operator_refresh(w->A, numbers, w->aggregate));
  PetscCall(dvi__operator_refresh(w->A, values, w->weight));
  PetscCallMPI(MPI_Type_free(&numbers));
  PetscCallMPI(MPI_Type_free(&values));
  return 0;
}

/* Make own rows of P, and take those of ghosts from their owners. */
static PetscErrorCode make_rows(work *w, PetscReal omega)
{
  const dvi__operator *A = w->A;
  PetscInt longest = 1, *aggregate;
  PetscScalar *weight;
  for (PetscInt i = 0; i < A->rows; i++) longest = PetscMax(longest, A->start[i + 1] - A->start[i]);
  PetscCall(PetscMalloc2((size_t)longest + 1, &aggregate, (size_t)longest + 1, &weight));
  w->width = 1;
  for (PetscInt i = 0; i < A->rows; i++)
    w->width = PetscMax(w->width, make_row(w, omega, i, aggregate, weight));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &w->width, 1, MPIU_INT, MPI_MAX, A->comm));
  const size_t width = (size_t)w->width, places = (size_t)A->columns * width;
  PetscCall(PetscMalloc2(places, &w->aggregate, places, &w->weight));
  for (size_t p = 0; p < places; p++) w->aggregate[p] = -1, w->weight[p] = 0;
  for (PetscInt i = 0; i < A->rows; i++) {
    const size_t count = (size_t)make_row(w, omega, i, aggregate, weight);
    PetscCall(PetscArraycpy(w->aggregate + (size_t)i * width, aggregate, count));
    PetscCall(PetscArraycpy(w->weight + (size_t)i * width, weight, count));
  }
  PetscCall(PetscFree2(aggregate, weight));
  return tell_rows(w);
}

static PetscErrorCode make_matrix(MPI_Comm comm, PetscInt rows, PetscInt columns, Mat *made)
{
  PetscCall(MatCreate(comm, made));
  PetscCall(MatSetSizes(*made, rows, columns, PETSC_DETERMINE, PETSC_DETERMINE));
  return MatSetType(*made, MATAIJ);
}

/* Numbers of own aggregates are those of their roots. */
static PetscErrorCode make_interpolation(const work *w, const PetscInt *number, dvi__coarser *made)
{
  const dvi__operator *A = w->A;
  const size_t places = (size_t)A->rows * (size_t)w->width;
  PetscInt entries = 0, *row, *column;
  PetscScalar *value;
  Mat P, PT;
  PetscCall(PetscMalloc3(places, &row, places, &column, places, &value));
  for (size_t p = 0; p < places; p++) {
    if (w->aggregate[p] < 0) continue;
    row[entries] = A->index[p / (size_t)w->width];
    column[entries] = w->aggregate[p];
    value[entries++] = w->weight[p];
  }
  PetscCall(make_matrix(A->comm, A->rows, w->aggregates.own, &P));
  PetscCall(MatSetPreallocationCOO(P, entries, row, column));
  PetscCall(MatSetValuesCOO(P, value, INSERT_VALUES));
  PetscCall(PetscFree3(row, column, value));
  PetscCall(MatTranspose(P, MAT_INITIAL_MATRIX, &PT));
  PetscCall(dvi__operator_of_matrix(A->comm, P, number, &made->P));
  PetscCall(dvi__operator_of_matrix(A->comm, PT, A->number, &made->PT));
  PetscCall(MatDestroy(&P));
  return MatDestroy(&PT);
}

/* ---- P^T A P ---- */

/* List the aggregates in the rows of P that are here. */
static PetscErrorCode list_aggregates(work *w)
{
  const size_t places = (size_t)w->A->columns * (size_t)w->width;
  PetscCall(PetscMalloc1(places, &w->index));
  for (size_t p = 0; p < places; p++)
    if (w->aggregate[p] >= 0) w->index[w->count++] = w->aggregate[p];
  PetscCall(PetscSortRemoveDupsInt(&w->count, w->index));
  for (size_t p = 0; p < places; p++)
    if (w->aggregate[p] >= 0)
      PetscCall(PetscFindInt(w->aggregate[p], w->count, w->index, w->aggregate + p));
  return 0;
}

/* Choose factors by which the diagonal of P^T A P comes near 1, and tell those of others. */
static PetscErrorCode find_factors(work *w)
{
  const dvi__aggregates *g = &w->aggregates;
  PetscInt *here;
  PetscLayout layout;
  PetscSF forest;
  PetscCall(PetscMalloc1((size_t)g->own, &w->exponent));
  PetscCall(PetscMalloc1((size_t)w->count, &here));
  PetscCall(PetscMalloc1((size_t)w->count, &w->factor));
  for (PetscInt k = 0; k < g->own; k++) {
    int exponent;
    (void)frexp(g->square[g->root[k]], &exponent);
    w->exponent[k] = -exponent / 2;
  }
  PetscCall(PetscLayoutCreateFromSizes(w->A->comm, g->own, PETSC_DETERMINE, 1, &layout));
  PetscCall(PetscSFCreate(w->A->comm, &forest));
  PetscCall(PetscSFSetGraphLayout(forest, layout, w->count, NULL, PETSC_COPY_VALUES, w->index));
  PetscCall(PetscSFBcastBegin(forest, MPIU_INT, w->exponent, here, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(forest, MPIU_INT, w->exponent, here, MPI_REPLACE));
  for (PetscInt k = 0; k < w->count; k++) w->factor[k] = ldexp(1, (int)here[k]);
  PetscCall(PetscFree(here));
  PetscCall(PetscSFDestroy(&forest));
  return PetscLayoutDestroy(&layout);
}

/* Make own rows of A P. `at` [count] are places in the row, -1 before and afterwards. */
static PetscErrorCode multiply(work *w, PetscInt *at)
{
  const dvi__operator *A = w->A;
  const PetscInt width = w->width;
  PetscInt most = 0, entries = 0;
  for (PetscInt e = 0; e < A->start[A->rows]; e++)
    for (PetscInt k = 0; k < width; k++) most += w->aggregate[A->column[e] * width + k] >= 0;
  PetscCall(PetscMalloc3((size_t)A->rows + 1, &w->start, (size_t)most, &w->place, (size_t)most,
                         &w->value));
  for (PetscInt i = 0; i < A->rows; i++) {
    w->start[i] = entries;
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++)
      for (PetscInt p = A->column[e] * width; p < (A->column[e] + 1) * width; p++) {
        const PetscInt which = w->aggregate[p];
        if (which < 0) continue;
        if (at[which] < 0) {
          at[which] = entries;
          w->place[entries] = which;
          w->value[entries++] = 0;
        }
        w->value[at[which]] += A->value[e] * w->weight[p];
      }
    for (PetscInt e = w->start[i]; e < entries; e++) at[w->place[e]] = -1;
  }
  w->start[A->rows] = entries;
  return 0;
}

/* List the places of own rows of P by their aggregates. */
static PetscErrorCode transpose(work *w)
{
  const PetscInt places = w->A->rows * w->width;
  PetscCall(PetscCalloc1((size_t)w->count + 2, &w->member_start));
  PetscCall(PetscMalloc1((size_t)places, &w->member));
  PetscInt *next = w->member_start + 1;
  for (PetscInt p = 0; p < places; p++)
    if (w->aggregate[p] >= 0) next[w->aggregate[p] + 1]++;
  for (PetscInt k = 0; k < w->count; k++) next[k + 1] += next[k];
  for (PetscInt p = 0; p < places; p++)
    if (w->aggregate[p] >= 0) w->member[next[w->aggregate[p]]++] = p;
  return 0;
}

/* Give a term of an entry of P^T A P, scaled. */
static double term_of(const work *w, PetscInt to, PetscInt p, PetscInt e)
{
  return w->weight[p] * w->factor[to] * (w->value[e] * w->factor[w->place[e]]);
}

/* Find the power of two that is 2^PLACES units of the terms. */
static PetscErrorCode find_unit(const work *w, int *exponent)
{
  double most = 0;
  for (PetscInt p = 0; p < w->A->rows * w->width; p++) {
    const PetscInt i = p / w->width, to = w->aggregate[p];
    for (PetscInt e = w->start[i]; e < w->start[i + 1] && to >= 0; e++)
      most = fmax(most, fabs(term_of(w, to, p, e)));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, w->A->comm));
  (void)frexp(most, exponent);
  return 0;
}

/* Entries of P^T A P, as many units each. */
typedef struct triplets {
  PetscInt count, room, *row, *column;
  PetscScalar *value;
} triplets;

static PetscErrorCode make_room(triplets *t, PetscInt more)
{
  if (t->row != NULL && t->count + more <= t->room) return 0;
  t->room = 2 * t->room + more;
  PetscCall(PetscRealloc((size_t)t->room * sizeof *t->row, &t->row));
  PetscCall(PetscRealloc((size_t)t->room * sizeof *t->column, &t->column));
  return PetscRealloc((size_t)t->room * sizeof *t->value, &t->value);
}

/* Sum up what own unknowns give to the row of an aggregate. `at` is as before. */
static PetscErrorCode sum_row(const work *w, PetscInt to, double per_unit, PetscInt *at,
                              triplets *t)
{
  const PetscInt first = t->count;
  for (PetscInt m = w->member_start[to]; m < w->member_start[to + 1]; m++) {
    const PetscInt p = w->member[m], i = p / w->width;
    PetscCall(make_room(t, w->start[i + 1] - w->start[i]));
    for (PetscInt e = w->start[i]; e < w->start[i + 1]; e++) {
      const PetscInt from = w->place[e];
      if (at[from] < 0) {
        at[from] = t->count;
        t->row[t->count] = w->index[to];
        t->column[t->count] = from;
        t->value[t->count++] = 0;
      }
      t->value[at[from]] += rint(term_of(w, to, p, e) * per_unit);
    }
  }
  for (PetscInt k = first; k < t->count; k++) {
    at[t->column[k]] = -1;
    t->column[k] = w->index[t->column[k]];
  }
  return 0;
}

/* Bring the entries of P^T A P, which count units, to their size. */
static PetscErrorCode rescale(const work *w, double unit, dvi__operator *A)
{
  PetscInt *exponent;
  PetscCall(PetscMalloc1((size_t)A->columns, &exponent));
  PetscCall(PetscArraycpy(exponent, w->exponent, (size_t)A->own));
  PetscCall(dvi__operator_refresh(A, MPIU_INT, exponent));
  for (PetscInt i = 0; i < A->rows; i++)
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++) {
      double scaled = A->value[e] * unit;
      if (A->column[e] == i && !(scaled > vanishing)) scaled = 1;
      A->value[e] = ldexp(scaled, -(int)(exponent[i] + exponent[A->column[e]]));
    }
  return PetscFree(exponent);
}

static PetscErrorCode make_product(work *w, const PetscInt *number, dvi__coarser *made)
{
  PetscInt *at;
  triplets t = {0};
  int exponent;
  Mat coarse;
  PetscCall(list_aggregates(w));
  PetscCall(find_factors(w));
  PetscCall(PetscMalloc1((size_t)w->count, &at));
  for (PetscInt k = 0; k < w->count; k++) at[k] = -1;
  PetscCall(multiply(w, at));
  PetscCall(transpose(w));
  PetscCall(find_unit(w, &exponent));
  for (PetscInt to = 0; to < w->count; to++)
    PetscCall(sum_row(w, to, ldexp(1, PLACES - exponent), at, &t));
  PetscCall(make_matrix(w->A->comm, w->aggregates.own, w->aggregates.own, &coarse));
  PetscCall(MatSetPreallocationCOO(coarse, t.count, t.row, t.column));
  PetscCall(MatSetValuesCOO(coarse, t.value, INSERT_VALUES));
  PetscCall(dvi__operator_of_matrix(w->A->comm, coarse, number, &made->A));
  PetscCall(rescale(w, ldexp(1, exponent - PLACES), &made->A));
  PetscCall(MatDestroy(&coarse));
  PetscCall(PetscFree(t.row));
  PetscCall(PetscFree(t.column));
  PetscCall(PetscFree(t.value));
  return PetscFree(at);
}

static PetscErrorCode clear(work *w)
{
  PetscCall(dvi__aggregates_clear(&w->aggregates));
  PetscCall(PetscFree2(w->aggregate, w->weight));
  PetscCall(PetscFree(w->index));
  PetscCall(PetscFree(w->exponent));
  PetscCall(PetscFree(w->factor));
  PetscCall(PetscFree3(w->start, w->place, w->value));
  PetscCall(PetscFree(w->member_start));
  return PetscFree(w->member);
}

/* ---- all ---- */

static PetscErrorCode make(work *w, PetscReal bound, dvi__coarser *made)
{
  const dvi__operator *A = w->A;
  PetscInt *number, total = A->rows;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_INT, MPI_SUM, A->comm));
  PetscCall(dvi__aggregate(A, &w->aggregates));
  made->total = w->aggregates.total;
  if (made->total == 0 || made->total > total / 2) return 0;
  PetscCall(PetscMalloc1((size_t)w->aggregates.own, &number));
  for (PetscInt k = 0; k < w->aggregates.own; k++) number[k] = A->number[w->aggregates.root[k]];
  PetscCall(make_rows(w, 4 / (3 * bound)));
  PetscCall(make_interpolation(w, number, made));
  PetscCall(make_product(w, number, made));
  return PetscFree(number);
}

PetscErrorCode dvi__coarsen(const dvi__operator *A, PetscReal bound, dvi__coarser *made)
{
  work w = {.A = A};
  *made = (dvi__coarser){.total = 0};
  PetscCall(make(&w, bound, made));
  return clear(&w);
}

PetscErrorCode dvi__coarser_clear(dvi__coarser *made)
{
  PetscCall(dvi__operator_clear(&made->A));
  PetscCall(dvi__operator_clear(&made->P));
  return dvi__operator_clear(&made->PT);
}
