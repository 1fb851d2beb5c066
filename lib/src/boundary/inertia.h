/* Inertia of large symmetric matrices. */
#ifndef DVI_BOUNDARY_INERTIA_H
#define DVI_BOUNDARY_INERTIA_H
#include "num/pattern.h"

/* Count the negative eigenvalues of the leading `size` rows and columns of a matrix. Its entries
 * couple neighbours alone, in blocks of `block` unknowns (the last one may be shorter), and the
 * last block with the first one.
 *
 * Block elimination starts at the first block. Each block's Schur complement is factored with 1 x 1
 * and 2 x 2 pivots (Bunch and Kaufman 1977), and together with the next block where it is nearly
 * singular. Time size * block^2, memory block^2 beside the matrix. Sylvester's law of inertia.
 * DVI_SINGULAR if a complement is singular to the last bit, DVI_NO_MEMORY. */
dvi_status dvi__inertia(const dvi__pattern *pattern, const double *values, int size, int block,
                        long *negative);

#endif
