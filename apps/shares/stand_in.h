/** A process that stands for one of many, hears nothing of the others, and cuts their shares out of
 * a mesh: what they would have is foreseen without them. */
#ifndef STAND_IN_H
#define STAND_IN_H
#include <dvi/mesh.h>
#include <stdbool.h>

#include "module/ranks.h"

/** Return the functions of such a process, for dvi_mesh_cut. Ghosts keep their values. */
dvi_ranks stand_in(int rank, int parts);

/** Make a share of the whole mesh, as the callback of dvi_scene_division. */
dvi_status stand_in_keep(const dvi_mesh *mesh, dvi_mesh **share, void *user);

/** A form that is exchanged. */
typedef struct form_of_share {
  int degree;
  /** Whether a cell's value is exchanged, by the numbers of the whole mesh or of the share. NULL:
   *  all are */
  const char *counts;
  bool by_share;
} form_of_share;

/** Count what the share of process `rank` of `parts` has, and what it receives in an exchange of a
 *  form. Returns false without memory. */
bool stand_in_count(const dvi_mesh *share, const form_of_share *form, int rank, int parts,
                    mesh_division *division);
#endif
