/* The choice of the section that declares the motion. */
#include "scene/sections/motion.h"

#include "scene/sections/sections.h"

static const char *const ways_to_move[] = {"lagrangian", "kinetic", "one_form", "constraints",
                                           "hamiltonian"};

/* The last way may stand with the two before it. Constraints beside the first two are
 * holonomic. */
enum { WAYS = sizeof ways_to_move / sizeof *ways_to_move, CONSTRAINTS = 3, HAMILTONIAN = WAYS - 1 };

const dvi__tree *dvi__motion_section(const dvi_scene *scene)
{
  const dvi__tree *found = NULL;
  for (int k = 0; k < WAYS && found == NULL; k++)
    found = dvi__tree_find(scene->tree, ways_to_move[k]);
  static const char *const of_field[] = {"field", "density", "schroedinger"};
  for (int k = 0; k < 3 && found == NULL; k++) found = dvi__tree_find(scene->tree, of_field[k]);
  return found;
}

bool dvi__check_motion_section(dvi_scene *scene)
{
  static const char *const ways = "one of these: lagrangian; kinetic and potentials; one_form and "
                                  "hamiltonian; hamiltonian, alone or with constraints";
  const dvi__tree *found = NULL;
  int count = 0, which = HAMILTONIAN;
  for (int k = 0; k < HAMILTONIAN; k++) {
    const dvi__tree *tree = dvi__tree_find(scene->tree, ways_to_move[k]);
    if (tree == NULL || (k == CONSTRAINTS && count > 0 && which < 2)) continue;
    found = tree;
    which = k;
    count++;
  }
  const dvi__tree *H = dvi__tree_find(scene->tree, "hamiltonian"),
                  *V = dvi__tree_find(scene->tree, "potentials");
  if (count == 0 && H == NULL)
    return dvi__scene_refuse(scene, DVI__NOWHERE, "what moves it is missing: %s", ways);
  if (count > 1) return dvi__scene_refuse(scene, found->span, "there must be %s", ways);
  if ((H != NULL) != (which >= 2))
    return dvi__scene_refuse(scene, (H != NULL ? H : found)->span,
                             H != NULL ? "beside %s there is no hamiltonian"
                                       : "%s needs a hamiltonian",
                             ways_to_move[which]);
  return V == NULL || which == 1 ||
         dvi__scene_refuse(scene, V->span, "potentials stand beside kinetic, not beside %s",
                           ways_to_move[which]);
}

bool dvi__refuse_factors(dvi_scene *scene, const dvi__tree *section, const char *name)
{
  return !dvi__has_factors(scene) ||
         dvi__scene_refuse(scene, section->span,
                           "beside %s there are no rotations, motions, directions and angles; "
                           "choose numbers and vectors",
                           name);
}
