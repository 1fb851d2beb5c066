/* The section one_form. */
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

bool dvi__read_one_form(dvi_scene *scene, const dvi__tree *section)
{
  dvi__scene_term *term;
  if (!dvi__refuse_factors(scene, section, "one_form")) return false;
  if (!dvi__field_read(scene, section, 0, "a one-form", &term) ||
      !dvi__make_one_form(scene, term, &scene->one_form))
    return false;
  scene->terms.one_form = &scene->one_form;
  scene->form = "one-form";
  return dvi__potentials_reserve(scene, 0) &&
         dvi__potential_read(scene, dvi__tree_find(scene->tree, "hamiltonian"), "H", 0);
}
