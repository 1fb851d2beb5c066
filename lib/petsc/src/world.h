/* The processes of a communicator, and what they tell each other. */
#ifndef DVI_PETSC_WORLD_H
#define DVI_PETSC_WORLD_H
#include <dvi/status.h>
#include <mpi.h>
#include <stdint.h>

#include "traffic.h"

typedef struct dvi__world {
  MPI_Comm comm;
  int rank, count;                  /* this process, and how many there are */
  int64_t agreements;               /* sums and largest numbers so far */
  struct dvi__letter *on_their_way; /* numbers that may not have been taken */
  dvi__traffic letters;             /* those that were received */
  int64_t corrections, iterations;  /* of the solver */
  dvi__traffic iteration;           /* of the last one of these */
} dvi__world;

/* Join a copy of a communicator, whose errors are returned. MPI_COMM_NULL and 0 are all processes.
 */
dvi_status dvi__world_join(MPI_Comm comm, dvi__world *world);
void dvi__world_leave(dvi__world *world);

/* The functions of dvi_ranks and dvi_yee_ranks. `world` is a dvi__world. */
int dvi__world_sum(int count, int64_t *number, void *world);
int dvi__world_largest(int count, double *number, void *world);
int dvi__world_send(int to, int count, const double *number, void *world);
int dvi__world_receive(int from, int most, double *number, int *count, void *world);

/* Agree with all processes whether they have succeeded so far. If not, all of them fail. */
dvi_status dvi__world_agree(const dvi__world *world, dvi_status status);

/* Fail because the processes could not speak with each other. */
dvi_status dvi__world_fail(const dvi__world *world);

#endif
