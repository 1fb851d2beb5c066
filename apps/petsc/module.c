#define _POSIX_C_SOURCE 200809L
#include "petsc/petsc_module.h"

#include <dvi/petsc.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

/* How long a process that has failed waits for the others, which may wait for it elsewhere. */
enum { PATIENCE = 2000, PAUSE = 5 }; /* milliseconds */

static dvi_division *division;
static dvi_yee_ranks *planes;
/* What all processes do together. It stays pending if this one gives up and ends the others. */
static MPI_Request pending = MPI_REQUEST_NULL;
static MPI_Win common = MPI_WIN_NULL; /* memory of one machine */

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
  return dvi_mesh_divide(mesh, NULL, share, &division);
}

static const dvi_yee_ranks *grid(void)
{
  if (planes == NULL) (void)dvi_yee_ranks_create(MPI_COMM_WORLD, &planes);
  return planes;
}

static void tell(int rank, int degree, mesh_division *told)
{
  dvi_division_facts facts = {.partitioner = ""};
  int n = DVI_MESH_DIMENSION_MAX;
  dvi_division_facts_of(division, &facts);
  while (n > 0 && facts.owned[n] == 0) n--;
  int64_t number[] = {facts.owned[n], facts.ghosts[n], facts.bytes_in[degree],
                      facts.messages_in[degree], facts.neighbours};
  (void)MPI_Bcast(number, sizeof number / sizeof *number, MPI_INT64_T, rank, MPI_COMM_WORLD);
  *told = (mesh_division){.partitioner = facts.partitioner,
                          .owned = number[0],
                          .ghosts = number[1],
                          .bytes_in = number[2],
                          .messages_in = (int)number[3],
                          .neighbours = (int)number[4]};
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

static void end(void)
{
  dvi_division_destroy(&division);
  dvi_yee_ranks_destroy(&planes);
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
    .grid = grid,
    .tell = tell,
    .largest = largest,
    .meet = meet,
    .end = end,
    .abandon = abandon,
};
