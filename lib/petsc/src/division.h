/* What joins the share of a process to the others. */
#ifndef DVI_PETSC_DIVISION_H
#define DVI_PETSC_DIVISION_H
#include <dvi/petsc.h>
#include <petscsf.h>

#include "world.h"

enum { DVI__DEGREES = DVI_MESH_DIMENSION_MAX + 1, DVI__NAME_SIZE = 32 };

struct dvi_division {
  dvi__world world;             /* the first member, so that a division is one */
  const dvi_mesh *share;        /* of which it is. Not owned */
  PetscSF forest[DVI__DEGREES]; /* roots are the owners' cells, leaves the ghosts */
  char partitioner[DVI__NAME_SIZE];
  dvi_division_facts facts;
  dvi__traffic before; /* what PETSc had counted */
};

/* Begin a division: check that PETSc runs, choose the partitioner, and join the processes. Whatever
 * was begun is for dvi_division_destroy, also after a failure. */
dvi_status dvi__division_begin(const dvi_division_options *options, dvi_division **division);

/* Refuse more parts than cells. */
dvi_status dvi__check_enough(int parts, int64_t cells);

/* Return how the processes of a division speak with each other. */
dvi_ranks dvi__division_ranks(dvi_division *division);

/* Join a share to the others, of meshes that have `total` [degrees] cells together. Called on all
 * processes. */
dvi_status dvi__division_join(dvi_division *division, const dvi_mesh *share, const int64_t *total);

#endif
