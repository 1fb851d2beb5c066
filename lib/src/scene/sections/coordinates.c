/* Parameters, coordinates and definitions. */
#include <dvi/number.h>
#include <math.h>
#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "scene/sections/sections.h"
#include "scene/elaborate/shape.h"

enum { COORDINATES_MAX = 100000000 };

/* ---- parameters ---- */

static int setting_of(dvi_scene *scene, const char *name, const dvi__scene_settings *settings)
{
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

/* The value that a setting gives to a number. */
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

static bool evaluate(dvi_scene *scene, const dvi__expression *e, dvi__parameter *p)
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

static bool read_parameter(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                           dvi__scene_settings *settings)
{
  const dvi__expression *e;
  dvi__parameter *p = &scene->parameter[scene->parameter_count];
  *p = (dvi__parameter){.name = key->text, .span = key->span};
  if (!dvi__tree_expression(scene, tree, &e) || !evaluate(scene, e, p)) return false;
  const int set = setting_of(scene, p->name, settings);
  if (scene->complaint->status != DVI_OK) return false;
  if (set >= 0) {
    settings->used[set] = 1;
    if (!apply_setting(scene, p, settings->text[set])) return false;
  }
  return dvi__names_add(&scene->names, &scene->arena, scene->complaint, p->name, key->span,
                        DVI__PARAMETER, scene->parameter_count++);
}

/* A setting that no parameter took. */
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
  if (dvi__tree_find(coordinates, name) != NULL)
    return dvi__complain(
        scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE,
        "%s: '%s' is a coordinate; a start is set through a parameter that initial names", text,
        name);
  return dvi__complain(scene->complaint, DVI_BAD_OPTION, DVI__NOWHERE,
                       "%s: there is no parameter '%s'%s", text, name,
                       dvi__nearest(name, scene->parameter_count, known, hint, sizeof hint));
}

bool dvi__read_parameters(dvi_scene *scene, const dvi__tree *section, dvi__scene_settings *settings)
{
  if (section != NULL && !dvi__want_mapping(scene, section, "parameters")) return false;
  const int count = section == NULL ? 0 : section->count;
  scene->parameter = dvi__arena_take(&scene->arena, (size_t)count + 1, sizeof *scene->parameter);
  if (scene->parameter == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < count; i++)
    if (!read_parameter(scene, section->key[i], section->child[i], settings)) return false;
  for (int i = 0; i < settings->count; i++)
    if (!settings->used[i]) return refuse_setting(scene, settings->text[i]);
  return true;
}

/* The parameter that is being read is the one behind those that were. */
bool dvi__note_parameter(dvi_scene *scene, dvi__parameter *parameter)
{
  parameter->stands |= scene->reads;
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

/* Parameters are made of those above them: from the last one on, all that mention one are known
 * when it is met. */
bool dvi__read_uses(dvi_scene *scene, const dvi__scene_settings *settings)
{
  for (int i = scene->parameter_count - 1; i >= 0; i--) {
    const dvi__parameter *p = &scene->parameter[i];
    for (const dvi__source_of *source = p->source; source != NULL; source = source->next)
      source->parameter->stands |= p->stands;
    if (p->stands == 0 && setting_of(scene, p->name, settings) >= 0)
      return dvi__complain(scene->complaint, DVI_BAD_OPTION, p->span,
                           "'%s' is set, but nothing in the scene mentions it", p->name);
  }
  return true;
}

/* ---- coordinates ---- */

/* What is declared of a coordinate: its kind, what a member is as a value, and how many numbers it
 * has in q and in v. */
typedef struct declared {
  dvi__kind kind;
  dvi__shape shape;
  int stored, velocities;
} declared;

static bool read_vector(dvi_scene *scene, const dvi__expression *e, declared *as)
{
  const dvi__tree size = {.kind = DVI__SCALAR, .span = e->part[0]->span};
  if (!dvi__tree_whole(scene, &size, "the size of a vector", 1, &as->shape.rows)) return false;
  as->stored = as->velocities = as->shape.rows;
  return true;
}

static bool read_kind(dvi_scene *scene, const dvi__tree *tree, declared *as)
{
  static const char *const known[] = {"scalar",    "rotation", "motion",
                                      "direction", "angle",    "vector"};
  static const declared meaning[] = {
      {DVI__LINES, {0, 1, 1}, 1, 1},   {DVI__ROTATION, {2, 3, 3}, 9, 3},
      {DVI__MOTION, {0, 1, 1}, 12, 6}, {DVI__DIRECTION, {1, 3, 1}, 3, 3},
      {DVI__ANGLE, {1, 2, 1}, 2, 1},   {DVI__LINES, {1, 0, 1}, 0, 0}};
  enum { KINDS = sizeof known / sizeof *known, VECTOR = KINDS - 1 };
  const dvi__expression *e;
  char hint[96];
  if (!dvi__tree_expression(scene, tree, &e)) return false;
  const int called = e->form == DVI__FORM_CALL && e->count == 1;
  const char *name = called || e->form == DVI__FORM_NAME ? e->name : "";
  for (int k = 0; k < KINDS; k++) {
    if (strcmp(name, known[k]) != 0 || called != (k == VECTOR)) continue;
    *as = meaning[k];
    return k != VECTOR || read_vector(scene, e, as);
  }
  if (strcmp(name, known[VECTOR]) == 0)
    return dvi__scene_refuse(scene, tree->span, "a vector has its size, as in vector(3)");
  return dvi__scene_refuse(scene, tree->span,
                           "a kind is scalar, vector(d), rotation, motion, direction or angle%s",
                           dvi__nearest(name, KINDS, known, hint, sizeof hint));
}

/* The rotation and the place of a motion. */
static bool make_parts(dvi_scene *scene, dvi__coordinate *x)
{
  dvi__coordinate *part = dvi__arena_take(&scene->arena, 2, sizeof *part);
  if (part == NULL) return dvi__scene_no_memory(scene);
  part[0] = part[1] = *x;
  part[0].kind = DVI__ROTATION;
  part[0].part_name = 'R';
  part[0].shape = (dvi__shape){2, 3, 3};
  part[0].q.components = 9;
  part[0].v.components = 3;
  part[1].kind = DVI__LINES;
  part[1].part_name = 'x';
  part[1].shape = (dvi__shape){1, 3, 1};
  part[1].q = (dvi__slots){x->q.first + 9, x->q.stride, 3};
  part[1].v = (dvi__slots){x->v.first + 3, x->v.stride, 3};
  x->part = part;
  return true;
}

/* A family has `rows` members for one index, rows * columns for two. */
static bool add_coordinate(dvi_scene *scene, const char *name, dvi__span span, int family, int rows,
                           int columns, const declared *as)
{
  const int number = scene->coordinate_count;
  dvi__coordinate *x = &scene->coordinate[number];
  const long most = (COORDINATES_MAX - scene->n) / as->stored;
  if ((long)rows * columns > most)
    return dvi__complain(scene->complaint, DVI_BAD_SIZE, span, "more than %d coordinates",
                         COORDINATES_MAX);
  const int size = rows * columns;
  *x = (dvi__coordinate){.name = name,
                         .span = span,
                         .kind = as->kind,
                         .family = family,
                         .size = size,
                         .columns = columns,
                         .shape = as->shape,
                         .q = {scene->n, as->stored, as->stored},
                         .v = {scene->nv, as->velocities, as->velocities}};
  scene->n += size * as->stored;
  scene->nv += size * as->velocities;
  scene->coordinate_count++;
  return (x->kind != DVI__MOTION || make_parts(scene, x)) &&
         dvi__names_add(&scene->names, &scene->arena, scene->complaint, name, span, DVI__COORDINATE,
                        number);
}

/* x, x[N] or x[N,M]. */
static bool declare(dvi_scene *scene, const dvi__expression *key, const declared *as)
{
  int extent[2] = {1, 1};
  dvi__subscripts sizes;
  if (key->form == DVI__FORM_NAME) return add_coordinate(scene, key->name, key->span, 0, 1, 1, as);
  if (key->form != DVI__FORM_INDEX || !dvi__subscripts_of(key, &sizes) ||
      key->part[0]->form != DVI__FORM_NAME)
    return dvi__scene_refuse(scene, key->span,
                             "a coordinate is declared as x, as x[N] for a family of N, or as "
                             "x[N,M] for one of N times M");
  for (int k = 0; k < sizes.count; k++) {
    const dvi__tree how_many = {.kind = DVI__SCALAR, .span = sizes.of[k]->span};
    if (!dvi__tree_whole(scene, &how_many, "the size of a family", 1, &extent[k])) return false;
  }
  return add_coordinate(scene, key->part[0]->name, key->part[0]->span, sizes.count, extent[0],
                        extent[1], as);
}

bool dvi__read_coordinates(dvi_scene *scene, const dvi__tree *section)
{
  int count = 0, turns = 0;
  if (!dvi__want_mapping(scene, section, "coordinates")) return false;
  const dvi__expression **key = dvi__arena_take(&scene->arena, (size_t)section->count + 1,
                                                sizeof(*key));
  if (key == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    if (!dvi__tree_expression(scene, section->key[i], &key[i])) return false;
    count += key[i]->form == DVI__FORM_LIST ? key[i]->count : 1;
  }
  scene->coordinate = dvi__arena_take(&scene->arena, (size_t)count + 1, sizeof *scene->coordinate);
  if (scene->coordinate == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    declared as;
    if (!read_kind(scene, section->child[i], &as)) return false;
    turns = turns || as.kind != DVI__LINES;
    if (key[i]->form != DVI__FORM_LIST && !declare(scene, key[i], &as)) return false;
    for (int k = 0; key[i]->form == DVI__FORM_LIST && k < key[i]->count; k++)
      if (!declare(scene, key[i]->part[k], &as)) return false;
  }
  if (scene->n == 0) return dvi__scene_refuse(scene, section->span, "there are no coordinates");
  scene->velocities = turns ? scene->n + scene->nv : scene->n;
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)scene->n, sizeof *scene->zeros);
  return scene->zeros != NULL ? dvi__labels_differ(scene) : dvi__scene_no_memory(scene);
}

/* ---- definitions ---- */

/* Its shape, and the first error in it; sums are tried at their ends. */
static bool try_definition(dvi_scene *scene, dvi__definition *d)
{
  dvi__context c;
  if (!dvi__context_make(&c, scene, DVI__SAYS_Q | DVI__SAYS_V | DVI__SAYS_P | DVI__SAYS_T,
                         "a definition"))
    return false;
  c.sample = 1;
  const dvi__value value = dvi__elaborate(&c, d->is);
  d->shape = value.shape;
  d->says = dvi__says(scene, d->is);
  dvi__context_free(&c);
  return !dvi__failed(value);
}

bool dvi__read_definitions(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "definitions")) return false;
  scene->definition = dvi__arena_take(&scene->arena, (size_t)section->count + 1,
                                      sizeof *scene->definition);
  if (scene->definition == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    dvi__definition *d = &scene->definition[i];
    d->name = section->key[i]->text;
    d->span = section->key[i]->span;
    if (!dvi__tree_expression(scene, section->child[i], &d->is) || !try_definition(scene, d))
      return false;
    scene->definition_count++;
    if (!dvi__names_add(&scene->names, &scene->arena, scene->complaint, d->name, d->span,
                        DVI__DEFINITION, i))
      return false;
  }
  return true;
}
