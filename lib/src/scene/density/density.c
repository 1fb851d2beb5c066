/* The section density, which is read when all others about it are: the space, the field and its
 * terms are made, and the scene's coordinates become the unknowns. */
#include <dvi/schroedinger.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

/* ---- the parts ---- */

bool dvi__density_node(dvi__context *c, const dvi__tree *section, dvi__node *node)
{
  const dvi__expression *e;
  return dvi__tree_expression(c->scene, section, &e) && dvi__elaborate_number(c, e, node);
}

static bool read_parts(dvi_scene *scene, const dvi__tree *section,
                       bool (*read)(dvi__context *, const dvi__tree *, dvi__node *))
{
  dvi__context c;
  dvi__node node;
  if (!dvi__context_make(&c, scene, DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T,
                         "a density"))
    return false;
  const struct dvi__scene_density *s = scene->density;
  const bool good = read(&c, section, &node) &&
                    (s->jets.is_rotation ? dvi__rotations_take_density(&c, node)
                                         : dvi__density_sort(&c, node)) &&
                    (s->moving == NULL || dvi__moving_take_density(&c, node));
  dvi__context_free(&c);
  return good;
}

bool dvi__refuse_order(dvi_scene *scene, const dvi__local *local, int k, int axis)
{
  const struct dvi__scene_density *s = scene->density;
  return dvi__scene_refuse(scene, local->span[k],
                           "the functions of this space have square integrable derivatives to "
                           "order %d along %s, and this one is of order %d; splines have more, as "
                           "in 'spline:degree=3'",
                           dvi_space_smoothness(s->space, axis), s->jets.axis[axis],
                           local->variable[k].order[axis]);
}

/* Refuse derivatives that are not square integrable. */
static bool check_orders(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  for (int class = 0; class < DVI__DENSITY_CLASSES; class ++) {
    const dvi__local *part = s->part[class];
    for (int k = 0; part != NULL && k < part->variables; k++)
      for (int d = 0; d < s->jets.dimension; d++)
        if (part->variable[k].order[d] > dvi_space_smoothness(s->space, d))
          return dvi__refuse_order(scene, part, k, d);
  }
  return true;
}

/* A run needs rates. */
static bool check_motion(dvi_scene *scene)
{
  static const char *const of_run[] = {"step", "until", "method"};
  const struct dvi__scene_density *s = scene->density;
  for (int k = 0; k < 3 && s->is_static; k++)
    if (dvi__tree_find(scene->tree, of_run[k]) != NULL)
      return dvi__scene_refuse(scene, s->section->span,
                               "there is no rate in it, so nothing would move; without '%s' and "
                               "the like dvi solve finds a static state",
                               of_run[k]);
  const bool is_first_order = s->part[DVI_DENSITY_ONE_FORM] != NULL;
  for (int k = 0; k < s->jets.components && is_first_order && s->start != NULL; k++)
    if (s->start_rate[k] != NULL)
      return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "initial")->span,
                               "of first degree in the rates a density tells them, so that the "
                               "start has none");
  return true;
}

/* ---- the field ---- */

int dvi__density_parts(const struct dvi__scene_density *s, dvi_density_part *part)
{
  int parts = 0;
  for (int class = 0; class < DVI__DENSITY_CLASSES; class ++) {
    dvi__local *local = s->part[class];
    if (local == NULL) continue;
    part[parts++] = (dvi_density_part){.kind = (dvi_density_kind) class,
                                       .variable = local->variable,
                                       .variables = local->variables,
                                       .pair = (const int(*)[2])local->pair,
                                       .pairs = local->pairs,
                                       .density = dvi__local_density,
                                       .time_derivative = local->has_time ? dvi__local_time : NULL,
                                       .user = local,
                                       .depends_on_time = local->has_time};
  }
  return parts;
}

static dvi_status make_field(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  dvi_density_part part[DVI__DENSITY_CLASSES];
  const dvi_density_terms terms = {.size = sizeof terms,
                                   .space = s->space,
                                   .components = s->jets.components,
                                   .part = part,
                                   .parts = dvi__density_parts(s, part),
                                   .condition = s->condition,
                                   .conditions = s->conditions,
                                   .translations = !s->has_placed_data,
                                   .placed_axes = s->placed_axes};
  dvi_status status = dvi_density_create(&terms, &s->density);
  if (status != DVI_OK || s->is_static) return status;
  const double damping = scene->terms.damping;
  status = dvi_density_system_terms(s->density, &scene->terms);
  scene->terms.damping = damping;
  return status;
}

bool dvi__density_complain(dvi_scene *scene, const dvi__tree *section, dvi_status status)
{
  dvi__span span;
  const char *words;
  if (status == DVI_CALLBACK_FAILED && dvi__fault_status() != DVI_OK) status = dvi__fault_status();
  if (status == DVI_NO_MEMORY) return dvi__scene_no_memory(scene);
  if (dvi__fault_place(&span, &words))
    return dvi__complain(scene->complaint, DVI_NOT_FINITE, span, "at the start: %s", words);
  return dvi__complain(scene->complaint, status, section->span, "%s", dvi_last_error());
}

/* Complain of the field, about the boundary if the sentence is about a part of that. */
static bool complain(dvi_scene *scene, dvi_status status)
{
  const dvi__tree *boundary = dvi__tree_find(scene->tree, "boundary");
  const char *sentence = dvi_last_error();
  const bool is_of_boundary = boundary != NULL && (strstr(sentence, "boundary") != NULL ||
                                                   strstr(sentence, "condition") != NULL);
  return dvi__density_complain(scene, is_of_boundary ? boundary : scene->density->section, status);
}

/* ---- the unknowns ---- */

/* Tell if all components have the same unknown functions, so that those of a function are some
 * neighbours among the coordinates. */
static bool is_even(const struct dvi__scene_density *s, int64_t unknowns, const int *place)
{
  const int components = s->jets.components;
  for (int64_t i = 0; i < unknowns; i++)
    if (place[i] / s->functions != i % components ||
        place[i] % s->functions != place[i - i % components] % s->functions)
      return false;
  return unknowns % components == 0;
}

/* Make a family of each field, or one of all numbers. */
static bool name_unknowns(dvi_scene *scene, int64_t unknowns, const int *place)
{
  const struct dvi__scene_density *s = scene->density;
  const bool even = is_even(s, unknowns, place);
  dvi__coordinate *x = dvi__arena_take(&scene->arena, (size_t)s->fields, sizeof *x);
  if (x == NULL) return dvi__scene_no_memory(scene);
  scene->coordinate = x;
  scene->coordinate_count = even ? s->fields : 1;
  for (int i = 0; i < scene->coordinate_count; i++) {
    const dvi__declared_field *field = s->field + i;
    const int size = even ? field->components : 1, stride = even ? s->jets.components : 1;
    const dvi__slots slots = {
        .first = even ? field->first : 0, .stride = stride, .components = size};
    x[i] = (dvi__coordinate){.name = field->name,
                             .span = field->span,
                             .kind = DVI__LINES,
                             .family = 1,
                             .size = (int)(unknowns / stride),
                             .columns = 1,
                             .shape = {even && field->is_vector, size, 1},
                             .q = slots,
                             .v = slots};
  }
  return true;
}

/* The names of positions stand for no coordinate any more, but must not be those of columns. */
static void rename_coordinates(dvi_scene *scene)
{
  for (int k = 0; k < scene->names.count; k++) {
    dvi__name *name = scene->names.name + k;
    if (name->sort != DVI__COORDINATE) continue;
    const dvi__declared_field *field = dvi__field_named(scene, name->text);
    const int number = field != NULL ? (int)(field - scene->density->field) : 0;
    name->number = number < scene->coordinate_count ? number : 0;
  }
}

static bool declare_unknowns(dvi_scene *scene)
{
  int64_t unknowns;
  const int *place = dvi_density_unknowns(scene->density->density, &unknowns);
  scene->n = scene->nv = scene->velocities = (int)unknowns;
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)scene->n, sizeof *scene->zeros);
  if (scene->zeros == NULL) return dvi__scene_no_memory(scene);
  if (!name_unknowns(scene, unknowns, place)) return false;
  rename_coordinates(scene);
  return true;
}

static bool make_start(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const size_t n = (size_t)scene->n, coefficients = (size_t)(s->jets.components * s->functions);
  scene->q = dvi__arena_take(&scene->arena, 3 * n, sizeof *scene->q);
  double *U = dvi__heap_take(2 * coefficients, sizeof *U);
  bool good = (scene->q != NULL && U != NULL) || dvi__scene_no_memory(scene);
  if (good) {
    scene->v = scene->q + n;
    scene->p = scene->v + n;
    good = dvi__density_start(scene, U, U + coefficients);
  }
  if (good) {
    const dvi_status status = dvi_density_project(s->density, U, U + coefficients, scene->q,
                                                  scene->v, s->is_static ? NULL : scene->p);
    good = (status == DVI_OK || complain(scene, status)) && dvi__density_check_ends(scene, U);
  }
  dvi__heap_free(U);
  return good;
}

/* ---- the section ---- */

/* A step that is a fraction of the largest stable one of verlet divides the span. */
static bool choose_step(dvi_scene *scene)
{
  double omega = 0;
  dvi_scene_plan *plan = &scene->plan;
  if (!(plan->fraction > 0)) return true;
  const dvi_status status = scene->density->density == NULL
                                ? DVI_UNSUPPORTED
                                : dvi_density_fastest(scene->density->density, &omega);
  if (status != DVI_OK || !(omega > 0))
    return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "step")->span,
                             "the largest frequency of this density is not known, so that a step "
                             "is no fraction of a stable one: give a number");
  plan->h = plan->fraction * 2 / omega;
  if (plan->t_end > 0) plan->h = plan->t_end / ceil(plan->t_end / plan->h * (1 - 1e-12));
  return true;
}

static void set_form(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi_mass *mass = &scene->terms.mass;
  scene->form = s->is_static                            ? "static"
                : s->part[DVI_DENSITY_GENERAL] != NULL  ? "general Lagrangian"
                : s->part[DVI_DENSITY_ONE_FORM] != NULL ? "one-form"
                                                        : "separable";
  if (s->part[DVI_DENSITY_KINETIC] != NULL)
    scene->mass = mass->diagonal != NULL ? "diagonal" : mass->values != NULL ? "sparse" : "scalar";
}

/* Make a field that has no space. */
/* Meshes that move and fields of rotations have no paths between two times. */
static bool refuse_final(dvi_scene *scene)
{
  const dvi__tree *final = dvi__tree_find(scene->tree, "final");
  return final == NULL || dvi__scene_refuse(scene, final->span, "%s",
                                            scene->density->moving != NULL
                                                ? "'final' is not for meshes that move"
                                                : "'final' is not for fields of rotations");
}

static bool make_other(dvi_scene *scene)
{
  const bool good = refuse_final(scene) && check_motion(scene) &&
                    (scene->density->moving != NULL ? dvi__moving_make(scene)
                                                    : dvi__rotations_make(scene)) &&
                    dvi__density_make_probes(scene) && dvi__choose_field_columns(scene) &&
                    choose_step(scene);
  scene->jets = NULL;
  return good;
}

static bool make(dvi_scene *scene)
{
  if (scene->density->moving != NULL || scene->density->jets.is_rotation) return make_other(scene);
  dvi__fault_clear();
  if (!dvi__density_read_final(scene) || !check_motion(scene) || !dvi__density_make_space(scene) ||
      !check_orders(scene))
    return false;
  const dvi_status status = make_field(scene);
  if (status != DVI_OK) return complain(scene, status);
  set_form(scene);
  const bool good = declare_unknowns(scene) && make_start(scene) &&
                    dvi__density_make_final(scene) && dvi__density_make_probes(scene) &&
                    dvi__choose_field_columns(scene) && dvi__lattice_find_symmetries(scene) &&
                    choose_step(scene);
  scene->jets = NULL; /* from here on the coordinates are the unknowns */
  return good;
}

bool dvi__read_density(dvi_scene *scene, const dvi__tree *section)
{
  scene->density->section = section;
  return read_parts(scene, section, dvi__density_node) && make(scene);
}

bool dvi__read_schroedinger(dvi_scene *scene, const dvi__tree *section)
{
  scene->density->section = section;
  return read_parts(scene, section, dvi__schroedinger_node) && make(scene) &&
         dvi__equation_check_ground(scene);
}

void dvi__scene_density_clear(dvi_scene *scene)
{
  if (scene->density == NULL) return;
  dvi__moving_clear(scene);
  dvi__rotations_clear(scene);
  if (scene->density->equation != NULL) dvi_schroedinger_destroy(&scene->density->equation->made);
  dvi_density_destroy(&scene->density->density);
  dvi_space_destroy(&scene->density->space);
  dvi_mesh_destroy(&scene->density->mesh);
  dvi_mesh_destroy(&scene->density->shown);
}
