/** Scene files as problems. */
#ifndef SCENE_H
#define SCENE_H
#include <dvi/scene.h>

#include "cli/options.h"
#include "cli/outputs.h"
#include "problem.h"

/** Return whether a problem's name is the path of a scene, which ends in .yaml or .yml. */
bool scene_is_path(const char *name);

/** Read a scene as a problem, with its "name=value" settings. Returns DONE, or complains and
 * returns the exit code. */
int scene_open(const char *path, const words *settings, problem **scene);

/** Read a scene on the share that a division cuts, or on the whole mesh if that is NULL. */
int scene_open_share(const char *path, const words *settings, const dvi_scene_division *division,
                     problem **scene);

/** The text of a scene's file, to be read many times with different settings. */
typedef struct scene_text {
  char *text; /**< [length] owned, also after a failure */
  size_t length;
} scene_text;

/** Read the text of the file. Returns DONE, or complains and returns the exit code. */
int scene_load(const char *path, scene_text *text);

/** Read a scene from such a text, as scene_open does. */
int scene_parse(const char *path, const scene_text *text, const words *settings, problem **scene);

/** Refuse to write any of the files over the scene itself, or over a scene that it may include.
 * Returns DONE, or complains and returns USAGE. */
int scene_spared(const char *command, const char *path, int count, const named_file *files);

/** Warn on standard error where a scene has a kink, and which order any method keeps there. */
void scene_warn(const char *command, const problem *scene);

/** Print what was found in a problem's scene and what has been derived from it by now. Prints
 * nothing for a problem of the catalogue. */
void scene_tell(const problem *scene);
/** Make the system of a scene, and the names and the start of its coordinates, unless they are
 * there. Returns DONE, or complains and returns the exit code. */
int scene_complete(problem *made);
#endif
