/* Calls all callbacks of a scene's system and events once at its start. */
#ifndef TESTS_SUPPORT_SCENE_CALLS_H
#define TESTS_SUPPORT_SCENE_CALLS_H
#include <dvi/scene.h>

/* Returns 0 if all gave finite numbers, else the first code of a callback that is not 0, for which
 * there must be a sentence. A positive code means that a number is not finite, a negative one that
 * derivatives could not be made. */
int call_all(const dvi_scene *scene);

#endif
