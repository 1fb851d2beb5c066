/* The sections hamiltonian and constraints. */
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

/* Make the function phi.w. */
static bool constraints_function(dvi_scene *scene, const dvi__tree *section, dvi__scene_term **term)
{
  dvi__context c;
  dvi__kernels list = {0};
  if (!dvi__context_make(&c, scene, DVI__MENTIONS_Q | DVI__MENTIONS_P, "a constraint"))
    return false;
  dvi__node total = dvi__constant(c.graph, 0);
  bool good = true;
  for (int a = 0; a < section->count && good; a++) {
    const dvi__expression *e;
    dvi__node phi;
    good = dvi__tree_expression(scene, section->child[a], &e) && dvi__elaborate_number(&c, e, &phi);
    if (good)
      dvi__add_product(&c, (dvi__value){.one = phi}, NULL, (dvi__numbering){.base = a}, &total);
  }
  good = good && dvi__kernels_add_node(&c, total, &list) &&
         dvi__kernels_function(scene, &list, section->count, term);
  dvi__context_free(&c);
  dvi__kernels_free(&list);
  return good;
}

static bool hamiltonian_read(dvi_scene *scene, const dvi__tree *tree)
{
  const dvi__expression *e;
  dvi__kernels H = {0};
  dvi__scene_term *term;
  const bool good = dvi__tree_expression(scene, tree, &e) &&
                    dvi__kernels_add(scene, DVI__MENTIONS_Q | DVI__MENTIONS_P | DVI__MENTIONS_T,
                                     "a Hamiltonian", e, 0, &H) &&
                    dvi__kernels_function(scene, &H, 0, &term) &&
                    dvi__make_hamiltonian(scene, term, &scene->hamiltonian);
  dvi__kernels_free(&H);
  scene->terms.hamiltonian = &scene->hamiltonian;
  return good;
}

bool dvi__read_hamiltonian(dvi_scene *scene, const dvi__tree *section)
{
  if (dvi__motion_section(scene) != section) return true;
  scene->form = "Hamiltonian";
  return dvi__refuse_factors(scene, section, "hamiltonian") && hamiltonian_read(scene, section);
}

bool dvi__read_constraints(dvi_scene *scene, const dvi__tree *section)
{
  dvi__scene_term *term;
  if (!dvi__want_mapping(scene, section, "constraints") ||
      !dvi__refuse_factors(scene, section, "constraints"))
    return false;
  if (section->count == 0 || section->count % 2 != 0 || section->count > 2 * scene->n)
    return dvi__scene_refuse(
        scene, section->span,
        "there are %d constraints; an even number is needed, at most 2 for each coordinate",
        section->count);
  if (!constraints_function(scene, section, &term) ||
      !dvi__make_constraint(scene, term, &scene->constraint))
    return false;
  scene->terms.constraint = &scene->constraint;
  scene->form = "Hamiltonian with constraints";
  return hamiltonian_read(scene, dvi__tree_find(scene->tree, "hamiltonian"));
}
