/* Grids of boxes that are divided along one axis: planes go to the two neighbours only, which needs
 * no DMDA. */
#include <dvi/petsc.h>
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"

/* The functions' user. */
typedef struct dvi__line {
  MPI_Comm comm;
  int rank, count;
} dvi__line;

/* Give the process that is that far, or none. */
static int process_at(const dvi__line *line, int away, int around)
{
  const int at = line->rank + away;
  if (at >= 0 && at < line->count) return at;
  return around ? (at + line->count) % line->count : MPI_PROC_NULL;
}

static int pass(int way, int around, int64_t count, const double *sent, double *received,
                void *user)
{
  const dvi__line *line = user;
  if (count > INT_MAX) return MPI_ERR_COUNT;
  return MPI_Sendrecv(sent, (int)count, MPI_DOUBLE, process_at(line, way, around), 0, received,
                      (int)count, MPI_DOUBLE, process_at(line, -way, around), 0, line->comm,
                      MPI_STATUS_IGNORE);
}

static int sum(int count, int64_t *number, void *user)
{
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_INT64_T, MPI_SUM,
                       ((const dvi__line *)user)->comm);
}

static int largest(int count, double *number, void *user)
{
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_DOUBLE, MPI_MAX,
                       ((const dvi__line *)user)->comm);
}

/* Errors are returned, so that a march can tell them. */
static dvi_status join(MPI_Comm comm, dvi__line *line)
{
  if (MPI_Comm_dup(comm, &line->comm) != MPI_SUCCESS)
    return dvi__fail(DVI_SOLVER_FAILED, "petsc: MPI could not make a communicator");
  (void)MPI_Comm_set_errhandler(line->comm, MPI_ERRORS_RETURN);
  (void)MPI_Comm_rank(line->comm, &line->rank);
  (void)MPI_Comm_size(line->comm, &line->count);
  return DVI_OK;
}

dvi_status dvi_yee_ranks_create(MPI_Comm comm, dvi_yee_ranks **ranks)
{
  int is_started = 0;
  if (ranks == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a place for ranks is needed");
  *ranks = NULL;
  (void)MPI_Initialized(&is_started);
  if (!is_started) return dvi__fail(DVI_BAD_ARGUMENT, "petsc: start MPI before grids are divided");
  dvi__line *line = DVI_NEW(dvi__line, 1);
  dvi_yee_ranks *r = DVI_NEW(dvi_yee_ranks, 1);
  dvi_status status = line != NULL && r != NULL ? DVI_OK
                                                : dvi__fail(DVI_NO_MEMORY, "petsc: no memory");
  if (status == DVI_OK) status = join(comm != MPI_COMM_NULL ? comm : MPI_COMM_WORLD, line);
  if (status != DVI_OK) {
    dvi__release(line);
    dvi__release(r);
    return status;
  }
  *r = (dvi_yee_ranks){.size = sizeof *r,
                       .rank = line->rank,
                       .count = line->count,
                       .pass = pass,
                       .sum = sum,
                       .largest = largest,
                       .user = line};
  *ranks = r;
  return DVI_OK;
}

void dvi_yee_ranks_destroy(dvi_yee_ranks **ranks)
{
  if (ranks == NULL || *ranks == NULL) return;
  dvi__line *line = (*ranks)->user;
  (void)MPI_Comm_free(&line->comm);
  dvi__release(line);
  dvi__release(*ranks);
  *ranks = NULL;
}
