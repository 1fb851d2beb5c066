/* An electromagnetic field on the scene's mesh. */
#include "scene/field/maxwell.h"

#include <math.h>
#include <string.h>

#include "scene/sections/sections.h"
#include "text/heap.h"

/* What a library's structure points to, while the field is made. */
typedef struct draft {
  dvi_wall *wall;
  dvi_current *current;
  dvi_field_probe *probe;
  double *eps, *nu, *sigma; /* [cells] or NULL */
  dvi_maxwell_terms terms;
} draft;

static void *take(dvi_scene *scene, size_t count, size_t size)
{
  void *memory = dvi__arena_take(&scene->arena, count > 0 ? count : 1, size);
  if (memory == NULL) (void)dvi__scene_no_memory(scene);
  return memory;
}

/* ---- materials ---- */

/* The star takes 1/mu. */
static bool set_materials(dvi_scene *scene, draft *d)
{
  static const dvi__quantity quantity[] = {{"eps", false, 1}, {"mu", false, 1}, {"sigma", true, 0}};
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  const dvi_mesh *mesh = scene->field->mesh;
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  double **const values[] = {&d->eps, &d->nu, &d->sigma};
  for (int i = 0; i < m->materials; i++)
    for (int k = 0; k < DVI__QUANTITIES; k++)
      if (m->material[i].place[k] != NULL &&
          !dvi__quantity_set(scene, quantity + k, m->material[i].part, m->material[i].span[k],
                             m->material[i].place[k], values[k]))
        return false;
  for (int64_t c = 0; c < cells && d->nu != NULL; c++) d->nu[c] = 1 / d->nu[c];
  return true;
}

/* ---- walls ---- */

/* On a mesh that is no grid a part cannot be taken out of the boundary. */
static bool is_strongest(dvi_scene *scene, const dvi__scene_wall *whole)
{
  static const int strength[] = {
      [DVI__WALL_PMC] = 0, [DVI__WALL_ABSORBING] = 1, [DVI__WALL_PEC] = 2};
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  for (int i = 0; i < m->walls; i++)
    if (m->wall[i].word <= DVI__WALL_ABSORBING && strength[m->wall[i].word] < strength[whole->word])
      return dvi__scene_refuse(scene, m->wall[i].span,
                               "the wall of the whole boundary is stronger than that of '%s'; give "
                               "each part of the boundary its own wall",
                               m->wall[i].part);
  return true;
}

static bool set_walls(dvi_scene *scene, draft *d)
{
  static const dvi_wall_kind kind[] = {
      [DVI__WALL_PMC] = DVI_PMC, [DVI__WALL_PEC] = DVI_PEC, [DVI__WALL_ABSORBING] = DVI_ABSORBING};
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  d->wall = take(scene, (size_t)m->walls, sizeof *d->wall);
  if (d->wall == NULL) return false;
  for (int i = 0; i < m->walls; i++) {
    const dvi__scene_wall *wall = m->wall + i;
    if (wall->word > DVI__WALL_ABSORBING)
      return dvi__scene_refuse(scene, wall->span,
                               "layers and phases are for 'method: yee' on boxes; a wall of this "
                               "mesh is pec, pmc or absorbing");
    if (strcmp(wall->part, "boundary") == 0 && !is_strongest(scene, wall)) return false;
    d->wall[d->terms.walls++] = (dvi_wall){.part = wall->part, .kind = kind[wall->word]};
  }
  return true;
}

/* ---- sources ---- */

/* Refuse a point that lies in no cell. Of a share the field finds that out, with all others. */
static bool is_inside(dvi_scene *scene, const double *point, dvi__span span, const char *what)
{
  int cell = 0;
  double weight[DVI_MESH_DIMENSION_MAX + 1];
  if (dvi__is_share(scene)) return true;
  const dvi_status status = dvi_mesh_locate(scene->field->mesh, 1, point, &cell, weight);
  if (status != DVI_OK)
    return dvi__complain(scene->complaint, status, span, "%s", dvi_last_error());
  return cell >= 0 || dvi__scene_refuse(scene, span, "%s is outside of the mesh", what);
}

static bool set_currents(dvi_scene *scene, draft *d)
{
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  int count = 0;
  d->current = take(scene, 3 * (size_t)m->sources, sizeof *d->current);
  for (int i = 0; i < m->sources && d->current != NULL; i++) {
    const dvi__scene_source *source = m->source + i;
    if (source->wave != NULL)
      return dvi__scene_refuse(scene, source->span,
                               "plane waves are for 'method: yee' on boxes, which this mesh is "
                               "not");
    if (source->at != NULL && !is_inside(scene, source->point, source->at->span, "the dipole"))
      return false;
    for (int axis = 0; axis < 3; axis++) {
      dvi_current *current = d->current + count;
      if (source->signal[axis] == NULL) continue;
      *current = (dvi_current){.signal = dvi__signal_value,
                               .impulse = dvi__signal_impulse,
                               .user = source->signal[axis]};
      if (source->density != NULL) {
        current->density = dvi__place_vector_value;
        current->density_user = source->density;
      } else {
        memcpy(current->at, source->point, sizeof source->point);
        current->along[axis] = 1;
      }
      count++;
    }
  }
  d->terms.current = d->current;
  d->terms.currents = count;
  return d->current != NULL;
}

/* ---- probes ---- */

static bool set_probes(dvi_scene *scene, draft *d)
{
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  d->probe = take(scene, (size_t)m->probes, sizeof *d->probe);
  for (int i = 0; i < m->probes && d->probe != NULL; i++) {
    const dvi__scene_probe *from = m->probe + i;
    dvi_field_probe *probe = d->probe + i;
    if (from->has_box)
      return dvi__scene_refuse(scene, from->span,
                               "a flux through a box is for 'method: yee' on boxes; on a mesh it "
                               "goes through a part");
    const bool has_point = *from->of == 'E' || *from->of == 'B';
    if (has_point && !is_inside(scene, from->at, from->place, "the probe")) return false;
    *probe = (dvi_field_probe){.name = from->name, .of = from->of, .part = from->part};
    memcpy(probe->at, from->at, sizeof from->at);
    dvi__maxwell_form(scene->field, *from->of == 'B', from->along, probe->along);
  }
  return d->probe != NULL;
}

/* ---- the start ---- */

/* The components of a form, of a vector in space, and where they failed. */
typedef struct form_of_vector {
  const struct dvi__scene_field *field;
  dvi__place_vector *vector;
  bool is_B, has_failed;
  double at[3];
} form_of_vector;

static int form_at(const double *x, double *value, void *user)
{
  form_of_vector *f = user;
  double vector[3] = {0};
  f->has_failed = dvi__place_vector_value(x, vector, f->vector) != 0;
  if (f->has_failed)
    memcpy(f->at, x, (size_t)f->field->space * sizeof *x);
  else
    dvi__maxwell_form(f->field, f->is_B, vector, value);
  return f->has_failed;
}

static bool integrate(dvi_scene *scene, dvi__place_vector *vector, bool is_B, double **form)
{
  form_of_vector f = {.field = scene->field, .vector = vector, .is_B = is_B};
  const dvi_mesh *mesh = scene->field->mesh;
  const int k = (scene->field->maxwell->is_scalar ? 0 : 1) + is_B;
  if (vector == NULL) return true;
  *form = take(scene, (size_t)dvi_mesh_count(mesh, k), sizeof **form);
  if (*form == NULL) return false;
  const dvi_status status = dvi_form_integrate(mesh, k, form_at, &f, *form);
  if (f.has_failed)
    return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "initial")->span,
                             "the start is not finite at (%g, %g, %g)", f.at[0], f.at[1], f.at[2]);
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, dvi__tree_find(scene->tree, "initial")->span, "%s",
                       dvi_last_error());
}

/* The circulation of A around a plane is the flux of B through it, and 0 along an electric wall. */
static bool refuse_B(dvi_scene *scene, dvi_status status)
{
  const struct dvi__scene_field *f = scene->field;
  const bool is_flux = status == DVI_BAD_ARGUMENT && f->dimension == 2 && !f->maxwell->is_scalar;
  return dvi__complain(scene->complaint, status, dvi__tree_find(scene->tree, "initial")->span,
                       is_flux ? "%s; the whole flux of B through a region that electric walls "
                                 "enclose, or that is periodic, must be 0"
                               : "%s",
                       dvi_last_error());
}

/* The start of the mechanical system: q = A, and the velocity -E. */
static bool make_start(dvi_scene *scene)
{
  struct dvi__scene_field *f = scene->field;
  struct dvi__scene_maxwell *m = f->maxwell;
  const size_t n = (size_t)scene->n;
  if (!integrate(scene, m->of_E, false, &m->start_E) ||
      !integrate(scene, m->of_A, false, &m->start_A) ||
      !integrate(scene, m->of_B, true, &m->start_B))
    return false;
  scene->q = take(scene, 3 * n, sizeof *scene->q);
  if (scene->q == NULL) return false;
  if (m->start_B != NULL) {
    const int64_t cells = dvi_mesh_count(f->mesh, m->is_scalar ? 0 : 1);
    m->start_A = take(scene, (size_t)cells, sizeof *m->start_A);
    const dvi_status status = m->start_A != NULL
                                  ? dvi_field_vector_potential(f->field, m->start_B, m->start_A)
                                  : DVI_NO_MEMORY;
    if (status != DVI_OK) return refuse_B(scene, status);
  }
  scene->v = scene->q + n;
  scene->p = scene->v + n;
  (void)dvi_field_project(f->field, m->start_A, NULL, scene->q, NULL);
  (void)dvi_field_project(f->field, m->start_E, NULL, scene->v, NULL);
  (void)dvi_field_project(f->field, NULL, m->start_E, NULL, scene->p);
  for (size_t i = 0; i < n; i++) {
    scene->v[i] = -scene->v[i];
    scene->p[i] = -scene->p[i];
  }
  return true;
}

/* ---- columns ---- */

/* A probe as what is watched. */
typedef struct watched {
  const dvi_field *field;
  int number;
} watched;

static int watch(double t, const double *q, const double *p, double *value, void *user)
{
  const watched *w = user;
  (void)t;
  return dvi_field_probe_at(w->field, w->number, q, p, value) == DVI_OK ? 0 : -1;
}

static bool watch_probes(dvi_scene *scene)
{
  const int count = scene->field->maxwell->probes;
  dvi_invariant *list = take(scene, (size_t)count, sizeof *list);
  watched *w = take(scene, (size_t)count, sizeof *w);
  for (int i = 0; i < count && list != NULL && w != NULL; i++) {
    w[i] = (watched){scene->field->field, i};
    list[i] = (dvi_invariant){
        .name = scene->field->maxwell->probe[i].name, .value = watch, .user = w + i};
  }
  scene->terms.invariants = list;
  scene->terms.invariant_count = count;
  return list != NULL && w != NULL;
}

/* ---- the field ---- */

static dvi_status make_field(dvi_scene *scene, draft *d)
{
  struct dvi__scene_field *f = scene->field;
  const int k = f->maxwell->is_scalar ? 0 : 1;
  const double *factor[DVI_MESH_DIMENSION_MAX + 1] = {NULL};
  factor[k] = d->eps;
  factor[k + 1] = d->nu;
  const dvi_star_options options = {.size = sizeof options, .kind = f->kind, .factor = factor};
  dvi_status status = dvi_star_create(f->mesh, &options, &f->star);
  d->terms.size = sizeof d->terms;
  d->terms.star = f->star;
  d->terms.scalar = f->maxwell->is_scalar;
  d->terms.wall = d->wall;
  d->terms.conductivity = d->sigma;
  d->terms.probe = d->probe;
  d->terms.probes = f->maxwell->probes;
  if (status == DVI_OK) status = dvi_maxwell_create(&d->terms, &f->field);
  return status == DVI_OK ? dvi__declare_system(scene) : status;
}

bool dvi__maxwell_make(dvi_scene *scene, const dvi__tree *section)
{
  draft d = {.terms = {.size = sizeof d.terms}};
  if (!set_materials(scene, &d) || !set_walls(scene, &d) || !set_currents(scene, &d) ||
      !set_probes(scene, &d))
    return false;
  const dvi_status status = make_field(scene, &d);
  if (status != DVI_OK) return dvi__complain_of_field(scene, section, status);
  scene->form = "separable";
  scene->mass = scene->terms.mass.diagonal != NULL ? "diagonal" : "sparse";
  return dvi__declare_unknowns(scene, section, "A") && make_start(scene) && watch_probes(scene) &&
         dvi__choose_field_columns(scene);
}
