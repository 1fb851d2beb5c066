/* The section sweep. */
#include <math.h>
#include <string.h>

#include "scene/elaborate/words.h"
#include "scene/sections/sections.h"

static bool read_values(dvi_scene *scene, const dvi__tree *list, dvi_scene_range *range)
{
  double *value = dvi__arena_take(&scene->arena, (size_t)list->count + 1, sizeof *value);
  if (value == NULL) return dvi__scene_no_memory(scene);
  if (list->count == 0)
    return dvi__scene_refuse(scene, list->span, "there is no value to sweep over");
  for (int i = 0; i < list->count; i++)
    if (!dvi__tree_number(scene, list->child[i], "a value", &value[i])) return false;
  range->count = list->count;
  range->value = value;
  return true;
}

/* Read from, to and count, values in even steps with both ends included. */
static bool read_steps(dvi_scene *scene, const dvi__tree *steps, dvi_scene_range *range)
{
  static const char *const known[] = {"from", "to", "count"};
  enum { COUNT_MAX = 1000000 };
  double end[2];
  int count = 0;
  if (!dvi__want_keys(scene, steps, "a range", 3, known)) return false;
  for (int k = 0; k < 3; k++)
    if (dvi__tree_find(steps, known[k]) == NULL)
      return dvi__scene_refuse(scene, steps->span, "a range needs '%s'", known[k]);
  const dvi__tree *how_many = dvi__tree_find(steps, "count");
  if (!dvi__tree_number(scene, dvi__tree_find(steps, "from"), "from", &end[0]) ||
      !dvi__tree_number(scene, dvi__tree_find(steps, "to"), "to", &end[1]) ||
      !dvi__tree_whole(scene, how_many, "count", 2, &count))
    return false;
  if (count > COUNT_MAX)
    return dvi__scene_refuse(scene, how_many->span, "at most %d values", COUNT_MAX);
  if (!isfinite((end[1] - end[0]) * count))
    return dvi__scene_refuse(scene, steps->span, "the range from %g to %g is too wide", end[0],
                             end[1]);
  double *value = dvi__arena_take(&scene->arena, (size_t)count, sizeof *value);
  if (value == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < count; i++) value[i] = end[0] + (end[1] - end[0]) * i / (count - 1);
  value[count - 1] = end[1];
  range->count = count;
  range->value = value;
  return true;
}

static bool read_sweep_range(dvi_scene *scene, const dvi__tree *key, const dvi__tree *values,
                             dvi_scene_range *range)
{
  const dvi__name *name = dvi__names_find(&scene->names, key->text);
  if (name == NULL && !dvi__is_word(key->text))
    return dvi__names_unknown(&scene->names, &scene->arena, scene->complaint, key->text, key->span);
  if (name == NULL || name->sort != DVI__PARAMETER || !scene->parameter[name->number].settable)
    return dvi__scene_refuse(scene, key->span, "'%s' is no parameter that is a number", key->text);
  range->name = key->text;
  if (values->kind == DVI__SEQUENCE) return read_values(scene, values, range);
  if (values->kind == DVI__MAPPING) return read_steps(scene, values, range);
  return dvi__scene_refuse(scene, values->span,
                           "a list of values belongs here, or {from: .., to: .., count: ..}");
}

bool dvi__read_sweep(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "sweep")) return false;
  scene->range = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *scene->range);
  if (scene->range == NULL) return dvi__scene_no_memory(scene);
  scene->range_count = section->count;
  for (int i = 0; i < section->count; i++)
    if (!read_sweep_range(scene, section->key[i], section->child[i], &scene->range[i]))
      return false;
  return true;
}
