/* Kernels of an expression. Each sum that is added to the whole is one kernel, and the rest is one
 * more. */
#ifndef DVI_SCENE_ELABORATE_KERNELS_H
#define DVI_SCENE_ELABORATE_KERNELS_H
#include "scene/elaborate/context.h"

/* A list of kernels that owns the nodes of their graphs, which dvi__kernels_free frees. The arena
 * owns everything else. */
typedef struct dvi__kernels {
  dvi__kernel *kernel;
  int count;
  int of_state; /* velocities are those of a state [nv] */
} dvi__kernels;

void dvi__kernels_free(dvi__kernels *list);

/* Add the kernels of a number, or of its negative. */
bool dvi__kernels_add(dvi_scene *scene, unsigned may, const char *where, const dvi__expression *e,
                      int negative, dvi__kernels *list);

/* Add the kernel of a context's node, without nodes that it does not need. A node that is zero adds
 * nothing. */
bool dvi__kernels_add_node(dvi__context *c, dvi__node root, dvi__kernels *list);

/* Make a function of the kernels, with `count` multipliers. The list is empty then, and the scene
 * keeps the function. */
bool dvi__kernels_function(dvi_scene *scene, dvi__kernels *list, int count, dvi__scene_term **term);

/* ---- parts of kernels by their degree in a block of variables, in velocities above all ---- */

/* A polynomial in the variables of a block. Its degree is 3 for any other function. It is pure if
 * all coefficients but that of degree 0 are without variables. */
typedef struct dvi__degree {
  int degree, pure, moves; /* `moves` is 1 if the part of degree 0 has other variables */
  int squares;             /* the coefficients of degree 2 are without variables */
} dvi__degree;

bool dvi__kernel_degree(dvi_scene *scene, const dvi__kernel *kernel, int block,
                        dvi__degree *degree);

/* Find the degree of all kernels of a list together. */
bool dvi__kernels_degree(dvi_scene *scene, const dvi__kernels *list, int block, dvi__degree *whole);

/* Return true if a term of a kernel is neither of degree 0 nor of degree 2 and pure. Sets the span
 * of the first such term. */
bool dvi__kernel_other_term(dvi_scene *scene, const dvi__kernel *kernel, int block, dvi__span *span,
                            int *found);

/* Add the part of degree 0 of each kernel (velocities are zero) or its negative.
 * dvi__kernels_moving adds the rest, for degree at most 2, with the block's variables taken from
 * the block `as`. */
bool dvi__kernels_at_rest(dvi_scene *scene, const dvi__kernels *of, int block, int negative,
                          dvi__kernels *list);
bool dvi__kernels_moving(dvi_scene *scene, const dvi__kernels *of, int block, int as,
                         dvi__kernels *list);

/* Add the part of degree 1 of each kernel likewise. */
bool dvi__kernels_linear(dvi_scene *scene, const dvi__kernels *of, int block, int as,
                         dvi__kernels *list);

#endif
