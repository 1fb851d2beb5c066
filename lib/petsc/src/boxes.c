/* Grids of boxes that are divided along axes: planes go from one process to another, which needs no
 * DMDA. */
#include <dvi/petsc.h>

#include "core/memory.h"
#include "core/status.h"
#include "world.h"

enum { MOST = 1 << 28 }; /* numbers in a message */

static int process_of(int rank)
{
  return rank >= 0 ? rank : MPI_PROC_NULL;
}

/* MPI counts by int. */
static int pass(int to, int from, int64_t count, const double *sent, double *received, void *user)
{
  const dvi__world *world = user;
  int failed = MPI_SUCCESS;
  for (int64_t done = 0; done < count && failed == MPI_SUCCESS; done += MOST) {
    const int next = (int)(count - done < MOST ? count - done : MOST);
    failed = MPI_Sendrecv(sent + done, next, MPI_DOUBLE, process_of(to), 0, received + done, next,
                          MPI_DOUBLE, process_of(from), 0, world->comm, MPI_STATUS_IGNORE);
  }
  return failed;
}

dvi_status dvi_yee_ranks_create(MPI_Comm comm, dvi_yee_ranks **ranks)
{
  int is_started = 0;
  if (ranks == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a place for ranks is needed");
  *ranks = NULL;
  (void)MPI_Initialized(&is_started);
  if (!is_started) return dvi__fail(DVI_BAD_ARGUMENT, "petsc: start MPI before grids are divided");
  /* join the others before memory can fail here alone, so that it is agreed on */
  dvi__world joined;
  DVI_TRY(dvi__world_join(comm, &joined));
  dvi__world *world = DVI_NEW(dvi__world, 1);
  dvi_yee_ranks *r = DVI_NEW(dvi_yee_ranks, 1);
  const int has_memory = world != NULL && r != NULL;
  const dvi_status status = dvi__world_agree(
      &joined, has_memory ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "petsc: no memory"));
  if (status != DVI_OK || !has_memory) {
    dvi__world_leave(&joined);
    dvi__release(world);
    dvi__release(r);
    return status;
  }
  *world = joined;
  *r = (dvi_yee_ranks){.size = sizeof *r,
                       .rank = world->rank,
                       .count = world->count,
                       .pass = pass,
                       .sum = dvi__world_sum,
                       .largest = dvi__world_largest,
                       .user = world};
  *ranks = r;
  return DVI_OK;
}

void dvi_yee_ranks_destroy(dvi_yee_ranks **ranks)
{
  if (ranks == NULL || *ranks == NULL) return;
  dvi__world *world = (*ranks)->user;
  dvi__world_leave(world);
  dvi__release(world);
  dvi__release(*ranks);
  *ranks = NULL;
}
