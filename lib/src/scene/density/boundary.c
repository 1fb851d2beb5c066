/* The section boundary: periodic axes, and conditions on parts of the boundary.
 *
 * A condition is fixed or free, perhaps with a value or a flux, which may depend on the time, or
 * {robin: a}. It is that of all fields, or a mapping by fields of such conditions. */
#include <math.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"

static const char *const side[DVI_AXES_MAX][2] = {
    {"left", "right"}, {"bottom", "top"}, {"back", "front"}};

/* The components that a condition is of. */
typedef struct extent {
  const char *part;
  int first, components;
} extent;

/* ---- callbacks ---- */

/* Part of a time's length by which it may be off a multiple of it that is meant. */
static const double same_time = 1e-6;

/* Find the multiples of the length of straight pieces before and after a time. Returns whether the
 * time lies between them, and is none of them, as all times are where a value is not straight. */
static bool is_between(const dvi__local *local, double t, double ends[2])
{
  if (!(local->straight > 0)) return false;
  const double count = floor(t / local->straight + same_time);
  ends[0] = count * local->straight;
  ends[1] = (count + 1) * local->straight;
  return t - ends[0] > same_time * local->straight;
}

/* Evaluate point k at both ends. */
static int evaluate_ends(const dvi__local *local, int64_t count, const double *x, int64_t k,
                         const double ends[2], double value[2])
{
  double at[DVI_AXES_MAX];
  for (int d = 0; d < local->dimension; d++) at[d] = x[d * count + k];
  const int failed = dvi__local_value(local, 1, ends[0], at, value);
  return failed != 0 ? failed : dvi__local_value(local, 1, ends[1], at, value + 1);
}

static int datum(int64_t count, double t, const double *x, double *value, void *user)
{
  double ends[2], at[2];
  int failed = 0;
  if (!is_between(user, t, ends)) return dvi__local_value(user, count, t, x, value);
  for (int64_t k = 0; k < count && failed == 0; k++) {
    failed = evaluate_ends(user, count, x, k, ends, at);
    value[k] = at[0] + (t - ends[0]) / (ends[1] - ends[0]) * (at[1] - at[0]);
  }
  return failed;
}

/* At multiples the rate is that of the function itself. */
static int datum_rate(int64_t count, double t, const double *x, double *rate, double *second,
                      void *user)
{
  double ends[2], at[2];
  int failed = 0;
  if (!is_between(user, t, ends)) return dvi__local_rates(user, count, t, x, rate, second);
  for (int64_t k = 0; k < count && failed == 0; k++) {
    failed = evaluate_ends(user, count, x, k, ends, at);
    rate[k] = (at[1] - at[0]) / (ends[1] - ends[0]);
    if (second != NULL) second[k] = 0;
  }
  return failed;
}

/* ---- conditions ---- */

static dvi_density_condition *add_condition(dvi_scene *scene, dvi_density_condition condition)
{
  struct dvi__scene_density *s = scene->density;
  dvi_density_condition *list = dvi__arena_grow(&scene->arena, s->condition, (size_t)s->conditions,
                                                sizeof *list);
  if (list == NULL) {
    (void)dvi__scene_no_memory(scene);
    return NULL;
  }
  s->condition = list;
  list[s->conditions] = condition;
  return list + s->conditions++;
}

/* Add the condition of one component, with a function that may be NULL. */
static bool add_one(dvi_scene *scene, const extent *of, int component, dvi_condition_kind kind,
                    dvi__local *local, double robin)
{
  dvi_density_condition condition = {
      .part = of->part, .component = component, .kind = kind, .robin = robin};
  if (local != NULL && local->term != NULL) {
    condition.datum = datum;
    condition.rate = local->has_time ? datum_rate : NULL;
    condition.user = local;
    if (local->axes != 0) scene->density->has_placed_data = true;
  }
  return add_condition(scene, condition) != NULL;
}

/* Read the time between multiples of which a fixed value is straight. */
static bool read_straight(dvi_scene *scene, const dvi__tree *tree, bool is_fixed, double *straight)
{
  if (!dvi__tree_number(scene, tree, "straight", straight)) return false;
  return (is_fixed && *straight > 0) ||
         dvi__scene_refuse(scene, tree->span,
                           "straight is the time above 0 between multiples of which a fixed value "
                           "is straight, as in '{fixed: sin(t), straight: 0.05}'");
}

/* Read {fixed: value}, {free: flux}, or {robin: a}, which may have a flux, too. */
static bool read_data(dvi_scene *scene, const extent *of, const dvi__tree *tree)
{
  static const char *const known[] = {"fixed", "free", "robin", "straight"};
  dvi__local *local[DVI_COMPONENTS_MAX] = {NULL};
  double robin = 0, straight = 0;
  if (!dvi__want_keys(scene, tree, "a condition", 4, known)) return false;
  const dvi__tree *fixed = dvi__tree_find(tree, "fixed"), *free = dvi__tree_find(tree, "free"),
                  *of_value = dvi__tree_find(tree, "robin"), *given = fixed != NULL ? fixed : free,
                  *of_time = dvi__tree_find(tree, "straight");
  if (of_time != NULL && !read_straight(scene, of_time, fixed != NULL, &straight)) return false;
  if (tree->count == 0 || (fixed != NULL && tree->count > 1 + (of_time != NULL)))
    return dvi__scene_refuse(scene, tree->span,
                             "a condition is fixed, or free, perhaps with robin, as in "
                             "'{fixed: sin(t)}' or '{robin: 2}'");
  if (of_value != NULL && !dvi__tree_number(scene, of_value, "robin", &robin)) return false;
  if (given != NULL &&
      !dvi__local_read(scene, given, DVI__MENTIONS_T, fixed != NULL ? "a fixed value" : "a flux",
                       of->components, local))
    return false;
  for (int k = 0; k < of->components; k++) {
    if (local[k] != NULL) local[k]->straight = straight;
    if (!add_one(scene, of, of->first + k, fixed != NULL ? DVI_FIXED : DVI_FREE, local[k], robin))
      return false;
  }
  return true;
}

static bool read_word(dvi_scene *scene, const extent *of, const dvi__tree *tree)
{
  static const char *const word[] = {"free", "fixed"};
  int which = 0;
  if (strcmp(tree->text, "periodic") == 0)
    return dvi__scene_refuse(scene, tree->span,
                             "periodic is a whole axis of a domain, as in 'boundary: periodic' or "
                             "'{x: periodic}'");
  while (which < 2 && strcmp(tree->text, word[which]) != 0) which++;
  if (which == 2)
    return dvi__scene_refuse(scene, tree->span,
                             "there is no condition '%s'; there are fixed, free, periodic of a "
                             "whole axis, {fixed: value}, {free: flux} and {robin: a}",
                             tree->text);
  for (int k = 0; k < of->components; k++)
    if (!add_one(scene, of, of->first + k, which == 1 ? DVI_FIXED : DVI_FREE, NULL, 0))
      return false;
  return true;
}

/* Read the condition of all fields, or a mapping by fields. */
static bool read_condition(dvi_scene *scene, const char *part, const dvi__tree *tree)
{
  const extent all = {part, 0, dvi__components(scene)};
  if (tree->kind == DVI__SCALAR) return read_word(scene, &all, tree);
  if (!dvi__want_mapping(scene, tree, "a condition")) return false;
  if (tree->count == 0 || dvi__field_named(scene, tree->key[0]->text) == NULL)
    return read_data(scene, &all, tree);
  for (int i = 0; i < tree->count; i++) {
    const dvi__declared_field *field = dvi__field_named(scene, tree->key[i]->text);
    if (field == NULL)
      return dvi__scene_refuse(scene, tree->key[i]->span, "there is no field '%s' in 'fields'",
                               tree->key[i]->text);
    const extent one = {part, field->first, field->components};
    const dvi__tree *is = tree->child[i];
    if (is->kind == DVI__SCALAR
            ? !read_word(scene, &one, is)
            : !dvi__want_mapping(scene, is, "a condition") || !read_data(scene, &one, is))
      return false;
  }
  return true;
}

/* ---- parts ---- */

static bool is_periodic(const dvi__tree *tree)
{
  return tree->kind == DVI__SCALAR && strcmp(tree->text, "periodic") == 0;
}

/* Find the axis that a part bounds. Returns -1 if there is none. */
static int axis_of_part(const dvi_scene *scene, const char *name)
{
  for (int d = 0; d < DVI_AXES_MAX && d < scene->density->jets.dimension; d++)
    if (strcmp(side[d][0], name) == 0 || strcmp(side[d][1], name) == 0) return d;
  return -1;
}

static bool is_condition(const char *word)
{
  return strcmp(word, "fixed") == 0 || strcmp(word, "free") == 0 || strcmp(word, "robin") == 0;
}

static bool refuse_part(dvi_scene *scene, const dvi__tree *key)
{
  enum { PARTS_MOST = 16 };
  const struct dvi__scene_density *s = scene->density;
  const char *part[PARTS_MOST], *next;
  char list[160];
  int parts = 0;
  if (is_condition(key->text))
    return dvi__scene_refuse(scene, key->span,
                             "'%s' is a condition, and needs a part before it, as in 'boundary: "
                             "{boundary: {%s: ..}}' for all of the boundary",
                             key->text, key->text);
  for (int i = 0;
       s->mesh != NULL && parts < PARTS_MOST - 1 && (next = dvi_mesh_part_name(s->mesh, i)) != NULL;
       i++)
    part[parts++] = next;
  for (int d = 0; d < s->jets.dimension && s->mesh == NULL; d++) {
    part[parts++] = s->jets.axis[d];
    part[parts++] = side[d][0];
    part[parts++] = side[d][1];
  }
  if (s->mesh == NULL) part[parts++] = "boundary";
  return dvi__scene_refuse(scene, key->span, "the boundary has no part '%s'; it has %s", key->text,
                           dvi__list_words(parts, part, " and ", list, sizeof list));
}

/* Read what is said of a part or an axis of a domain. */
static bool read_part(dvi_scene *scene, const dvi__tree *section, const dvi__tree *key,
                      const dvi__tree *tree)
{
  struct dvi__scene_density *s = scene->density;
  const int axis = dvi__axis_named(scene, key->text),
            bounded = axis >= 0 ? -1 : axis_of_part(scene, key->text);
  if (strcmp(key->text, "boundary") == 0) return read_condition(scene, "boundary", tree);
  if (axis < 0 && bounded < 0) return refuse_part(scene, key);
  if (axis >= 0 && is_periodic(tree)) return true;
  if (bounded >= 0 && dvi__tree_find(section, s->jets.axis[bounded]) != NULL)
    return dvi__scene_refuse(scene, key->span,
                             "the axis %s, to which '%s' belongs, has a condition of its own",
                             s->jets.axis[bounded], key->text);
  for (int k = 0; k < 2; k++)
    if ((axis >= 0 || strcmp(side[bounded][k], key->text) == 0) &&
        !read_condition(scene, side[axis >= 0 ? axis : bounded][k], tree))
      return false;
  return true;
}

static bool read_part_of_mesh(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  int64_t count;
  (void)dvi_mesh_part_cells(scene->density->mesh, key->text, 0, &count);
  return count < 0 ? refuse_part(scene, key) : read_condition(scene, key->text, tree);
}

/* Note the axes that are periodic. */
static bool read_periods(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_density *s = scene->density;
  for (int d = 0; d < s->jets.dimension; d++) {
    const dvi__tree *of_axis = section->kind == DVI__SCALAR
                                   ? section
                                   : dvi__tree_find(section, s->jets.axis[d]);
    s->axis[d].periodic = of_axis != NULL && is_periodic(of_axis);
    if (s->axis[d].periodic && s->mesh != NULL)
      return dvi__scene_refuse(scene, of_axis->span,
                               "periods of a mesh are those of its generator, as in 'mesh: "
                               "{generator: kuhn-torus}'");
  }
  return true;
}

bool dvi__density_read_boundary(dvi_scene *scene, const dvi__tree *section)
{
  if (section->kind != DVI__SCALAR && !dvi__want_mapping(scene, section, "boundary")) return false;
  if (!read_periods(scene, section)) return false;
  if (section->kind == DVI__SCALAR)
    return is_periodic(section) || read_condition(scene, "boundary", section);
  for (int i = 0; i < section->count; i++)
    if (!(scene->density->mesh != NULL
              ? read_part_of_mesh(scene, section->key[i], section->child[i])
              : read_part(scene, section, section->key[i], section->child[i])))
      return false;
  return true;
}
