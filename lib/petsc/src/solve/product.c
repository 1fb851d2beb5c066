#include "product.h"

#include <math.h>
#include <petscsf.h>

enum { PLACES = 38 };

/* What of a coarser diagonal is only rounding: the unknown is a whole component without fixed
 * values, or none interpolates from it, and its equation is left out. */
static const double vanishing = 0x1p-20;

typedef struct work {
  const dvi__operator *A;
  const dvi__rows *rows;
  PetscInt width;
  PetscInt *column;                /* [columns*width] places in `index`, or -1 */
  PetscInt count, *index;          /* columns of P in these rows: PETSc's numbers, ascending */
  PetscSF forest;                  /* roots are own columns of P, leaves those in `index` */
  PetscReal *factor;               /* [count] powers of two */
  PetscInt *exponent;              /* [own columns of P] of these */
  PetscInt *start, *place;         /* [rows+1], and columns of A P, places in `index` */
  PetscScalar *value;              /* of A P */
  PetscInt *member_start, *member; /* [count+1], and rows*width + k of the entries of P^T */
} work;

/* ---- P ---- */

PetscErrorCode dvi__rows_allocate(const dvi__operator *A, PetscInt own, PetscInt width,
                                  dvi__rows *made)
{
  const size_t places = (size_t)A->columns * (size_t)width;
  made->own = own;
  made->width = width;
  PetscCall(PetscMalloc3((size_t)own, &made->number, places, &made->column, places, &made->weight));
  for (size_t p = 0; p < places; p++) made->column[p] = -1, made->weight[p] = 0;
  return 0;
}

PetscErrorCode dvi__rows_clear(dvi__rows *made)
{
  return PetscFree3(made->number, made->column, made->weight);
}

PetscErrorCode dvi__rows_tell(const dvi__operator *A, dvi__rows *rows)
{
  MPI_Datatype numbers, values;
  PetscCallMPI(MPI_Type_contiguous((int)rows->width, MPIU_INT, &numbers));
  PetscCallMPI(MPI_Type_contiguous((int)rows->width, MPIU_SCALAR, &values));
  PetscCallMPI(MPI_Type_commit(&numbers));
  PetscCallMPI(MPI_Type_commit(&values));
  PetscCall(dvi__operator_refresh(A, numbers, rows->column));
  PetscCall(dvi__operator_refresh(A, values, rows->weight));
  PetscCallMPI(MPI_Type_free(&numbers));
  PetscCallMPI(MPI_Type_free(&values));
  return 0;
}

static PetscErrorCode make_matrix(MPI_Comm comm, PetscInt rows, PetscInt columns, Mat *made)
{
  PetscCall(MatCreate(comm, made));
  PetscCall(MatSetSizes(*made, rows, columns, PETSC_DETERMINE, PETSC_DETERMINE));
  return MatSetType(*made, MATAIJ);
}

static PetscErrorCode make_interpolation(const dvi__operator *A, const dvi__rows *rows,
                                         dvi__coarser *made)
{
  const size_t places = (size_t)A->rows * (size_t)rows->width;
  PetscInt entries = 0, *row, *column;
  PetscScalar *value;
  Mat P, PT;
  PetscCall(PetscMalloc3(places, &row, places, &column, places, &value));
  for (size_t p = 0; p < places; p++) {
    if (rows->column[p] < 0) continue;
    row[entries] = A->index[p / (size_t)rows->width];
    column[entries] = rows->column[p];
    value[entries++] = rows->weight[p];
  }
  PetscCall(make_matrix(A->comm, A->rows, rows->own, &P));
  PetscCall(MatSetPreallocationCOO(P, entries, row, column));
  PetscCall(MatSetValuesCOO(P, value, INSERT_VALUES));
  PetscCall(PetscFree3(row, column, value));
  PetscCall(MatTranspose(P, MAT_INITIAL_MATRIX, &PT));
  PetscCall(dvi__operator_of_matrix(A->comm, P, rows->number, &made->P));
  PetscCall(dvi__operator_of_matrix(A->comm, PT, A->number, &made->PT));
  PetscCall(MatDestroy(&P));
  return MatDestroy(&PT);
}

/* ---- A P ---- */

/* List the columns of P in the rows that are here. */
static PetscErrorCode list_columns(work *w)
{
  const size_t places = (size_t)w->A->columns * (size_t)w->width;
  PetscCall(PetscMalloc1(places, &w->index));
  PetscCall(PetscMalloc1(places, &w->column));
  for (size_t p = 0; p < places; p++)
    if (w->rows->column[p] >= 0) w->index[w->count++] = w->rows->column[p];
  PetscCall(PetscSortRemoveDupsInt(&w->count, w->index));
  for (size_t p = 0; p < places; p++) {
    w->column[p] = -1;
    if (w->rows->column[p] >= 0)
      PetscCall(PetscFindInt(w->rows->column[p], w->count, w->index, w->column + p));
  }
  return 0;
}

/* Make own rows of A P. `at` [count] are places in the row, -1 before and afterwards. */
static PetscErrorCode multiply(work *w, PetscInt *at)
{
  const dvi__operator *A = w->A;
  const PetscInt width = w->width;
  PetscInt most = 0, entries = 0;
  for (PetscInt e = 0; e < A->start[A->rows]; e++)
    for (PetscInt k = 0; k < width; k++) most += w->column[A->column[e] * width + k] >= 0;
  PetscCall(PetscMalloc3((size_t)A->rows + 1, &w->start, (size_t)most, &w->place, (size_t)most,
                         &w->value));
  for (PetscInt i = 0; i < A->rows; i++) {
    w->start[i] = entries;
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++)
      for (PetscInt p = A->column[e] * width; p < (A->column[e] + 1) * width; p++) {
        const PetscInt which = w->column[p];
        if (which < 0) continue;
        if (at[which] < 0) {
          at[which] = entries;
          w->place[entries] = which;
          w->value[entries++] = 0;
        }
        w->value[at[which]] += A->value[e] * w->rows->weight[p];
      }
    for (PetscInt e = w->start[i]; e < entries; e++) at[w->place[e]] = -1;
  }
  w->start[A->rows] = entries;
  return 0;
}

/* ---- scales ---- */

static PetscErrorCode plant(work *w)
{
  PetscLayout layout;
  PetscCall(PetscLayoutCreateFromSizes(w->A->comm, w->rows->own, PETSC_DETERMINE, 1, &layout));
  PetscCall(PetscSFCreate(w->A->comm, &w->forest));
  PetscCall(PetscSFSetGraphLayout(w->forest, layout, w->count, NULL, PETSC_COPY_VALUES, w->index));
  return PetscLayoutDestroy(&layout);
}

/* Set `square` [own columns] to the largest terms of the diagonal of P^T A P, of all processes. */
static PetscErrorCode find_squares(const work *w, PetscReal *square)
{
  PetscReal *here;
  PetscCall(PetscCalloc1((size_t)w->count, &here));
  for (PetscInt p = 0; p < w->A->rows * w->width; p++)
    for (PetscInt e = w->start[p / w->width]; e < w->start[p / w->width + 1]; e++)
      if (w->place[e] == w->column[p])
        here[w->column[p]] = fmax(here[w->column[p]], fabs(w->rows->weight[p] * w->value[e]));
  for (PetscInt k = 0; k < w->rows->own; k++) square[k] = 0;
  PetscCall(PetscSFReduceBegin(w->forest, MPIU_REAL, here, square, MPI_MAX));
  PetscCall(PetscSFReduceEnd(w->forest, MPIU_REAL, here, square, MPI_MAX));
  return PetscFree(here);
}

/* Choose factors by which the diagonal of P^T A P comes near 1, and tell those of others. */
static PetscErrorCode find_factors(work *w, const PetscReal *square)
{
  PetscInt *here;
  PetscReal *found;
  const size_t own = (size_t)w->rows->own;
  PetscCall(PetscMalloc1(own, &w->exponent));
  PetscCall(PetscMalloc1(own, &found));
  PetscCall(PetscMalloc1((size_t)w->count, &here));
  PetscCall(PetscMalloc1((size_t)w->count, &w->factor));
  if (square == NULL) PetscCall(find_squares(w, found));
  for (size_t k = 0; k < own; k++) {
    int exponent;
    (void)frexp(square != NULL ? square[k] : found[k], &exponent);
    w->exponent[k] = -exponent / 2;
  }
  PetscCall(PetscSFBcastBegin(w->forest, MPIU_INT, w->exponent, here, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(w->forest, MPIU_INT, w->exponent, here, MPI_REPLACE));
  for (PetscInt k = 0; k < w->count; k++) w->factor[k] = ldexp(1, (int)here[k]);
  PetscCall(PetscFree(found));
  return PetscFree(here);
}

/* ---- P^T A P ---- */

/* List the places of own rows of P by their columns. */
static PetscErrorCode transpose(work *w)
{
  const PetscInt places = w->A->rows * w->width;
  PetscCall(PetscCalloc1((size_t)w->count + 2, &w->member_start));
  PetscCall(PetscMalloc1((size_t)places, &w->member));
  PetscInt *next = w->member_start + 1;
  for (PetscInt p = 0; p < places; p++)
    if (w->column[p] >= 0) next[w->column[p] + 1]++;
  for (PetscInt k = 0; k < w->count; k++) next[k + 1] += next[k];
  for (PetscInt p = 0; p < places; p++)
    if (w->column[p] >= 0) w->member[next[w->column[p]]++] = p;
  return 0;
}

/* Give a term of an entry of P^T A P, scaled. */
static double term_of(const work *w, PetscInt to, PetscInt p, PetscInt e)
{
  return w->rows->weight[p] * w->factor[to] * (w->value[e] * w->factor[w->place[e]]);
}

/* Find the power of two that is 2^PLACES units of the terms. */
static PetscErrorCode find_unit(const work *w, int *exponent)
{
  double most = 0;
  for (PetscInt p = 0; p < w->A->rows * w->width; p++) {
    const PetscInt i = p / w->width, to = w->column[p];
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

/* Sum up what own unknowns give to a row. `at` is as before. */
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

/* Give all rows an entry on the diagonal. */
static PetscErrorCode add_diagonal(const work *w, triplets *t)
{
  PetscInt end = 0;
  PetscCall(make_room(t, w->rows->own));
  PetscCallMPI(MPI_Scan(&w->rows->own, &end, 1, MPIU_INT, MPI_SUM, w->A->comm));
  for (PetscInt k = end - w->rows->own; k < end; k++) {
    t->row[t->count] = t->column[t->count] = k;
    t->value[t->count++] = 0;
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

static PetscErrorCode make_product(work *w, const PetscReal *square, dvi__operator *made)
{
  PetscInt *at;
  triplets t = {0};
  int exponent;
  Mat coarse;
  PetscCall(list_columns(w));
  PetscCall(plant(w));
  PetscCall(PetscMalloc1((size_t)w->count, &at));
  for (PetscInt k = 0; k < w->count; k++) at[k] = -1;
  PetscCall(multiply(w, at));
  PetscCall(find_factors(w, square));
  PetscCall(transpose(w));
  PetscCall(find_unit(w, &exponent));
  for (PetscInt to = 0; to < w->count; to++)
    PetscCall(sum_row(w, to, ldexp(1, PLACES - exponent), at, &t));
  PetscCall(add_diagonal(w, &t));
  PetscCall(make_matrix(w->A->comm, w->rows->own, w->rows->own, &coarse));
  PetscCall(MatSetPreallocationCOO(coarse, t.count, t.row, t.column));
  PetscCall(MatSetValuesCOO(coarse, t.value, INSERT_VALUES));
  PetscCall(dvi__operator_of_matrix(w->A->comm, coarse, w->rows->number, made));
  PetscCall(rescale(w, ldexp(1, exponent - PLACES), made));
  PetscCall(MatDestroy(&coarse));
  PetscCall(PetscFree(t.row));
  PetscCall(PetscFree(t.column));
  PetscCall(PetscFree(t.value));
  return PetscFree(at);
}

static PetscErrorCode clear(work *w)
{
  PetscCall(PetscSFDestroy(&w->forest));
  PetscCall(PetscFree(w->column));
  PetscCall(PetscFree(w->index));
  PetscCall(PetscFree(w->exponent));
  PetscCall(PetscFree(w->factor));
  PetscCall(PetscFree3(w->start, w->place, w->value));
  PetscCall(PetscFree(w->member_start));
  return PetscFree(w->member);
}

PetscErrorCode dvi__product(const dvi__operator *A, const dvi__rows *rows, const PetscReal *square,
                            dvi__coarser *made)
{
  work w = {.A = A, .rows = rows, .width = rows->width};
  PetscCall(make_interpolation(A, rows, made));
  PetscCall(make_product(&w, square, &made->A));
  return clear(&w);
}

PetscErrorCode dvi__coarser_clear(dvi__coarser *made)
{
  PetscCall(dvi__operator_clear(&made->A));
  PetscCall(dvi__operator_clear(&made->P));
  return dvi__operator_clear(&made->PT);
}
