/* The march of a density on a lattice of cells in space and time (dvi/multisymplectic.h).
 *
 * The cells are those of the space, whose functions must be the lattice's, fem of degree 1. Its
 * symmetries are found by trying: shifts of a component, and turns of a complex field. */
#include <dvi/multisymplectic.h>
#include <math.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

/* ---- the cells ---- */

static bool is_lumped(const char *kind)
{
  return strstr(kind, "lumped=yes") != NULL;
}

const char *dvi__lattice_refused(const dvi_scene *scene, const char **section)
{
  const struct dvi__scene_density *s = scene->density;
  if (s->mesh != NULL) {
    *section = "mesh";
    return "multisymplectic steps have cells in space and time, and a mesh has none: give a domain";
  }
  if (s->moving != NULL) {
    *section = "moving";
    return "multisymplectic steps have cells in space and time at rest, and no mesh that moves";
  }
  if (s->jets.is_rotation) {
    *section = "fields";
    return "multisymplectic steps are for fields of numbers; 'lie-verlet' takes those of rotations";
  }
  for (int d = 0; d < s->jets.dimension; d++)
    if (!dvi__axis_is_linear(s->axis[d].kind)) {
      *section = "space";
      return "multisymplectic steps are on the cells of linear functions: give each axis a space "
             "such as 'fem:degree=1,cells=100'";
    }
  return NULL;
}

bool dvi__lattice_is_semidiscrete(const dvi_scene *scene, const char *method)
{
  const struct dvi__scene_density *s = scene->density;
  dvi_multisymplectic_weights weights;
  if (s->start_moves) return false; /* the first step is one of the field itself */
  if (dvi_multisymplectic_parse(method, &weights) != DVI_OK) return false;
  for (int d = 0; d < s->jets.dimension; d++) {
    const double right = is_lumped(s->axis[d].kind) ? 0 : 1.0 / 6;
    if (fabs(weights.space[d] - right) > 1e-12 || strstr(s->axis[d].kind, "points=") != NULL)
      return false;
  }
  return true;
}

/* ---- symmetries ---- */

/* A shift of the component `first`, or a turn of it and `second`. */
typedef struct motion {
  int components, first, second; /* second is -1 for a shift */
} motion;

static int move(int64_t count, const double *u, double *xi, void *user)
{
  const motion *m = user;
  memset(xi, 0, (size_t)(m->components * count) * sizeof *xi);
  for (int64_t i = 0; i < count; i++) {
    double *to = xi + m->first * count + i;
    *to = m->second < 0 ? 1 : -u[m->second * count + i];
    if (m->second >= 0) xi[m->second * count + i] = u[m->first * count + i];
  }
  return 0;
}

/* Numbers from -1 to 1 that look random. */
static double draw(int *seed)
{
  const double x = sin(12.9898 * ++*seed) * 43758.5453;
  return 2 * (x - floor(x)) - 1;
}

static int find_variable(const dvi__local *part, const dvi_jet *like, int component)
{
  for (int k = 0; k < part->variables; k++) {
    const dvi_jet *jet = part->variable + k;
    if (jet->component == component && jet->rate == like->rate &&
        memcmp(jet->order, like->order, sizeof jet->order) == 0)
      return k;
  }
  return -1;
}

/* Give the change of variable k under the motion. */
static double change_of(const dvi__local *part, const motion *m, int k, const double *z)
{
  const dvi_jet *jet = part->variable + k;
  const bool is_first = jet->component == m->first, is_value = !jet->rate && jet->order[0] == 0 &&
                                                               jet->order[1] == 0 &&
                                                               jet->order[2] == 0;
  if (m->second < 0) return is_first && is_value ? 1 : 0;
  if (!is_first && jet->component != m->second) return 0;
  const int other = find_variable(part, jet, is_first ? m->second : m->first);
  return (is_first ? -1 : 1) * (other >= 0 ? z[other] : 0.7);
}

/* Tell if a part does not change at some points, but for roundings. */
static bool is_kept(const struct dvi__scene_density *s, const dvi__local *part, const motion *m)
{
  enum { POINTS = 5 };
  double x[DVI_AXES_MAX] = {0}, z[DVI_JETS_MAX], l_z[DVI_JETS_MAX];
  int seed = 0;
  for (int point = 0; point < POINTS; point++) {
    double sum = 0, size = 0;
    for (int d = 0; d < s->jets.dimension; d++)
      x[d] = s->axis[d].from + (s->axis[d].to - s->axis[d].from) * (0.5 + 0.5 * draw(&seed));
    for (int k = 0; k < part->variables; k++) z[k] = draw(&seed);
    if (dvi__local_density(1, draw(&seed), x, z, NULL, l_z, NULL, (void *)part) != 0) return false;
    for (int k = 0; k < part->variables; k++) {
      const double term = l_z[k] * change_of(part, m, k, z);
      sum += term;
      size += fabs(term);
    }
    if (!(fabs(sum) <= 1e-12 * size)) return false;
  }
  return true;
}

static bool is_free(const struct dvi__scene_density *s, int component)
{
  for (int i = 0; i < s->conditions; i++) {
    const dvi_density_condition *c = s->condition + i;
    if (c->component == component &&
        (c->kind == DVI_FIXED || c->robin > 0 || c->robin < 0 || c->datum != NULL))
      return false;
  }
  return true;
}

static bool is_symmetry(const struct dvi__scene_density *s, const motion *m)
{
  if (!is_free(s, m->first) || (m->second >= 0 && !is_free(s, m->second))) return false;
  for (int class = 0; class < DVI__DENSITY_CLASSES; class ++)
    if (s->part[class] != NULL && !is_kept(s, s->part[class], m)) return false;
  return true;
}

/* Add what a motion conserves, under a name with that of the field. */
static bool add_symmetry(dvi_scene *scene, const char *format, const char *name, motion m)
{
  struct dvi__scene_density *s = scene->density;
  const size_t size = strlen(format) + strlen(name);
  char *full = dvi__arena_take(&scene->arena, size, 1);
  motion *kept = dvi__arena_take(&scene->arena, 1, sizeof *kept);
  if (full == NULL || kept == NULL) return dvi__scene_no_memory(scene);
  (void)dvi__print(full, size, format, name);
  *kept = m;
  s->symmetry[s->symmetries++] = (dvi_multisymplectic_symmetry){
      .name = full, .field = move, .user = kept};
  return true;
}

bool dvi__lattice_find_symmetries(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  const char *unread;
  const int components = s->jets.components;
  if (dvi__lattice_refused(scene, &unread) != NULL || s->is_static) return true;
  s->symmetry = dvi__arena_take(&scene->arena, 2 * (size_t)components, sizeof *s->symmetry);
  if (s->symmetry == NULL) return dvi__scene_no_memory(scene);
  for (int c = 0; c < components; c++) {
    const motion shift = {components, c, -1};
    if (is_symmetry(s, &shift) && !add_symmetry(scene, "momentum_%s", s->component[c], shift))
      return false;
  }
  for (int i = 0; i < s->fields; i++) {
    const dvi__declared_field *field = s->field + i;
    const motion turn = {components, field->first, field->first + 1};
    if (field->is_complex && is_symmetry(s, &turn) &&
        !add_symmetry(scene, "charge_%s", field->name, turn))
      return false;
  }
  return true;
}

/* ---- the march ---- */

/* Complete what the density says to terms. `part` has room for all parts. */
static dvi_status make_terms(const dvi_scene *scene, const dvi_march_options *options,
                             dvi_density_part *part, dvi_multisymplectic_terms *terms)
{
  const struct dvi__scene_density *s = scene->density;
  *terms = (dvi_multisymplectic_terms){.size = sizeof *terms,
                                       .axis = s->axis,
                                       .axes = s->jets.dimension,
                                       .components = s->jets.components,
                                       .part = part,
                                       .parts = dvi__density_parts(s, part),
                                       .condition = s->condition,
                                       .conditions = s->conditions,
                                       .step = options->step,
                                       .fraction = options->fraction,
                                       .span = options->span,
                                       .mean_rate = s->start_moves,
                                       .symmetry = s->symmetry,
                                       .symmetries = s->symmetries};
  for (int d = 0; d < s->jets.dimension; d++)
    if (s->axis[d].node == NULL)
      terms->cells[d] = (int)dvi__axis_option(s->axis[d].kind, "cells=", 0);
  return dvi_multisymplectic_parse(options->method, &terms->weights);
}

/* Set the first level, and E = -u_t, or minus the mean rate to the level after it. */
static dvi_status find_levels(const struct dvi__scene_density *s, double step, int64_t values,
                              double *u, double *E)
{
  dvi_status status = dvi__density_interpolate(s, s->start, 0, u);
  if (status == DVI_OK)
    status = s->start_moves ? dvi__density_interpolate(s, s->start, step, E)
                            : dvi__density_interpolate_rate(s, E);
  for (int64_t i = 0; i < values; i++) E[i] = s->start_moves ? (u[i] - E[i]) / step : -E[i];
  return status;
}

/* Start from the values at the vertices. */
static dvi_status start(const dvi_scene *scene, dvi_march *march)
{
  const struct dvi__scene_density *s = scene->density;
  const int64_t values = s->jets.components * s->functions;
  double *u = dvi__heap_take(2 * (size_t)values, sizeof *u);
  if (u == NULL) return DVI_NO_MEMORY;
  double *const E = u + values;
  const dvi_march_state state = {.size = sizeof state, .A = u, .E = E};
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  dvi_status status = find_levels(s, facts.step, values, u, E);
  if (status == DVI_OK) status = dvi_march_start(march, &state);
  dvi__heap_free(u);
  return status;
}

dvi_status dvi__lattice_march(const dvi_scene *scene, const dvi_march_options *options,
                              dvi_march **march)
{
  dvi_density_part part[DVI__DENSITY_CLASSES];
  dvi_multisymplectic_terms terms;
  dvi_status status = make_terms(scene, options, part, &terms);
  if (status == DVI_OK) status = dvi_multisymplectic_create(&terms, march);
  if (status == DVI_OK) status = start(scene, *march);
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}

dvi_status dvi__lattice_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                             dvi_law *law, int *count)
{
  dvi_density_part part[DVI__DENSITY_CLASSES];
  dvi_multisymplectic_terms terms;
  const dvi_status status = make_terms(scene, options, part, &terms);
  return status == DVI_OK ? dvi_multisymplectic_laws(&terms, NULL, steps, 1, law, count) : status;
}
