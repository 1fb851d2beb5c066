/** The mesh of a scene's field, which several processes share (module/ranks.h). */
#ifndef SHARE_OF_SCENE_H
#define SHARE_OF_SCENE_H
#include <stdbool.h>

#include "problem.h"

/** Check that several processes can share a scene, by leapfrog, or of a solid, if the command takes
 * it, by avi and verlet. `method` is NULL for the scene's own. Returns DONE, or complains and
 * returns USAGE. */
int share_check(const char *command, const problem *scene, const char *method, bool takes_solids);

/** Print how the processes share the mesh, and what a step makes them exchange. Called by all of
 * them, with `csv` as the path of a table, "-" for standard output or NULL. Returns DONE, or
 * complains and returns the exit code. */
int share_tell(const problem *scene, const char *csv);
#endif
