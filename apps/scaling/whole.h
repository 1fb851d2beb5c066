/** What the whole mesh or grid has, and what a step on it moves. */
#ifndef WHOLE_H
#define WHOLE_H
#include "scaling/ranks_bench.h"

/** Name it, and what it has: "mesh" and "cells", or those of a grid. */
const char *whole_name(const whole_run *whole);
const char *whole_unit(const whole_run *whole);

/** Count it, of a march on the whole. Returns DONE, or complains and returns the exit code. */
int whole_count(const timed_march *timed, whole_run *whole);

/** Foresee the blocks of a grid for the ranks that are asked for. Returns DONE, or complains and
 *  returns the exit code. */
int whole_foresee(ranks_bench *b);
#endif
