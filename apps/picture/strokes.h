/** Vectors of the cells of a grid, as short strokes in the middle of its faces. */
#ifndef STROKES_H
#define STROKES_H
#include <stdio.h>

#include "picture/raster.h"

/** The components of vectors by cell. The last one is NULL for vectors in the plane. */
typedef struct stroke_field {
  const vtu_field *component[3];
} stroke_field;

/** Find the components of vectors. Returns DONE, or complains and returns USAGE. */
int strokes_find(const vtu_grid *g, const char *name, stroke_field *field);

/** Write the strokes that are not hidden as "x y dx dy", the longest vectors as long as their faces
 *  have room, and others in proportion. Returns their number. */
int64_t strokes_write(FILE *script, const vtu_grid *g, const stroke_field *field,
                      const viewpoint *from, const skin *s, const raster *pixels);
#endif
