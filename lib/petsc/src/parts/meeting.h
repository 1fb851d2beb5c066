/* Rows of numbers that meet at the process of their first number, a vertex of the whole mesh. Cells
 * that several processes have are found to be the same there, by their vertices. */
#ifndef DVI_PETSC_MEETING_H
#define DVI_PETSC_MEETING_H
#include "blocks.h"

typedef struct dvi__meeting {
  const dvi__world *world;
  PetscSF forest;  /* leaves are the rows of this process, and roots the vertices of its block */
  int width;       /* of a row */
  int64_t count;   /* rows that meet here */
  int *row;        /* [count*width] */
  PetscInt *order; /* [count] of the rows, ascending by all of their numbers */
} dvi__meeting;

/* Send this process's rows [count*width] to a meeting. Called on all processes, and all fail if one
 * does. Cleared in any case. */
dvi_status dvi__meet(const dvi__block *vertices, int64_t count, int width, const int *row,
                     dvi__meeting *meeting);
void dvi__meeting_clear(dvi__meeting *meeting);

/* Compare the first numbers of the rows that are in order at `a` and `b`. */
int dvi__meeting_same(const dvi__meeting *meeting, int64_t a, int64_t b, int numbers);

#endif
