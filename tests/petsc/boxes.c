/* Grids of boxes that MPI's processes divide among them have every bit of one process, which each
 * of them runs, too. Usage: mpirun -np N boxes */
#include <dvi/petsc.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "support/shares/box_shares.h"

enum { TRIALS = 16 };

/* Return whether ranks are refused before MPI's start. */
static int is_too_early(void)
{
  dvi_yee_ranks *ranks = NULL;
  return dvi_yee_ranks_create(MPI_COMM_NULL, &ranks) == DVI_BAD_ARGUMENT && ranks == NULL &&
         strstr(dvi_last_error(), "start MPI") != NULL;
}

/* If memory fails on the last process alone, all of them fail. Returns the number of wrong ends. */
static int check_memory(void)
{
  int rank, count, wrong = 0;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &count);
  for (int successes = 0; successes < 2; successes++) {
    dvi_yee_ranks *ranks;
    if (rank == count - 1) dvi__fail_allocations_after(successes);
    wrong += dvi_yee_ranks_create(MPI_COMM_NULL, &ranks) != DVI_NO_MEMORY || ranks != NULL;
    dvi__fail_allocations_after(-1);
  }
  return wrong;
}

int main(int argc, char **argv)
{
  const int early = is_too_early();
  dvi_yee_ranks *ranks = NULL;
  int failures = !early;
  if (MPI_Init(&argc, &argv) != MPI_SUCCESS) return 1;
  failures += check_memory();
  if (dvi_yee_ranks_create(MPI_COMM_NULL, &ranks) != DVI_OK) return 1;
  for (int i = 0; i < TRIALS; i++) {
    box_trial *trial = make_box_trial(i);
    const int64_t wrong = run_box_share(trial, ranks);
    if (wrong != 0)
      (void)fprintf(stderr, "process %d of %d, grid %d: %lld differences (%s)\n", ranks->rank,
                    ranks->count, i, (long long)wrong, dvi_last_error());
    failures += wrong != 0;
    free_box_trial(trial);
  }
  dvi_yee_ranks_destroy(&ranks);
  (void)MPI_Finalize();
  return failures > 0;
}
