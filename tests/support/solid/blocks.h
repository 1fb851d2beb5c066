/* Blocks of triangles and tetrahedra with starts, for tests of solids. */
#ifndef SUPPORT_SOLID_BLOCKS_H
#define SUPPORT_SOLID_BLOCKS_H
#include "support/solid/quad_solid.h"

/* Kuhn's simplices of cells^n boxes in the unit cube, with planes of nodes at X = (i/cells)^grading
 * along the first axis. */
dvi_mesh *graded_block(int n, int cells, double grading);

/* Set u = 0 and v = size (.2 Y, -.1 Z, .15 X Z), in a plane size (.2 Y, -.1 X). */
void turning_start(const quad_solid *s, double size, quad *u, quad *v);

#endif
