/** Pictures of grids: filled maps of fields, edges of cells, circumcentric dual edges, vectors. */
#ifndef PICTURE_H
#define PICTURE_H
#include "picture/strokes.h"

/** What to draw of a grid. */
typedef struct picture {
  const char *title;
  int fields;                    /**< panels. 0 for one with edges alone */
  const vtu_field *const *field; /**< [fields] */
  bool edges;                    /**< draw the edges of the cells */
  bool duals;                    /**< draw the dual edges of triangles and rectangles */
  const stroke_field *strokes;   /**< vectors to draw, or NULL */
  viewpoint from;
} picture;

/** Draw the picture into an SVG file. Returns DONE, or complains and returns the exit code. */
int picture_draw(const char *path, const vtu_grid *g, const picture *p);
#endif
