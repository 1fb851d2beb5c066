/** A path between the ends of a request, with its guess. */
#ifndef PATH_ENDS_H
#define PATH_ENDS_H
#include "boundary/path_request.h"
#include "csv/points.h"
#include "problem.h"

/** Return the ends of a name, or 0 if it is unknown. */
dvi_ends ends_from_name(const char *name);

/** Create the path of a problem with the guess of the request, whose points are `guess` if it names
 * a file. Returns DONE, or complains and returns the exit code. */
int path_open(const path_request *request, const problem *scene, const points *guess,
              dvi_path **path);
#endif
