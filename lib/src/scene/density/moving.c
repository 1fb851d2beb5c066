/* The section moving: a density on one axis whose mesh moves (dvi/moving.h).
 *
 * In place of the field on a space there is one whose nodes are coordinates, too, or have a path.
 * The scene's coordinates are the positions x_1, x_2 and so on that are unknown, under the name of
 * the axis, and the values of the fields, node by node. */
#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/density/moving.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

/* Gauss points a cell of a density that is no polynomial. */
enum { POINTS_OF_OTHERS = 8 };

const dvi_moving *dvi_scene_moving(const dvi_scene *scene)
{
  return scene == NULL || scene->density == NULL || scene->density->moving == NULL
             ? NULL
             : scene->density->moving->made;
}

/* ---- callbacks, whose user is the scene_moving ---- */

static int monitor(int64_t count, const double *x, double *m, void *user)
{
  return dvi__local_value(((dvi__scene_moving *)user)->monitor, count, 0, x, m);
}

static int path(int count, double t, const double *X, double *x, double *rate, void *user)
{
  const dvi__local *motion = ((dvi__scene_moving *)user)->motion;
  const int failed = dvi__local_value(motion, count, t, X, x);
  return failed != 0 ? failed : dvi__local_rates(motion, count, t, X, rate, NULL);
}

static int wave(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                double *velocity, void *user)
{
  const dvi__scene_moving *m = user;
  const struct dvi__scene_density *s = m->density;
  int failed = m->velocity != NULL ? dvi__local_value(m->velocity, count, 0, x, velocity) : 0;
  for (int c = 0; c < s->jets.components && failed == 0 && s->start != NULL; c++) {
    failed = dvi__local_value(s->start[c], count, 0, x, u + c * count);
    if (failed == 0) failed = dvi__local_value(m->slope[c], count, 0, x, u_x + c * count);
    if (failed == 0) failed = dvi__density_start_rate(s, c, count, x, u_t + c * count);
  }
  return failed;
}

/* ---- reading ---- */

static bool refuse(dvi_scene *scene, const dvi__tree *tree, const char *sentence)
{
  return dvi__scene_refuse(scene, tree->span, "%s", sentence);
}

static bool check_domain(dvi_scene *scene, const dvi__tree *section)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi__tree *space = dvi__tree_find(scene->tree, "space");
  if (s->mesh != NULL || s->jets.dimension != 1)
    return refuse(scene, section, "meshes move on a domain of one axis");
  if (space == NULL || s->axis[0].kind == NULL || !dvi__axis_is_linear(s->axis[0].kind) ||
      strstr(s->axis[0].kind, "lumped=yes") != NULL)
    return refuse(scene, space != NULL ? space : section,
                  "cells that move are linear: 'space' is 'fem:degree=1,cells=100' there");
  return (s->jets.components <= DVI_MOVING_COMPONENTS_MAX && !s->jets.is_rotation) ||
         refuse(scene, section, "on a mesh that moves there are 4 components of fields at most");
}

/* Read numbers of at least 0 by their names. */
static bool read_numbers(dvi_scene *scene, const dvi__tree *section, dvi_moving_terms *terms)
{
  const struct {
    const char *name;
    double *number;
  } list[] = {{"mu", &terms->mu},
              {"kappa", &terms->kappa},
              {"stretch", &terms->stretch},
              {"viscosity", &terms->viscosity},
              {"dispersion", &terms->dispersion},
              {"path_step", &terms->path_step}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    const dvi__tree *tree = dvi__tree_find(section, list[i].name);
    if (tree == NULL) continue;
    if (!dvi__tree_number(scene, tree, list[i].name, list[i].number)) return false;
    if (!(*list[i].number >= 0))
      return dvi__scene_refuse(scene, tree->span, "%s is 0 or more, and not %.17g", list[i].name,
                               *list[i].number);
  }
  return true;
}

/* Read a jump, a number or one for each component. */
static bool read_jump(dvi_scene *scene, const dvi__tree *tree, dvi__scene_moving *m)
{
  const int components = scene->density->jets.components;
  const bool is_list = tree->kind == DVI__SEQUENCE;
  if ((is_list ? tree->count : 1) != components || tree->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span, "%s has %d number%s here", "a jump", components,
                             components == 1 ? "" : "s");
  for (int c = 0; c < components; c++)
    if (!dvi__tree_number(scene, is_list ? tree->child[c] : tree, "a jump", m->jump + c))
      return false;
  if (!scene->density->axis[0].periodic)
    return refuse(scene, tree, "a jump is what a field on a periodic axis grows by along it");
  m->terms.jump = m->jump;
  return true;
}

/* Read free, equal, or a path. */
static bool read_motion(dvi_scene *scene, const dvi__tree *tree, dvi__scene_moving *m)
{
  const char *word = tree->kind == DVI__SCALAR ? tree->text : "";
  m->terms.motion = strcmp(word, "equal") == 0  ? DVI_MOVING_EQUAL
                    : strcmp(word, "free") == 0 ? DVI_MOVING_FREE
                                                : DVI_MOVING_PRESCRIBED;
  if (m->terms.motion != DVI_MOVING_PRESCRIBED) return true;
  m->terms.path = path;
  return dvi__local_read(scene, tree, DVI__MENTIONS_T, "the path of nodes", 1, &m->motion);
}

/* Read the derivatives in space of the start. */
static bool read_slopes(dvi_scene *scene, dvi__scene_moving *m)
{
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  for (int i = 0; initial != NULL && i < initial->count; i++) {
    const dvi__declared_field *field = dvi__field_named(scene, initial->key[i]->text);
    if (field != NULL && !dvi__local_read_slope(scene, initial->child[i], 0, "the slope of a start",
                                                field->components, m->slope + field->first))
      return false;
  }
  return true;
}

static bool read_mapping(dvi_scene *scene, const dvi__tree *section, dvi__scene_moving *m)
{
  static const char *const known[] = {"mu",         "kappa",    "monitor",  "motion",
                                      "stretch",    "velocity", "points",   "viscosity",
                                      "dispersion", "jump",     "path_step"};
  const dvi__tree *motion = dvi__tree_find(section, "motion"),
                  *graded = dvi__tree_find(section, "monitor"),
                  *velocity = dvi__tree_find(section, "velocity"),
                  *points = dvi__tree_find(section, "points"),
                  *jump = dvi__tree_find(section, "jump");
  if (!dvi__want_keys(scene, section, "a mesh that moves", 11, known) ||
      !read_numbers(scene, section, &m->terms) ||
      (motion != NULL && !read_motion(scene, motion, m)) ||
      (jump != NULL && !read_jump(scene, jump, m)) ||
      (points != NULL && !dvi__tree_whole(scene, points, "points", 1, &m->terms.points)))
    return false;
  if (graded != NULL) m->terms.monitor = monitor;
  return (graded == NULL ||
          dvi__local_read(scene, graded, 0, "the monitor of nodes", 1, &m->monitor)) &&
         (velocity == NULL ||
          dvi__local_read(scene, velocity, 0, "the velocity of nodes", 1, &m->velocity));
}

bool dvi__read_moving(dvi_scene *scene, const dvi__tree *section)
{
  if (!check_domain(scene, section)) return false;
  dvi__scene_moving *m = dvi__arena_take(&scene->arena, 1, sizeof *m);
  if (m == NULL) return dvi__scene_no_memory(scene);
  m->density = scene->density;
  m->section = section;
  if (section->kind == DVI__SCALAR && strcmp(section->text, "no") == 0) return true;
  scene->density->moving = m;
  if (section->kind != DVI__MAPPING && strcmp(section->text, "yes") != 0)
    return refuse(scene, section,
                  "'moving' is yes, no, or tells how, as in '{mu: 0.01, kappa: 0.1}'");
  return (section->kind != DVI__MAPPING || read_mapping(scene, section, m)) &&
         read_slopes(scene, m);
}

bool dvi__moving_take_density(dvi__context *c, dvi__node root)
{
  dvi__kernels list = {0};
  dvi__scene_moving *m = c->scene->density->moving;
  if (!dvi__kernels_add_node(c, root, &list) || !dvi__local_make(c->scene, &list, &m->whole))
    return false;
  if (!m->whole->has_place || m->terms.motion == DVI_MOVING_PRESCRIBED) return true;
  m->terms.space_derivative = dvi__moving_place_derivative;
  return dvi__kernels_add_node(c, root, &list) &&
         dvi__local_make_placed(c->scene, &list, &m->placed);
}

/* ---- the field ---- */

/* Take a condition as that of an end. */
static bool take_condition(dvi_scene *scene, const dvi_density_condition *c, int end)
{
  dvi__scene_moving *m = scene->density->moving;
  dvi_moving_end *of = end == 0 ? &m->terms.left : &m->terms.right;
  const dvi__local *datum = c->datum != NULL ? c->user : NULL;
  const double x = end == 0 ? scene->density->axis[0].from : scene->density->axis[0].to;
  if (c->kind != DVI_FIXED && (datum != NULL || c->robin > 0 || c->robin < 0))
    return refuse(scene, dvi__tree_find(scene->tree, "boundary"),
                  "at ends of a mesh that moves there is no flux and no robin");
  if (datum != NULL && datum->has_time)
    return refuse(scene, dvi__tree_find(scene->tree, "boundary"),
                  "fixed values at ends of a mesh that moves do not depend on time");
  if (c->kind == DVI_FIXED) m->fixed[end]++;
  of->kind = c->kind;
  of->value = m->end[end];
  return datum == NULL || dvi__local_value(datum, 1, 0, &x, m->end[end] + c->component) == 0 ||
         dvi__density_complain(scene, dvi__tree_find(scene->tree, "boundary"), DVI_CALLBACK_FAILED);
}

static bool take_ends(dvi_scene *scene)
{
  static const char *const side[] = {"left", "right"};
  const struct dvi__scene_density *s = scene->density;
  for (int i = 0; i < s->conditions; i++)
    for (int end = 0; end < 2; end++) {
      const char *part = s->condition[i].part;
      if ((strcmp(part, side[end]) == 0 || strcmp(part, "boundary") == 0) &&
          !take_condition(scene, s->condition + i, end))
        return false;
    }
  for (int end = 0; end < 2; end++)
    if (s->moving->fixed[end] % s->jets.components != 0)
      return refuse(scene, dvi__tree_find(scene->tree, "boundary"),
                    "at an end of a mesh that moves all components are fixed, or none");
  return true;
}

/* Two points are exact for the squares of a kinetic part, and p/2 + 1 for a polynomial of degree p
 * in fields that are linear in a cell. */
static int choose_points(const struct dvi__scene_density *s)
{
  if (s->degree < 0 || !s->is_uniform) return POINTS_OF_OTHERS;
  const int points = s->degree / 2 + 1;
  return points < 2 ? 2 : points > DVI_MOVING_POINTS_MAX ? DVI_MOVING_POINTS_MAX : points;
}

static dvi_status create(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  dvi__scene_moving *m = s->moving;
  dvi_moving_terms *terms = &m->terms;
  dvi__local *whole = m->whole;
  const dvi_density_part part = {.kind = DVI_DENSITY_GENERAL,
                                 .variable = whole->variable,
                                 .variables = whole->variables,
                                 .pair = (const int(*)[2])whole->pair,
                                 .pairs = whole->pairs,
                                 .density = dvi__local_density,
                                 .user = whole,
                                 .depends_on_time = whole->has_time};
  terms->size = sizeof *terms;
  terms->axis = s->axis[0];
  terms->axis.kind = NULL;
  terms->cells = s->axis[0].node == NULL ? (int)dvi__axis_option(s->axis[0].kind, "cells=", 0) : 0;
  terms->components = s->jets.components;
  terms->part = &part;
  terms->translations = s->is_uniform;
  if (terms->points == 0) terms->points = choose_points(s);
  terms->user = m;
  const dvi_status status = dvi_moving_create(terms, &m->made);
  terms->part = NULL;
  if (status != DVI_OK || s->is_static) return status;
  const double damping = scene->terms.damping;
  const dvi_status made = dvi_moving_system_terms(m->made, &scene->terms);
  scene->terms.damping = damping;
  return made;
}

/* ---- the unknowns ---- */

/* Name the positions that are unknown by the axis, and the values by their fields. */
static bool name_unknowns(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi__scene_moving *m = s->moving;
  int cells;
  (void)dvi_moving_nodes(m->made, &cells);
  const bool periodic = s->axis[0].periodic, is_free = m->terms.motion != DVI_MOVING_PRESCRIBED;
  const int components = s->jets.components, stride = components + is_free,
            positions = !is_free   ? 0
                        : periodic ? cells
                                   : cells - 1,
            values = periodic ? cells : cells + 1 - (m->fixed[0] > 0) - (m->fixed[1] > 0),
            before = is_free && (periodic || m->fixed[0] > 0); /* a position stands in front */
  dvi__coordinate *x = dvi__arena_take(&scene->arena, (size_t)s->fields + 1, sizeof *x);
  if (x == NULL) return dvi__scene_no_memory(scene);
  scene->coordinate = x;
  scene->coordinate_count = 0;
  if (is_free) {
    const dvi__slots slots = {before ? 0 : components, stride, 1};
    x[scene->coordinate_count++] = (dvi__coordinate){.name = s->jets.axis[0],
                                                     .span = s->axis_span[0],
                                                     .kind = DVI__LINES,
                                                     .family = 1,
                                                     .size = positions,
                                                     .columns = 1,
                                                     .shape = {0, 1, 1},
                                                     .q = slots,
                                                     .v = slots};
  }
  for (int i = 0; i < s->fields; i++) {
    const dvi__declared_field *field = s->field + i;
    const dvi__slots slots = {field->first + before, stride, field->components};
    x[scene->coordinate_count++] = (dvi__coordinate){
        .name = field->name,
        .span = field->span,
        .kind = DVI__LINES,
        .family = 1,
        .size = values,
        .columns = 1,
        .shape = {field->is_vector, field->components, 1},
        .q = slots,
        .v = slots};
  }
  scene->n = scene->nv = scene->velocities = positions + components * values;
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

static bool make_start(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const size_t n = (size_t)scene->n;
  scene->q = dvi__arena_take(&scene->arena, 3 * n, sizeof *scene->q);
  scene->zeros = dvi__arena_take(&scene->arena, 2 * n, sizeof *scene->zeros);
  if (scene->q == NULL || scene->zeros == NULL) return dvi__scene_no_memory(scene);
  scene->v = scene->q + n;
  scene->p = scene->v + n;
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  const dvi_status status = dvi_moving_start(s->moving->made, wave, s->moving, scene->q,
                                             s->is_static ? NULL : scene->v,
                                             s->is_static ? NULL : scene->p);
  return status == DVI_OK ||
         dvi__density_complain(
             scene, status != DVI_SINGULAR && initial != NULL ? initial : s->moving->section,
             status);
}

bool dvi__moving_make(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  dvi__scene_moving *m = s->moving;
  if (m->whole->term == NULL) return refuse(scene, s->section, "a density of zero moves nothing");
  dvi__fault_clear();
  if (!take_ends(scene)) return false;
  const dvi_status status = create(scene);
  if (status != DVI_OK)
    return dvi__density_complain(scene, status == DVI_SINGULAR ? s->section : m->section, status);
  scene->form = s->is_static ? "static" : "general Lagrangian";
  if (!name_unknowns(scene)) return false;
  rename_coordinates(scene);
  scene->terms.dimension = scene->n;
  return make_start(scene);
}

void dvi__moving_clear(dvi_scene *scene)
{
  if (scene->density->moving != NULL) dvi_moving_destroy(&scene->density->moving->made);
}

void dvi__moving_explain(const dvi_scene *scene, char *text, size_t size)
{
  static const char *const words[] = {"are unknowns", "follow a path",
                                      "are unknowns, with arcs of one length"};
  const dvi__scene_moving *m = scene->density->moving;
  int cells;
  (void)dvi_moving_nodes(m->made, &cells);
  (void)dvi__print(text, size,
                   "a mesh of %d cells whose nodes %s: mu = %.17g, kappa = %.17g, %d Gauss points "
                   "a cell\n%d coordinates\n",
                   cells, words[m->terms.motion], m->terms.mu, m->terms.kappa, m->terms.points,
                   scene->n);
}
