/* The sections one_form, hamiltonian and constraints. Constraints beside a Hamiltonian are those on
 * phase space, phi(q,p) = 0. Beside a Lagrangian they are holonomic, phi(t,q) = 0. */
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

/* Add phi_a times the multiplier `number` to a total. */
static bool add_constraint(dvi__context *c, const dvi__tree *tree, int number, dvi__node *total)
{
  const dvi__expression *e;
  dvi__node phi;
  if (!dvi__tree_expression(c->scene, tree, &e) || !dvi__elaborate_number(c, e, &phi)) return false;
  dvi__add_product(c, (dvi__value){.one = phi}, NULL, (dvi__numbering){.base = number}, total);
  return true;
}

bool dvi__constraints_function(dvi_scene *scene, const dvi__tree *section, int first, int count,
                               unsigned may, dvi__scene_term **term)
{
  dvi__context c;
  dvi__kernels list = {0};
  if (!dvi__context_make(&c, scene, DVI__MENTIONS_Q | may, "a constraint")) return false;
  dvi__node total = dvi__constant(c.graph, 0);
  bool good = true;
  for (int a = 0; a < count && good; a++)
    good = add_constraint(&c, section->child[first + a], a, &total);
  good = good && dvi__kernels_add_node(&c, total, &list) &&
         dvi__kernels_function(scene, &list, count, term);
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

/* Each constraint is a term of its own, with its name. */
static bool read_holonomic(dvi_scene *scene, const dvi__tree *section)
{
  if (scene->terms.one_form != NULL)
    return dvi__scene_refuse(scene, section->span,
                             "beside a one-form there are no constraints; a term of degree 2 in "
                             "the velocities, or a Hamiltonian, may have them");
  if (section->count == 0 || section->count > scene->n)
    return dvi__scene_refuse(scene, section->span,
                             "there are %d constraints; at least 1 is needed, at most one for each "
                             "coordinate",
                             section->count);
  dvi_holonomic *list = dvi__arena_take(&scene->arena, (size_t)section->count, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int a = 0; a < section->count; a++) {
    dvi__scene_term *term;
    if (!dvi__want_name(scene, section->key[a]->text, section->key[a]->span) ||
        !dvi__constraints_function(scene, section, a, 1, DVI__MENTIONS_T, &term) ||
        !dvi__make_holonomic(scene, section->key[a]->text, term, &list[a]))
      return false;
  }
  scene->terms.holonomics = scene->holonomics = list;
  scene->terms.holonomic_count = section->count;
  return true;
}

bool dvi__read_constraints(dvi_scene *scene, const dvi__tree *section)
{
  dvi__scene_term *term;
  if (!dvi__want_mapping(scene, section, "constraints")) return false;
  if (dvi__tree_find(scene->tree, "hamiltonian") == NULL) return read_holonomic(scene, section);
  if (!dvi__refuse_factors(scene, section, "constraints")) return false;
  if (section->count == 0 || section->count % 2 != 0 || section->count > 2 * scene->n)
    return dvi__scene_refuse(
        scene, section->span,
        "there are %d constraints; an even number is needed, at most 2 for each coordinate",
        section->count);
  if (!dvi__constraints_function(scene, section, 0, section->count, DVI__MENTIONS_P, &term) ||
      !dvi__make_constraint(scene, term, &scene->constraint))
    return false;
  scene->terms.constraint = &scene->constraint;
  scene->form = "Hamiltonian with constraints";
  return hamiltonian_read(scene, dvi__tree_find(scene->tree, "hamiltonian"));
}

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
