/* The coordinates of a mesh that moves. They stand node by node, the positions x_1, x_2 and so on
 * that are unknown, under the names of the axes, and the values of the fields. */
#include <string.h>

#include "scene/density/moving.h"

/* A family: numbers `first` to first + components - 1 of all nodes that have them as unknowns. */
typedef struct family {
  const char *name;
  dvi__span span;
  bool is_vector;
  int first, components;
} family;

/* The coordinates of the numbers of each node, of which there are `numbers`, or -1. */
typedef struct table {
  const int *unknown;
  int nodes, numbers;
} table;

/* Tell if all of a family or nothing of it is unknown at a node. */
static bool is_whole(const table *t, int node, const family *f)
{
  const int *at = t->unknown + (ptrdiff_t)node * t->numbers + f->first;
  for (int k = 1; k < f->components; k++)
    if (at[k] != (at[0] < 0 ? -1 : at[0] + k)) return false;
  return true;
}

/* List the first coordinates of the members. Returns their number, or -1 after a complaint. */
static int list_members(dvi_scene *scene, const table *t, const family *f, int *place)
{
  int count = 0;
  for (int node = 0; node < t->nodes; node++) {
    if (!is_whole(t, node, f)) {
      const dvi__tree *boundary = dvi__tree_find(scene->tree, "boundary");
      (void)dvi__scene_refuse(scene, boundary != NULL ? boundary->span : f->span,
                              "on a mesh that moves all components of %s are fixed at a place, or "
                              "none",
                              f->name);
      return -1;
    }
    const int at = t->unknown[(ptrdiff_t)node * t->numbers + f->first];
    if (at >= 0) place[count++] = at;
  }
  return count;
}

/* Give places at equal distances by these alone. */
static dvi__slots slots_of(const family *f, int count, const int *place)
{
  const int stride = count > 1 ? place[1] - place[0] : 1;
  for (int k = 1; k < count; k++)
    if (place[k] - place[k - 1] != stride)
      return (dvi__slots){.components = f->components, .place = place};
  return (dvi__slots){
      .first = count > 0 ? place[0] : 0, .stride = stride, .components = f->components};
}

static bool add_family(dvi_scene *scene, const table *t, const family *f)
{
  int *place = dvi__arena_take(&scene->arena, (size_t)t->nodes + 1, sizeof *place);
  if (place == NULL) return dvi__scene_no_memory(scene);
  const int count = list_members(scene, t, f, place);
  if (count <= 0) return count == 0;
  const dvi__slots slots = slots_of(f, count, place);
  scene->coordinate[scene->coordinate_count++] = (dvi__coordinate){
      .name = f->name,
      .span = f->span,
      .kind = DVI__LINES,
      .family = 1,
      .size = count,
      .columns = 1,
      .shape = {f->is_vector, f->components, 1},
      .q = slots,
      .v = slots};
  scene->n += count * f->components;
  return true;
}

static bool add_families(dvi_scene *scene, const table *t)
{
  const struct dvi__scene_density *s = scene->density;
  const int axes = s->jets.dimension;
  for (int d = 0; d < axes; d++)
    if (!add_family(scene, t, &(family){s->jets.axis[d], s->axis_span[d], false, d, 1}))
      return false;
  for (int i = 0; i < s->fields; i++) {
    const dvi__declared_field *field = s->field + i;
    if (!add_family(scene, t,
                    &(family){field->name, field->span, field->is_vector, axes + field->first,
                              field->components}))
      return false;
  }
  return true;
}

/* The names of the place now are those of the families. */
static void rename_coordinates(dvi_scene *scene)
{
  for (int k = 0; k < scene->names.count; k++) {
    dvi__name *name = scene->names.name + k;
    int number = 0;
    for (int i = 0; i < scene->coordinate_count; i++)
      if (strcmp(scene->coordinate[i].name, name->text) == 0) number = i;
    if (name->sort == DVI__COORDINATE) name->number = number;
  }
}

bool dvi__moving_name_unknowns(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const size_t families = (size_t)s->jets.dimension + (size_t)s->fields;
  table t = {.numbers = s->jets.dimension + s->jets.components};
  t.unknown = dvi_moving_unknowns(s->moving->made, &t.nodes);
  scene->coordinate = dvi__arena_take(&scene->arena, families, sizeof *scene->coordinate);
  if (scene->coordinate == NULL) return dvi__scene_no_memory(scene);
  scene->coordinate_count = scene->n = 0;
  if (!add_families(scene, &t)) return false;
  scene->nv = scene->velocities = scene->n;
  rename_coordinates(scene);
  return true;
}
