#include "world.h"

#include "core/memory.h"
#include "core/status.h"

/* A copy of numbers that are sent, which MPI reads until they have been taken. */
typedef struct dvi__letter {
  struct dvi__letter *next;
  MPI_Request request;
  double *number;
} dvi__letter;

/* Forget the first letter if it has been taken, or in any case. Returns whether it is gone. */
static int forget_first(dvi__letter **first, int in_any_case)
{
  dvi__letter *letter = *first;
  int is_taken = 1;
  (void)MPI_Test(&letter->request, &is_taken, MPI_STATUS_IGNORE);
  if (!is_taken && !in_any_case) return 0;
  if (!is_taken) {
    (void)MPI_Cancel(&letter->request);
    /* NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): dvi__world_send began it */
    (void)MPI_Wait(&letter->request, MPI_STATUS_IGNORE);
  }
  *first = letter->next;
  dvi__release(letter->number);
  dvi__release(letter);
  return 1;
}

dvi_status dvi__world_join(MPI_Comm comm, dvi__world *world)
{
  static const MPI_Comm none = 0;
  const int is_given = comm != MPI_COMM_NULL && comm != none;
  *world = (dvi__world){.comm = MPI_COMM_NULL};
  if (MPI_Comm_dup(is_given ? comm : MPI_COMM_WORLD, &world->comm) != MPI_SUCCESS)
    return dvi__fail(DVI_SOLVER_FAILED, "petsc: MPI could not make a communicator");
  (void)MPI_Comm_set_errhandler(world->comm, MPI_ERRORS_RETURN);
  (void)MPI_Comm_rank(world->comm, &world->rank);
  (void)MPI_Comm_size(world->comm, &world->count);
  return DVI_OK;
}

void dvi__world_leave(dvi__world *world)
{
  while (world->on_their_way != NULL) forget_first(&world->on_their_way, 1);
  if (world->comm != MPI_COMM_NULL) (void)MPI_Comm_free(&world->comm);
}

int dvi__world_sum(int count, int64_t *number, void *world)
{
  dvi__world *w = world;
  w->agreements++;
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_INT64_T, MPI_SUM, w->comm);
}

int dvi__world_largest(int count, double *number, void *world)
{
  dvi__world *w = world;
  w->agreements++;
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_DOUBLE, MPI_MAX, w->comm);
}

int dvi__world_send(int to, int count, const double *number, void *world)
{
  dvi__world *w = world;
  dvi__letter **last = &w->on_their_way;
  while (*last != NULL)
    if (!forget_first(last, 0)) last = &(*last)->next;
  dvi__letter *letter = DVI_NEW(dvi__letter, 1);
  double *copy = dvi__duplicate(number, (size_t)count, sizeof *number);
  if (letter == NULL || copy == NULL) {
    dvi__release(letter);
    dvi__release(copy);
    return MPI_ERR_NO_MEM;
  }
  letter->number = copy;
  letter->request = MPI_REQUEST_NULL;
  *last = letter;
  /* NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): forget_first ends it */
  return MPI_Isend(copy, count, MPI_DOUBLE, to, 0, w->comm, &letter->request);
}

int dvi__world_receive(int from, int most, double *number, int *count, void *world)
{
  dvi__world *w = world;
  MPI_Status status;
  MPI_Message message;
  int failed = MPI_Mprobe(from, 0, w->comm, &message, &status);
  if (failed == MPI_SUCCESS) failed = MPI_Get_count(&status, MPI_DOUBLE, count);
  if (failed != MPI_SUCCESS || *count > most) return failed != MPI_SUCCESS ? failed : MPI_ERR_COUNT;
  w->letters.messages++;
  w->letters.bytes += *count * (int64_t)sizeof *number;
  return MPI_Mrecv(number, *count, MPI_DOUBLE, &message, MPI_STATUS_IGNORE);
}

dvi_status dvi__world_fail(const dvi__world *world)
{
  return dvi__fail(DVI_SOLVER_FAILED, "petsc: process %d of %d could not speak with the others",
                   world->rank, world->count);
}

dvi_status dvi__world_agree(const dvi__world *world, dvi_status status)
{
  int extreme[2] = {(int)status, -(int)status}; /* failures have numbers above or below 0 */
  if (MPI_Allreduce(MPI_IN_PLACE, extreme, 2, MPI_INT, MPI_MAX, world->comm) != MPI_SUCCESS)
    return status != DVI_OK ? status : dvi__world_fail(world);
  const dvi_status agreed = (dvi_status)(extreme[1] > 0 ? -extreme[1] : extreme[0]);
  if (status != DVI_OK || agreed == DVI_OK) return agreed;
  return dvi__fail(agreed, "petsc: another process of %d failed, whose sentence tells why",
                   world->count);
}
