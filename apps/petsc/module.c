#define _POSIX_C_SOURCE 200809L
#include "petsc/petsc_module.h"

#include <dvi/petsc.h>
#include <stddef.h>
#include <time.h>

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

/* How long a process that has failed waits for the others, which may wait for it elsewhere. */
enum { PATIENCE = 2000, PAUSE = 5 }; /* milliseconds */

static dvi_division *division;

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

static dvi_status divide(const dvi_mesh *mesh, dvi_mesh **share)
{
  dvi_division_destroy(&division);
  return dvi_mesh_divide(mesh, NULL, share, &division);
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

/* Wait until a request is met, for good or only for a while. */
static bool is_met(MPI_Request request, bool has_failed)
{
  const struct timespec pause = {.tv_nsec = PAUSE * 1000000L};
  int met = 0;
  if (!has_failed) return MPI_Wait(&request, MPI_STATUS_IGNORE) == MPI_SUCCESS;
  for (int waited = 0; !met && waited < PATIENCE; waited += PAUSE) {
    if (MPI_Test(&request, &met, MPI_STATUS_IGNORE) != MPI_SUCCESS) return false;
    if (!met) (void)nanosleep(&pause, NULL);
  }
  return met;
}

static bool largest(int number, bool has_failed, int *all)
{
  MPI_Request request;
  return MPI_Iallreduce(&number, all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &request) ==
             MPI_SUCCESS &&
         is_met(request, has_failed);
}

static bool meet(const rank_end *own, rank_end *all)
{
  MPI_Request request;
  return MPI_Iallgather(own, (int)sizeof *own, MPI_BYTE, all, (int)sizeof *all, MPI_BYTE,
                        MPI_COMM_WORLD, &request) == MPI_SUCCESS &&
         is_met(request, own->code != 0);
}

static void end(void)
{
  dvi_division_destroy(&division);
  (void)PetscPopErrorHandler();
  (void)PetscFinalize();
}

static void abandon(int code)
{
  (void)MPI_Abort(MPI_COMM_WORLD, code);
}

const petsc_module dvi_petsc = {
    .start = start,
    .divide = divide,
    .tell = tell,
    .modes = find_modes,
    .largest = largest,
    .meet = meet,
    .end = end,
    .abandon = abandon,
};
