/* All callbacks of a scene's system and events, called once at its start. */
#ifndef TESTS_SUPPORT_SCENE_CALLS_H
#define TESTS_SUPPORT_SCENE_CALLS_H
#include <dvi/scene.h>

/* 0: all gave finite numbers; else the first of their codes that is not 0, for which a sentence
 * must be there: positive where a number is not finite, negative where derivatives could not be
 * made. */
int call_all(const dvi_scene *scene);

#endif
