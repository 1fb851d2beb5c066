/* The section parameters, and settings of parameters from outside. */
#include <dvi/number.h>
#include <math.h>
#include <string.h>

#include "scene/elaborate/shape.h"
#include "scene/sections/sections.h"

/* Return the number of the setting of a parameter, or -1. */
static int setting_of(dvi_scene *scene, const char *name)
{
  const dvi__scene_settings *settings = scene->settings;
  const size_t length = strlen(name);
  int found = -1;
  for (int i = 0; i < settings->count; i++) {
    const char *text = settings->text[i];
    if (strncmp(text, name, length) != 0 || text[length] != '=') continue;
    if (found >= 0)
      (void)dvi__complain(scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE, "%s is set twice", name);
    found = i;
  }
  return found;
}

/* Apply the value that a setting gives to a number. */
static bool apply_setting(dvi_scene *scene, dvi__parameter *p, const char *text)
{
  const char *number = text + strlen(p->name) + 1;
  double value = 0.0;
  const char *end = dvi_number_read(number, &value);
  if (!p->settable)
    return dvi__complain(scene->complaint, DVI_BAD_OPTION, p->span,
                         "%s: '%s' is a list, and only numbers can be set", text, p->name);
  if (end == number || *end != '\0' || !isfinite(value))
    return dvi__complain(scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE,
                         "%s: '%s' is no finite number", text, number);
  p->value[0] = value;
  return true;
}

static bool parameter_evaluate(dvi_scene *scene, const dvi__expression *e, dvi__parameter *p)
{
  dvi__context c;
  if (!dvi__context_make(&c, scene, 0, "a parameter")) return false;
  const dvi__value value = dvi__elaborate(&c, e);
  bool good = !dvi__failed(value);
  if (good) {
    p->shape = value.shape;
    p->settable = value.shape.rank == 0;
    p->value = dvi__arena_take(&scene->arena, (size_t)dvi__value_size(value), sizeof *p->value);
    good = p->value != NULL ? dvi__constants_of(&c, e, value, p->value)
                            : dvi__scene_no_memory(scene);
  }
  dvi__context_free(&c);
  return good;
}

static bool parameter_read(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  const dvi__expression *e;
  dvi__parameter *p = &scene->parameter[scene->parameter_count];
  *p = (dvi__parameter){.name = key->text, .span = key->span};
  if (!dvi__tree_expression(scene, tree, &e) || !parameter_evaluate(scene, e, p)) return false;
  const int set = setting_of(scene, p->name);
  p->is = set < 0 ? e : NULL;
  if (scene->complaint->status != DVI_OK) return false;
  if (set >= 0) {
    scene->settings->used[set] = 1;
    if (!apply_setting(scene, p, scene->settings->text[set])) return false;
  }
  return dvi__names_add(&scene->names, &scene->arena, scene->complaint, p->name, key->span,
                        DVI__PARAMETER, scene->parameter_count++);
}

/* Refuse a setting that no parameter took. */
static bool refuse_setting(dvi_scene *scene, const char *text)
{
  char hint[96] = "";
  const char *equals = strchr(text, '=');
  if (equals == NULL)
    return dvi__complain(scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE,
                         "the setting '%s' is not of the form name=value", text);
  const char *name = dvi__arena_text(&scene->arena, text, (size_t)(equals - text));
  const char **known = dvi__arena_take(&scene->arena, (size_t)scene->parameter_count + 1,
                                       sizeof *known);
  if (name == NULL || known == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < scene->parameter_count; i++) known[i] = scene->parameter[i].name;
  const dvi__tree *coordinates = dvi__tree_find(scene->tree, "coordinates");
  if (coordinates != NULL && dvi__tree_find(coordinates, name) != NULL)
    return dvi__complain(
        scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE,
        "%s: '%s' is a coordinate; a start is set through a parameter that initial names", text,
        name);
  return dvi__complain(scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE,
                       "%s: there is no parameter '%s'%s", text, name,
                       dvi__nearest(name, scene->parameter_count, known, hint, sizeof hint));
}

bool dvi__read_parameters(dvi_scene *scene, const dvi__tree *section)
{
  const dvi__scene_settings *settings = scene->settings;
  scene->reads = DVI__IN_PARAMETERS;
  if (!dvi__want_mapping(scene, section, "parameters")) return false;
  scene->parameter = dvi__arena_take(&scene->arena, (size_t)section->count + 1,
                                     sizeof *scene->parameter);
  if (scene->parameter == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!parameter_read(scene, section->key[i], section->child[i])) return false;
  for (int i = 0; i < settings->count; i++)
    if (!settings->used[i]) return refuse_setting(scene, settings->text[i]);
  return true;
}

/* Note a use. The parameter that is being read is the one behind those that were. */
bool dvi__note_parameter(dvi_scene *scene, dvi__parameter *parameter)
{
  parameter->used_in |= scene->reads;
  if (scene->reads != DVI__IN_PARAMETERS || parameter->last_made == scene->parameter_count + 1)
    return true;
  dvi__source_of *source = dvi__arena_take(&scene->arena, 1, sizeof *source);
  if (source == NULL) return dvi__scene_no_memory(scene);
  dvi__parameter *made = &scene->parameter[scene->parameter_count];
  *source = (dvi__source_of){parameter, made->source};
  made->source = source;
  parameter->last_made = scene->parameter_count + 1;
  return true;
}

/* Tell parameters their uses. Parameters are made of those above them. From the last one on, all
 * uses of a parameter are known when it is met. */
bool dvi__read_uses(dvi_scene *scene)
{
  for (int i = scene->parameter_count - 1; i >= 0; i--) {
    const dvi__parameter *p = &scene->parameter[i];
    for (const dvi__source_of *source = p->source; source != NULL; source = source->next)
      source->parameter->used_in |= p->used_in;
    if (p->used_in == 0 && setting_of(scene, p->name) >= 0)
      return dvi__complain(scene->complaint, DVI_BAD_OPTION, p->span,
                           "'%s' is set, but nothing in the scene mentions it", p->name);
  }
  return true;
}
