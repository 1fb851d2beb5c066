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
};

#endif
