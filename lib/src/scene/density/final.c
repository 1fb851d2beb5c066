/* The section final: the fields at the end of a path whose values at two times are known. */
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

bool dvi__density_read_final(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  const dvi__tree *section = dvi__tree_find(scene->tree, "final");
  if (section == NULL) return true;
  if (!dvi__want_mapping(scene, section, "final")) return false;
  s->final = dvi__arena_take(&scene->arena, (size_t)s->jets.components, sizeof *s->final);
  if (s->final == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    const dvi__declared_field *field = dvi__field_named(scene, section->key[i]->text);
    if (field == NULL)
      return dvi__scene_refuse(scene, section->key[i]->span,
                               "the end has the fields, without rates, and no '%s'",
                               section->key[i]->text);
    if (!dvi__local_read(scene, section->child[i], 0, "an end", field->components,
                         s->final + field->first))
      return false;
  }
  return true;
}

static bool complain(dvi_scene *scene, dvi_status status)
{
  dvi__span span;
  const char *words;
  if (status == DVI_NO_MEMORY) return dvi__scene_no_memory(scene);
  if (dvi__fault_place(&span, &words))
    return dvi__complain(scene->complaint, DVI_NOT_FINITE, span, "at the end: %s", words);
  return dvi__complain(scene->complaint, status, dvi__tree_find(scene->tree, "final")->span, "%s",
                       dvi_last_error());
}

bool dvi__density_make_final(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const size_t n = (size_t)scene->n, coefficients = (size_t)(s->jets.components * s->functions);
  if (s->final == NULL) return true;
  double *numbers = dvi__arena_take(&scene->arena, 3 * n, sizeof *numbers);
  char *marks = dvi__arena_take(&scene->arena, 3 * n, 1);
  double *U = dvi__heap_take(coefficients, sizeof *U);
  if (numbers == NULL || marks == NULL || U == NULL) {
    dvi__heap_free(U);
    return dvi__scene_no_memory(scene);
  }
  dvi__fault_clear();
  dvi_status status = dvi__density_interpolate(s, s->final, 0, U);
  if (status == DVI_OK) status = dvi_density_project(s->density, U, NULL, numbers, NULL, NULL);
  dvi__heap_free(U);
  scene->final_q = numbers;
  scene->final_v = numbers + n;
  scene->final_p = scene->final_v + n;
  scene->free_q = marks;
  scene->final_has_v = marks + n;
  scene->free_p = memset(marks + 2 * n, 1, n);
  return status == DVI_OK || complain(scene, status);
}
