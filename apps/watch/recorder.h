/** A run under way: its rows, events, alarms, plot and checkpoint, and what is said of it at the
 *  end. */
#ifndef RECORDER_H
#define RECORDER_H
#include "problem.h"
#include "watch/run_request.h"

/** Drive the integrator from where it stands to the end that is asked for, and write what is
 *  asked for. Returns the exit code. */
int record(const run_request *request, const problem *scene, dvi_integrator *integrator);
#endif
