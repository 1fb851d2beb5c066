/* The processes to which the n-cells of a mesh belong: by their numbers, or by a partitioner of
 * PETSc, which gets the graph of the cells. */
#ifndef DVI_PETSC_OWNERS_H
#define DVI_PETSC_OWNERS_H
#include <dvi/mesh.h>
#include <petscsys.h>

/* The processes, and the partitioner's name. */
typedef struct dvi__divider {
  MPI_Comm comm;
  int rank, ranks;
  const char *partitioner;
} dvi__divider;

/* Return the status of a call of PETSc, with a sentence if it failed. */
dvi_status dvi__check_petsc(PetscErrorCode code);

/* Agree with all processes whether they have succeeded so far. If not, all of them fail. */
dvi_status dvi__agree_all(const dvi__divider *divider, dvi_status status);

/* Find the owners [n-cells] of the mesh, the same on all processes. */
dvi_status dvi__find_owners(const dvi_mesh *mesh, const dvi__divider *divider, int *owner);

#endif
