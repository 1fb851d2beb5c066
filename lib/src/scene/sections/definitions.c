/* The section definitions. */
#include <string.h>

#include "scene/elaborate/shape.h"
#include "scene/sections/sections.h"

/* Find the shape of a definition, and the first error in it. Sums are tried at their ends. */
static bool try_definition(dvi_scene *scene, dvi__definition *d)
{
  dvi__context c;
  if (!dvi__context_make(&c, scene,
                         DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_P | DVI__MENTIONS_T,
                         "a definition"))
    return false;
  c.sample = 1;
  const dvi__value value = dvi__elaborate(&c, d->is);
  d->shape = value.shape;
  d->mentions = dvi__mentions(scene, d->is);
  dvi__context_free(&c);
  return !dvi__failed(value);
}

bool dvi__read_definitions(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "definitions")) return false;
  const int before = scene->definition_count; /* those of a solid */
  dvi__definition *list = dvi__arena_take(
      &scene->arena, (size_t)before + (size_t)section->count + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  if (before > 0) memcpy(list, scene->definition, (size_t)before * sizeof *list);
  scene->definition = list;
  for (int i = 0; i < section->count; i++) {
    dvi__definition *d = &scene->definition[before + i];
    d->name = section->key[i]->text;
    d->span = section->key[i]->span;
    if (!dvi__tree_expression(scene, section->child[i], &d->is) || !try_definition(scene, d))
      return false;
    scene->definition_count++;
    if (!dvi__names_add(&scene->names, &scene->arena, scene->complaint, d->name, d->span,
                        DVI__DEFINITION, before + i))
      return false;
  }
  return true;
}
