/* The inside of an inverse of stages, for the files that share it. */
#ifndef DVI_STEP_DEGENERATE_STAGE_INVERSE_STRUCT_H
#define DVI_STEP_DEGENERATE_STAGE_INVERSE_STRUCT_H
#include "step/degenerate/stage_inverse.h"

struct dvi__stage_inverse {
  int n, m, has_end, unknowns, stride; /* a column has `stride` numbers, whole blocks */
  double moved[DVI__STAGE_LANES][DVI__STAGE_LANES],
      back[DVI__STAGE_LANES][DVI__STAGE_LANES]; /* G and G^-1 by columns */
  double sign[DVI__STAGE_LANES];
  double path[DVI__STAGE_LANES][DVI__STAGE_LANES]
             [DVI__STAGE_LANES]; /* column l of G^-1 times row r of G, as [l][r] */
  double unit[DVI__STAGE_LANES][DVI__STAGE_LANES],
      inner[DVI__STAGE_LANES][DVI__STAGE_LANES]; /* the matrix 1 and G, without rows of the end */
  double of_start[DVI__STAGE_LANES],
      of_end[DVI__STAGE_LANES]; /* G^-1 of 1 in all rows, and in the last one */
  double path_of_start[DVI__STAGE_LANES][DVI__STAGE_LANES],
      path_of_end[DVI__STAGE_LANES][DVI__STAGE_LANES]; /* the same times -G's last row */
  dvi__stage_entry *given, *turned; /* [n*n] by columns: entries, and -Omega^-1 times them */
  double *Omega;                    /* [n*n] -Omega^-1 by columns */
  double *inverse;                  /* [stride*unknowns + LANES] by columns */
};

#endif
