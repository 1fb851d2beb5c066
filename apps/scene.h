/** Scene files in the place of problems. */
#ifndef SCENE_H
#define SCENE_H
#include "options.h"
#include "problem.h"

/** Whether a problem's name is the path of a scene: it ends in .yaml or .yml. */
bool scene_is_path(const char *name);

/** Read a scene as a problem, with its "name=value" settings. Returns DONE, or complains and returns the exit code. */
int scene_open(const char *path, const words *settings, problem **scene);
#endif
