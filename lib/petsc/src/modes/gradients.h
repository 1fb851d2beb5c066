/* The gradients among forms of degree 1, which are taken away from them: K = d^T M_2 d vanishes on
 * all d phi, so that as many modes of frequency zero as vertices would hide the others. */
#ifndef DVI_PETSC_GRADIENTS_H
#define DVI_PETSC_GRADIENTS_H

#include "division.h"
#include "inverse.h"
#include "numbering.h"

typedef struct dvi__gradients {
  dvi__edges edges;     /* rows are the unknowns, columns vertices with independent gradients */
  PetscInt count;       /* of these vertices, of all processes. 0: there is nothing to do */
  dvi__inverse poisson; /* of d^T M d */
  Vec charge, phi, form;
} dvi__gradients;

/* What they are made for. */
typedef struct dvi__edge_field {
  dvi_division *division;
  const dvi__numbering *unknowns;
  Vec mass; /* the diagonal of M */
  int is_large;
} dvi__edge_field;

/* Prepare a projection. All processes call it. For dvi__gradients_clear after failures, too. */
dvi_status dvi__gradients_create(const dvi__edge_field *of, dvi__gradients *gradients);
void dvi__gradients_clear(dvi__gradients *gradients);

/* Take the gradients away from a form y, y - d phi with d^T M d phi = d^T M y. `My` is M y. */
PetscErrorCode dvi__gradients_project(dvi__gradients *gradients, Vec My, Vec y);

#endif
