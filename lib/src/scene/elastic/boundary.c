/* The sections boundary, loads and obstacles of a solid. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/elastic/scene_elastic.h"
#include "scene/sections/sections.h"

static const char *const axis[] = {"x", "y", "z"};

/* ---- given displacements ---- */

static int displace(double t, const double *X, double *u, double *rate, void *user)
{
  const dvi__solid_function *f = user;
  memset(u, 0, (size_t)f->n * sizeof *u);
  memset(rate, 0, (size_t)f->n * sizeof *rate);
  const int failed = dvi__solid_function_value(f, t, X, NULL, u + f->first);
  return failed != 0 || !f->has_time ? failed : dvi__solid_function_rate(f, t, X, rate + f->first);
}

static dvi_elastic_condition *next_condition(dvi_scene *scene, const char *part)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  dvi_elastic_condition *made = s->condition + s->conditions++;
  *made = (dvi_elastic_condition){.part = part, .is_steady = 1};
  return made;
}

/* Read '{x: 0, z: 0.1*t}', each component by itself. */
static bool read_components(dvi_scene *scene, const char *part, const dvi__tree *tree)
{
  const int n = scene->field->space;
  if (!dvi__want_keys(scene, tree, "a displacement by component", n, axis)) return false;
  for (int i = 0; i < n && i < DVI__SOLID_AXES; i++) {
    const dvi__tree *value = dvi__tree_find(tree, axis[i]);
    if (value == NULL) continue;
    dvi__solid_function *function;
    if (!dvi__solid_function_read(scene, value, DVI__SOLID_TIME, 1, "a displacement", &function))
      return false;
    function->first = i;
    dvi_elastic_condition *made = next_condition(scene, part);
    made->component[i] = 1;
    made->displacement = displace;
    made->is_steady = !function->has_time;
    made->user = function;
  }
  return true;
}

/* A condition is a word, or gives a displacement. */
static bool read_condition(dvi_scene *scene, const char *part, dvi__span span,
                           const dvi__tree *tree)
{
  static const char *const word[] = {"free", "fixed"};
  dvi__solid_function *function;
  int64_t count;
  int which;
  (void)dvi_mesh_part_cells(scene->field->mesh, part, 0, &count);
  if (count < 0) return dvi__refuse_part(scene, span, part, false);
  if (tree->kind == DVI__SCALAR) {
    if (!dvi__tree_word(scene, tree, "a condition", 2, word, &which)) return false;
    if (which == 1) (void)next_condition(scene, part);
    return true;
  }
  if (!dvi__want_mapping(scene, tree, "a condition") ||
      !dvi__want_keys(scene, tree, "a condition", 1, word + 1))
    return false;
  if (tree->count != 1)
    return dvi__scene_refuse(scene, tree->span,
                             "a condition of a solid is fixed or free, or gives a displacement, as "
                             "in '{fixed: [0, 0.1*t]}' or '{fixed: {x: 0}}'");
  if (tree->child[0]->kind == DVI__MAPPING) return read_components(scene, part, tree->child[0]);
  if (!dvi__solid_function_read(scene, tree->child[0], DVI__SOLID_TIME, scene->field->space,
                                "a displacement", &function))
    return false;
  dvi_elastic_condition *made = next_condition(scene, part);
  made->displacement = displace;
  made->is_steady = !function->has_time;
  made->user = function;
  return true;
}

bool dvi__elastic_read_boundary(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  const size_t most = (size_t)DVI__SOLID_AXES * (size_t)section->count + 1;
  s->condition = dvi__arena_take(&scene->arena, most, sizeof *s->condition);
  if (s->condition == NULL) return dvi__scene_no_memory(scene);
  return dvi__read_by_part(scene, section, read_condition);
}

/* ---- loads ---- */

static int push(double t, const double *X, const double *normal, double *force, void *user)
{
  return dvi__solid_function_value(user, t, X, normal, force);
}

static bool refuse_load(dvi_scene *scene, const dvi__tree *key)
{
  static const char *const gravity = "gravity";
  char hint[64];
  return dvi__scene_refuse(scene, key->span,
                           "a load is 'gravity', or by a part's name a force per volume, as in "
                           "'{force: [0, 0, -1]}', or of the boundary a traction per area, as in "
                           "'{traction: -2*normal}'%s",
                           dvi__nearest(key->text, 1, &gravity, hint, sizeof hint));
}

/* Return the degree of a part's largest cells, of which a share may have none, or -1. */
static int degree_of_part(const dvi_mesh *mesh, const char *part)
{
  const char *name;
  for (int i = 0; (name = dvi_mesh_part_name(mesh, i)) != NULL; i++)
    if (strcmp(name, part) == 0) return dvi_mesh_part_degree(mesh, i);
  return -1;
}

static bool read_load(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  static const char *const known[] = {"force", "traction"};
  struct dvi__scene_elastic *s = scene->field->elastic;
  dvi__solid_function *function;
  if (tree->kind == DVI__MAPPING && !dvi__want_keys(scene, tree, "a load", 2, known)) return false;
  if (tree->kind != DVI__MAPPING || tree->count != 1) return refuse_load(scene, key);
  const bool is_traction = strcmp(tree->key[0]->text, "traction") == 0;
  const int degree = degree_of_part(scene->field->mesh, key->text), n = scene->field->dimension;
  if (is_traction && degree != n - 1)
    return dvi__scene_refuse(
        scene, key->span, "the mesh has no part '%s' of facets for a traction; 'boundary' is one",
        key->text);
  if (!is_traction && degree >= 0 && degree < n)
    return dvi__scene_refuse(scene, key->span,
                             "the part '%s' has no volume for a force; a part of the boundary has "
                             "a 'traction', a force per area",
                             key->text);
  if (degree < 0) return dvi__refuse_part(scene, key->span, key->text, true);
  if (!dvi__solid_function_read(
          scene, tree->child[0], DVI__SOLID_TIME | (is_traction ? DVI__SOLID_NORMAL : 0),
          scene->field->space, is_traction ? "a traction" : "a force", &function))
    return false;
  s->load[s->loads++] = (dvi_elastic_load){
      .part = key->text, .force = push, .is_steady = !function->has_time, .user = function};
  return true;
}

bool dvi__read_loads(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  if (s == NULL) return dvi__scene_refuse(scene, section->span, "'loads' is of 'field: elastic'");
  if (!dvi__want_mapping(scene, section, "loads")) return false;
  const size_t most = (size_t)section->count + (size_t)s->materials + 1;
  s->load = dvi__arena_take(&scene->arena, most, sizeof *s->load);
  if (s->load == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    const dvi__tree *key = section->key[i];
    if (strcmp(key->text, "gravity") != 0) {
      if (!read_load(scene, key, section->child[i])) return false;
      continue;
    }
    s->gravity = section->child[i];
    if (!dvi__point_read(scene, s->gravity, scene->field->space, "gravity", s->acceleration))
      return false;
  }
  return dvi__solid_add_gravity(scene);
}

/* ---- gravity ---- */

/* The weight of a part, beside what other parts say of its cells. */
typedef struct weight {
  int n;
  double force[DVI__SOLID_AXES];
} weight;

static int weigh(double t, const double *X, const double *normal, double *force, void *user)
{
  const weight *w = user;
  (void)t, (void)X, (void)normal;
  for (int i = 0; i < w->n; i++) force[i] = w->force[i];
  return 0;
}

static bool add_weight(dvi_scene *scene, const char *part, double density)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  weight *w = dvi__arena_take(&scene->arena, 1, sizeof *w);
  if (w == NULL) return dvi__scene_no_memory(scene);
  w->n = scene->field->space;
  for (int i = 0; i < w->n; i++) w->force[i] = density * s->acceleration[i];
  s->load[s->loads++] = (dvi_elastic_load){.part = part, .force = weigh, .is_steady = 1, .user = w};
  return true;
}

/* The first material of a density, counted from 1. */
static int kind_of(const struct dvi__scene_elastic *s, int material)
{
  int i = 0;
  while (s->material[i].rho != s->material[material].rho) i++;
  return i + 1;
}

static double density_of(const struct dvi__scene_elastic *s, int kind)
{
  return kind > 0 ? s->material[kind - 1].rho : 0;
}

/* Add the weight of a material to what others say of its cells. `kind` [cells] has the densities so
 * far. Processes count together whether there was only one. */
static bool weigh_material(dvi_scene *scene, int i, int *kind)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  int64_t count;
  const dvi_elastic_material *m = s->material + i;
  const int *cell = dvi_mesh_part_cells(scene->field->mesh, m->part, scene->field->dimension,
                                        &count);
  const int before = count > 0 ? kind[cell[0]] : 0, after = kind_of(s, i);
  for (int64_t k = 0; k < count; k++) {
    const int other = kind[cell[k]];
    if (other != before && s->weighed == NULL)
      return dvi__scene_refuse(scene, s->material_span[i],
                               "with gravity the part '%s' must lie in one other material, and "
                               "some of its cells have the density %g, and others %g",
                               m->part, density_of(s, before), density_of(s, other));
    for (int power = 0; power < 3 && s->weighed != NULL; power++)
      s->weighed[3 * i + power] += power == 0 ? 1 : power == 1 ? other : other * other;
    kind[cell[k]] = after;
  }
  return add_weight(scene, m->part, m->rho - density_of(s, before));
}

/* The last material of a cell counts, and loads add up. So the load of a part is that of its
 * density beside the one that its cells had before, which is the same in all of them. */
bool dvi__solid_add_gravity(dvi_scene *scene)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  const int64_t cells = dvi_mesh_count(scene->field->mesh, scene->field->dimension);
  if (s->gravity == NULL) return true;
  int *kind = dvi__arena_take(&scene->arena, (size_t)cells, sizeof *kind);
  if (kind == NULL) return dvi__scene_no_memory(scene);
  if (dvi__is_share(scene)) {
    s->weighed = dvi__arena_take(&scene->arena, 3 * (size_t)s->materials, sizeof *s->weighed);
    if (s->weighed == NULL) return dvi__scene_no_memory(scene);
  }
  for (int i = 0; i < s->materials; i++)
    if (!weigh_material(scene, i, kind)) return false;
  return true;
}

/* N numbers whose sums are k N, and of their squares k k N, are all k. */
bool dvi__solid_check_gravity(dvi_scene *scene)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  if (s->weighed == NULL) return true;
  const dvi_status status = dvi_elastic_sum(s->solid, 3 * s->materials, s->weighed);
  if (status != DVI_OK)
    return dvi__complain(scene->complaint, status, s->gravity->span, "%s", dvi_last_error());
  for (int i = 0; i < s->materials; i++) {
    const double *sum = s->weighed + 3 * i, kind = sum[0] > 0 ? rint(sum[1] / sum[0]) : 0;
    if (sum[1] != kind * sum[0] || sum[2] != kind * kind * sum[0])
      return dvi__scene_refuse(scene, s->material_span[i],
                               "with gravity the part '%s' must lie in one other material, and its "
                               "cells have several densities",
                               s->material[i].part);
  }
  return true;
}

/* ---- obstacles ---- */

static bool read_plane(dvi_scene *scene, const dvi__tree *tree, dvi_obstacle *o)
{
  static const char *const known[] = {"point", "normal"};
  const int n = scene->field->space;
  const dvi__tree *point = dvi__tree_find(tree, "point"), *normal = dvi__tree_find(tree, "normal");
  double square = 0;
  if (!dvi__want_keys(scene, tree, "a plane", 2, known)) return false;
  if (point == NULL || normal == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a plane has a point and a normal, which points to the side of the "
                             "body, as in '{point: [0, 0, 0], normal: [0, 0, 1]}'");
  if (!dvi__point_read(scene, point, n, "a point", o->point) ||
      !dvi__point_read(scene, normal, n, "a normal", o->normal))
    return false;
  for (int i = 0; i < n; i++) square += o->normal[i] * o->normal[i];
  return (square > 0 && isfinite(square)) ||
         dvi__scene_refuse(scene, normal->span, "the normal of a plane is not 0");
}

static bool read_ball(dvi_scene *scene, const dvi__tree *tree, dvi_obstacle *o)
{
  static const char *const known[] = {"centre", "radius"};
  const dvi__tree *centre = dvi__tree_find(tree, "centre"),
                  *radius = dvi__tree_find(tree, "radius");
  if (!dvi__want_keys(scene, tree, "a ball", 2, known)) return false;
  if (centre == NULL || radius == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a ball has a centre and a radius, as in '{centre: [0, 0, 0], radius: "
                             "1}'");
  return dvi__point_read(scene, centre, scene->field->space, "a centre", o->point) &&
         dvi__solid_number(scene, radius, "radius", false, &o->radius);
}

static const char *const obstacle_key[] = {"plane", "ball", "hollow", "restitution", "friction"};
enum { SHAPES = 3, OBSTACLE_KEYS = 5 };

static bool read_shape(dvi_scene *scene, const dvi__tree *tree, dvi_obstacle *o)
{
  static const dvi_obstacle_kind kind[SHAPES] = {DVI_OBSTACLE_PLANE, DVI_OBSTACLE_BALL,
                                                 DVI_OBSTACLE_HOLLOW};
  const dvi__tree *shape = NULL;
  int shapes = 0;
  for (int k = 0; k < SHAPES; k++) {
    const dvi__tree *found = dvi__tree_find(tree, obstacle_key[k]);
    if (found == NULL) continue;
    shape = found;
    o->kind = kind[k];
    shapes++;
  }
  if (shapes != 1)
    return dvi__scene_refuse(scene, tree->span,
                             "an obstacle is a plane, a ball, or the hollow of one, as in '{ball: "
                             "{centre: [0, 0, -2], radius: 1}, restitution: 0.5}'");
  return dvi__want_mapping(scene, shape, "the shape of an obstacle") &&
         (o->kind == DVI_OBSTACLE_PLANE ? read_plane : read_ball)(scene, shape, o);
}

static bool read_obstacle(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                          dvi_obstacle *o)
{
  *o = (dvi_obstacle){.name = key->text};
  if (!dvi__want_name(scene, key->text, key->span) ||
      !dvi__want_mapping(scene, tree, "an obstacle") ||
      !dvi__want_keys(scene, tree, "an obstacle", OBSTACLE_KEYS, obstacle_key) ||
      !read_shape(scene, tree, o))
    return false;
  const dvi__tree *restitution = dvi__tree_find(tree, "restitution"),
                  *friction = dvi__tree_find(tree, "friction");
  if (restitution == NULL)
    return dvi__scene_refuse(scene, tree->span, "an obstacle needs 'restitution', from 0 to 1");
  if (!dvi__solid_number(scene, restitution, "restitution", true, &o->restitution) ||
      (friction != NULL && !dvi__solid_number(scene, friction, "friction", true, &o->friction)))
    return false;
  return o->restitution <= 1 ||
         dvi__scene_refuse(scene, restitution->span,
                           "the restitution is %g; it is a number from 0 to 1", o->restitution);
}

bool dvi__read_obstacles(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  if (s == NULL)
    return dvi__scene_refuse(scene, section->span, "'obstacles' is of 'field: elastic'");
  if (!dvi__want_mapping(scene, section, "obstacles")) return false;
  s->obstacle = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *s->obstacle);
  if (s->obstacle == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!read_obstacle(scene, section->key[i], section->child[i], s->obstacle + s->obstacles++))
      return false;
  return true;
}

/* The distance of a point from an obstacle, below 0 inside. */
static double gap_of(const dvi_obstacle *o, int n, const double *x)
{
  double along = 0, square = 0, length = 0;
  for (int i = 0; i < n; i++) {
    const double d = x[i] - o->point[i];
    along += d * o->normal[i];
    square += d * d;
    length += o->normal[i] * o->normal[i];
  }
  if (o->kind == DVI_OBSTACLE_PLANE) return along / sqrt(length);
  return o->kind == DVI_OBSTACLE_BALL ? sqrt(square) - o->radius : o->radius - sqrt(square);
}

bool dvi__solid_check_obstacles(dvi_scene *scene)
{
  const struct dvi__scene_elastic *s = scene->field->elastic;
  const dvi_mesh *mesh = scene->field->mesh;
  const int n = scene->field->space;
  const double *X = dvi_mesh_points(mesh);
  int64_t count;
  const int *node = dvi_mesh_part_cells(mesh, "boundary", 0, &count);
  for (int64_t k = 0; k < count && s->obstacles > 0; k++) {
    double x[DVI__SOLID_AXES] = {0};
    for (int i = 0; i < n; i++) x[i] = X[node[k] * n + i] + s->u[node[k] * n + i];
    for (int i = 0; i < s->obstacles; i++)
      if (gap_of(s->obstacle + i, n, x) < -1e-12 * (1 + fabs(x[0]) + fabs(x[1]) + fabs(x[2])))
        return dvi__scene_refuse(
            scene,
            dvi__tree_find(dvi__tree_find(scene->tree, "obstacles"), s->obstacle[i].name)->span,
            "at the start node %d, (%g, %g, %g), is %g inside of the obstacle "
            "'%s'; move one of them",
            node[k], x[0], x[1], x[2], -gap_of(s->obstacle + i, n, x), s->obstacle[i].name);
  }
  return true;
}
