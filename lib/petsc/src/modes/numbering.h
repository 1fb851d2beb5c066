/* Cells of a divided mesh as rows of PETSc's matrices: each process has consecutive numbers for the
 * chosen cells that it owns. */
#ifndef DVI_PETSC_NUMBERING_H
#define DVI_PETSC_NUMBERING_H
#include <dvi/petsc.h>
#include <petscmat.h>

#include "division.h"

typedef struct dvi__numbering {
  PetscInt own, first, total; /* rows of this process, the first of them, and of all */
  PetscInt *number;           /* [k-cells of the share] of rows, -1 for cells that are not chosen */
  int *cell;                  /* [own] ascending */
} dvi__numbering;

/* Number the k-cells for which `chosen` [k-cells] is not 0. All processes call it, and all fail if
 * one does.
 *
 * DVI_BAD_SIZE if PetscInt cannot number them, DVI_NO_MEMORY, DVI_SOLVER_FAILED. */
dvi_status dvi__number_cells(dvi_division *division, int k, const char *chosen,
                             dvi__numbering *numbering);
void dvi__numbering_clear(dvi__numbering *numbering);

/* A matrix whose rows and columns are cells of the share. */
typedef struct dvi__cell_matrix {
  const dvi_matrix *matrix;
  const int *row, *column; /* the cell of each. NULL: these are the cells themselves */
  const dvi__numbering *rows, *columns;
} dvi__cell_matrix;

/* Make the matrix of all processes from the rows of cells that this one owns. Rows and columns
 * without a number are left out. For MatDestroy. */
dvi_status dvi__matrix_of_all(dvi_division *division, const dvi__cell_matrix *part, Mat *all);

/* Label the vertices [vertices] of each component of the mesh: with the number in the whole mesh of
 * its first vertex, or with -1 if `held` is not 0 at one of its vertices. */
dvi_status dvi__label_components(dvi_division *division, const char *held, double *label);

#endif
