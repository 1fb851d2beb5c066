/** What ends the scaling first, and what would be done about it. */
#ifndef RANKS_LIMITS_H
#define RANKS_LIMITS_H
#include <stdio.h>

#include "scaling/ranks_bench.h"

/** Print it, with the numbers of ranks. */
void ranks_limits_print(FILE *stream, const ranks_bench *b);
#endif
