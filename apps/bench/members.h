/** dvi bench --scale members=...: what a member's step costs in an ensemble, and in runs one after
 * the other. */
#ifndef MEMBERS_H
#define MEMBERS_H
#include <stdbool.h>

#include "bench/scale.h"

/** Whether it is members that are to be scaled, not a parameter of the problem. */
bool members_asked(const char *scaled);

/** Measure and report. Returns an exit code. */
int members_run(const scale_request *request);
#endif
