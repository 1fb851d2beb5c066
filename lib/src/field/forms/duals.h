/* The circumcentric dual cells in one simplex. */
#ifndef DVI_FIELD_FORMS_DUALS_H
#define DVI_FIELD_FORMS_DUALS_H
#include "field/forms/gram.h"
#include "field/mesh/faces.h"

/* The faces of a simplex T by the set of their corners, where bit c stands for corner c. */
typedef struct dvi__duals {
  double piece[DVI__CORNER_SETS];  /* |*s and T|, with its sign */
  double volume[DVI__CORNER_SETS]; /* kappa |s|. That of a vertex is 1 */
} dvi__duals;

/* 1/m! for m from 0 to 4. */
extern const double dvi__inverse_factorial[];

/* Compute the faces of degree `least` and more of a placed n-simplex. Returns 0, or the set of a
 * face that has no volume in the metric. */
int dvi__duals_of(const dvi__placed *placed, int n, int least, dvi__duals *duals);

#endif
