#include "cli/started.h"

#include <stddef.h>
#include <stdlib.h>

static int number_of(const char *name)
{
  const char *text = getenv(name);
  return text != NULL ? (int)strtol(text, NULL, 10) : -1;
}

/* Open MPI, MPICH and others, and Slurm with PMIx or PMI2 tell in the environment. */
int started_processes(int *rank)
{
  static const char *const starter[][3] = {
      {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_RANK"},
      {"PMI_SIZE", "PMI_RANK", "PMI_RANK"},
      {"SLURM_NTASKS", "SLURM_PROCID", "PMIX_RANK"}};
  *rank = 0;
  for (size_t i = 0; i < sizeof starter / sizeof *starter; i++) {
    const int count = number_of(starter[i][0]);
    if (count < 2 || getenv(starter[i][2]) == NULL) continue;
    *rank = number_of(starter[i][1]);
    return count;
  }
  return 1;
}
