/** dvi bench --scale members=..., which compares the cost of a member's step in an ensemble and in
 * runs one after the other. */
#ifndef MEMBERS_H
#define MEMBERS_H
#include <stdbool.h>

#include "bench/scale.h"

/** Return whether the axis is the number of members instead of a parameter of the problem. */
bool members_asked(const char *scaled);

/** Measure and report. Returns an exit code. */
int members_run(const scale_request *request);
#endif
