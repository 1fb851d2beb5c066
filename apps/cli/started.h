/** How many processes mpirun or srun has started. */
#ifndef STARTED_H
#define STARTED_H

/** Return how many there are, 1 without them, and set *rank to the number of this one. */
int started_processes(int *rank);
#endif
