/** What holds points together: constraints, joints and springs. */
#ifndef VIEW_LINKS_H
#define VIEW_LINKS_H
#include <stdbool.h>

#include "problem.h"
#include "view/layout.h"

/** Link the points of one constraint, the points between which a force acts, and directions with
 * the origin. Forces between all pairs, as gravity is, are not drawn, nor those of more than a few
 * pairs a point. Returns false without memory. */
bool links_find(const problem *scene, view_layout *layout);
#endif
