/* The solid of a scene, its start, and its marches. */
#include <dvi/march.h>
#include <math.h>
#include <string.h>

#include "scene/elastic/scene_elastic.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

static const char *const march_name[] = {"avi", "verlet"};
enum { MARCHES = sizeof march_name / sizeof *march_name };

/* ---- the beginning ---- */

bool dvi__elastic_begin(dvi_scene *scene)
{
  const dvi__tree *field = dvi__tree_find(scene->tree, "field");
  if (field == NULL || field->kind != DVI__SCALAR || strcmp(field->text, "elastic") != 0)
    return true;
  scene->field->elastic = dvi__arena_take(&scene->arena, 1, sizeof *scene->field->elastic);
  return scene->field->elastic != NULL || dvi__scene_no_memory(scene);
}

bool dvi__is_elastic(const dvi_scene *scene)
{
  return scene->field != NULL && scene->field->elastic != NULL;
}

bool dvi__elastic_check_mesh(dvi_scene *scene, const dvi__tree *section)
{
  const struct dvi__scene_field *f = scene->field;
  return (dvi_mesh_kind(f->mesh) == DVI_SIMPLICES && f->dimension == f->space && f->space >= 2 &&
          f->space <= DVI__SOLID_AXES) ||
         dvi__scene_refuse(scene, section->span,
                           "a solid has triangles in a plane or tetrahedra in space, as those of "
                           "'generator: kuhn'; this mesh has cells of dimension %d in %d "
                           "coordinates%s",
                           f->dimension, f->space,
                           dvi_mesh_kind(f->mesh) == DVI_SIMPLICES ? "" : ", which are boxes");
}

bool dvi__elastic_refuse_section(dvi_scene *scene, const dvi__tree *section, const char *name)
{
  return !dvi__is_elastic(scene) ||
         dvi__scene_refuse(
             scene, section->span, "'%s' is not of 'field: elastic'%s", name,
             strcmp(name, "damping") == 0
                 ? "; a material has alpha and beta, the damping by mass and stiffness"
                 : "");
}

/* Complain with the library's last sentence. Of a callback that failed the scene knows why. */
static bool refuse(dvi_scene *scene, dvi__span span, dvi_status status)
{
  if (status == DVI_NO_MEMORY || dvi__fault_status() == DVI_NO_MEMORY)
    return dvi__scene_no_memory(scene);
  return dvi__complain(scene->complaint, status == DVI_SINGULAR ? DVI_BAD_FILE : status, span, "%s",
                       dvi_last_error());
}

/* ---- the start ---- */

bool dvi__elastic_read_start(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"u", "u'"};
  struct dvi__scene_elastic *s = scene->field->elastic;
  dvi__solid_function **const function[] = {&s->value, &s->rate};
  if (!dvi__want_mapping(scene, section, "initial") ||
      !dvi__want_keys(scene, section, "the start of a solid", 2, known))
    return false;
  for (int k = 0; k < 2; k++) {
    const dvi__tree *value = dvi__tree_find(section, known[k]);
    if (value != NULL &&
        !dvi__solid_function_read(scene, value, 0, scene->field->space, "a start", function[k]))
      return false;
  }
  return true;
}

/* Evaluate the start at all nodes. */
static bool evaluate(dvi_scene *scene, const dvi__solid_function *function, double *values)
{
  const dvi_mesh *mesh = scene->field->mesh;
  const double *X = dvi_mesh_points(mesh);
  const int n = scene->field->space;
  for (int64_t v = 0; v < dvi_mesh_count(mesh, 0) && function != NULL; v++) {
    bool good = dvi__solid_function_value(function, 0, X + v * n, NULL, values + v * n) == 0;
    for (int i = 0; i < n; i++) good = good && isfinite(values[v * n + i]);
    if (!good && dvi__fault_status() == DVI_NO_MEMORY) return dvi__scene_no_memory(scene);
    if (!good)
      return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "initial")->span,
                               "the start is not finite at node %lld, (%g, %g, %g)", (long long)v,
                               X[v * n], X[v * n + 1], n > 2 ? X[v * n + 2] : 0.0);
  }
  return true;
}

/* Refuse displacements of the start, u [vertices*n], that differ from those that are given. */
static bool agrees_with_given(dvi_scene *scene, const double *given)
{
  const struct dvi__scene_elastic *s = scene->field->elastic;
  const double *X = dvi_mesh_points(scene->field->mesh);
  const int n = scene->field->space;
  const int64_t numbers = s->value != NULL ? dvi_mesh_count(scene->field->mesh, 0) * n : 0;
  double size = 0;
  for (int64_t k = 0; k < numbers; k++) size = fmax(size, fmax(fabs(X[k]), fabs(given[k])));
  for (int64_t k = 0; k < numbers; k++)
    if (!(fabs(s->u[k] - given[k]) <= 1e-9 * size))
      return dvi__scene_refuse(
          scene, dvi__tree_find(dvi__tree_find(scene->tree, "initial"), "u")->span,
          "the start moves node %lld by %g along %c, where the boundary gives %g; let both be the "
          "same there at t = 0",
          (long long)(k / n), s->u[k], "xyz"[k % n], given[k]);
  return true;
}

/* Velocities that are given count more than those of the start, as in a bar that hits a wall. */
static bool make_start(dvi_scene *scene)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  const size_t n = (size_t)scene->n, numbers = (size_t)dvi_mesh_count(scene->field->mesh, 0) *
                                               (size_t)scene->field->space;
  double *given = dvi__arena_take(&scene->arena, numbers, sizeof *given);
  s->u = dvi__arena_take(&scene->arena, 2 * numbers, sizeof *s->u);
  scene->q = dvi__arena_take(&scene->arena, 3 * n, sizeof *scene->q);
  if (given == NULL || s->u == NULL || scene->q == NULL) return dvi__scene_no_memory(scene);
  s->velocity = s->u + numbers;
  scene->v = scene->q + n;
  scene->p = scene->v + n;
  if (!evaluate(scene, s->value, s->u) || !evaluate(scene, s->rate, s->velocity)) return false;
  dvi_elastic_project(s->solid, s->u, s->velocity, scene->q, scene->v, scene->p);
  const dvi_status status = dvi_elastic_lift(s->solid, 0, scene->q, scene->p, given, s->velocity);
  if (status != DVI_OK) return refuse(scene, dvi__tree_find(scene->tree, "boundary")->span, status);
  if (!agrees_with_given(scene, given)) return false;
  s->u = given;
  return true;
}

/* Let all processes fail if the start fails on one of them. */
static bool make_all_starts(dvi_scene *scene, const dvi__tree *section)
{
  const dvi_elastic *solid = scene->field->elastic->solid;
  const bool is_made = make_start(scene);
  const dvi_status status = dvi_elastic_agree(solid, is_made ? DVI_OK : DVI_BAD_FILE);
  return is_made && (status == DVI_OK || refuse(scene, section->span, status));
}

/* A cell may be inverted where its law is not defined. */
static bool check_start(dvi_scene *scene, const dvi__tree *section)
{
  const struct dvi__scene_elastic *s = scene->field->elastic;
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  dvi_elastic_energies energies;
  const dvi_status status = dvi_elastic_energy(s->solid, 0, s->u, s->velocity, NULL, &energies);
  if (status != DVI_OK) return refuse(scene, (initial != NULL ? initial : section)->span, status);
  return dvi__solid_check_obstacles(scene);
}

/* ---- the solid ---- */

/* Complain with the library's last sentence about the section that it is of. */
static bool complain(dvi_scene *scene, const dvi__tree *otherwise, dvi_status status)
{
  static const struct {
    const char *word, *section;
  } blame[] = {{"load", "loads"},
               {"obstacle", "obstacles"},
               {"material", "materials"},
               {"energy", "materials"},
               {"stress", "materials"},
               {"condition", "boundary"},
               {"displacement", "boundary"},
               {"held", "boundary"},
               {"mesh", "mesh"}};
  const dvi__tree *found = NULL;
  for (size_t i = 0; i < sizeof blame / sizeof *blame && found == NULL; i++)
    if (strstr(dvi_last_error(), blame[i].word) != NULL)
      found = dvi__tree_find(scene->tree, blame[i].section);
  return refuse(scene, (found != NULL ? found : otherwise)->span, status);
}

/* Methods that step over fast motions take the energy in two parts. */
static int wants_split(const dvi_scene *scene)
{
  static const char *const name[] = {"imex", "trig", "respa", "mollified", "multiscale"};
  const char *method = scene->plan.method;
  for (size_t i = 0; i < sizeof name / sizeof *name && method != NULL; i++)
    if (strstr(method, name[i]) != NULL) return 1;
  return 0;
}

static dvi_status make_solid(dvi_scene *scene)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  const dvi_elastic_terms terms = {.size = sizeof terms,
                                   .mesh = scene->field->mesh,
                                   .material = s->material,
                                   .materials = s->materials,
                                   .condition = s->condition,
                                   .conditions = s->conditions,
                                   .load = s->load,
                                   .loads = s->loads,
                                   .obstacle = s->obstacle,
                                   .obstacles = s->obstacles,
                                   .split = wants_split(scene)};
  const dvi_status status = dvi_elastic_create(&terms, &s->solid);
  return status == DVI_OK ? dvi_elastic_system_terms(s->solid, &scene->terms) : status;
}

bool dvi__elastic_make(dvi_scene *scene, const dvi__tree *section)
{
  if (dvi__tree_find(scene->tree, "materials") == NULL)
    return dvi__scene_refuse(scene, section->span,
                             "a solid has materials, as in 'materials: {all: {law: neo-hookean, "
                             "lambda: 1, mu: 1, rho: 1}}'");
  dvi__fault_clear();
  const dvi_status status = make_solid(scene);
  if (status != DVI_OK) return complain(scene, section, status);
  scene->form = "separable";
  scene->mass = "diagonal";
  return dvi__solid_check_gravity(scene) && dvi__declare_unknowns(scene, section, "u") &&
         make_all_starts(scene, section) && check_start(scene, section) &&
         dvi__solid_place_probes(scene) && dvi__choose_field_columns(scene);
}

dvi_status dvi__elastic_fastest(const dvi_scene *scene, double *omega)
{
  return dvi_elastic_fastest(scene->field->elastic->solid, omega);
}

void dvi__elastic_clear(dvi_scene *scene)
{
  if (dvi__is_elastic(scene)) dvi_elastic_destroy(&scene->field->elastic->solid);
}

const dvi_elastic *dvi_scene_elastic(const dvi_scene *scene)
{
  return scene != NULL && dvi__is_elastic(scene) ? scene->field->elastic->solid : NULL;
}

const char *dvi__elastic_observable(const dvi_scene *scene, int i)
{
  static const char *const plane[] = {"energy",     "kinetic", "stored", "load", "momentum_x",
                                      "momentum_y", "angular", "growth", "hits", NULL},
                           *const space[] = {"energy",     "kinetic",    "stored",     "load",
                                             "momentum_x", "momentum_y", "momentum_z", "angular_x",
                                             "angular_y",  "angular_z",  "growth",     "hits",
                                             NULL};
  return (scene->field->space == 2 ? plane : space)[i];
}

/* ---- marches ---- */

bool dvi__elastic_marches(const char *method)
{
  const size_t length = strcspn(method, ":");
  for (int i = 0; i < MARCHES; i++)
    if (strlen(march_name[i]) == length && strncmp(march_name[i], method, length) == 0) return true;
  return false;
}

dvi_status dvi__elastic_march(const dvi_scene *scene, const dvi_march_options *options,
                              dvi_march **march)
{
  const struct dvi__scene_elastic *s = scene->field->elastic;
  const size_t numbers = (size_t)dvi_mesh_count(scene->field->mesh, 0) *
                         (size_t)scene->field->space;
  double *E = dvi__heap_take(numbers, sizeof *E);
  for (size_t i = 0; i < numbers && E != NULL; i++) E[i] = -s->velocity[i];
  const dvi_march_state state = {.size = sizeof state, .A = s->u, .E = E};
  dvi_status status = dvi_elastic_agree(s->solid, E != NULL ? DVI_OK : DVI_NO_MEMORY);
  if (status == DVI_OK) status = dvi_elastic_march_create(s->solid, options, march);
  if (status == DVI_OK) status = dvi_march_start(*march, &state);
  if (status != DVI_OK) dvi_march_destroy(march);
  dvi__heap_free(E);
  return status;
}

dvi_status dvi__elastic_march_state(const dvi_scene *scene, const dvi_march *march, double *q,
                                    double *p)
{
  const dvi_elastic *solid = scene->field->elastic->solid;
  const int64_t numbers = dvi_march_size(march, DVI_FORM_A);
  double *u = dvi__heap_take(2 * (size_t)numbers, sizeof *u);
  dvi_status status = dvi_elastic_agree(solid, u != NULL ? DVI_OK : DVI_NO_MEMORY);
  if (status != DVI_OK || u == NULL) {
    dvi__heap_free(u);
    return status;
  }
  double *const rate = u + numbers;
  status = dvi_march_sample(march, DVI_FORM_A, 0, NULL, u);
  if (status == DVI_OK && p != NULL) status = dvi_march_sample(march, DVI_FORM_E, 0, NULL, rate);
  for (int64_t i = 0; i < numbers; i++) rate[i] = -rate[i];
  if (status == DVI_OK) dvi_elastic_project(solid, u, rate, q, NULL, p);
  dvi__heap_free(u);
  return status;
}

dvi_status dvi__elastic_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                             dvi_law *law, int *count)
{
  return dvi_elastic_laws(scene->field->elastic->solid, options, steps, law, count);
}
