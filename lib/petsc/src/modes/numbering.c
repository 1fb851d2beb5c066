#include "numbering.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "owners.h"

/* ---- numbers ---- */

static dvi_status count_rows(const dvi__world *world, int64_t own, dvi__numbering *n)
{
  int64_t first = 0, total = own;
  if (MPI_Exscan(&own, &first, 1, MPI_INT64_T, MPI_SUM, world->comm) != MPI_SUCCESS ||
      MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_INT64_T, MPI_SUM, world->comm) != MPI_SUCCESS)
    return dvi__world_fail(world);
  if (total > PETSC_MAX_INT)
    return dvi__fail(DVI_BAD_SIZE, "petsc: this PETSc numbers at most %lld unknowns, not %lld",
                     (long long)PETSC_MAX_INT, (long long)total);
  n->own = (PetscInt)own;
  n->first = world->rank > 0 ? (PetscInt)first : 0; /* MPI leaves that of the first one open */
  n->total = (PetscInt)total;
  return DVI_OK;
}

/* Numbers of other processes' cells come from them. */
static dvi_status spread_numbers(dvi_division *division, int k, double *form, dvi__numbering *n)
{
  const int64_t cells = dvi_mesh_count(division->share, k);
  for (int64_t c = 0; c < cells; c++) form[c] = -1;
  for (PetscInt i = 0; i < n->own; i++) form[n->cell[i]] = (double)(n->first + i);
  DVI_TRY(dvi_division_refresh(division, k, form));
  for (int64_t c = 0; c < cells; c++) n->number[c] = (PetscInt)form[c];
  return DVI_OK;
}

dvi_status dvi__number_cells(dvi_division *division, int k, const char *chosen, dvi__numbering *n)
{
  const int64_t cells = dvi_mesh_count(division->share, k);
  const int *owner = dvi_mesh_share_owners(division->share, k);
  double *form = DVI_NEW(double, cells);
  *n = (dvi__numbering){.number = DVI_NEW(PetscInt, cells), .cell = DVI_NEW(int, cells)};
  const int has_memory = form != NULL && n->number != NULL && n->cell != NULL;
  int64_t own = 0;
  for (int64_t c = 0; has_memory && c < cells; c++)
    if (chosen[c] && owner[c] == division->world.rank) n->cell[own++] = (int)c;
  dvi_status status = dvi__world_agree(
      &division->world,
      has_memory ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for numbers of unknowns"));
  if (status == DVI_OK) status = count_rows(&division->world, own, n);
  if (status == DVI_OK && has_memory) status = spread_numbers(division, k, form, n);
  dvi__release(form);
  if (status != DVI_OK) dvi__numbering_clear(n);
  return status;
}

void dvi__numbering_clear(dvi__numbering *n)
{
  dvi__release(n->number);
  dvi__release(n->cell);
  *n = (dvi__numbering){.own = 0};
}

/* ---- matrices ---- */

/* Rows of this process, compressed. */
typedef struct rows {
  PetscInt *start, *column;
  PetscScalar *value;
} rows;

static int64_t first_entry(const dvi_matrix *A, int64_t row)
{
  return A->start != NULL ? A->start[row] : row * A->width;
}

static void fill_rows(const dvi__cell_matrix *part, rows *r)
{
  const dvi_matrix *A = part->matrix;
  const dvi__numbering *n = part->rows;
  PetscInt row = 0, entries = 0;
  for (int64_t i = 0; i < A->rows && row < n->own; i++) {
    if ((part->row != NULL ? part->row[i] : i) != n->cell[row]) continue;
    r->start[row++] = entries;
    for (int64_t e = first_entry(A, i); e < first_entry(A, i + 1); e++) {
      const int64_t j = A->column != NULL ? A->column[e] : i;
      const PetscInt column = part->columns->number[part->column != NULL ? part->column[j] : j];
      if (column < 0) continue;
      r->column[entries] = column;
      r->value[entries++] = A->value != NULL ? A->value[e] : A->sign[e];
    }
  }
  r->start[row] = entries;
}

static PetscErrorCode create(dvi_division *division, const dvi__cell_matrix *part, const rows *r,
                             Mat *all)
{
  PetscCall(MatCreate(division->world.comm, all));
  PetscCall(MatSetSizes(*all, part->rows->own, part->columns->own, part->rows->total,
                        part->columns->total));
  PetscCall(MatSetType(*all, MATAIJ));
  /* of the two, that of another type does nothing */
  PetscCall(MatSeqAIJSetPreallocationCSR(*all, r->start, r->column, r->value));
  return MatMPIAIJSetPreallocationCSR(*all, r->start, r->column, r->value);
}

dvi_status dvi__matrix_of_all(dvi_division *division, const dvi__cell_matrix *part, Mat *all)
{
  const int64_t entries = dvi_matrix_entries(part->matrix);
  rows r = {.start = DVI_NEW(PetscInt, part->rows->own + 1),
            .column = DVI_NEW(PetscInt, entries),
            .value = DVI_NEW(PetscScalar, entries)};
  dvi_status status = DVI_OK;
  *all = NULL;
  if (entries > PETSC_MAX_INT)
    status = dvi__fail(DVI_BAD_SIZE, "petsc: this PETSc counts at most %lld entries of a matrix",
                       (long long)PETSC_MAX_INT);
  if (r.start == NULL || r.column == NULL || r.value == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a matrix");
  if (status == DVI_OK) fill_rows(part, &r);
  status = dvi__world_agree(&division->world, status);
  if (status == DVI_OK) status = dvi__check_petsc(create(division, part, &r, all));
  dvi__release(r.start);
  dvi__release(r.column);
  dvi__release(r.value);
  return status;
}

/* ---- components ---- */

/* Give the two ends of each edge the smaller one of their labels, until all edges of the share have
 * equal ones. Returns whether a label has changed. */
static int level_labels(const dvi_matrix *edges, double *label)
{
  int has_changed = 0;
  for (int changed = 1; changed;) {
    changed = 0;
    for (int64_t e = 0; e < 2 * edges->rows; e += 2) {
      double *one = label + edges->column[e], *other = label + edges->column[e + 1];
      if (*one == *other) continue;
      *one = *other = fmin(*one, *other);
      changed = has_changed = 1;
    }
  }
  return has_changed;
}

dvi_status dvi__label_components(dvi_division *division, const char *held, double *label)
{
  const dvi_mesh *share = division->share;
  const int64_t *number = dvi_mesh_share_numbers(share, 0);
  dvi_matrix edges;
  double changed = 1;
  DVI_TRY(dvi__world_agree(&division->world, dvi_mesh_incidence(share, 0, &edges)));
  for (int64_t v = 0; v < dvi_mesh_count(share, 0); v++)
    label[v] = held[v] ? -1 : (double)number[v];
  while (changed > 0) {
    DVI_TRY(dvi_division_refresh(division, 0, label));
    changed = level_labels(&edges, label);
    if (dvi__world_largest(1, &changed, (void *)&division->world) != 0)
      return dvi__world_fail(&division->world);
  }
  return DVI_OK;
}
