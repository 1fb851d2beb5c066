#define _POSIX_C_SOURCE 200809L
#include "petsc/petsc_module.h"

#include <dvi/petsc.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

/* How long a process that has failed waits for the others, which may wait for it elsewhere. */
enum { PATIENCE = 2000, PAUSE = 5 }; /* milliseconds */

static dvi_division *division;
static dvi_yee_ranks *planes;
static dvi_yee_ranks counted;  /* the same, which count what is received */
static mesh_traffic of_planes; /* as counted */
/* What all processes do together. It stays pending if this one gives up and ends the others. */
static MPI_Request pending = MPI_REQUEST_NULL;
static MPI_Win common = MPI_WIN_NULL;     /* memory of one machine */
static MPI_Comm workers = MPI_COMM_WORLD; /* the processes among which there is work */

static bool start(int *rank, int *count)
{
  /* the command has handlers of its own */
  (void)PetscOptionsSetValue(NULL, "-no_signal_handler", "true");
  if (PetscInitializeNoArguments() != 0) return false;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  (void)MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  (void)MPI_Comm_rank(MPI_COMM_WORLD, rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, count);
  return true;
}

/* ---- one machine ---- */

static void *share_memory(size_t head, size_t each, int *own, int *count)
{
  MPI_Comm machine;
  MPI_Aint size = 0;
  int unit;
  void *memory = NULL;
  if (MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine) !=
      MPI_SUCCESS)
    return NULL;
  (void)MPI_Comm_rank(machine, own);
  (void)MPI_Comm_size(machine, count);
  if (*own == 0) size = (MPI_Aint)(head + (size_t)*count * each);
  const int failed = MPI_Win_allocate_shared(size, 1, MPI_INFO_NULL, machine, &memory, &common);
  if (failed || MPI_Win_shared_query(common, 0, &size, &unit, &memory) != MPI_SUCCESS) return NULL;
  if (*own == 0) memset(memory, 0, (size_t)size);
  (void)MPI_Barrier(machine);
  (void)MPI_Comm_free(&machine);
  return memory;
}

static bool wait_for_all(void)
{
  return MPI_Barrier(MPI_COMM_WORLD) == MPI_SUCCESS;
}

/* ---- shares ---- */

static dvi_status divide(const dvi_mesh *mesh, dvi_mesh **share)
{
  dvi_division_destroy(&division);
  const dvi_division_options options = {.size = sizeof options, .comm = workers};
  return dvi_mesh_divide(mesh, &options, share, &division);
}

static dvi_status read_share(const char *path, dvi_mesh **share)
{
  dvi_division_destroy(&division);
  const dvi_division_options options = {.size = sizeof options, .comm = workers};
  return dvi_mesh_read_divided(path, &options, share, &division);
}

static dvi_status save(const dvi_march *march, const char *path)
{
  return dvi_march_write_divided(march, division, path);
}

static dvi_status load(dvi_march *march, const char *path)
{
  return dvi_march_read_divided(march, division, path);
}

/* ---- planes of grids ---- */

static int pass(int to, int from, int64_t count, const double *sent, double *received, void *user)
{
  if (from >= 0) {
    of_planes.messages++;
    of_planes.bytes += count * (int64_t)sizeof *received;
  }
  return planes->pass(to, from, count, sent, received, user);
}

static int sum(int count, int64_t *number, void *user)
{
  of_planes.agreements++;
  return planes->sum(count, number, user);
}

static int largest_of(int count, double *number, void *user)
{
  of_planes.agreements++;
  return planes->largest(count, number, user);
}

static const dvi_yee_ranks *grid(void)
{
  if (planes == NULL && dvi_yee_ranks_create(workers, &planes) != DVI_OK) return NULL;
  counted = *planes;
  counted.pass = pass;
  counted.sum = sum;
  counted.largest = largest_of;
  return &counted;
}

static void tell(int rank, int degree, mesh_division *told)
{
  dvi_division_facts facts = {.partitioner = ""};
  int n = DVI_MESH_DIMENSION_MAX;
  dvi_division_facts_of(division, &facts);
  while (n > 0 && facts.owned[n] == 0) n--;
  int64_t number[] = {facts.owned[n],         facts.ghosts[n],
                      facts.bytes_in[degree], facts.messages_in[degree],
                      facts.neighbours,       facts.agreements};
  (void)MPI_Bcast(number, sizeof number / sizeof *number, MPI_INT64_T, rank, workers);
  *told = (mesh_division){.partitioner = facts.partitioner,
                          .owned = number[0],
                          .ghosts = number[1],
                          .bytes_in = number[2],
                          .messages_in = (int)number[3],
                          .neighbours = (int)number[4],
                          .agreements = number[5]};
}

static void count(mesh_traffic *traffic)
{
  dvi_division_facts facts = {.partitioner = ""};
  dvi_division_facts_of(division, &facts);
  *traffic = (mesh_traffic){.messages = facts.traffic.messages + of_planes.messages,
                            .bytes = facts.traffic.bytes + of_planes.bytes,
                            .agreements = facts.agreements + of_planes.agreements,
                            .sums = facts.traffic.sums,
                            .gathers = facts.traffic.gathers,
                            .corrections = facts.corrections,
                            .iterations = facts.iterations,
                            .iteration_messages = facts.iteration.messages,
                            .iteration_bytes = facts.iteration.bytes,
                            .iteration_sums = facts.iteration.sums,
                            .iteration_gathers = facts.iteration.gathers};
}

static dvi_status find_modes(const dvi_field *field, const dvi_modes_options *options,
                             double *eigenvalue, mode_search *search)
{
  dvi_modes_facts facts = {.solver = ""};
  const dvi_status status = dvi_division_modes(division, field, options, eigenvalue, NULL, &facts);
  *search = (mode_search){.unknowns = facts.unknowns,
                          .zeros = facts.zeros,
                          .solver = facts.solver,
                          .solutions = facts.solutions,
                          .residual = facts.residual};
  return status;
}

/* Wait until what is pending is met, for good or only for a while. */
static bool is_met(bool has_failed)
{
  const struct timespec pause = {.tv_nsec = PAUSE * 1000000L};
  int met = 0;
  if (!has_failed) return MPI_Wait(&pending, MPI_STATUS_IGNORE) == MPI_SUCCESS;
  for (int waited = 0; !met && waited < PATIENCE; waited += PAUSE) {
    if (MPI_Test(&pending, &met, MPI_STATUS_IGNORE) != MPI_SUCCESS) return false;
    if (!met) (void)nanosleep(&pause, NULL);
  }
  return met;
}

static bool largest(int number, bool has_failed, int *all)
{
  return MPI_Iallreduce(&number, all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &pending) ==
             MPI_SUCCESS &&
         is_met(has_failed);
}

static bool meet(const rank_end *own, rank_end *all)
{
  return MPI_Iallgather(own, (int)sizeof *own, MPI_BYTE, all, (int)sizeof *all, MPI_BYTE,
                        MPI_COMM_WORLD, &pending) == MPI_SUCCESS &&
         is_met(own->code != 0);
}

/* ---- measurements among some of the processes ---- */

static void dismiss(void)
{
  dvi_division_destroy(&division);
  dvi_yee_ranks_destroy(&planes);
  if (workers != MPI_COMM_WORLD && workers != MPI_COMM_NULL) (void)MPI_Comm_free(&workers);
  workers = MPI_COMM_WORLD;
}

static bool among(int count, bool *takes_part)
{
  int rank = 0;
  dismiss();
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  *takes_part = rank < count;
  if (MPI_Comm_split(MPI_COMM_WORLD, *takes_part ? 0 : MPI_UNDEFINED, rank, &workers) !=
      MPI_SUCCESS)
    return false;
  return !*takes_part || MPI_Comm_set_errhandler(workers, MPI_ERRORS_RETURN) == MPI_SUCCESS;
}

static bool rest(int number, int *all)
{
  const struct timespec pause = {.tv_nsec = PAUSE * 1000000L};
  int met = 0;
  if (MPI_Iallreduce(&number, all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &pending) != MPI_SUCCESS)
    return false;
  while (MPI_Test(&pending, &met, MPI_STATUS_IGNORE) == MPI_SUCCESS && !met)
    (void)nanosleep(&pause, NULL);
  return met;
}

static bool gather(const void *own, size_t size, void *all)
{
  return MPI_Allgather(own, (int)size, MPI_BYTE, all, (int)size, MPI_BYTE, workers) == MPI_SUCCESS;
}

static bool on_machine(int *most)
{
  MPI_Comm machine = MPI_COMM_NULL;
  if (MPI_Comm_split_type(workers, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine) != MPI_SUCCESS)
    return false;
  (void)MPI_Comm_size(machine, most);
  (void)MPI_Comm_free(&machine);
  return MPI_Allreduce(MPI_IN_PLACE, most, 1, MPI_INT, MPI_MAX, workers) == MPI_SUCCESS;
}

static dvi_status refresh(int degree, double *values)
{
  return dvi_division_refresh(division, degree, values);
}

/* Send there and back once. */
static int bounce(int rank, void *bytes, int size)
{
  const int code = rank == 0 ? MPI_Send(bytes, size, MPI_BYTE, 1, 0, workers)
                             : MPI_Recv(bytes, size, MPI_BYTE, 0, 0, workers, MPI_STATUS_IGNORE);
  if (code != MPI_SUCCESS) return code;
  return rank == 0 ? MPI_Recv(bytes, size, MPI_BYTE, 1, 0, workers, MPI_STATUS_IGNORE)
                   : MPI_Send(bytes, size, MPI_BYTE, 0, 0, workers);
}

static double ping(void *bytes, int size, int times)
{
  enum { MEANS = 5 };
  int rank = 0, code = MPI_SUCCESS;
  double least = INFINITY;
  (void)MPI_Comm_rank(workers, &rank);
  for (int i = 0; i <= MEANS; i++) {
    const double began = MPI_Wtime();
    for (int k = 0; k < times && code == MPI_SUCCESS; k++) code = bounce(rank, bytes, size);
    /* the first mean makes the connection */
    if (i > 0) least = fmin(least, (MPI_Wtime() - began) / times / 2);
  }
  return code == MPI_SUCCESS ? least : (double)NAN;
}

#ifdef PETSC_HAVE_PTSCOTCH
#define PARTITIONER "ptscotch"
#else
#define PARTITIONER "blocks"
#endif

static dvi_status partition(const dvi_mesh *mesh, int parts, int *owner)
{
  const dvi_division_options options = {
      .size = sizeof options, .comm = MPI_COMM_SELF, .partitioner = PARTITIONER};
  return dvi_mesh_partition(mesh, &options, parts, owner);
}

static void end(void)
{
  dismiss();
  if (common != MPI_WIN_NULL) (void)MPI_Win_free(&common);
  (void)PetscPopErrorHandler();
  (void)PetscFinalize();
}

static void abandon(int code)
{
  (void)MPI_Abort(MPI_COMM_WORLD, code);
}

const petsc_module dvi_petsc = {
    .start = start,
    .share_memory = share_memory,
    .wait_for_all = wait_for_all,
    .divide = divide,
    .read = read_share,
    .read_whole = dvi_mesh_read_whole,
    .write = dvi_mesh_write_divided,
    .save = save,
    .load = load,
    .grid = grid,
    .tell = tell,
    .count = count,
    .modes = find_modes,
    .largest = largest,
    .meet = meet,
    .among = among,
    .rest = rest,
    .gather = gather,
    .on_machine = on_machine,
    .refresh = refresh,
    .ping = ping,
    .partition = partition,
    .partitioner = PARTITIONER,
    .end = end,
    .abandon = abandon,
};
