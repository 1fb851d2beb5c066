/* The section coordinates. */
#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "scene/sections/columns.h"
#include "scene/sections/sections.h"

enum { COORDINATES_MAX = 100000000 };

/* The declaration of a coordinate, with its kind, the shape of a member as a value, and its numbers
 * in q and in v. */
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
      {.kind = DVI__LINES, .shape = {0, 1, 1}, .stored = 1, .velocities = 1},
      {.kind = DVI__ROTATION, .shape = {2, 3, 3}, .stored = 9, .velocities = 3},
      {.kind = DVI__MOTION, .shape = {0, 1, 1}, .stored = 12, .velocities = 6},
      {.kind = DVI__DIRECTION, .shape = {1, 3, 1}, .stored = 3, .velocities = 3},
      {.kind = DVI__ANGLE, .shape = {1, 2, 1}, .stored = 2, .velocities = 1},
      {.kind = DVI__LINES, .shape = {1, 0, 1}, .stored = 0, .velocities = 0},
  };
  enum { KINDS = sizeof known / sizeof *known, VECTOR = KINDS - 1 };
  const dvi__expression *e;
  char hint[96];
  if (!dvi__tree_expression(scene, tree, &e)) return false;
  const int called = e->form == DVI__FORM_CALL && e->count == 1;
  const char *name = called || e->form == DVI__FORM_NAME ? dvi__word_of(scene, e) : "";
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

/* Make the rotation and the place of a motion. */
static bool make_parts(dvi_scene *scene, dvi__coordinate *x)
{
  dvi__coordinate *part = dvi__arena_take(&scene->arena, 2, sizeof *part);
  if (part == NULL) return dvi__scene_no_memory(scene);
  part[0] = part[1] = *x;
  part[0].kind = DVI__ROTATION;
  part[0].part_name = 'R';
  part[0].shape = (dvi__shape){.rank = 2, .rows = 3, .columns = 3};
  part[0].q.components = 9;
  part[0].v.components = 3;
  part[1].kind = DVI__LINES;
  part[1].part_name = 'x';
  part[1].shape = (dvi__shape){.rank = 1, .rows = 3, .columns = 1};
  part[1].q = (dvi__slots){.first = x->q.first + 9, .stride = x->q.stride, .components = 3};
  part[1].v = (dvi__slots){.first = x->v.first + 3, .stride = x->v.stride, .components = 3};
  x->part = part;
  return true;
}

/* Add a coordinate. A family has `rows` members for one index, rows * columns for two. */
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
  *x = (dvi__coordinate){
      .name = name,
      .span = span,
      .kind = as->kind,
      .family = family,
      .size = size,
      .columns = columns,
      .shape = as->shape,
      .q = {.first = scene->n, .stride = as->stored, .components = as->stored},
      .v = {.first = scene->nv, .stride = as->velocities, .components = as->velocities}};
  scene->n += size * as->stored;
  scene->nv += size * as->velocities;
  scene->coordinate_count++;
  return (x->kind != DVI__MOTION || make_parts(scene, x)) &&
         dvi__names_add(&scene->names, &scene->arena, scene->complaint, name, span, DVI__COORDINATE,
                        number);
}

/* Declare x, x[N] or x[N,M]. */
static bool declare_coordinate(dvi_scene *scene, const dvi__expression *key, const declared *as)
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
  int count = 0, on_manifold = 0;
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
    on_manifold = on_manifold || as.kind != DVI__LINES;
    if (key[i]->form != DVI__FORM_LIST && !declare_coordinate(scene, key[i], &as)) return false;
    for (int k = 0; key[i]->form == DVI__FORM_LIST && k < key[i]->count; k++)
      if (!declare_coordinate(scene, key[i]->part[k], &as)) return false;
  }
  if (scene->n == 0) return dvi__scene_refuse(scene, section->span, "there are no coordinates");
  scene->velocities = on_manifold ? scene->n + scene->nv : scene->n;
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)scene->n, sizeof *scene->zeros);
  return scene->zeros != NULL ? dvi__labels_differ(scene) : dvi__scene_no_memory(scene);
}

bool dvi__add_lines(dvi_scene *scene, const char *name, dvi__span span, int rank, int first,
                    int size)
{
  const dvi__slots slots = {.first = first, .stride = size, .components = size};
  const int number = scene->coordinate_count++;
  scene->coordinate[number] = (dvi__coordinate){.name = name,
                                                .span = span,
                                                .kind = DVI__LINES,
                                                .size = 1,
                                                .columns = 1,
                                                .shape = {rank, size, 1},
                                                .q = slots,
                                                .v = slots};
  return dvi__names_add(&scene->names, &scene->arena, scene->complaint, name, span, DVI__COORDINATE,
                        number);
}
