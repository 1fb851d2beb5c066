/** A run with its rows, events, alarms, plot and checkpoint, and its final report. */
#ifndef RECORDER_H
#define RECORDER_H
#include "problem.h"
#include "watch/run_request.h"

/** Drive the integrator from its state to the requested end, and write the requested output.
 * Returns the exit code. */
int record(const run_request *request, const problem *scene, dvi_integrator *integrator);
#endif
