/* The section controls: controls by name, with their costs and bounds. */
#include <math.h>

#include "scene/elaborate/shape.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

enum { CONTROLS_MOST = 16 };

/* Read [least, most]. */
static bool read_bounds(dvi_scene *scene, const dvi__tree *tree, double *least, double *most)
{
  const dvi__expression *e;
  dvi__context c;
  double bound[2];
  if (!dvi__tree_expression(scene, tree, &e) || !dvi__context_make(&c, scene, 0, "a bound"))
    return false;
  const dvi__value value = dvi__elaborate(&c, e);
  bool good = !dvi__failed(value);
  if (good && (value.shape.rank != 1 || value.shape.rows != 2))
    good = dvi__scene_refuse(scene, e->span, "bounds are two numbers, as in 'within: [-2, 2]'");
  good = good && dvi__constants_of(&c, e, value, bound);
  dvi__context_free(&c);
  if (good && !(bound[0] < bound[1]))
    good = dvi__scene_refuse(scene, e->span, "the bound %g does not lie below %g", bound[0],
                             bound[1]);
  if (good) *least = bound[0], *most = bound[1];
  return good;
}

static bool register_control(dvi_scene *scene, const dvi__tree *key, const dvi__tree *control,
                             int a)
{
  static const char *const known[] = {"cost", "within"};
  scene->control_name[a] = key->text;
  scene->control_least[a] = -HUGE_VAL;
  scene->control_most[a] = HUGE_VAL;
  if (!dvi__want_mapping(scene, control, "a control") ||
      !dvi__want_keys(scene, control, "a control", 2, known))
    return false;
  const dvi__tree *bounds = dvi__tree_find(control, "within");
  if (bounds != NULL &&
      !read_bounds(scene, bounds, &scene->control_least[a], &scene->control_most[a]))
    return false;
  if (dvi__tree_find(control, "cost") == NULL)
    return dvi__scene_refuse(scene, key->span, "the control %s has no cost, as in 'cost: %s^2/2'",
                             key->text, key->text);
  return dvi__names_add(&scene->names, &scene->arena, scene->complaint, key->text, key->span,
                        DVI__CONTROL, a);
}

static bool add_cost(dvi_scene *scene, const dvi__tree *control, dvi__kernels *cost)
{
  const dvi__expression *e;
  return dvi__tree_expression(scene, dvi__tree_find(control, "cost"), &e) &&
         dvi__kernels_add(scene,
                          DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T | DVI__MENTIONS_U,
                          "a cost", e, 0, cost);
}

static bool read_costs(dvi_scene *scene, const dvi__tree *section)
{
  dvi__kernels cost = {0};
  dvi__scene_term *term;
  bool good = true;
  for (int a = 0; a < section->count && good; a++) good = add_cost(scene, section->child[a], &cost);
  good = good && dvi__kernels_function(scene, &cost, 0, &term) &&
         dvi__make_control_cost(scene, term);
  dvi__kernels_free(&cost);
  return good;
}

bool dvi__read_controls(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "controls") ||
      !dvi__refuse_factors(scene, section, "controls"))
    return false;
  const size_t count = (size_t)section->count;
  if (count < 1 || count > CONTROLS_MOST)
    return dvi__scene_refuse(scene, section->span, "%zu controls; there may be 1 to %d", count,
                             CONTROLS_MOST);
  scene->control_name = dvi__arena_take(&scene->arena, count, sizeof *scene->control_name);
  double *bounds = dvi__arena_take(&scene->arena, 2 * count, sizeof *bounds);
  if (scene->control_name == NULL || bounds == NULL) return dvi__scene_no_memory(scene);
  scene->control_least = bounds;
  scene->control_most = bounds + count;
  scene->control_count = (int)count;
  for (int a = 0; a < section->count; a++)
    if (!register_control(scene, section->key[a], section->child[a], a)) return false;
  return read_costs(scene, section);
}
