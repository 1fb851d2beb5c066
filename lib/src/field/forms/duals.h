/* The circumcentric dual cells in one simplex. */
#ifndef DVI_FIELD_FORMS_DUALS_H
#define DVI_FIELD_FORMS_DUALS_H
#include "field/forms/gram.h"

enum { DVI__CORNER_SETS = 1 << DVI__SIMPLEX_CORNERS };

/* The faces of a simplex T by the set of their corners, where bit c stands for corner c. */
typedef struct dvi__duals {
  double piece[DVI__CORNER_SETS];  /* |*s and T|, with its sign */
  double volume[DVI__CORNER_SETS]; /* kappa |s|. That of a vertex is 1 */
} dvi__duals;

/* 1/m! for m from 0 to 4. */
extern const double dvi__inverse_factorial[];

/* Give the corners in a set, ascending. Returns their count. */
int dvi__corners_of_set(int set, int *corner);

/* Give the numbers of the faces of an n-cell of a mesh of simplices. */
void dvi__number_faces(const dvi_mesh *mesh, int64_t cell, int64_t number[DVI__CORNER_SETS]);

/* Compute the faces of degree `least` and more of a placed n-simplex. Returns 0, or the set of a
 * face that has no volume in the metric. */
int dvi__duals_of(const dvi__placed *placed, int n, int least, dvi__duals *duals);

#endif
