/* Hints for words that mean something elsewhere, on paper, in other languages or programs. */
#ifndef DVI_SCENE_ELABORATE_HINTS_H
#define DVI_SCENE_ELABORATE_HINTS_H
#include "scene/elaborate/names.h"

/* Write "; write X" if an unknown name in an expression means X elsewhere, as ln, arctan, or xdot
 * for the rate of a coordinate x, else "". Returns `hint` [size]. */
const char *dvi__hint_of_name(const dvi__names *names, const char *name, char *hint, size_t size);

/* Return the section that another program calls `key`, as dt for step, or NULL. */
const char *dvi__hint_of_section(const char *key);

#endif
