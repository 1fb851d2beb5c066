/** What ranks receive from others in a step, and how long it takes to bring it. */
#ifndef HALO_H
#define HALO_H
#include "scaling/ranks_bench.h"

/** Find the most that a rank of a run has and receives, and of a grid this rank's own block. Called
 *  by all that work, as the next one. Returns DONE, or complains and returns the exit code. */
int halo_find(const timed_request *request, const timed_march *timed, shared_run *run, block *own);

/** Time the exchange of a step without the step. Returns likewise. */
int halo_time(const timed_march *timed, const block *own, long rounds, shared_run *run);
#endif
