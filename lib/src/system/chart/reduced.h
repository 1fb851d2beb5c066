/* A Lagrangian without potentials that every element of the group leaves invariant, in a body's own
 * numbers. It is a sum over the bodies of
 *
 *     L = Omega.J Omega/2 + x'.R (Omega x m rho) + m |x'|^2/2
 *
 * and of constant masses of angles and coordinates. */
#ifndef DVI_SYSTEM_CHART_REDUCED_H
#define DVI_SYSTEM_CHART_REDUCED_H
#include "system/chart/charted.h"
#include "system/system.h"

/* A rotation, with the place x of its body if x moves with the rotation. */
typedef struct dvi__reduced_body {
  int slot, line;              /* slots of the rotation and of x_1, line is -1 without x */
  double inertia[9], shift[3]; /* J and m rho */
} dvi__reduced_body;

typedef struct dvi__reduced {
  int count, masses;
  dvi__reduced_body *bodies;
  int *row, *column; /* rows and columns [masses] of constant masses between chart coordinates */
  double *mass;
} dvi__reduced;

/* Read the parts from the mass of a system. Directions are refused, because they are no group.
 * DVI_UNSUPPORTED names a mass that depends on the place in the group. */
dvi_status dvi__reduced_create(const dvi_system *system, dvi__reduced *reduced);
void dvi__reduced_clear(dvi__reduced *reduced);

#endif
