/* Marches of a scene's field. */
#include <math.h>
#include <string.h>

#include "scene/field/maxwell.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

static bool is_called(const char *method, const char *name)
{
  const size_t length = strlen(name);
  return strncmp(method, name, length) == 0 && (method[length] == '\0' || method[length] == ':');
}

/* Tell if a method is one by which only shares march. Whole meshes have it as systems do. */
static bool is_implicit(const char *method)
{
  return is_called(method, "midpoint") || is_called(method, "imex") ||
         is_called(method, "galerkin");
}

int dvi_scene_marches(const dvi_scene *scene, const char *method)
{
  if (scene == NULL || (scene->field == NULL && scene->density == NULL)) return 0;
  if (method == NULL) method = scene->plan.method;
  if (method == NULL) return 0;
  if (scene->density != NULL) return dvi__density_marches(scene, method);
  if (dvi__is_elastic(scene)) return dvi__elastic_marches(method);
  if (dvi__is_share(scene) && is_implicit(method))
    return scene->field->maxwell == NULL || is_called(method, "midpoint");
  const char *name;
  for (int i = 0; (name = dvi_march_method_name(i)) != NULL; i++)
    if (is_called(method, name)) return 1;
  return 0;
}

/* Spread the scene's start, of unknowns, over all cells, and start. */
static dvi_status start(const dvi_scene *scene, dvi_march *march)
{
  const struct dvi__scene_field *f = scene->field;
  const struct dvi__scene_maxwell *m = f->maxwell;
  if (m != NULL) {
    const dvi_march_state state = {
        .size = sizeof state, .E = m->start_E, .A = m->start_A, .B = m->start_B};
    return dvi_march_start(march, &state);
  }
  int64_t unknowns;
  const int64_t vertices = dvi_mesh_count(f->mesh, 0);
  const int *unknown = dvi_field_unknowns(f->field, &unknowns);
  double *u = dvi__heap_take(2 * (size_t)vertices, sizeof *u);
  if (u == NULL) return DVI_NO_MEMORY;
  double *E = u + vertices;
  (void)dvi_field_lift(f->field, scene->q, u);
  for (int64_t i = 0; i < unknowns; i++) E[unknown[i]] = -scene->v[i];
  const dvi_march_state state = {.size = sizeof state, .A = u, .E = E};
  const dvi_status status = dvi_march_start(march, &state);
  dvi__heap_free(u);
  return status;
}

/* Take what the options leave open from the scene. */
static dvi_march_options complete(const dvi_scene *scene, const dvi_march_options *options)
{
  dvi_march_options all = options != NULL ? *options : (dvi_march_options){.size = sizeof all};
  const dvi_scene_plan *plan = &scene->plan;
  if (all.method == NULL) all.method = plan->method;
  if (all.step == 0 && all.fraction == 0) {
    all.fraction = plan->fraction;
    if (!(all.fraction > 0)) all.step = plan->h;
  }
  if (all.span == 0) all.span = plan->t_end;
  return all;
}

/* Tell if a grid without its mesh has all that the scene and the options want. A start by A, what
 * happens on parts, and A itself are those of a mesh, on which yee is the same method. */
static bool suits_grid(const struct dvi__scene_field *f, const dvi_march_options *options)
{
  const struct dvi__scene_maxwell *m = f->maxwell;
  if (m == NULL || !f->is_grid || strcmp(options->method, "yee") != 0) return false;
  bool is_by_part = false;
  for (int i = 0; i < m->probes; i++) is_by_part = is_by_part || m->probe[i].part != NULL;
  return f->field == NULL || !(is_by_part || m->of_A != NULL || options->potential);
}

dvi_status dvi_scene_march_create(const dvi_scene *scene, const dvi_march_options *options,
                                  dvi_march **march)
{
  if (scene == NULL || march == NULL) return DVI_BAD_ARGUMENT;
  *march = NULL;
  if (!dvi_scene_marches(scene, options != NULL ? options->method : NULL)) return DVI_BAD_OPTION;
  if (scene->terms.damping > 0) return DVI_UNSUPPORTED;
  const dvi_march_options all = complete(scene, options);
  if (scene->density != NULL) return dvi__density_march(scene, &all, march);
  if (dvi__is_elastic(scene)) return dvi__elastic_march(scene, &all, march);
  const struct dvi__scene_field *f = scene->field;
  const bool divides_grid = suits_grid(f, &all) && f->ranks != NULL;
  if (dvi__is_share(scene) && !divides_grid && strcmp(all.method, "leapfrog") != 0 &&
      !is_implicit(all.method))
    return DVI_UNSUPPORTED;
  if (f->kind != DVI_CIRCUMCENTRIC && strcmp(all.method, "yee") == 0 &&
      dvi_mesh_kind(f->mesh) == DVI_BOXES)
    return DVI_UNSUPPORTED;
  if (suits_grid(f, &all)) return dvi__grid_march(scene, &all, march);
  if (f->field == NULL) return DVI_UNSUPPORTED;
  dvi_status status = dvi_march_create(f->field, &all, march);
  if (status == DVI_OK) status = start(scene, *march);
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}

/* Set q = u and p = -M E of a wave. */
static dvi_status wave_state(const dvi_field *field, const dvi_march *march, double *q, double *p)
{
  const int64_t cells = dvi_march_size(march, DVI_FORM_A);
  double *u = dvi__heap_take(2 * (size_t)cells, sizeof *u);
  if (u == NULL) return DVI_NO_MEMORY;
  double *const E = u + cells;
  dvi_status status = dvi_march_sample(march, DVI_FORM_A, 0, NULL, u);
  if (status == DVI_OK && p != NULL) status = dvi_march_sample(march, DVI_FORM_E, 0, NULL, E);
  for (int64_t i = 0; i < cells; i++) E[i] = -E[i];
  if (status == DVI_OK) status = dvi_field_project(field, u, E, q, p);
  dvi__heap_free(u);
  return status;
}

dvi_status dvi_scene_march_state(const dvi_scene *scene, const dvi_march *march, double *q,
                                 double *p)
{
  if (scene == NULL || march == NULL || q == NULL) return DVI_BAD_ARGUMENT;
  if (dvi_march_size(march, DVI_FORM_A) == 0) return DVI_UNSUPPORTED;
  if (scene->density != NULL) return dvi__density_march_state(scene, march, q, p);
  if (dvi__is_elastic(scene)) return dvi__elastic_march_state(scene, march, q, p);
  const dvi_field *field = dvi_scene_field(scene);
  return field != NULL ? wave_state(field, march, q, p) : DVI_UNSUPPORTED;
}

const char *dvi_scene_grid_only(const dvi_scene *scene)
{
  if (scene == NULL || scene->field == NULL || scene->field->mesh != NULL) return NULL;
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  return m->grid_only != NULL ? m->grid_only : "size";
}

/* ---- vectors in cells ---- */

const dvi_mesh *dvi_scene_mesh(dvi_scene *scene)
{
  if (scene != NULL && scene->density != NULL) return dvi__density_mesh(scene);
  if (scene == NULL || scene->field == NULL) return NULL;
  struct dvi__scene_field *f = scene->field;
  if (f->mesh != NULL) return f->mesh;
  if (f->drawn == NULL) (void)dvi_mesh_generate("box", &f->grid, &f->drawn);
  return f->drawn;
}

/* Put a form's components in a cell to those of a vector: the inverse of dvi__maxwell_form, with a
 * lone component across the grid. */
static void to_vector(const struct dvi__scene_field *f, bool is_B, const double *form,
                      double *vector)
{
  const struct dvi__scene_maxwell *m = f->maxwell;
  const int count = is_B ? m->B : m->E;
  vector[0] = vector[1] = vector[2] = 0;
  if (count == 1) {
    vector[f->dimension == 1 && !is_B ? 1 : 2] = form[0];
  } else if (!is_B) {
    for (int i = 0; i < count; i++) vector[i] = form[i];
  } else if (m->is_scalar) {
    vector[0] = form[1];
    vector[1] = -form[0];
  } else {
    vector[0] = form[2];
    vector[1] = -form[1];
    vector[2] = form[0];
  }
}

static dvi_status vectors_of_mesh(const struct dvi__scene_field *f, const dvi_march *march,
                                  dvi_march_form form, double *vector)
{
  const bool is_B = form == DVI_FORM_B;
  const int k = (f->maxwell->is_scalar ? 0 : 1) + is_B, n = dvi_mesh_dimension(f->mesh),
            components = dvi_form_components(f->space, k);
  const int64_t cells = dvi_mesh_count(f->mesh, n), size = dvi_march_size(march, form);
  double *values = dvi__heap_take((size_t)(size + cells * components), sizeof *values);
  if (values == NULL) return DVI_NO_MEMORY;
  double *at = values + size;
  dvi_status status = dvi_march_sample(march, form, 0, NULL, values);
  if (status == DVI_OK) status = dvi_form_at_centres(f->mesh, k, values, at);
  for (int64_t c = 0; c < cells && status == DVI_OK; c++)
    to_vector(f, is_B, at + c * components, vector + 3 * c);
  dvi__heap_free(values);
  return status;
}

dvi_status dvi_scene_vectors(const dvi_scene *scene, const dvi_march *march, dvi_march_form form,
                             double *vector)
{
  dvi_march_facts facts;
  if (scene == NULL || march == NULL || vector == NULL) return DVI_BAD_ARGUMENT;
  if (scene->field == NULL || scene->field->maxwell == NULL || form == DVI_FORM_A)
    return DVI_UNSUPPORTED;
  dvi_march_facts_of(march, &facts);
  if (strcmp(facts.method, "yee") == 0) return dvi__grid_vectors(scene, march, form, vector);
  return vectors_of_mesh(scene->field, march, form, vector);
}
