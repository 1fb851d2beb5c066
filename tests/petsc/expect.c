#include "expect.h"

#include <dvi/status.h>
#include <mpi.h>
#include <stdio.h>

int rank, ranks, failures;

void expect(int holds, const char *what, const char *where)
{
  int all = holds;
  (void)MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (all) return;
  failures++;
  if (!holds)
    (void)fprintf(stderr, "process %d of %d, %s: %s (%s)\n", rank, ranks, where, what,
                  dvi_last_error());
}
