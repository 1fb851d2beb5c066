/* The local problems of the cells of a box. */
#ifndef DVI_FIELD_MULTISCALE_CELL_H
#define DVI_FIELD_MULTISCALE_CELL_H
#include "field/multiscale/multiscale.h"

/* Solve for the local functions `value` [coarse cells][4][(fine+1)^2] with the coefficient a of the
 * fine cells. The bits do not depend on the number of threads. */
dvi_status dvi__cells_solve(const dvi__multiscale_terms *terms, const dvi__fine_axis axis[2],
                            const double *a, double *value);

#endif
