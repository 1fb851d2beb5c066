/* The section probes: values of the field at points, and integrals, watched along a run. A probe at
 * a point is a sum of the values at the vertices of the cell in which it is, by Whitney's
 * interpolation. */
#include <string.h>

#include "scene/field/maxwell.h"
#include "text/heap.h"
#include "scene/sections/sections.h"

enum { VERTICES_MOST = 16 };

/* u = constant + sum of weight * q, or an integral. */
struct dvi__probe {
  const char *name;
  dvi__span span;      /* of the name */
  const dvi__tree *at; /* NULL for an integral */
  dvi__field_integral *integral;
  double point[DVI__PLACE_SPACE];
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
  if (dvi__is_share(scene))
    return dvi__complain(scene->complaint, DVI_UNSUPPORTED, section->span,
                         "probes of a wave need the whole mesh, and this is the share of one of "
                         "several processes");
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

/* Find the weights of a probe's cell one by one, as the values of functions that are 1 at one of
 * its vertices. Fixed vertices add to the constant. */
static bool place_probe(dvi_scene *scene, struct dvi__probe *probe, double *u)
{
  const struct dvi__scene_field *f = scene->field;
  const int n = dvi_mesh_dimension(f->mesh);
  int cell, width;
  int64_t unknowns;
  double weight[DVI_MESH_DIMENSION_MAX + 1], value;
  dvi_status status = dvi_mesh_locate(f->mesh, 1, probe->point, &cell, weight);
  if (status != DVI_OK)
    return dvi__complain(scene->complaint, status, probe->at->span, "%s", dvi_last_error());
  if (cell < 0)
    return dvi__scene_refuse(scene, probe->at->span, "the probe '%s' is outside of the mesh",
                             probe->name);
  const int *vertex = dvi_mesh_vertices(f->mesh, n, &width) + (ptrdiff_t)cell * width,
            *unknown = dvi_field_unknowns(f->field, &unknowns);
  (void)dvi_field_lift(f->field, scene->zeros, u);
  status = dvi_form_evaluate(f->mesh, 0, u, cell, weight, &probe->constant);
  memset(u, 0, (size_t)dvi_mesh_count(f->mesh, 0) * sizeof *u);
  for (int c = 0; c < width && status == DVI_OK; c++) {
    int64_t low = 0, high = unknowns;
    while (low < high) {
      const int64_t middle = (low + high) / 2;
      if (unknown[middle] < vertex[c])
        low = middle + 1;
      else
        high = middle;
    }
    if (low == unknowns || unknown[low] != vertex[c]) continue;
    u[vertex[c]] = 1;
    status = dvi_form_evaluate(f->mesh, 0, u, cell, weight, &value);
    u[vertex[c]] = 0;
    probe->unknown[probe->count] = (int)low;
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
                              .value = is_integral ? dvi__field_integral_value : probe_value,
                              .user = is_integral ? (void *)probe->integral : probe};
  }
  dvi__heap_free(u);
  scene->terms.invariants = list;
  scene->terms.invariant_count = f->probes;
  return good;
}
