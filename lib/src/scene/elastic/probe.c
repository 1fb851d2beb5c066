/* The section probes of a solid: displacements, velocities, places and stresses at points, and
 * energies of parts. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/elastic/scene_elastic.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

static const char *const word[] = {"u",      "u'",      "x",      "stress", "von_mises",
                                   "energy", "kinetic", "stored", "load"};
enum { WORDS = sizeof word / sizeof *word, COMPONENTS_MOST = 6 };

/* ---- reading ---- */

static bool add_named(dvi_scene *scene, const dvi__solid_probe *probe, const char *ending)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  char text[128];
  dvi__solid_probe *made = s->probe + s->probes++;
  *made = *probe;
  if (*ending == '\0') return true;
  (void)snprintf(text, sizeof text, "%s_%s", probe->name, ending);
  made->name = dvi__arena_text(&scene->arena, text, strlen(text));
  return made->name != NULL || dvi__scene_no_memory(scene);
}

/* Add a probe of each component of a vector. */
static bool add_vector(dvi_scene *scene, dvi__solid_probe probe)
{
  for (int i = 0; i < scene->field->space; i++) {
    const char ending[] = {"xyz"[i], '\0'};
    memset(probe.along, 0, sizeof probe.along);
    probe.along[i] = 1;
    if (!add_named(scene, &probe, ending)) return false;
  }
  return true;
}

/* Add a probe of each component of the stress, which is symmetric. */
static bool add_stress(dvi_scene *scene, dvi__solid_probe probe)
{
  for (int i = 0; i < scene->field->space; i++)
    for (int j = i; j < scene->field->space; j++) {
      const char ending[] = {"xyz"[i], "xyz"[j], '\0'};
      memset(probe.along, 0, sizeof probe.along);
      memset(probe.across, 0, sizeof probe.across);
      probe.along[i] = probe.across[j] = 1;
      if (!add_named(scene, &probe, ending)) return false;
    }
  return true;
}

/* The stress along a direction is n.sigma n, of a unit vector n. */
static bool read_direction(dvi_scene *scene, const dvi__tree *along, dvi__solid_probe *probe)
{
  double square = 0;
  if (!dvi__point_read(scene, along, scene->field->space, "a direction", probe->along))
    return false;
  for (int i = 0; i < scene->field->space; i++) square += probe->along[i] * probe->along[i];
  if (!(square > 0)) return dvi__scene_refuse(scene, along->span, "a direction is not 0");
  for (int i = 0; i < scene->field->space && probe->of == DVI__SOLID_STRESS; i++)
    probe->across[i] = probe->along[i] /= sqrt(square);
  return add_named(scene, probe, "");
}

static bool read_at(dvi_scene *scene, const dvi__tree *tree, const dvi__tree *at,
                    dvi__solid_probe *probe)
{
  static const char *const known[] = {"of", "at", "along"};
  const dvi__tree *along = dvi__tree_find(tree, "along");
  if (!dvi__want_keys(scene, tree, "a probe at a point", 3, known)) return false;
  if (at == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a probe of %s is at a point of the reference, as "
                             "in '{of: %s, at: [0, 0, 1]}'",
                             word[probe->of], word[probe->of]);
  probe->place = at->span;
  if (!dvi__point_read(scene, at, scene->field->space, "a point", probe->at)) return false;
  if (probe->of == DVI__SOLID_MISES)
    return along == NULL
               ? add_named(scene, probe, "")
               : dvi__scene_refuse(scene, along->span, "von_mises is a number without a direction");
  if (along != NULL) return read_direction(scene, along, probe);
  return probe->of == DVI__SOLID_STRESS ? add_stress(scene, *probe) : add_vector(scene, *probe);
}

static bool read_part(dvi_scene *scene, const dvi__tree *tree, dvi__solid_probe *probe)
{
  static const char *const known[] = {"of", "part"};
  const dvi__tree *part = dvi__tree_find(tree, "part");
  if (!dvi__want_keys(scene, tree, "a probe of an energy", 2, known) ||
      (part != NULL && !dvi__want_text(scene, part, "a part of the mesh")))
    return false;
  if (part != NULL) {
    probe->part = part->text;
    if (!dvi__has_part_of_cells(scene->field->mesh, part->text))
      return dvi__refuse_part(scene, part->span, part->text, true);
  }
  return add_named(scene, probe, "");
}

static bool read_probe(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  int which = DVI__SOLID_DISPLACEMENT;
  if (!dvi__want_name(scene, key->text, key->span) || !dvi__want_mapping(scene, tree, "a probe"))
    return false;
  const dvi__tree *of = dvi__tree_find(tree, "of");
  if (of != NULL && !dvi__tree_word(scene, of, "what a probe is of", WORDS, word, &which))
    return false;
  dvi__solid_probe probe = {.name = key->text, .span = key->span, .of = (dvi__solid_quantity)which};
  return which < DVI__SOLID_TOTAL ? read_at(scene, tree, dvi__tree_find(tree, "at"), &probe)
                                  : read_part(scene, tree, &probe);
}

/* Refuse the name of another column. */
static bool name_is_new(dvi_scene *scene, int i)
{
  const struct dvi__scene_elastic *s = scene->field->elastic;
  const char *name = s->probe[i].name;
  bool there = strcmp(name, "t") == 0 || dvi__is_unknown(name, 'u');
  for (int k = 0; dvi__elastic_observable(scene, k) != NULL; k++)
    there = there || strcmp(dvi__elastic_observable(scene, k), name) == 0;
  for (int k = 0; k < i; k++) there = there || strcmp(s->probe[k].name, name) == 0;
  return !there || dvi__scene_refuse(scene, s->probe[i].span,
                                     "there is a column '%s' already; choose another name", name);
}

bool dvi__elastic_read_probes(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  const size_t most = (size_t)COMPONENTS_MOST * (size_t)section->count + 1;
  if (!dvi__want_mapping(scene, section, "probes")) return false;
  s->probe = dvi__arena_take(&scene->arena, most, sizeof *s->probe);
  if (s->probe == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!read_probe(scene, section->key[i], section->child[i])) return false;
  for (int i = 0; i < s->probes; i++)
    if (!name_is_new(scene, i)) return false;
  return true;
}

/* ---- values ---- */

/* The displacements and velocities [vertices*n] of a state. Released by the caller. */
typedef struct motion {
  double *u, *rate;
} motion;

static dvi_status find_motion(const dvi_elastic *solid, double t, const double *q, const double *p,
                              motion *m)
{
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const size_t numbers = (size_t)dvi_mesh_count(mesh, 0) * (size_t)dvi_mesh_dimension(mesh);
  m->u = dvi__heap_take(2 * numbers, sizeof *m->u);
  if (m->u == NULL) return DVI_NO_MEMORY;
  m->rate = m->u + numbers;
  return dvi_elastic_lift(solid, t, q, p, m->u, m->rate);
}

/* Interpolate the values at the nodes, along the probe's direction. */
static double at_point(const dvi__solid_probe *probe, const double *nodes, const double *more)
{
  int width;
  const dvi_mesh *mesh = dvi_elastic_mesh(probe->solid);
  const int n = dvi_mesh_dimension(mesh),
            *vertex = dvi_mesh_vertices(mesh, n, &width) + (ptrdiff_t)probe->cell * width;
  double sum = 0;
  for (int a = 0; a < width; a++)
    for (int i = 0; i < n; i++) {
      const ptrdiff_t k = (ptrdiff_t)vertex[a] * n + i;
      sum += probe->weight[a] * probe->along[i] * (nodes[k] + (more != NULL ? more[k] : 0));
    }
  return sum;
}

static dvi_status stress_at(const dvi__solid_probe *probe, const double *u, double *value)
{
  const int n = dvi_mesh_dimension(dvi_elastic_mesh(probe->solid));
  double sigma[DVI__SOLID_AXES * DVI__SOLID_AXES] = {0};
  if (probe->of == DVI__SOLID_MISES)
    return dvi_elastic_von_mises(probe->solid, 1, &probe->cell, u, value);
  const dvi_status status = dvi_elastic_stress(probe->solid, 1, &probe->cell, u, sigma);
  *value = 0;
  for (int i = 0; i < n * n; i++) *value += probe->along[i / n] * sigma[i] * probe->across[i % n];
  return status;
}

static dvi_status energy_of(const dvi__solid_probe *probe, double t, const motion *m, double *value)
{
  dvi_elastic_energies e;
  const dvi_status status = dvi_elastic_energy(probe->solid, t, m->u, m->rate, probe->part, &e);
  if (status != DVI_OK) return status;
  *value = probe->of == DVI__SOLID_KINETIC  ? e.kinetic
           : probe->of == DVI__SOLID_STORED ? e.stored
           : probe->of == DVI__SOLID_LOAD   ? e.load
                                            : e.kinetic + e.stored + e.load;
  return DVI_OK;
}

/* Give the value at a point where its cell is owned, and 0 on the other processes. */
static dvi_status value_here(const dvi__solid_probe *probe, const motion *m, double *value)
{
  *value = 0;
  if (probe->cell < 0) return DVI_OK;
  switch (probe->of) {
  case DVI__SOLID_DISPLACEMENT: *value = at_point(probe, m->u, NULL); break;
  case DVI__SOLID_VELOCITY: *value = at_point(probe, m->rate, NULL); break;
  case DVI__SOLID_POSITION:
    *value = at_point(probe, dvi_mesh_points(dvi_elastic_mesh(probe->solid)), m->u);
    break;
  default: return stress_at(probe, m->u, value);
  }
  return DVI_OK;
}

/* `user` is a probe. */
static int watch(double t, const double *q, const double *p, double *value, void *user)
{
  const dvi__solid_probe *probe = user;
  const bool is_at_point = probe->of < DVI__SOLID_TOTAL;
  motion m = {.u = NULL};
  dvi_status status = find_motion(probe->solid, t, q, p, &m);
  if (status == DVI_OK && is_at_point) status = value_here(probe, &m, value);
  status = dvi_elastic_agree(probe->solid, status);
  if (status == DVI_OK)
    status = is_at_point ? dvi_elastic_sum(probe->solid, 1, value) : energy_of(probe, t, &m, value);
  dvi__heap_free(m.u);
  return status == DVI_OK ? 0 : status == DVI_SINGULAR ? 1 : -1;
}

/* ---- making ---- */

static bool place_probe(dvi_scene *scene, dvi__solid_probe *probe)
{
  probe->solid = scene->field->elastic->solid;
  if (probe->of >= DVI__SOLID_TOTAL) return true;
  const dvi_status status = dvi_elastic_locate(probe->solid, probe->at, &probe->cell,
                                               probe->weight);
  if (status == DVI_BAD_ARGUMENT)
    return dvi__scene_refuse(scene, probe->place, "the probe '%s' is outside of the mesh",
                             probe->name);
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, probe->place, "%s", dvi_last_error());
}

bool dvi__solid_place_probes(dvi_scene *scene)
{
  const struct dvi__scene_elastic *s = scene->field->elastic;
  dvi_invariant *list = dvi__arena_take(&scene->arena, (size_t)s->probes + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < s->probes; i++) {
    if (!place_probe(scene, s->probe + i)) return false;
    list[i] = (dvi_invariant){.name = s->probe[i].name, .value = watch, .user = s->probe + i};
  }
  scene->terms.invariants = list;
  scene->terms.invariant_count = s->probes;
  return true;
}
