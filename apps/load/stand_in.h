/** A process that stands for one of many, hears nothing of the others, and cuts their shares out of
 * a mesh: what they would have is foreseen without them. */
#ifndef STAND_IN_H
#define STAND_IN_H
#include <dvi/mesh.h>
#include <stdbool.h>

#include "module/ranks.h"

/** Return the functions of such a process, for dvi_mesh_cut. Ghosts keep their values. */
dvi_ranks stand_in(int rank, int parts);

/** Count what a share has that was cut by it, and what a refresh of a form of degree k receives.
 * Returns false without memory. */
bool stand_in_count(const dvi_mesh *share, int k, int rank, int parts, mesh_division *division);
#endif
