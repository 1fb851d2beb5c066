/** What all runs share at their ends. */
#ifndef RUN_END_H
#define RUN_END_H
#include <stdbool.h>

#include "cli/file.h"
#include "watch/run_request.h"

/** What the second Ctrl-C says. */
extern const char run_ended_again[];

/** Check a file of rows. Complains and returns false; main complains about standard output. */
bool run_file_is_good(const whole_file *file);

/** Tell that a signal ended the run at t, and how to continue. Returns the exit code. */
int run_interrupted(const run_request *request, int signal, double t);

/** Prepare what is said if one of several processes is killed: from which checkpoint to go on.
 *
 *  @param saved  the time of the last checkpoint that this run has written. NULL without one
 *  @param next  the time of one that is being written. NULL without one */
void run_tell_checkpoint(const run_request *request, const double *saved, const double *next);

/** Return whether the output is kept. Only a failure that cut it short discards it. */
bool run_keeps_files(int code);
#endif
