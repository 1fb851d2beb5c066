#include "operator.h"

#include <petscsf.h>

#include "vector.h"

/* ---- columns ---- */

/* Allocate what belongs to columns. */
static PetscErrorCode take_columns(PetscInt own, PetscInt ghosts, dvi__operator *made)
{
  made->own = own;
  made->columns = own + ghosts;
  const size_t count = (size_t)made->columns;
  PetscCall(PetscMalloc3(count, &made->number, count, &made->index, count, &made->x));
  return 0;
}

PetscErrorCode dvi__operator_refresh(const dvi__operator *A, MPI_Datatype type, void *values)
{
  PetscCall(PetscSFBcastBegin(A->forest, type, values, values, MPI_REPLACE));
  return PetscSFBcastEnd(A->forest, type, values, values, MPI_REPLACE);
}

/* Number own columns as PETSc does, one process after the other, and tell the ghosts. */
static PetscErrorCode number_own(dvi__operator *made)
{
  PetscInt first = 0;
  PetscCallMPI(MPI_Exscan(&made->own, &first, 1, MPIU_INT, MPI_SUM, made->comm));
  PetscMPIInt rank;
  PetscCallMPI(MPI_Comm_rank(made->comm, &rank));
  if (rank == 0) first = 0;
  for (PetscInt i = 0; i < made->own; i++) made->index[i] = first + i;
  return dvi__operator_refresh(made, MPIU_INT, made->index);
}

/* ---- of a share ---- */

PetscErrorCode dvi__place_unknowns(MPI_Comm comm, const dvi__unknowns *unknowns, PetscInt *place,
                                   PetscInt *own)
{
  const int *owner = dvi_mesh_share_owners(unknowns->share, unknowns->degree),
            *cell = unknowns->cell;
  PetscMPIInt rank;
  PetscInt here = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  *own = 0;
  for (int64_t i = 0; i < unknowns->count; i++) *own += owner[cell[i]] == rank;
  PetscInt elsewhere = *own;
  for (int64_t i = 0; i < unknowns->count; i++)
    place[i] = owner[cell[i]] == rank ? here++ : elsewhere++;
  return 0;
}

/* Join the ghosts to their owners by the numbers of the cells in the whole mesh. */
static PetscErrorCode plant(dvi__operator *made)
{
  const PetscInt ghosts = made->columns - made->own;
  PetscInt *place, most = -1;
  PetscLayout layout;
  for (PetscInt c = 0; c < made->columns; c++) most = PetscMax(most, made->number[c]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT, MPI_MAX, made->comm));
  PetscCall(PetscMalloc1((size_t)made->columns, &place));
  for (PetscInt c = 0; c < made->columns; c++) place[c] = c;
  PetscCall(PetscLayoutCreateFromSizes(made->comm, PETSC_DECIDE, most + 1, 1, &layout));
  PetscCall(PetscSFCreateByMatchingIndices(layout, made->own, made->number, place, 0, ghosts,
                                           made->number + made->own, place + made->own, 0, NULL,
                                           &made->forest));
  PetscCall(PetscSFSetUp(made->forest));
  PetscCall(PetscFree(place));
  return PetscLayoutDestroy(&layout);
}

static int64_t first_entry(const dvi_matrix *A, int64_t row)
{
  return A->width > 0 ? row * A->width : A->start[row];
}

/* Copy own rows. Their columns ascend in the share, and therefore in the whole mesh. */
static PetscErrorCode copy_rows(const dvi_matrix *A, const PetscInt *place, dvi__operator *made)
{
  PetscInt entries = 0;
  made->rows = made->own;
  for (int64_t i = 0; i < A->rows; i++)
    if (place[i] < made->own) entries += (PetscInt)(first_entry(A, i + 1) - first_entry(A, i));
  PetscCall(PetscMalloc3((size_t)made->rows + 1, &made->start, (size_t)entries, &made->column,
                         (size_t)entries, &made->value));
  entries = 0;
  for (int64_t i = 0; i < A->rows; i++) {
    if (place[i] >= made->own) continue;
    made->start[place[i]] = entries;
    for (int64_t e = first_entry(A, i); e < first_entry(A, i + 1); e++) {
      made->column[entries] = place[A->column != NULL ? A->column[e] : i];
      made->value[entries++] = A->value[e];
    }
  }
  made->start[made->rows] = entries;
  return 0;
}

PetscErrorCode dvi__operator_of_share(MPI_Comm comm, const dvi__unknowns *unknowns,
                                      const dvi_matrix *A, dvi__operator *made)
{
  const int64_t *number = dvi_mesh_share_numbers(unknowns->share, unknowns->degree);
  PetscInt *place, own;
  *made = (dvi__operator){.comm = comm};
  PetscCall(PetscMalloc1((size_t)unknowns->count, &place));
  PetscCall(dvi__place_unknowns(comm, unknowns, place, &own));
  PetscCall(take_columns(own, (PetscInt)unknowns->count - own, made));
  for (int64_t i = 0; i < unknowns->count; i++)
    made->number[place[i]] = (PetscInt)number[unknowns->cell[i]];
  PetscCall(copy_rows(A, place, made));
  PetscCall(PetscFree(place));
  PetscCall(plant(made));
  return number_own(made);
}

/* ---- of an assembled matrix ---- */

/* Give the place of a column of PETSc's, own or among the sorted ghosts. */
static PetscErrorCode find_place(const dvi__operator *A, PetscInt first, PetscInt index,
                                 PetscInt *place)
{
  const PetscInt ghosts = A->columns - A->own;
  *place = index - first;
  if (*place >= 0 && *place < A->own) return 0;
  PetscCall(PetscFindInt(index, ghosts, A->index + A->own, place));
  *place += A->own;
  return 0;
}

/* List the columns of own rows that other processes own, sorted and each once. */
static PetscErrorCode find_ghosts(Mat A, PetscInt *count, PetscInt **ghost)
{
  PetscInt first, last, first_column, last_column, entries;
  const PetscInt *column;
  *count = 0;
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  PetscCall(MatGetOwnershipRangeColumn(A, &first_column, &last_column));
  for (int pass = 0; pass < 2; pass++) {
    if (pass == 1) PetscCall(PetscMalloc1((size_t)*count, ghost));
    *count = 0;
    for (PetscInt i = first; i < last; i++) {
      PetscCall(MatGetRow(A, i, &entries, &column, NULL));
      for (PetscInt e = 0; e < entries; e++) {
        if (column[e] >= first_column && column[e] < last_column) continue;
        if (pass == 1) (*ghost)[*count] = column[e];
        ++*count;
      }
      PetscCall(MatRestoreRow(A, i, &entries, &column, NULL));
    }
  }
  return PetscSortRemoveDupsInt(count, *ghost);
}

/* Sort the entries of a row by their keys. Rows are short. */
static PetscErrorCode sort_row(PetscInt count, PetscInt *key, PetscInt *column, PetscScalar *value)
{
  for (PetscInt e = 1; e < count; e++)
    for (PetscInt k = e; k > 0 && key[k] < key[k - 1]; k--) {
      const PetscInt number = key[k], at = column[k];
      const PetscScalar entry = value[k];
      key[k] = key[k - 1], column[k] = column[k - 1], value[k] = value[k - 1];
      key[k - 1] = number, column[k - 1] = at, value[k - 1] = entry;
    }
  return 0;
}

/* Copy the rows, each in the order of its columns' numbers. */
static PetscErrorCode copy_assembled(Mat A, dvi__operator *made)
{
  PetscInt first, last, entries, total = 0, first_column, *key;
  const PetscInt *column;
  const PetscScalar *value;
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  PetscCall(MatGetOwnershipRangeColumn(A, &first_column, NULL));
  made->rows = last - first;
  for (PetscInt i = first; i < last; i++) {
    PetscCall(MatGetRow(A, i, &entries, NULL, NULL));
    total += entries;
    PetscCall(MatRestoreRow(A, i, &entries, NULL, NULL));
  }
  PetscCall(PetscMalloc3((size_t)made->rows + 1, &made->start, (size_t)total, &made->column,
                         (size_t)total, &made->value));
  PetscCall(PetscMalloc1((size_t)total, &key));
  total = 0;
  for (PetscInt i = first; i < last; i++) {
    made->start[i - first] = total;
    PetscCall(MatGetRow(A, i, &entries, &column, &value));
    for (PetscInt e = 0; e < entries; e++) {
      PetscCall(find_place(made, first_column, column[e], made->column + total + e));
      key[total + e] = made->number[made->column[total + e]];
      made->value[total + e] = value[e];
    }
    PetscCall(sort_row(entries, key + total, made->column + total, made->value + total));
    total += entries;
    PetscCall(MatRestoreRow(A, i, &entries, &column, &value));
  }
  made->start[made->rows] = total;
  return PetscFree(key);
}

PetscErrorCode dvi__operator_of_matrix(MPI_Comm comm, Mat A, const PetscInt *number,
                                       dvi__operator *made)
{
  PetscInt ghosts, *ghost, own, *place;
  PetscLayout layout;
  *made = (dvi__operator){.comm = comm};
  PetscCall(find_ghosts(A, &ghosts, &ghost));
  PetscCall(MatGetLocalSize(A, NULL, &own));
  PetscCall(take_columns(own, ghosts, made));
  PetscCall(PetscMalloc1((size_t)ghosts, &place));
  for (PetscInt g = 0; g < ghosts; g++) place[g] = own + g;
  PetscCall(MatGetLayouts(A, NULL, &layout));
  PetscCall(PetscSFCreate(made->comm, &made->forest));
  PetscCall(PetscSFSetGraphLayout(made->forest, layout, ghosts, place, PETSC_COPY_VALUES, ghost));
  PetscCall(PetscSFSetUp(made->forest));
  PetscCall(PetscArraycpy(made->number, number, (size_t)own));
  PetscCall(dvi__operator_refresh(made, MPIU_INT, made->number));
  PetscCall(number_own(made));
  PetscCall(copy_assembled(A, made));
  PetscCall(PetscFree(place));
  return PetscFree(ghost);
}

PetscErrorCode dvi__operator_clear(dvi__operator *made)
{
  PetscCall(PetscSFDestroy(&made->forest));
  PetscCall(PetscFree3(made->start, made->column, made->value));
  return PetscFree3(made->number, made->index, made->x);
}

/* ---- products ---- */

PetscErrorCode dvi__operator_multiply(const dvi__operator *A, const PetscScalar *x, PetscScalar *y)
{
  PetscCall(PetscArraycpy(A->x, x, (size_t)A->own));
  PetscCall(dvi__operator_refresh(A, MPIU_SCALAR, A->x));
  for (PetscInt i = 0; i < A->rows; i++) {
    PetscScalar sum = 0;
    for (PetscInt e = A->start[i]; e < A->start[i + 1]; e++)
      sum += A->value[e] * A->x[A->column[e]];
    y[i] = sum;
  }
  return 0;
}

PetscScalar dvi__operator_entry(const dvi__operator *A, PetscInt row, PetscInt column)
{
  for (PetscInt e = A->start[row]; e < A->start[row + 1]; e++)
    if (A->column[e] == column) return A->value[e];
  return 0;
}

/* ---- a matrix of PETSc ---- */

static PetscErrorCode multiply(Mat shown, Vec x, Vec y)
{
  const dvi__operator *A;
  const PetscScalar *in;
  PetscScalar *out;
  PetscCall(MatShellGetContext(shown, &A));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  PetscCall(dvi__operator_multiply(A, in, out));
  PetscCall(VecRestoreArray(y, &out));
  return VecRestoreArrayRead(x, &in);
}

static PetscErrorCode get_diagonal(Mat shown, Vec diagonal)
{
  const dvi__operator *A;
  PetscScalar *out;
  PetscCall(MatShellGetContext(shown, &A));
  PetscCall(VecGetArray(diagonal, &out));
  for (PetscInt i = 0; i < A->rows; i++) out[i] = dvi__operator_entry(A, i, i);
  return VecRestoreArray(diagonal, &out);
}

static PetscErrorCode create_vectors(Mat shown, Vec *right, Vec *left)
{
  const dvi__operator *A;
  PetscCall(MatShellGetContext(shown, &A));
  if (right != NULL) PetscCall(dvi__vector_create(A->comm, A->own, right));
  return left != NULL ? dvi__vector_create(A->comm, A->rows, left) : 0;
}

PetscErrorCode dvi__operator_show(dvi__operator *A, Mat *shown)
{
  PetscCall(MatCreateShell(A->comm, A->rows, A->own, PETSC_DETERMINE, PETSC_DETERMINE, A, shown));
  PetscCall(MatShellSetOperation(*shown, MATOP_MULT, (void (*)(void))multiply));
  PetscCall(MatShellSetOperation(*shown, MATOP_MULT_TRANSPOSE, (void (*)(void))multiply));
  PetscCall(MatShellSetOperation(*shown, MATOP_GET_DIAGONAL, (void (*)(void))get_diagonal));
  PetscCall(MatShellSetOperation(*shown, MATOP_CREATE_VECS, (void (*)(void))create_vectors));
  return MatSetOption(*shown, MAT_SYMMETRIC, PETSC_TRUE);
}
