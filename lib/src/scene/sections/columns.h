/* Names of columns. */
#ifndef DVI_SCENE_SECTIONS_COLUMNS_H
#define DVI_SCENE_SECTIONS_COLUMNS_H
#include "scene/elaborate/model.h"

/* Refuse a name that dvi run has as a column already, but for those of a coordinate (or NULL). */
bool dvi__column_is_new(dvi_scene *scene, const char *text, dvi__span span,
                        const dvi__coordinate *of);

/* Refuse coordinates whose columns have the same name. */
bool dvi__labels_differ(dvi_scene *scene);

#endif
