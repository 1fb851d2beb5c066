/* The kind msfem, on one axis and in the plane. */
#ifndef DVI_FIELD_SPACE_MSFEM_H
#define DVI_FIELD_SPACE_MSFEM_H
#include "field/space/kind.h"

/* Places of the options among the values of a line. */
enum {
  DVI__MSFEM_CELLS,
  DVI__MSFEM_FINE,
  DVI__MSFEM_POINTS,
  DVI__MSFEM_EDGES,
  DVI__MSFEM_OVERLAP,
  DVI__MSFEM_THREADS,
  DVI__MSFEM_POINTS_MOST = 16
};

/* The names of dvi__edges. */
extern const char *const dvi__msfem_edges[];

/* Give the Gauss points of a part, on so many axes. */
int dvi__msfem_points(const dvi__line *line, int axes);

#endif
