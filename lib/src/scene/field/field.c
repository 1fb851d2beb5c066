/* The section field, which is read when all others about it are: the field and its system are made,
 * and the scene's coordinates become the unknowns. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/field/maxwell.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

bool dvi__complain_of_field(dvi_scene *scene, const dvi__tree *otherwise, dvi_status status)
{
  static const struct {
    const char *word, *section;
  } blame[] = {{"repair", "mesh"},    {"source", "source"},   {"wall", "boundary"},
               {"fixed", "boundary"}, {"dipole", "sources"},  {"signal", "sources"},
               {"probe", "probes"},   {" part ", "boundary"}, {"point", "probes"},
               {"star", "star"}};
  const char *sentence = dvi_last_error();
  const dvi__tree *found = NULL;
  for (size_t i = 0; i < sizeof blame / sizeof *blame && found == NULL; i++)
    if (strstr(sentence, blame[i].word) != NULL)
      found = dvi__tree_find(scene->tree, blame[i].section);
  return dvi__complain(scene->complaint, status, (found != NULL ? found : otherwise)->span, "%s",
                       sentence);
}

/* ---- the start ---- */

/* Evaluate the start at all vertices. */
static bool evaluate_start(dvi_scene *scene, const dvi__place *place, double *values)
{
  const dvi_mesh *mesh = scene->field->mesh;
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  const int64_t *number = dvi_mesh_share_numbers(mesh, 0);
  const double *point = dvi_mesh_points(mesh);
  const int space = dvi_mesh_space(mesh);
  for (int64_t v = 0; v < vertices && place != NULL; v++)
    if (dvi__place_value(place, point + v * space, NULL, values + v) != 0 || !isfinite(values[v]))
      return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "initial")->span,
                               "the start is not finite at vertex %lld, (%g, %g)",
                               (long long)(number != NULL ? number[v] : v), point[v * space],
                               space > 1 ? point[v * space + 1] : 0.0);
  return true;
}

static bool make_start(dvi_scene *scene)
{
  const struct dvi__scene_field *field = scene->field;
  const size_t n = (size_t)scene->n, vertices = (size_t)dvi_mesh_count(field->mesh, 0);
  scene->q = dvi__arena_take(&scene->arena, 3 * n, sizeof *scene->q);
  double *u = dvi__heap_take(2 * vertices, sizeof *u), *rate = u != NULL ? u + vertices : NULL;
  bool good = scene->q != NULL && u != NULL;
  if (!good) (void)dvi__scene_no_memory(scene);
  good = good && evaluate_start(scene, field->value, u) && evaluate_start(scene, field->rate, rate);
  if (good) {
    scene->v = scene->q + n;
    scene->p = scene->v + n;
    (void)dvi_field_project(field->field, u, NULL, scene->q, NULL);
    (void)dvi_field_project(field->field, rate, NULL, scene->v, NULL);
    (void)dvi_field_project(field->field, NULL, rate, NULL, scene->p);
  }
  dvi__heap_free(u);
  return good;
}

/* ---- coordinates ---- */

bool dvi__declare_unknowns(dvi_scene *scene, const dvi__tree *section, const char *name)
{
  dvi__coordinate *u = dvi__arena_take(&scene->arena, 1, sizeof *u);
  scene->n = scene->nv = scene->velocities = scene->terms.dimension;
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)scene->n, sizeof *scene->zeros);
  if (u == NULL || scene->zeros == NULL) return dvi__scene_no_memory(scene);
  *u = (dvi__coordinate){.name = name,
                         .span = section->span,
                         .kind = DVI__LINES,
                         .family = 1,
                         .size = scene->n,
                         .columns = 1,
                         .shape = {0, 1, 1},
                         .q = {.first = 0, .stride = 1, .components = 1},
                         .v = {.first = 0, .stride = 1, .components = 1}};
  scene->coordinate = u;
  scene->coordinate_count = 1;
  return true;
}

/* What marches observe beside the probes. Waves have the first ones. */
const char *const dvi__observable[] = {"energy", "growth", "gauss", "charge", "divergence", NULL};
enum { OF_WAVES = 2 };

/* Return what marches of the scene's field observe, NULL beyond the last one. */
static const char *observable(const dvi_scene *scene, int i)
{
  if (dvi__is_elastic(scene)) return dvi__elastic_observable(scene, i);
  return scene->field->maxwell != NULL || i < OF_WAVES ? dvi__observable[i] : NULL;
}

int dvi__list_field_columns(const dvi_scene *scene, const char **known)
{
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  const int probes = m != NULL ? m->probes : scene->terms.invariant_count;
  int count = 0;
  for (; observable(scene, count) != NULL; count++)
    if (known != NULL) known[count] = observable(scene, count);
  for (int i = 0; i < scene->terms.symmetry_count; i++, count++)
    if (known != NULL) known[count] = scene->terms.symmetries[i].name;
  for (int i = 0; i < probes; i++, count++)
    if (known != NULL)
      known[count] = m != NULL ? m->probe[i].name : scene->terms.invariants[i].name;
  return count;
}

bool dvi__is_mechanical_column(const dvi_scene *scene, const char *name)
{
  static const char *const column[] = {"t", "energy_balance", "h", "jump"};
  for (size_t k = 0; k < sizeof column / sizeof *column; k++)
    if (strcmp(column[k], name) == 0) return true;
  if (scene->field->mesh == NULL ||
      !dvi__is_unknown(name, scene->field->maxwell != NULL ? 'A' : 'u'))
    return false;
  const long number = strtol(strrchr(name, '_') + 1, NULL, 10);
  return number >= 1 && number <= scene->nv;
}

/* ---- the field ---- */

const char *const dvi__field_word[DVI__FIELD_WORDS] = {"wave", "maxwell", "elastic"};

dvi_status dvi__declare_system(dvi_scene *scene)
{
  const double damping = scene->terms.damping;
  dvi_field *field = scene->field->field;
  dvi_status status = DVI_OK;
  if (dvi__is_share(scene)) {
    int64_t unknowns;
    (void)dvi_field_unknowns(field, &unknowns);
    scene->terms = (dvi_system_terms){.dimension = (int)unknowns};
  } else {
    status = dvi_field_system_terms(field, &scene->terms);
  }
  scene->terms.damping = damping;
  return status;
}

static dvi_status make_field(dvi_scene *scene)
{
  struct dvi__scene_field *f = scene->field;
  const dvi_star_options options = {
      .size = sizeof options, .kind = f->kind, .factor = (const double *const *)f->factor};
  dvi_status status = dvi_star_create(f->mesh, &options, &f->star);
  const dvi_wave_terms terms = {
      .size = sizeof terms,
      .star = f->star,
      .condition = f->condition,
      .conditions = f->conditions,
      .source = f->source != NULL ? dvi__place_source : NULL,
      .source_user = f->source,
      .potential = f->density.density != NULL ? &f->density : NULL,
  };
  if (status == DVI_OK) status = dvi_wave_create(&terms, &f->field);
  return status == DVI_OK ? dvi__declare_system(scene) : status;
}

static bool make_wave(dvi_scene *scene, const dvi__tree *section)
{
  const dvi_status status = make_field(scene);
  if (status != DVI_OK)
    return dvi__complain_of_field(scene, dvi__tree_find(scene->tree, "mesh"), status);
  scene->form = "separable";
  scene->mass = scene->terms.mass.diagonal != NULL ? "diagonal" : "sparse";
  return dvi__declare_unknowns(scene, section, "u") && make_start(scene) &&
         dvi__probes_make(scene) && dvi__choose_field_columns(scene);
}

/* A step that is a fraction of the largest stable one of verlet divides the span. */
static bool choose_step(dvi_scene *scene)
{
  double omega;
  dvi_scene_plan *plan = &scene->plan;
  if (!(plan->fraction > 0) || scene->field->mesh == NULL) return true;
  const dvi_status status = dvi__is_elastic(scene) ? dvi__elastic_fastest(scene, &omega)
                                                   : dvi_field_fastest(scene->field->field, &omega);
  if (status != DVI_OK)
    return dvi__complain_of_field(scene, dvi__tree_find(scene->tree, "mesh"), status);
  if (!(omega > 0))
    return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "step")->span,
                             "nothing oscillates here, so that a step is no fraction of a stable "
                             "one: give a number");
  plan->h = plan->fraction * 2 / omega;
  if (plan->t_end > 0) plan->h = plan->t_end / ceil(plan->t_end / plan->h * (1 - 1e-12));
  return true;
}

bool dvi__read_field(dvi_scene *scene, const dvi__tree *section)
{
  static bool (*const make[DVI__FIELD_WORDS])(dvi_scene *, const dvi__tree *) = {
      make_wave, dvi__maxwell_make, dvi__elastic_make};
  int which;
  if (!dvi__tree_word(scene, section, "field", DVI__FIELD_WORDS, dvi__field_word, &which))
    return false;
  if (scene->field->mesh == NULL) return dvi__grid_make(scene);
  return make[which](scene, section) && choose_step(scene);
}

void dvi__scene_field_clear(dvi_scene *scene)
{
  if (scene->field == NULL) return;
  dvi__elastic_clear(scene);
  dvi_field_destroy(&scene->field->field);
  dvi_star_destroy(&scene->field->star);
  dvi_mesh_destroy(&scene->field->mesh);
  dvi_mesh_destroy(&scene->field->drawn);
}

/* ---- questions ---- */

const dvi_field *dvi_scene_field(const dvi_scene *scene)
{
  return scene != NULL && scene->field != NULL ? scene->field->field : NULL;
}

int dvi_scene_solve_options(const dvi_scene *scene, dvi_field_solve_options *options)
{
  if (dvi_scene_field(scene) == NULL || options == NULL) return 0;
  *options = scene->field->solve;
  return 1;
}
