/* A Lagrangian without potentials that every element of the group leaves as it is, in a body's own
 * numbers:
 *
 *     L = Omega.J Omega/2 + x'.R (Omega x m rho) + m |x'|^2/2     for each body,     and constant masses of angles and
 * coordinates. */
#ifndef DVI_SYSTEM_REDUCED_H
#define DVI_SYSTEM_REDUCED_H
#include "system/chart/charted.h"
#include "system/system.h"

/* A rotation, with the place x of its body if that moves with it. */
typedef struct dvi__body {
  int slot, line;              /* of the rotation, and of x_1; line -1: there is none */
  double inertia[9], shift[3]; /* J and m rho */
} dvi__body;

typedef struct dvi__reduced {
  int count, masses;
  dvi__body *bodies;
  int *row, *column; /* [masses] constant masses between chart coordinates */
  double *mass;
} dvi__reduced;

/* Read it from the mass of a system without directions, which are no group. DVI_UNSUPPORTED names a
 * mass that depends on where the group is. */
dvi_status dvi__reduced_create(const dvi_system *system, dvi__reduced *reduced);
void dvi__reduced_clear(dvi__reduced *reduced);

#endif
