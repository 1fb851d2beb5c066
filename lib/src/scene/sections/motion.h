/* Functions shared by the sections that declare the motion. */
#ifndef DVI_SCENE_SECTIONS_MOTION_H
#define DVI_SCENE_SECTIONS_MOTION_H
#include "scene/elaborate/kernels.h"
#include "scene/sections/target.h"

/* Return true if the scene declares the motion, in one of the possible ways. Complains if not. */
bool dvi__check_motion_section(dvi_scene *scene);

/* Refuse section `name` beside rotations, directions and angles, which need a kinetic energy. */
bool dvi__refuse_factors(dvi_scene *scene, const dvi__tree *section, const char *name);

/* Take room for so many potentials, and one more. */
bool dvi__potentials_reserve(dvi_scene *scene, int count);

/* Add a potential of these kernels, or none if there are none. */
bool dvi__potential_add(dvi_scene *scene, const char *name, int fast, dvi__kernels *list);
bool dvi__potential_read(dvi_scene *scene, const dvi__tree *tree, const char *name, int fast);

/* Read a vector field xi, written by coordinate, as the function xi.w. It is one of q, and of what
 * else `may` (DVI__MENTIONS_..) allows. `where` is for messages. */
bool dvi__field_read(dvi_scene *scene, const dvi__tree *field, unsigned may, const char *where,
                     dvi__scene_term **term);

/* Add the value of a target times w at its numbers to a list. */
bool dvi__add_target(dvi_scene *scene, const dvi__target *target, const dvi__tree *tree,
                     unsigned may, const char *where, dvi__kernels *list);

/* Make the function phi.w of `count` constraints from `first` on, of q and of what else `may`
 * allows. */
bool dvi__constraints_function(dvi_scene *scene, const dvi__tree *section, int first, int count,
                               unsigned may, dvi__scene_term **term);

/* Add value.w to a total, with w the multipliers at the numbers of a target, or at one number. */
void dvi__add_product(dvi__context *c, dvi__value value, const dvi__target *target,
                      dvi__numbering numbering, dvi__node *total);

#endif
