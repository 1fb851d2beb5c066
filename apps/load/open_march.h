/** Marches of a scene's field. */
#ifndef OPEN_MARCH_H
#define OPEN_MARCH_H
#include <dvi/march.h>
#include <stdbool.h>

#include "problem.h"

/** Create a march of the scene's field, and start it. The options' method and step are NULL and 0
 * for the scene's own. Returns DONE, or complains, with the place in the scene where it is known,
 * and returns the exit code. */
int open_march(const problem *scene, const dvi_march_options *options, dvi_march **march);

/** Tell if a march takes a step, as all but tents do. */
bool march_has_step(const char *method);

/** Check that a march has steps of which a study can take any number. Returns DONE, or complains
 * and returns the exit code. */
int check_studied_march(const char *command, const problem *scene, const char *method);
#endif
