/* Hints for words that mean something elsewhere: on paper, in other languages or programs. */
#ifndef DVI_SCENE_HINTS_H
#define DVI_SCENE_HINTS_H
#include "scene/elaborate/names.h"

/* "; write X" for what an unknown name in an expression means elsewhere: ln, arctan, the rate xdot
 * of a coordinate x; else "". `hint` [size] is returned. */
const char *dvi__hint_of_name(const dvi__names *names, const char *name, char *hint, size_t size);

/* The section that is called so elsewhere, as dt for step, or NULL. */
const char *dvi__hint_of_section(const char *key);

#endif
