/* A mesh divided among processes: the graph of its n-cells goes to a partitioner of PETSc, and the
 * values of ghosts come through a star forest for each degree (PetscSF). */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "division.h"
#include "owners.h"
#include "solve/solver.h"
#include "traffic.h"

/* ---- how processes speak with each other ---- */

static int refresh(int degree, double *values, void *user)
{
  const dvi_division *d = user;
  const PetscSF forest = d->forest[degree];
  int failed = PetscSFBcastBegin(forest, MPI_DOUBLE, values, values, MPI_REPLACE);
  if (failed == 0) failed = PetscSFBcastEnd(forest, MPI_DOUBLE, values, values, MPI_REPLACE);
  return failed;
}

dvi_ranks dvi__division_ranks(dvi_division *division)
{
  return (dvi_ranks){.size = sizeof(dvi_ranks),
                     .rank = division->world.rank,
                     .count = division->world.count,
                     .refresh = refresh,
                     .sum = dvi__world_sum,
                     .largest = dvi__world_largest,
                     .send = dvi__world_send,
                     .receive = dvi__world_receive,
                     .solver = &dvi__solver_of_petsc,
                     .user = division};
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

static PetscErrorCode drop_selection(selection *s)
{
  return PetscFree2(s->number, s->place);
}

/* Own cells and ghosts of all degrees. */
typedef struct selections {
  selection own[DVI__DEGREES], ghost[DVI__DEGREES];
} selections;

static PetscErrorCode select_all(const dvi_mesh *share, int rank, selections *s)
{
  for (int k = 0; k <= dvi_mesh_dimension(share); k++) {
    PetscCall(select_cells(share, k, rank, 1, s->own + k));
    PetscCall(select_cells(share, k, rank, 0, s->ghost + k));
  }
  return 0;
}

static PetscErrorCode plant(dvi_division *division, const selections *s, int64_t total, int k)
{
  const selection *own = s->own + k, *ghost = s->ghost + k;
  PetscLayout layout;
  PetscCall(
      PetscLayoutCreateFromSizes(division->world.comm, PETSC_DECIDE, (PetscInt)total, 1, &layout));
  PetscCall(PetscSFCreateByMatchingIndices(layout, own->count, own->number, own->place, 0,
                                           ghost->count, ghost->number, ghost->place, 0, NULL,
                                           &division->forest[k]));
  PetscCall(PetscSFSetUp(division->forest[k]));
  division->facts.owned[k] = own->count;
  division->facts.ghosts[k] = ghost->count;
  division->facts.bytes_in[k] = ghost->count * (int64_t)sizeof(double);
  PetscMPIInt owners = 0;
  PetscCall(PetscSFGetRootRanks(division->forest[k], &owners, NULL, NULL, NULL, NULL));
  division->facts.messages_in[k] = (int)owners;
  return PetscLayoutDestroy(&layout);
}

static PetscErrorCode plant_all(dvi_division *division, const selections *s, int n,
                                const int64_t *total)
{
  for (int k = 0; k <= n; k++) PetscCall(plant(division, s, total[k], k));
  division->facts.neighbours = division->facts.messages_in[n];
  division->facts.rank = division->world.rank;
  division->facts.ranks = division->world.count;
  return 0;
}

dvi_status dvi__division_join(dvi_division *division, const dvi_mesh *share, const int64_t *total)
{
  const int n = dvi_mesh_dimension(share);
  selections s = {0};
  division->share = share;
  dvi_status status = dvi__world_agree(
      &division->world, dvi__check_petsc(select_all(share, division->world.rank, &s)));
  if (status == DVI_OK)
    status = dvi__world_agree(&division->world,
                              dvi__check_petsc(plant_all(division, &s, n, total)));
  for (int k = 0; k < DVI__DEGREES; k++) {
    (void)drop_selection(s.own + k);
    (void)drop_selection(s.ghost + k);
  }
  return status;
}

/* ---- create ---- */

/* All processes must call PETSc, which has been started and has not ended. */
static dvi_status check_started(void)
{
  PetscBool started = PETSC_FALSE, ended = PETSC_FALSE;
  (void)PetscInitialized(&started);
  (void)PetscFinalized(&ended);
  if (started && !ended) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "petsc: start PETSc before a mesh is divided "
                                     "(PetscInitialize)");
}

static dvi_status choose(const dvi_division_options *options, dvi_division *division)
{
#ifdef PETSC_HAVE_PTSCOTCH
  const char *name = "ptscotch";
#else
  const char *name = "blocks";
#endif
  if (options != NULL && options->partitioner != NULL) name = options->partitioner;
  if (strlen(name) >= DVI__NAME_SIZE)
    return dvi__fail(DVI_BAD_OPTION, "petsc: there is no partitioner \"%s\"", name);
  memcpy(division->partitioner, name, strlen(name) + 1);
  division->facts.partitioner = division->partitioner;
  return DVI_OK;
}

dvi_status dvi__check_enough(int parts, int64_t cells)
{
  if (cells >= parts) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "petsc: %d processes cannot share %lld cells: take fewer",
                   parts, (long long)cells);
}

/* The processes have the same mesh, as far as the numbers of cells tell, with enough cells for the
 * parts. */
static dvi_status check_mesh(const dvi_mesh *mesh, const dvi__world *world, int parts)
{
  int64_t count[2 * DVI__DEGREES] = {0};
  const int n = dvi_mesh_dimension(mesh);
  for (int k = 0; k < DVI__DEGREES; k++) {
    count[2 * k] = dvi_mesh_count(mesh, k);
    count[2 * k + 1] = -count[2 * k];
  }
  if (MPI_Allreduce(MPI_IN_PLACE, count, 2 * DVI__DEGREES, MPI_INT64_T, MPI_MAX, world->comm) !=
      MPI_SUCCESS)
    return dvi__world_fail(world);
  for (int k = 0; k < DVI__DEGREES; k++)
    if (count[2 * k] != -count[2 * k + 1])
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "petsc: the mesh is not the same on all processes: they "
                       "have %lld to %lld cells of degree %d",
                       (long long)-count[2 * k + 1], (long long)count[2 * k], k);
  return dvi__check_enough(parts, count[2 * n]);
}

static dvi_status make(const dvi_mesh *mesh, dvi_division *division, dvi_mesh **share)
{
  const dvi__world *world = &division->world;
  const dvi__divider divider = {
      .world = world, .parts = world->count, .partitioner = division->partitioner};
  const dvi_ranks ranks = dvi__division_ranks(division);
  int64_t total[DVI__DEGREES];
  DVI_TRY(check_mesh(mesh, world, world->count));
  int *owner = DVI_NEW(int, dvi_mesh_count(mesh, dvi_mesh_dimension(mesh)));
  dvi_status status = dvi__world_agree(
      world, owner != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for owners"));
  if (status == DVI_OK) status = dvi__find_owners(mesh, &divider, owner);
  if (status == DVI_OK) status = dvi__world_agree(world, dvi_mesh_cut(mesh, owner, &ranks, share));
  dvi__release(owner);
  for (int k = 0; k < DVI__DEGREES; k++) total[k] = dvi_mesh_count(mesh, k);
  return status == DVI_OK ? dvi__division_join(division, *share, total) : status;
}

static dvi_status check_options(const dvi_division_options *options)
{
  if (options == NULL || options->size == sizeof *options) return check_started();
  return dvi__fail(DVI_BAD_ARGUMENT, "petsc: set options.size to sizeof(dvi_division_options)");
}

/* Join the others before anything can fail here alone: memory is agreed on with them. */
static dvi_status take_place(const dvi_division_options *options, dvi_division **made)
{
  dvi__world world = {.comm = MPI_COMM_NULL};
  DVI_TRY(dvi__world_join(options != NULL ? options->comm : MPI_COMM_NULL, &world));
  *made = DVI_NEW(dvi_division, 1);
  if (*made == NULL) {
    const dvi_status status = dvi__world_agree(&world,
                                               dvi__fail(DVI_NO_MEMORY, "petsc: no memory"));
    dvi__world_leave(&world);
    return status;
  }
  (*made)->world = world;
  (*made)->before = dvi__traffic_so_far();
  return dvi__world_agree(&world, DVI_OK);
}

dvi_status dvi__division_begin(const dvi_division_options *options, dvi_division **division)
{
  DVI_TRY(check_options(options));
  const dvi_status status = take_place(options, division);
  return status == DVI_OK && *division != NULL ? choose(options, *division) : status;
}

dvi_status dvi_mesh_partition(const dvi_mesh *mesh, const dvi_division_options *options, int parts,
                              int *owner)
{
  dvi_division made = {.world = {.comm = MPI_COMM_NULL}};
  if (mesh == NULL || owner == NULL || parts < 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a mesh, a number of parts and a place for owners "
                                       "are needed");
  DVI_TRY(check_options(options));
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  dvi_status status = choose(options, &made);
  if (status == DVI_OK)
    status = dvi__world_join(options != NULL ? options->comm : MPI_COMM_NULL, &made.world);
  if (status == DVI_OK) status = check_mesh(mesh, &made.world, parts);
  const dvi__divider divider = {
      .world = &made.world, .parts = parts, .partitioner = made.partitioner};
  if (status == DVI_OK) status = dvi__find_owners(mesh, &divider, owner);
  (void)PetscPopErrorHandler();
  dvi__world_leave(&made.world);
  return status;
}

dvi_status dvi_mesh_divide(const dvi_mesh *mesh, const dvi_division_options *options,
                           dvi_mesh **share, dvi_division **division)
{
  if (mesh == NULL || share == NULL || division == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a mesh and places for results are needed");
  *share = NULL;
  *division = NULL;
  dvi_division *made = NULL;
  /* The sentence is the library's, and PETSc prints none. */
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  dvi_status status = dvi__division_begin(options, &made);
  if (status == DVI_OK && made != NULL) status = make(mesh, made, share);
  (void)PetscPopErrorHandler();
  if (status != DVI_OK) {
    dvi_mesh_destroy(share);
    dvi_division_destroy(&made);
  }
  *division = made;
  return status;
}

static dvi_division_traffic show(dvi__traffic t)
{
  return (dvi_division_traffic){
      .messages = t.messages, .bytes = t.bytes, .sums = t.sums, .gathers = t.gathers};
}

void dvi_division_facts_of(const dvi_division *division, dvi_division_facts *facts)
{
  if (division == NULL || facts == NULL) return;
  const dvi__world *world = &division->world;
  dvi__traffic traffic = dvi__traffic_since(dvi__traffic_so_far(), division->before);
  traffic.messages += world->letters.messages;
  traffic.bytes += world->letters.bytes;
  *facts = division->facts;
  facts->agreements = world->agreements;
  facts->traffic = show(traffic);
  facts->corrections = world->corrections;
  facts->iterations = world->iterations;
  facts->iteration = show(world->iteration);
}

dvi_status dvi_division_refresh(dvi_division *division, int degree, double *values)
{
  if (division == NULL || values == NULL || degree < 0 || degree > DVI_MESH_DIMENSION_MAX ||
      division->forest[degree] == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a division, a degree of its cells and values are "
                                       "needed");
  return refresh(degree, values, division) == 0 ? DVI_OK : dvi__world_fail(&division->world);
}

void dvi_division_destroy(dvi_division **division)
{
  PetscBool ended = PETSC_FALSE;
  if (division == NULL || *division == NULL) return;
  (void)PetscFinalized(&ended);
  for (int k = 0; k < DVI__DEGREES && !ended; k++) (void)PetscSFDestroy(&(*division)->forest[k]);
  if (!ended) dvi__world_leave(&(*division)->world);
  dvi__release(*division);
  *division = NULL;
}
