/* Partitioners and the graph of a mesh's n-cells. */
#include "owners.h"

#include <petscmat.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

dvi_status dvi__check_petsc(PetscErrorCode code)
{
  const char *words = NULL;
  char *reason = NULL;
  if (code == 0) return DVI_OK;
  (void)PetscErrorMessage(code, &words, &reason);
  return dvi__fail(DVI_SOLVER_FAILED, "petsc: %s (code %d)%s%s", words != NULL ? words : "failed",
                   (int)code, reason != NULL && reason[0] != '\0' ? ": " : "",
                   reason != NULL ? reason : "");
}

/* ---- the graph of the n-cells ---- */

/* Cells `first` to `last`-1 of the graph, in compressed rows. */
typedef struct graph {
  int64_t first, last;
  PetscInt *start, *neighbour;
} graph;

/* Fill in the two n-cells at each facet, or -1. Of more than two the first ones count. */
static int *find_sides(const dvi_matrix *d)
{
  int *side = DVI_NEW(int, 2 * d->columns);
  for (int64_t f = 0; f < 2 * d->columns && side != NULL; f++) side[f] = -1;
  for (int64_t i = 0; i < d->rows * d->width && side != NULL; i++) {
    int *at = side + 2 * (int64_t)d->column[i];
    if (at[0] < 0)
      at[0] = (int)(i / d->width);
    else if (at[1] < 0)
      at[1] = (int)(i / d->width);
  }
  return side;
}

static PetscErrorCode fill_rows(const dvi_matrix *d, const int *side, graph *g)
{
  PetscInt entries = 0;
  PetscCall(PetscMalloc1((size_t)(g->last - g->first + 1), &g->start));
  PetscCall(PetscMalloc1((size_t)((g->last - g->first) * d->width + 1), &g->neighbour));
  for (int64_t c = g->first; c < g->last; c++) {
    g->start[c - g->first] = entries;
    for (int64_t i = c * d->width; i < (c + 1) * d->width; i++) {
      const int *at = side + 2 * (int64_t)d->column[i];
      const int other = at[0] == c ? at[1] : at[0];
      if (other >= 0) g->neighbour[entries++] = other;
    }
  }
  g->start[g->last - g->first] = entries;
  return 0;
}

/* Make the graph of this process's cells. Its arrays are for PetscFree. */
static dvi_status make_graph(const dvi_mesh *mesh, graph *g)
{
  dvi_matrix d;
  DVI_TRY(dvi_mesh_incidence(mesh, dvi_mesh_dimension(mesh) - 1, &d));
  if ((g->last - g->first) * d.width > PETSC_MAX_INT)
    return dvi__fail(DVI_BAD_SIZE,
                     "petsc: %lld cells of a process have more neighbours than this PETSc can "
                     "number, %lld: take more processes, or a PETSc with integers of 64 bits",
                     (long long)(g->last - g->first), (long long)PETSC_MAX_INT);
  int *side = find_sides(&d);
  if (side == NULL) return dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a graph");
  const dvi_status status = dvi__check_petsc(fill_rows(&d, side, g));
  dvi__release(side);
  return status;
}

/* ---- partitioners ---- */

/* Choose the partitioner. All processes have the same result. */
static dvi_status set_type(MatPartitioning partitioning, const char *name)
{
  const PetscErrorCode code = MatPartitioningSetType(partitioning, name);
  if (code == PETSC_ERR_ARG_UNKNOWN_TYPE)
    return dvi__fail(
        DVI_BAD_OPTION,
        "petsc: this PETSc has no partitioner \"%s\"; there are blocks and, where PETSc "
        "was built with it, ptscotch",
        name);
  return dvi__check_petsc(code);
}

static PetscErrorCode apply(MatPartitioning partitioning, const graph *g, PetscInt *owner)
{
  IS parts;
  const PetscInt *part;
  PetscCall(MatPartitioningApply(partitioning, &parts));
  PetscCall(ISGetIndices(parts, &part));
  PetscCall(PetscArraycpy(owner + g->first, part, (size_t)(g->last - g->first)));
  PetscCall(ISRestoreIndices(parts, &part));
  return ISDestroy(&parts);
}

/* Find the owners of this process's cells. The graph's arrays become PETSc's. */
static dvi_status partition(const dvi__divider *divider, int64_t cells, graph *g, PetscInt *owner)
{
  Mat adjacency = NULL;
  MatPartitioning partitioning = NULL;
  dvi_status status = dvi__check_petsc(
      MatCreateMPIAdj(divider->world->comm, (PetscInt)(g->last - g->first), (PetscInt)cells,
                      g->start, g->neighbour, NULL, &adjacency));
  if (status == DVI_OK)
    status = dvi__check_petsc(MatPartitioningCreate(divider->world->comm, &partitioning));
  if (status == DVI_OK)
    status = dvi__check_petsc(MatPartitioningSetAdjacency(partitioning, adjacency));
  if (status == DVI_OK) status = set_type(partitioning, divider->partitioner);
  if (status == DVI_OK)
    status = dvi__check_petsc(MatPartitioningSetNParts(partitioning, (PetscInt)divider->parts));
  if (status == DVI_OK) status = dvi__check_petsc(apply(partitioning, g, owner));
  (void)MatPartitioningDestroy(&partitioning);
  (void)MatDestroy(&adjacency);
  return status;
}

/* Tell all processes the owners that each has found. */
static PetscErrorCode gather(const dvi__divider *divider, int64_t cells, PetscInt *owner)
{
  for (int r = 0; r < divider->world->count; r++) {
    const int64_t first = cells * r / divider->world->count,
                  last = cells * (r + 1) / divider->world->count;
    PetscCallMPI(MPI_Bcast(owner + first, (int)(last - first), MPIU_INT, r, divider->world->comm));
  }
  return 0;
}

static dvi_status find_by_graph(const dvi_mesh *mesh, const dvi__divider *divider, int64_t cells,
                                PetscInt *found)
{
  const int rank = divider->world->rank, ranks = divider->world->count;
  graph g = {.first = cells * rank / ranks, .last = cells * (rank + 1) / ranks};
  const dvi_status made = found != NULL ? make_graph(mesh, &g)
                                        : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for owners");
  dvi_status status = dvi__world_agree(divider->world, made);
  if (status != DVI_OK) {
    (void)PetscFree(g.start);
    (void)PetscFree(g.neighbour);
    return status;
  }
  status = dvi__world_agree(divider->world, partition(divider, cells, &g, found));
  return status == DVI_OK ? dvi__check_petsc(gather(divider, cells, found)) : status;
}

dvi_status dvi__find_owners(const dvi_mesh *mesh, const dvi__divider *divider, int *owner)
{
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  if (strcmp(divider->partitioner, "blocks") == 0 || divider->parts == 1) {
    for (int64_t c = 0; c < cells; c++) owner[c] = (int)(c * divider->parts / cells);
    return DVI_OK;
  }
  PetscInt *found = DVI_NEW(PetscInt, cells);
  const dvi_status status = find_by_graph(mesh, divider, cells, found);
  for (int64_t c = 0; c < cells && status == DVI_OK; c++) owner[c] = (int)found[c];
  dvi__release(found);
  return status;
}
