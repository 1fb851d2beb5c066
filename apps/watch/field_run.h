/** A run of a field by a march, with its rows, pictures and checkpoint. */
#ifndef FIELD_RUN_H
#define FIELD_RUN_H
#include "problem.h"
#include "watch/run_request.h"

/** Run a scene's field by the request's method, which is one of marches. Returns the exit code. */
int field_run(run_request *request, const problem *scene);
#endif
