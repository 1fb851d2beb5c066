#include "world.h"

#include "core/status.h"

dvi_status dvi__world_join(MPI_Comm comm, dvi__world *world)
{
  static const MPI_Comm none = 0;
  const int is_given = comm != MPI_COMM_NULL && comm != none;
  if (MPI_Comm_dup(is_given ? comm : MPI_COMM_WORLD, &world->comm) != MPI_SUCCESS)
    return dvi__fail(DVI_SOLVER_FAILED, "petsc: MPI could not make a communicator");
  (void)MPI_Comm_set_errhandler(world->comm, MPI_ERRORS_RETURN);
  (void)MPI_Comm_rank(world->comm, &world->rank);
  (void)MPI_Comm_size(world->comm, &world->count);
  return DVI_OK;
}

void dvi__world_leave(dvi__world *world)
{
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
