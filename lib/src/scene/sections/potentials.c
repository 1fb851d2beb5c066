/* The section potentials, and potentials of any other section. */
#include <string.h>

#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

/* Return 1 if the Hessian is constant. The degree shows it, or the formulas of the Hessian do if
 * time moves a linear part. */
static int is_quadratic(const dvi__degree *degree, const dvi__scene_term *term)
{
  return degree->degree <= 2 &&
         (degree->pure || dvi__function_second_constant(term->function, DVI__PAIR_QQ) == 1);
}

bool dvi__potential_add(dvi_scene *scene, const char *name, int fast, dvi__kernels *list)
{
  dvi__scene_term *term;
  dvi__degree degree;
  if (list->count == 0) return true;
  dvi_potential *potential =
      (dvi_potential *)&scene->terms.potentials[scene->terms.potential_count++];
  if (!dvi__kernels_degree(scene, list, DVI__COORDINATES, &degree) ||
      !dvi__kernels_function(scene, list, 0, &term) ||
      !dvi__make_potential(scene, name, term, potential))
    return false;
  potential->fast = fast;
  potential->quadratic = is_quadratic(&degree, term);
  return true;
}

bool dvi__potentials_reserve(dvi_scene *scene, int count)
{
  scene->terms.potentials = dvi__arena_take(&scene->arena, (size_t)count + 1,
                                            sizeof *scene->terms.potentials);
  return scene->terms.potentials != NULL || dvi__scene_no_memory(scene);
}

bool dvi__potential_read(dvi_scene *scene, const dvi__tree *tree, const char *name, int fast)
{
  const dvi__expression *e;
  dvi__kernels V = {0};
  const bool good = dvi__tree_expression(scene, tree, &e) &&
                    dvi__kernels_add(scene, DVI__MENTIONS_Q | DVI__MENTIONS_T, "a potential", e, 0,
                                     &V) &&
                    dvi__potential_add(scene, name, fast, &V);
  dvi__kernels_free(&V);
  return good;
}

/* Read a potential, or those under slow or fast by name. Potentials are slow by default. */
static bool read_speed(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  const int fast = strcmp(key->text, "fast") == 0;
  if (!dvi__want_name(scene, key->text, key->span)) return false;
  if (tree->kind != DVI__MAPPING) return dvi__potential_read(scene, tree, key->text, fast);
  if (!fast && strcmp(key->text, "slow") != 0)
    return dvi__scene_refuse(scene, key->span,
                             "a potential is an expression; only slow and fast hold some by name");
  for (int i = 0; i < tree->count; i++)
    if (!dvi__want_name(scene, tree->key[i]->text, tree->key[i]->span) ||
        !dvi__potential_read(scene, tree->child[i], tree->key[i]->text, fast))
      return false;
  return true;
}

bool dvi__read_potentials(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "potentials")) return false;
  int count = section->count;
  for (int i = 0; i < section->count; i++) count += section->child[i]->count;
  if (!dvi__potentials_reserve(scene, count)) return false;
  for (int i = 0; i < section->count; i++)
    if (!read_speed(scene, section->key[i], section->child[i])) return false;
  return true;
}
