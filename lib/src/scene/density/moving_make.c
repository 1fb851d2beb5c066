/* The field of a scene on a mesh that moves: its ends, its cells, and its start. */
#include <dvi/scene.h>
#include <string.h>

#include "scene/density/moving.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"

/* Points a cell of a density that is no polynomial. */
enum { POINTS_OF_OTHERS = 8, TRIANGLE_OF_SQUARES = 3, TRIANGLE_OF_OTHERS = 6 };

static bool refuse(dvi_scene *scene, const dvi__tree *tree, const char *sentence)
{
  return dvi__scene_refuse(scene, tree->span, "%s", sentence);
}

/* ---- conditions at the ends of an axis ---- */

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

/* ---- the field ---- */

/* Two points are exact for the squares of a kinetic part, and p/2 + 1 for a polynomial of degree p
 * in fields that are linear in a cell. The rules of triangles have the degrees 2 and 4. */
static int choose_points(const struct dvi__scene_density *s)
{
  const bool is_known = s->degree >= 0 && s->placed_axes == 0;
  if (s->jets.dimension == 2)
    return is_known && s->degree <= 2 ? TRIANGLE_OF_SQUARES : TRIANGLE_OF_OTHERS;
  if (!is_known) return POINTS_OF_OTHERS;
  const int points = s->degree / 2 + 1;
  return points < 2 ? 2 : points > DVI_MOVING_POINTS_MAX ? DVI_MOVING_POINTS_MAX : points;
}

static void take_axis(const struct dvi__scene_density *s, dvi_moving_terms *terms)
{
  terms->axis = s->axis[0];
  terms->axis.kind = NULL;
  terms->cells = s->axis[0].node == NULL ? (int)dvi__axis_option(s->axis[0].kind, "cells=", 0) : 0;
}

/* Divide the boxes of two axes into triangles. */
static bool divide(dvi_scene *scene, dvi_mesh **mesh)
{
  const struct dvi__scene_density *s = scene->density;
  dvi_generator_options options = {.size = sizeof options, .dimension = 2};
  for (int d = 0; d < 2; d++) {
    const dvi_axis *axis = s->axis + d;
    if (axis->node != NULL)
      return dvi__scene_refuse(
          scene, s->axis_span[d],
          "triangles that move are made of equal cells of each axis; a section "
          "'mesh' gives others");
    options.cells[d] = (int)dvi__axis_option(axis->kind, "cells=", 0);
    options.origin[d] = axis->from;
    options.extent[d] = axis->to - axis->from;
    options.periodic[d] = axis->periodic;
    if (options.cells[d] < 1 || (axis->periodic && options.cells[d] < 3))
      return dvi__scene_refuse(
          scene, dvi__tree_find(scene->tree, "space")->span,
          "the axis %s has %d cells, and triangles that move need %d at least, "
          "as in 'fem:degree=1,cells=16'",
          s->jets.axis[d], options.cells[d], axis->periodic ? 3 : 1);
  }
  const dvi_status status = dvi_mesh_generate("kuhn", &options, mesh);
  return status == DVI_OK || dvi__density_complain(scene, s->place, status);
}

static void take_density(const dvi__local *whole, dvi_density_part *part)
{
  *part = (dvi_density_part){.kind = DVI_DENSITY_GENERAL,
                             .variable = whole->variable,
                             .variables = whole->variables,
                             .pair = (const int(*)[2])whole->pair,
                             .pairs = whole->pairs,
                             .density = dvi__local_density,
                             .user = (void *)whole,
                             .depends_on_time = whole->has_time};
}

static dvi_status create_on(dvi_scene *scene, const dvi_mesh *mesh)
{
  struct dvi__scene_density *s = scene->density;
  dvi__scene_moving *m = s->moving;
  dvi_moving_terms *terms = &m->terms;
  dvi_density_part part;
  take_density(m->whole, &part);
  terms->size = sizeof *terms;
  terms->mesh = mesh;
  terms->condition = mesh != NULL ? s->condition : NULL;
  terms->conditions = mesh != NULL ? s->conditions : 0;
  if (mesh == NULL) take_axis(s, terms);
  terms->components = s->jets.components;
  terms->part = &part;
  terms->translations = s->placed_axes == 0;
  if (terms->points == 0) terms->points = choose_points(s);
  terms->user = m;
  const dvi_status status = dvi_moving_create(terms, &m->made);
  terms->part = NULL;
  terms->mesh = NULL;
  if (status != DVI_OK || s->is_static) return status;
  const double damping = scene->terms.damping;
  const dvi_status made = dvi_moving_system_terms(m->made, &scene->terms);
  scene->terms.damping = damping;
  return made;
}

/* Complain of the field, about the boundary if the sentence is about a condition there. */
static bool complain(dvi_scene *scene, dvi_status status)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi__tree *boundary = dvi__tree_find(scene->tree, "boundary");
  const bool is_of_boundary = boundary != NULL && strstr(dvi_last_error(), "condition") != NULL;
  return dvi__density_complain(scene,
                               is_of_boundary           ? boundary
                               : status == DVI_SINGULAR ? s->section
                                                        : s->moving->section,
                               status);
}

static bool create(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  dvi_mesh *mesh = NULL;
  if (s->jets.dimension == 1 && !take_ends(scene)) return false;
  if (s->jets.dimension == 2 && s->mesh == NULL && !divide(scene, &mesh)) return false;
  const dvi_status status = create_on(scene, mesh != NULL ? mesh : s->mesh);
  const bool good = status == DVI_OK || complain(scene, status);
  dvi_mesh_destroy(&mesh);
  return good;
}

/* ---- the start ---- */

int dvi__moving_wave(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                     double *velocity, void *user)
{
  const dvi__scene_moving *m = user;
  const struct dvi__scene_density *s = m->density;
  const int axes = s->jets.dimension;
  int failed = 0;
  for (int i = 0; i < axes && failed == 0; i++)
    failed = dvi__local_value(m->velocity[i], count, 0, x, velocity + i * count);
  for (int c = 0; c < s->jets.components && failed == 0 && s->start != NULL; c++) {
    failed = dvi__local_value(s->start[c], count, 0, x, u + c * count);
    for (int i = 0; i < axes && failed == 0; i++)
      failed = dvi__local_value(m->slope[i][c], count, 0, x, u_x + (c * axes + i) * count);
    if (failed == 0) failed = dvi__density_start_rate(s, c, count, x, u_t + c * count);
  }
  return failed;
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
  const dvi_status status = dvi_moving_start(s->moving->made, dvi__moving_wave, s->moving, scene->q,
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
  if (!create(scene)) return false;
  scene->form = s->is_static ? "static" : "general Lagrangian";
  if (!dvi__moving_name_unknowns(scene)) return false;
  scene->terms.dimension = scene->n;
  return make_start(scene) && dvi__moving_check_ends(scene);
}

void dvi__moving_clear(dvi_scene *scene)
{
  if (scene->density->moving != NULL) dvi_moving_destroy(&scene->density->moving->made);
}

/* ---- what was made ---- */

/* Tell which symmetries there are. */
static void explain_momenta(const dvi_scene *scene, char *text, size_t size)
{
  const dvi_system_terms *terms = &scene->terms;
  size_t used = 0;
  for (int i = 0; i < terms->symmetry_count && used < size; i++) {
    (void)dvi__print(text + used, size - used, "%s%s", i > 0 ? ", " : "",
                     terms->symmetries[i].name);
    used = strlen(text);
  }
  if (terms->symmetry_count > 0)
    (void)dvi__print(text + used, size - used,
                     ": kept to roundoff by methods that keep linear momenta, such as midpoint\n");
}

/* Tell of nodes that are faster than waves at the start. */
static void explain_speed(const dvi_scene *scene, char *text, size_t size)
{
  double x[DVI_MOVING_AXES_MAX] = {0};
  const int count = scene->density->is_static ? 0 : dvi__moving_fast_nodes(scene, x);
  if (count == 0) return;
  (void)dvi__print(text, size,
                   "caution: as fast as waves or faster are %d of the nodes, such as that at %s = ",
                   count, scene->density->jets.axis[0]);
  size_t used = strlen(text);
  for (int i = 0; i < scene->density->jets.dimension; i++, used = strlen(text))
    (void)dvi__print(text + used, size - used, "%s%.6g", i > 0 ? ", " : "", x[i]);
  (void)dvi__print(text + used, size - used,
                   ": short errors grow there; let the nodes move more slowly\n");
}

void dvi__moving_explain(const dvi_scene *scene, char *text, size_t size)
{
  static const char *const words[] = {"are unknowns", "follow a path",
                                      "are unknowns, with arcs of one length"};
  const dvi__scene_moving *m = scene->density->moving;
  const bool plane = scene->density->jets.dimension == 2;
  int cells;
  (void)dvi_moving_nodes(m->made, &cells);
  (void)dvi__print(text, size,
                   "a mesh of %d %s whose nodes %s: mu = %.17g, kappa = %.17g, %d %s\n%d "
                   "coordinates\n",
                   cells, plane ? "triangles" : "cells", words[m->terms.motion], m->terms.mu,
                   m->terms.kappa, m->terms.points,
                   plane ? "points a triangle" : "Gauss points a cell", scene->n);
  size_t used = strlen(text);
  explain_momenta(scene, text + used, size - used);
  used = strlen(text);
  explain_speed(scene, text + used, size - used);
}
