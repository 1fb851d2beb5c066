/** Moments of rigid bodies, from the constant mass of a system. */
#ifndef VIEW_MOMENTS_H
#define VIEW_MOMENTS_H
#include "problem.h"
#include "view/layout.h"

/** Find the mass, the centre of mass and the second moments about it, xx, xy, xz, yy, yz and zz, of
 * each body in its own frame. Those of a body without a place are about its fixed point, and its
 * mass is 0, because it is not known. */
void moments_find(const problem *scene, view_layout *layout);
#endif
