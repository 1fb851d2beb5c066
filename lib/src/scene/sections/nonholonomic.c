/* The section nonholonomic: rows A(t,q) q' + a(t,q) = 0, which are linear in the velocities. */
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

static bool refuse_motion(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "nonholonomic") ||
      !dvi__refuse_factors(scene, section, "nonholonomic"))
    return false;
  if (scene->terms.one_form != NULL || scene->terms.hamiltonian != NULL)
    return dvi__scene_refuse(scene, section->span,
                             "beside a %s there are no nonholonomic constraints; they go with "
                             "lagrangian, or kinetic and potentials, of second degree in the "
                             "velocities or more",
                             scene->form);
  if (section->count > 0 && section->count <= scene->n) return true;
  return dvi__scene_refuse(scene, section->span,
                           "there are %d nonholonomic constraints; at least 1 is needed, at most "
                           "one for each coordinate",
                           section->count);
}

/* Check that a row is linear in the velocities. Tell if it has a part without them. */
static bool check_linear(dvi_scene *scene, const dvi__tree *tree, bool *affine)
{
  const dvi__expression *e;
  dvi__kernels row = {0}, rest = {0};
  dvi__degree degree = {.degree = 0};
  bool good = dvi__tree_expression(scene, tree, &e) &&
              dvi__kernels_add(scene, DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T,
                               "a nonholonomic constraint", e, 0, &row) &&
              dvi__kernels_degree(scene, &row, DVI__VELOCITIES, &degree);
  if (good && degree.degree == 0)
    good = dvi__scene_refuse(scene, e->span,
                             "there is no velocity in it; a constraint phi(t,q) = 0 stands under "
                             "constraints");
  if (good && degree.degree > 1)
    good = dvi__scene_refuse(scene, e->span,
                             "it is not linear in the velocities, as A(t,q)*q' + a(t,q) is");
  good = good && dvi__kernels_at_rest(scene, &row, DVI__VELOCITIES, 0, &rest);
  *affine = rest.count > 0;
  dvi__kernels_free(&row);
  dvi__kernels_free(&rest);
  return good;
}

bool dvi__read_nonholonomic(dvi_scene *scene, const dvi__tree *section)
{
  if (!refuse_motion(scene, section)) return false;
  dvi_nonholonomic *list = dvi__arena_take(&scene->arena, (size_t)section->count, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int a = 0; a < section->count; a++) {
    dvi__scene_term *term;
    bool affine;
    if (!dvi__want_name(scene, section->key[a]->text, section->key[a]->span) ||
        !check_linear(scene, section->child[a], &affine) ||
        !dvi__constraints_function(scene, section, a, 1, DVI__MENTIONS_V | DVI__MENTIONS_T,
                                   &term) ||
        !dvi__make_nonholonomic(scene, section->key[a]->text, term, affine, &list[a]))
      return false;
  }
  scene->terms.nonholonomics = scene->nonholonomics = list;
  scene->terms.nonholonomic_count = section->count;
  return true;
}
