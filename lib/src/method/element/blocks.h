/* Simplified Newton's method body by body, with the blocks of the Jacobian that belong to what the
 * mass couples: one block for each body, direction or angle of its own. Potentials between bodies
 * are left out. They change an iteration by h^2 times their stiffness, and the iteration stalls
 * where that is much. */
#ifndef DVI_METHOD_ELEMENT_BLOCKS_H
#define DVI_METHOD_ELEMENT_BLOCKS_H
#include <dvi/status.h>
#include <stddef.h>

#include "num/pattern.h"

typedef struct dvi__blocks dvi__blocks;

/* Create blocks for the pattern vv [n x n] of the mass and that of the Jacobian, whose s unknowns
 * of a coordinate are neighbours. *blocks is NULL if a block is so large that its sparse factor
 * costs less. */
dvi_status dvi__blocks_create(const dvi__pattern *vv, const dvi__pattern *jacobian, int s,
                              dvi__blocks **blocks);
void dvi__blocks_destroy(dvi__blocks **blocks);

/* Give the count of numbers of all blocks and their inverses. The first number is the sign of the
 * product of their determinants. */
size_t dvi__blocks_numbers(const dvi__blocks *blocks);

/* Give room for the values of a Jacobian. */
double *dvi__blocks_jacobian(dvi__blocks *blocks);

/* Take the blocks of that Jacobian, and invert them. DVI_SINGULAR. */
dvi_status dvi__blocks_invert(dvi__blocks *blocks, double *numbers);

/* Replace R by the inverse blocks times R. */
void dvi__blocks_solve(const dvi__blocks *blocks, const double *numbers, double *R);

/* Give the place of the inverses among the numbers. */
size_t dvi__blocks_inverses(const dvi__blocks *blocks);

/* Replace R [unknowns*width] of members side by side by their inverses times R, each with the bits
 * of one alone. Rows of the inverses are `stride` apart. `work` has room for R. */
void dvi__blocks_solve_members(const dvi__blocks *blocks, int width, int stride,
                               const double *inverses, double *R, double *work);

/* Add the magnitudes of the blocks times those of x to sum. */
void dvi__blocks_add_moved(const dvi__blocks *blocks, const double *numbers, const double *x,
                           double *sum);

#endif
