/* A mesh divided among processes: the graph of its n-cells goes to a partitioner of PETSc, and the
 * values of ghosts come through a star forest for each degree (PetscSF). */
#include <dvi/petsc.h>
#include <petscmat.h>
#include <petscsf.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { DEGREES = DVI_MESH_DIMENSION_MAX + 1, NAME_SIZE = 32 };

struct dvi_division {
  MPI_Comm comm;
  PetscSF forest[DEGREES]; /* roots are the owners' cells, leaves the ghosts */
  char partitioner[NAME_SIZE];
  dvi_division_facts facts;
};

static dvi_status check_petsc(PetscErrorCode code)
{
  const char *words = NULL;
  if (code == 0) return DVI_OK;
  (void)PetscErrorMessage(code, &words, NULL);
  return dvi__fail(DVI_SOLVER_FAILED, "petsc: %s (code %d)", words != NULL ? words : "failed",
                   (int)code);
}

/* ---- how processes speak with each other ---- */

static int refresh(int degree, double *values, void *user)
{
  const dvi_division *d = user;
  const PetscSF forest = d->forest[degree];
  int failed = PetscSFBcastBegin(forest, MPI_DOUBLE, values, values, MPI_REPLACE);
  if (failed == 0) failed = PetscSFBcastEnd(forest, MPI_DOUBLE, values, values, MPI_REPLACE);
  return failed;
}

static int sum(int count, int64_t *number, void *user)
{
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_INT64_T, MPI_SUM,
                       ((const dvi_division *)user)->comm);
}

static int largest(int count, double *number, void *user)
{
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_DOUBLE, MPI_MAX,
                       ((const dvi_division *)user)->comm);
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

/* Fill in the rows. PETSc owns them from then on. */
static PetscErrorCode fill_graph(const dvi_matrix *d, const int *side, graph *g)
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

static PetscErrorCode partition(MPI_Comm comm, const char *name, int64_t cells, graph *g,
                                PetscInt *owner)
{
  MatPartitioning divider;
  Mat adjacency;
  IS parts;
  const PetscInt *part;
  PetscCall(MatCreateMPIAdj(comm, (PetscInt)(g->last - g->first), (PetscInt)cells, g->start,
                            g->neighbour, NULL, &adjacency));
  PetscCall(MatPartitioningCreate(comm, &divider));
  PetscCall(MatPartitioningSetAdjacency(divider, adjacency));
  PetscCall(MatPartitioningSetType(divider, name));
  PetscCall(MatPartitioningApply(divider, &parts));
  PetscCall(ISGetIndices(parts, &part));
  PetscCall(PetscArraycpy(owner + g->first, part, (size_t)(g->last - g->first)));
  PetscCall(ISRestoreIndices(parts, &part));
  PetscCall(ISDestroy(&parts));
  PetscCall(MatPartitioningDestroy(&divider));
  return MatDestroy(&adjacency);
}

/* Tell all processes the owners that each has found. */
static PetscErrorCode gather(MPI_Comm comm, int64_t cells, int ranks, PetscInt *owner)
{
  for (int r = 0; r < ranks; r++) {
    const int64_t first = cells * r / ranks, last = cells * (r + 1) / ranks;
    PetscCallMPI(MPI_Bcast(owner + first, (int)(last - first), MPIU_INT, r, comm));
  }
  return 0;
}

static dvi_status find_owners(const dvi_mesh *mesh, const dvi_division *division, int *owner)
{
  const int ranks = division->facts.ranks, rank = division->facts.rank;
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  dvi_matrix d;
  if (strcmp(division->partitioner, "blocks") == 0 || ranks == 1) {
    for (int64_t c = 0; c < cells; c++) owner[c] = (int)(c * ranks / cells);
    return DVI_OK;
  }
  DVI_TRY(dvi_mesh_incidence(mesh, dvi_mesh_dimension(mesh) - 1, &d));
  graph g = {.first = cells * rank / ranks, .last = cells * (rank + 1) / ranks};
  int *side = find_sides(&d);
  PetscInt *found = DVI_NEW(PetscInt, cells);
  dvi_status status = side != NULL && found != NULL
                          ? check_petsc(fill_graph(&d, side, &g))
                          : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a graph");
  if (status == DVI_OK)
    status = check_petsc(partition(division->comm, division->partitioner, cells, &g, found));
  if (status == DVI_OK) status = check_petsc(gather(division->comm, cells, ranks, found));
  for (int64_t c = 0; c < cells && status == DVI_OK; c++) owner[c] = (int)found[c];
  dvi__release(side);
  dvi__release(found);
  return status;
}

/* ---- star forests ---- */

/* Own cells, or the others, of a degree of the share: their numbers in the whole mesh, and in the
 * share. */
typedef struct selection {
  PetscInt count, *number, *place;
} selection;

static PetscErrorCode select_cells(const dvi_mesh *share, int k, int rank, int own, selection *s)
{
  const int64_t cells = dvi_mesh_count(share, k), *number = dvi_mesh_share_numbers(share, k);
  const int *owner = dvi_mesh_share_owners(share, k);
  PetscCall(PetscMalloc2((size_t)cells, &s->number, (size_t)cells, &s->place));
  s->count = 0;
  for (int64_t c = 0; c < cells; c++) {
    if ((owner[c] == rank) != own) continue;
    s->number[s->count] = (PetscInt)number[c];
    s->place[s->count++] = (PetscInt)c;
  }
  return 0;
}

static PetscErrorCode plant(dvi_division *division, const dvi_mesh *share, int64_t total, int k)
{
  PetscLayout layout;
  selection own, ghost;
  PetscCall(select_cells(share, k, division->facts.rank, 1, &own));
  PetscCall(select_cells(share, k, division->facts.rank, 0, &ghost));
  PetscCall(PetscLayoutCreateFromSizes(division->comm, PETSC_DECIDE, (PetscInt)total, 1, &layout));
  PetscCall(PetscSFCreateByMatchingIndices(layout, own.count, own.number, own.place, 0, ghost.count,
                                           ghost.number, ghost.place, 0, NULL,
                                           &division->forest[k]));
  PetscCall(PetscSFSetUp(division->forest[k]));
  division->facts.owned[k] = own.count;
  division->facts.ghosts[k] = ghost.count;
  division->facts.bytes_in[k] = ghost.count * (int64_t)sizeof(double);
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCall(PetscFree2(own.number, own.place));
  return PetscFree2(ghost.number, ghost.place);
}

static PetscErrorCode plant_all(dvi_division *division, const dvi_mesh *share, const dvi_mesh *mesh)
{
  const int n = dvi_mesh_dimension(share);
  PetscMPIInt neighbours = 0;
  for (int k = 0; k <= n; k++) PetscCall(plant(division, share, dvi_mesh_count(mesh, k), k));
  PetscCall(PetscSFGetRootRanks(division->forest[n], &neighbours, NULL, NULL, NULL, NULL));
  division->facts.neighbours = (int)neighbours;
  return 0;
}

/* ---- create ---- */

static dvi_status choose(const dvi_division_options *options, dvi_division *division)
{
  const char *name = options != NULL && options->partitioner != NULL ? options->partitioner
                                                                     : "ptscotch";
  if (strlen(name) >= NAME_SIZE)
    return dvi__fail(DVI_BAD_OPTION, "petsc: there is no partitioner \"%s\"", name);
  strcpy(division->partitioner, name);
  division->facts.partitioner = division->partitioner;
  return DVI_OK;
}

static dvi_status join(MPI_Comm comm, dvi_division *division)
{
  if (MPI_Comm_dup(comm, &division->comm) != MPI_SUCCESS)
    return dvi__fail(DVI_SOLVER_FAILED, "petsc: MPI could not make a communicator");
  (void)MPI_Comm_set_errhandler(division->comm, MPI_ERRORS_RETURN);
  (void)MPI_Comm_rank(division->comm, &division->facts.rank);
  (void)MPI_Comm_size(division->comm, &division->facts.ranks);
  return DVI_OK;
}

static dvi_status make(const dvi_mesh *mesh, dvi_division *division, dvi_mesh **share)
{
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  int *owner = DVI_NEW(int, cells);
  if (owner == NULL) return dvi__fail(DVI_NO_MEMORY, "petsc: no memory for owners");
  const dvi_ranks ranks = {.size = sizeof ranks,
                           .rank = division->facts.rank,
                           .count = division->facts.ranks,
                           .refresh = refresh,
                           .sum = sum,
                           .largest = largest,
                           .user = division};
  dvi_status status = find_owners(mesh, division, owner);
  if (status == DVI_OK) status = dvi_mesh_cut(mesh, owner, &ranks, share);
  dvi__release(owner);
  if (status == DVI_OK) status = check_petsc(plant_all(division, *share, mesh));
  return status;
}

dvi_status dvi_mesh_divide(const dvi_mesh *mesh, const dvi_division_options *options,
                           dvi_mesh **share, dvi_division **division)
{
  if (mesh == NULL || share == NULL || division == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a mesh and places for results are needed");
  if (options != NULL && options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: set options.size to sizeof(dvi_division_options)");
  *share = NULL;
  *division = DVI_NEW(dvi_division, 1);
  if (*division == NULL) return dvi__fail(DVI_NO_MEMORY, "petsc: no memory");
  (*division)->comm = MPI_COMM_NULL;
  dvi_status status = choose(options, *division);
  if (status == DVI_OK)
    status = join(options != NULL && options->comm != MPI_COMM_NULL && options->comm != NULL
                      ? options->comm
                      : MPI_COMM_WORLD,
                  *division);
  if (status == DVI_OK) status = make(mesh, *division, share);
  if (status == DVI_OK) return DVI_OK;
  dvi_mesh_destroy(share);
  dvi_division_destroy(division);
  return status;
}

void dvi_division_facts_of(const dvi_division *division, dvi_division_facts *facts)
{
  if (division != NULL && facts != NULL) *facts = division->facts;
}

void dvi_division_destroy(dvi_division **division)
{
  if (division == NULL || *division == NULL) return;
  for (int k = 0; k < DEGREES; k++) (void)PetscSFDestroy(&(*division)->forest[k]);
  if ((*division)->comm != MPI_COMM_NULL) (void)MPI_Comm_free(&(*division)->comm);
  dvi__release(*division);
  *division = NULL;
}
