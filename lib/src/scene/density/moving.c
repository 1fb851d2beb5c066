/* The section moving: a density on one axis, or in a plane, whose mesh moves (dvi/moving.h).
 *
 * In place of the field on a space there is one whose nodes are coordinates, too, or have a path.
 * Here is what the section says. */
#include <dvi/scene.h>
#include <string.h>

#include "scene/density/moving.h"
#include "scene/sections/sections.h"

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
  const dvi__scene_moving *m = user;
  int failed = 0;
  for (int i = 0; i < m->density->jets.dimension && failed == 0; i++) {
    failed = dvi__local_value(m->motion[i], count, t, X, x + i * count);
    if (failed == 0) failed = dvi__local_rates(m->motion[i], count, t, X, rate + i * count, NULL);
  }
  return failed;
}

/* ---- reading ---- */

static bool refuse(dvi_scene *scene, const dvi__tree *tree, const char *sentence)
{
  return dvi__scene_refuse(scene, tree->span, "%s", sentence);
}

static bool is_right(const char *kind)
{
  return dvi__axis_is_linear(kind) && strstr(kind, "lumped=yes") == NULL;
}

static bool check_domain(dvi_scene *scene, const dvi__tree *section)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi__tree *space = dvi__tree_find(scene->tree, "space");
  if (s->jets.dimension > DVI_MOVING_AXES_MAX)
    return refuse(scene, section, "meshes move on a domain of one or two axes");
  bool is_linear = s->mesh != NULL ? s->kind == NULL || is_right(s->kind) : space != NULL;
  for (int d = 0; d < s->jets.dimension && s->mesh == NULL; d++)
    is_linear = is_linear && s->axis[d].kind != NULL && is_right(s->axis[d].kind);
  if (!is_linear)
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

/* Read a jump along an axis, a number or one for each component. */
static bool read_jump_along(dvi_scene *scene, const dvi__tree *tree, int axis, dvi__scene_moving *m)
{
  const struct dvi__scene_density *s = scene->density;
  const int components = s->jets.components;
  const bool is_list = tree->kind == DVI__SEQUENCE;
  if ((is_list ? tree->count : 1) != components || tree->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span, "%s has %d number%s here", "a jump", components,
                             components == 1 ? "" : "s");
  for (int c = 0; c < components; c++)
    if (!dvi__tree_number(scene, is_list ? tree->child[c] : tree, "a jump",
                          m->jump + axis * components + c))
      return false;
  if (s->mesh == NULL && !s->axis[axis].periodic)
    return refuse(scene, tree, "a jump is what a field on a periodic axis grows by along it");
  m->terms.jump = m->jump;
  return true;
}

/* Read the jump along the only axis, or a mapping by axes. */
static bool read_jump(dvi_scene *scene, const dvi__tree *tree, dvi__scene_moving *m)
{
  const dvi__jets *jets = &scene->density->jets;
  if (jets->dimension == 1) return read_jump_along(scene, tree, 0, m);
  if (tree->kind != DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span,
                             "in a plane a jump is one along an axis, as in "
                             "'{%s: 1}'",
                             jets->axis[0]);
  if (!dvi__want_keys(scene, tree, "a jump", jets->dimension, jets->axis)) return false;
  for (int i = 0; i < tree->count; i++)
    if (!read_jump_along(scene, tree->child[i], dvi__axis_named(scene, tree->key[i]->text), m))
      return false;
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
  return dvi__local_read(scene, tree, DVI__MENTIONS_T, "the path of nodes",
                         scene->density->jets.dimension, m->motion);
}

/* Read the derivatives in space of the start. */
static bool read_slopes(dvi_scene *scene, dvi__scene_moving *m)
{
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  for (int i = 0; initial != NULL && i < initial->count; i++) {
    const dvi__declared_field *field = dvi__field_named(scene, initial->key[i]->text);
    for (int d = 0; field != NULL && d < scene->density->jets.dimension; d++)
      if (!dvi__local_read_slope(scene, initial->child[i], d, "the slope of a start",
                                 field->components, m->slope[d] + field->first))
        return false;
  }
  return true;
}

static bool read_slide(dvi_scene *scene, const dvi__tree *tree, int *slide)
{
  const char *word = tree->kind == DVI__SCALAR ? tree->text : "";
  *slide = strcmp(word, "yes") == 0;
  return *slide || strcmp(word, "no") == 0 ||
         refuse(scene, tree, "slide is yes or no: if nodes of the boundary move along it");
}

static bool read_mapping(dvi_scene *scene, const dvi__tree *section, dvi__scene_moving *m)
{
  static const char *const known[] = {"mu",         "kappa",    "monitor",   "motion",
                                      "stretch",    "velocity", "points",    "viscosity",
                                      "dispersion", "jump",     "path_step", "slide"};
  const dvi__tree *motion = dvi__tree_find(section, "motion"),
                  *graded = dvi__tree_find(section, "monitor"),
                  *velocity = dvi__tree_find(section, "velocity"),
                  *points = dvi__tree_find(section, "points"),
                  *jump = dvi__tree_find(section, "jump"),
                  *slide = dvi__tree_find(section, "slide");
  const int axes = scene->density->jets.dimension;
  if (!dvi__want_keys(scene, section, "a mesh that moves", 12, known) ||
      !read_numbers(scene, section, &m->terms) ||
      (motion != NULL && !read_motion(scene, motion, m)) ||
      (jump != NULL && !read_jump(scene, jump, m)) ||
      (slide != NULL && !read_slide(scene, slide, &m->terms.slide)) ||
      (points != NULL && !dvi__tree_whole(scene, points, "points", 1, &m->terms.points)))
    return false;
  if (graded != NULL) m->terms.monitor = monitor;
  return (graded == NULL ||
          dvi__local_read(scene, graded, 0, "the monitor of nodes", 1, &m->monitor)) &&
         (velocity == NULL ||
          dvi__local_read(scene, velocity, 0, "the velocity of nodes", axes, m->velocity));
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
  if (m->whole->axes == 0 || m->terms.motion == DVI_MOVING_PRESCRIBED) return true;
  m->terms.space_derivative = dvi__moving_place_derivative;
  return dvi__kernels_add_node(c, root, &list) &&
         dvi__local_make_placed(c->scene, &list, &m->placed);
}
