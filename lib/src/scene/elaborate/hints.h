/* What people write who come from elsewhere: paper, other languages, other programs. */
#ifndef DVI_SCENE_SLIPS_H
#define DVI_SCENE_SLIPS_H
#include "scene/elaborate/names.h"

/* "; write X" for what an unknown name in an expression means elsewhere: ln, arctan, the rate xdot
 * of a coordinate x; else "". `hint` [size] is returned. */
const char *dvi__name_elsewhere(const dvi__names *names, const char *name, char *hint, size_t size);

/* The section that is called so elsewhere, as dt for step, or NULL. */
const char *dvi__section_elsewhere(const char *key);

#endif
