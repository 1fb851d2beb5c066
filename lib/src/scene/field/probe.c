/* The section probes: values of the field at points, and integrals, watched along a run. A probe at
 * a point is a sum of the values at the vertices of the cell in which it is, by Whitney's
 * interpolation. */
#include <math.h>
#include <string.h>

#include "scene/field/maxwell.h"
#include "text/heap.h"
#include "scene/sections/sections.h"

enum { VERTICES_MOST = 16 };

/* u = constant + sum of weight * q, or an integral. */
struct dvi__probe {
  const dvi_field *field;
  const char *name;
  dvi__span span;      /* of the name */
  const dvi__tree *at; /* NULL for an integral */
  dvi__field_integral *integral;
  double point[DVI__PLACE_SPACE];
  int first; /* vertex of the cell, or -1 if this share has it not */
  int count;
  int unknown[VERTICES_MOST];
  double weight[VERTICES_MOST], constant;
};

static int probe_value(double t, const double *q, const double *p, double *value, void *user)
{
  const struct dvi__probe *probe = user;
  (void)t, (void)p;
  *value = probe->constant;
  for (int i = 0; i < probe->count; i++) *value += probe->weight[i] * q[probe->unknown[i]];
  return 0;
}

int dvi__field_sum_value(const dvi_field *field, int64_t count, const int *cell,
                         dvi_field_term *term, void *user, double *value)
{
  const dvi_status status = dvi_field_sum(field, count, cell, term, user, value);
  if (status == DVI_NOT_FINITE) *value = NAN;
  return status == DVI_OK || status == DVI_NOT_FINITE ? 0 : 1;
}

/* A probe of a state q. */
typedef struct state {
  const struct dvi__probe *probe;
  const double *q;
} state;

static int value_at(int64_t vertex, double *value, void *user)
{
  const state *of = user;
  (void)vertex;
  return probe_value(0, of->q, NULL, value, (void *)of->probe);
}

/* The owner of a cell's first vertex has all of the cell, and tells the other processes. */
static int shared_value(double t, const double *q, const double *p, double *value, void *user)
{
  state of = {user, q};
  (void)t, (void)p;
  return dvi__field_sum_value(of.probe->field, of.probe->first >= 0, &of.probe->first, value_at,
                              &of, value);
}

/* ---- reading ---- */

static bool read_probe(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                       struct dvi__probe *probe)
{
  static const char *const known[] = {"at", "integral", "over"};
  if (!dvi__want_name(scene, key->text, key->span) || !dvi__want_mapping(scene, tree, "a probe") ||
      !dvi__want_keys(scene, tree, "a probe", 3, known))
    return false;
  const dvi__tree *integral = dvi__tree_find(tree, "integral"),
                  *over = dvi__tree_find(tree, "over");
  probe->name = key->text;
  probe->span = key->span;
  probe->at = dvi__tree_find(tree, "at");
  if ((probe->at == NULL) == (integral == NULL) || (over != NULL && integral == NULL))
    return dvi__scene_refuse(scene, tree->span,
                             "a probe has a point, as in '{at: [0, 1]}', or an integral, as in "
                             "'{integral: u^2, over: all}'");
  if (integral == NULL)
    return dvi__point_read(scene, probe->at, scene->field->space, "a point", probe->point);
  return dvi__field_integral_read(scene, integral, over, &probe->integral);
}

bool dvi__read_probes(dvi_scene *scene, const dvi__tree *section)
{
  if (scene->density != NULL) return dvi__density_read_probes(scene, section);
  if (dvi__is_elastic(scene)) return dvi__elastic_read_probes(scene, section);
  if (scene->field->maxwell != NULL) return dvi__maxwell_read_probes(scene, section);
  if (!dvi__want_mapping(scene, section, "probes")) return false;
  struct dvi__probe *probe = dvi__arena_take(&scene->arena, (size_t)section->count + 1,
                                             sizeof *probe);
  if (probe == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!read_probe(scene, section->key[i], section->child[i], probe + i)) return false;
  scene->field->probe = probe;
  scene->field->probes = section->count;
  return true;
}

/* ---- making ---- */

/* Find the cell of a probe, which may be of another share, -1, and the weights of its vertices. */
static bool find_cell(dvi_scene *scene, const struct dvi__probe *probe, int *cell, double *weight)
{
  const dvi_status status = dvi_field_locate(scene->field->field, probe->point, cell, weight);
  if (status == DVI_BAD_ARGUMENT)
    return dvi__scene_refuse(scene, probe->at->span, "the probe '%s' is outside of the mesh",
                             probe->name);
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, probe->at->span, "%s", dvi_last_error());
}

/* Return the number of a vertex among the unknowns, or -1. */
static int number_of(const dvi_field *field, int vertex)
{
  int64_t unknowns, low = 0;
  const int *unknown = dvi_field_unknowns(field, &unknowns);
  int64_t high = unknowns;
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (unknown[middle] < vertex)
      low = middle + 1;
    else
      high = middle;
  }
  return low < unknowns && unknown[low] == vertex ? (int)low : -1;
}

/* Find the weights of a probe's cell one by one, as the values of functions that are 1 at one of
 * its vertices. Fixed vertices add to the constant. */
static bool place_probe(dvi_scene *scene, struct dvi__probe *probe, double *u)
{
  const struct dvi__scene_field *f = scene->field;
  int cell, width;
  double weight[DVI_MESH_DIMENSION_MAX + 1], value;
  probe->field = f->field;
  probe->first = -1;
  if (!find_cell(scene, probe, &cell, weight)) return false;
  if (cell < 0) return true;
  const int *vertex = dvi_mesh_vertices(f->mesh, dvi_mesh_dimension(f->mesh), &width);
  vertex += (ptrdiff_t)cell * width;
  probe->first = vertex[0];
  (void)dvi_field_lift(f->field, scene->zeros, u);
  dvi_status status = dvi_form_evaluate(f->mesh, 0, u, cell, weight, &probe->constant);
  memset(u, 0, (size_t)dvi_mesh_count(f->mesh, 0) * sizeof *u);
  for (int c = 0; c < width && status == DVI_OK; c++) {
    const int number = number_of(f->field, vertex[c]);
    if (number < 0) continue;
    u[vertex[c]] = 1;
    status = dvi_form_evaluate(f->mesh, 0, u, cell, weight, &value);
    u[vertex[c]] = 0;
    probe->unknown[probe->count] = number;
    probe->weight[probe->count++] = value;
  }
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, probe->at->span, "%s", dvi_last_error());
}

bool dvi__is_unknown(const char *name, char letter)
{
  if (strncmp(name, "p_", 2) == 0) name += 2;
  return name[0] == letter && name[1] == '_' && name[2] != 0 &&
         strspn(name + 2, "0123456789") == strlen(name + 2);
}

/* Refuse the name of another column. */
static bool name_is_new(dvi_scene *scene, const struct dvi__probe *probe)
{
  bool there = strcmp(probe->name, "t") == 0 || strcmp(probe->name, "energy") == 0 ||
               dvi__is_unknown(probe->name, 'u');
  for (int i = 0; i < scene->terms.symmetry_count; i++)
    there = there || strcmp(scene->terms.symmetries[i].name, probe->name) == 0;
  return !there ||
         dvi__scene_refuse(scene, probe->span,
                           "there is a column '%s' already; choose another name", probe->name);
}

bool dvi__probes_make(dvi_scene *scene)
{
  struct dvi__scene_field *f = scene->field;
  const size_t vertices = (size_t)dvi_mesh_count(f->mesh, 0);
  double *u = dvi__heap_take(vertices, sizeof *u);
  dvi_invariant *list = dvi__arena_take(&scene->arena, (size_t)f->probes + 1, sizeof *list);
  bool good = u != NULL && list != NULL;
  if (!good) (void)dvi__scene_no_memory(scene);
  for (int i = 0; i < f->probes && good; i++) {
    struct dvi__probe *probe = f->probe + i;
    const bool is_integral = probe->integral != NULL;
    good = name_is_new(scene, probe) &&
           (is_integral ? dvi__field_integral_make(scene, probe->integral)
                        : place_probe(scene, probe, u));
    list[i] = (dvi_invariant){.name = probe->name,
                              .value = is_integral            ? dvi__field_integral_value
                                       : dvi__is_share(scene) ? shared_value
                                                              : probe_value,
                              .user = is_integral ? (void *)probe->integral : probe};
  }
  dvi__heap_free(u);
  scene->terms.invariants = list;
  scene->terms.invariant_count = f->probes;
  return good;
}
