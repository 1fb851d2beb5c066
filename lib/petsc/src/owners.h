/* The processes to which the n-cells of a mesh belong: by their numbers, or by a partitioner of
 * PETSc, which gets the graph of the cells. */
#ifndef DVI_PETSC_OWNERS_H
#define DVI_PETSC_OWNERS_H
#include <dvi/mesh.h>
#include <petscsys.h>

#include "world.h"

/* The processes, the number of parts, which may be another one, and the partitioner's name. */
typedef struct dvi__divider {
  const dvi__world *world;
  int parts;
  const char *partitioner;
} dvi__divider;

/* Return the status of a call of PETSc, with a sentence if it failed. */
dvi_status dvi__check_petsc(PetscErrorCode code);

/* Find the owners [n-cells] of the mesh, the same on all processes. */
dvi_status dvi__find_owners(const dvi_mesh *mesh, const dvi__divider *divider, int *owner);

#endif
