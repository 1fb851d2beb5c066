/** Scene files in the place of problems. */
#ifndef SCENE_H
#define SCENE_H
#include "options.h"
#include "problem.h"

/** Whether a problem's name is the path of a scene: it ends in .yaml or .yml. */
bool scene_is_path(const char *name);

/** Read a scene as a problem, with its "name=value" settings. Returns DONE, or complains and returns the exit code. */
int scene_open(const char *path, const words *settings, problem **scene);

/** Print what was found in a problem's scene and what has been derived from it by now; nothing for a problem of the catalogue. */
void scene_tell(const problem *scene);
#endif
