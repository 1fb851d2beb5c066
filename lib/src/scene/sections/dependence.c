/* The motion and the start as functions of the parameters, and the section objective. Expressions
 * are elaborated with the parameters as variables of the block of inputs. */
#include <string.h>

#include "scene/elaborate/kernels.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

static const unsigned of_motion = DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T |
                                  DVI__OF_PARAMETERS;

static bool add_expression(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                           int negative, dvi__kernels *list)
{
  const dvi__expression *e;
  return dvi__tree_expression(scene, tree, &e) &&
         dvi__kernels_add(scene, may, where, e, negative, list);
}

/* Make a function of the list, which is empty then. It belongs to no motion. */
static bool finish(dvi_scene *scene, bool good, dvi__kernels *list, int count,
                   dvi__scene_term **term)
{
  good = good && dvi__kernels_function(scene, list, count, term);
  dvi__kernels_free(list);
  if (good) (*term)->role = DVI__ROLE_AUXILIARY;
  return good;
}

/* Subtract potentials, which may stand in groups. */
static bool subtract_potentials(dvi_scene *scene, const dvi__tree *tree, dvi__kernels *list)
{
  if (tree->kind != DVI__MAPPING)
    return add_expression(scene, tree, of_motion, "a potential", 1, list);
  for (int i = 0; i < tree->count; i++)
    if (!subtract_potentials(scene, tree->child[i], list)) return false;
  return true;
}

static bool read_lagrangian(dvi_scene *scene)
{
  dvi__kernels L = {0};
  const dvi__tree *lagrangian = dvi__tree_find(scene->tree, "lagrangian"),
                  *kinetic = dvi__tree_find(scene->tree, "kinetic"),
                  *potentials = dvi__tree_find(scene->tree, "potentials"),
                  *whole = lagrangian != NULL ? lagrangian : kinetic;
  bool good = whole != NULL && add_expression(scene, whole, of_motion, "a Lagrangian", 0, &L);
  if (good && kinetic != NULL && potentials != NULL)
    good = subtract_potentials(scene, potentials, &L);
  return finish(scene, good, &L, 0, &scene->varied_L);
}

static bool read_forces(dvi_scene *scene)
{
  const dvi__tree *forces = dvi__tree_find(scene->tree, "forces"),
                  *dissipation = dvi__tree_find(scene->tree, "dissipation");
  dvi__kernels R = {0};
  if (forces != NULL) {
    if (!dvi__field_read(scene, forces, of_motion | DVI__MENTIONS_U, "a force", &scene->varied_F))
      return false;
    scene->varied_F->role = DVI__ROLE_AUXILIARY;
  }
  return dissipation == NULL ||
         finish(scene, add_expression(scene, dissipation, of_motion, "a dissipation", 1, &R), &R, 0,
                &scene->varied_R);
}

/* Read the values of the start that are coordinates, or those that are not. */
static bool read_start(dvi_scene *scene, const dvi__tree *initial, int coordinates,
                       dvi__scene_term **term)
{
  dvi__kernels list = {0};
  bool good = true;
  for (int i = 0; i < initial->count && good; i++) {
    dvi__target target;
    good = dvi__read_target(scene, initial->key[i], &target);
    if (good && (target.mentions == DVI__MENTIONS_Q) == coordinates)
      good = dvi__add_target(scene, &target, initial->child[i], DVI__OF_PARAMETERS, "a start",
                             &list);
  }
  return finish(scene, good, &list, scene->nv, term);
}

bool dvi__read_dependence(dvi_scene *scene)
{
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  if (scene->start_overlaps)
    return dvi__scene_refuse(scene, initial->span,
                             "derivatives by parameters need each number of the start once, by a "
                             "formula or by itself");
  return dvi__make_inputs(scene) && read_lagrangian(scene) && read_forces(scene) &&
         read_start(scene, initial, 1, &scene->varied_q) &&
         read_start(scene, initial, 0, &scene->varied_second);
}

/* ---- objectives ---- */

static bool read_objective(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                           dvi__scene_term **term)
{
  dvi__kernels list = {0};
  return tree == NULL ||
         finish(scene, add_expression(scene, tree, may, where, 0, &list), &list, 0, term);
}

bool dvi__read_objective(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"end", "integral"};
  const unsigned at_end = DVI__MENTIONS_Q | DVI__MENTIONS_P | DVI__MENTIONS_T | DVI__OF_PARAMETERS;
  if (!dvi__want_mapping(scene, section, "objective") ||
      !dvi__want_keys(scene, section, "an objective", 2, known) ||
      !dvi__refuse_factors(scene, section, "objective"))
    return false;
  if (scene->terms.one_form != NULL || scene->terms.hamiltonian != NULL)
    return dvi__scene_refuse(scene, section->span,
                             "an objective is of a motion with a Lagrangian of second degree in "
                             "the velocities or more");
  if (section->count == 0)
    return dvi__scene_refuse(scene, section->span, "an objective has an end, an integral or both");
  return dvi__make_inputs(scene) &&
         read_objective(scene, dvi__tree_find(section, "end"), at_end, "the end of an objective",
                        &scene->objective_end) &&
         read_objective(scene, dvi__tree_find(section, "integral"), of_motion,
                        "the integral of an objective", &scene->objective_rate) &&
         dvi__make_objective(scene);
}
