/* The largest eigenvalue of a pencil whose rows are unknowns of a share of a mesh. */
#ifndef DVI_FIELD_PENCIL_ON_SHARE_H
#define DVI_FIELD_PENCIL_ON_SHARE_H
#include <dvi/mesh.h>

#include "field/algebra/modes.h"

/* Unknowns that are components of the cells of one degree. */
typedef struct dvi__cell_unknowns {
  const dvi_mesh *mesh; /* whole, or a share */
  int degree, components;
  int64_t count, total; /* here, and in the whole mesh */
  const int *place;     /* [count] ascending, cell * components + component */
} dvi__cell_unknowns;

/* Give a bound of the largest eigenvalue over all processes, as dvi__largest_eigenvalue does. M is
 * diagonal. Called on all processes. */
dvi_status dvi__largest_on_share(const dvi__pencil *pencil, const dvi__cell_unknowns *unknowns,
                                 double *bound);

#endif
