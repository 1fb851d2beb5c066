/* The section probes: values of expressions at points, and integrals of expressions over the
 * domain, by the quadrature of the space. They are watched along a run. */
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/columns.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

struct dvi__density_probe {
  const char *name;
  dvi__span span;
  const dvi_scene *scene;
  dvi__local *function;
  bool is_integral, has_rates;
  double point[DVI_AXES_MAX];
  int node; /* of a field of rotations */
};

/* ---- reading ---- */

/* Read a field at a point, u(0.5) or u(0.5, 1). */
static bool read_call(dvi_scene *scene, const dvi__tree *tree, struct dvi__density_probe *probe)
{
  const dvi__expression *e;
  const int axes = scene->density->jets.dimension;
  if (!dvi__tree_expression(scene, tree, &e)) return false;
  const dvi__declared_field *field = e->form == DVI__FORM_CALL ? dvi__field_named(scene, e->name)
                                                               : NULL;
  if (field == NULL || e->count != axes)
    return dvi__scene_refuse(scene, tree->span,
                             "a probe is a field at a point, as in 'u(%s)', an expression there, "
                             "'{of: EXPR, at: POINT}', or '{integral: EXPR}'",
                             axes == 1   ? "0.5"
                             : axes == 2 ? "0.5, 1"
                                         : "0.5, 1, 2");
  for (int d = 0; d < axes; d++) {
    const dvi__tree one = {.kind = DVI__SCALAR, .span = e->part[d]->span};
    if (!dvi__tree_number(scene, &one, "a coordinate", probe->point + d)) return false;
  }
  const dvi__tree name = {.kind = DVI__SCALAR, .span = {e->span.first, strlen(e->name)}};
  return dvi__local_read(scene, &name, DVI__OF_FIELD, "a probe", 1, &probe->function);
}

static bool read_mapping(dvi_scene *scene, const dvi__tree *tree, struct dvi__density_probe *probe)
{
  static const char *const known[] = {"at", "of", "integral"};
  if (!dvi__want_keys(scene, tree, "a probe", 3, known)) return false;
  const dvi__tree *at = dvi__tree_find(tree, "at"), *of = dvi__tree_find(tree, "of"),
                  *integral = dvi__tree_find(tree, "integral");
  if (integral != NULL ? at != NULL || of != NULL : at == NULL || of == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a probe has an expression and a point, as in '{of: d(u,x), at: "
                             "0.5}', or an integral, as in '{integral: u^2}'");
  probe->is_integral = integral != NULL;
  return (at == NULL ||
          dvi__point_read(scene, at, scene->density->jets.dimension, "a point", probe->point)) &&
         dvi__local_read(scene, integral != NULL ? integral : of, DVI__OF_FIELD | DVI__MENTIONS_T,
                         integral != NULL ? "an integral" : "a probe", 1, &probe->function);
}

static bool read_probe(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                       struct dvi__density_probe *probe)
{
  probe->name = key->text;
  probe->span = key->span;
  probe->scene = scene;
  if (!dvi__want_name(scene, key->text, key->span)) return false;
  if (!(tree->kind == DVI__MAPPING ? read_mapping(scene, tree, probe)
                                   : read_call(scene, tree, probe)))
    return false;
  for (int k = 0; k < probe->function->variables; k++)
    probe->has_rates = probe->has_rates || probe->function->variable[k].rate;
  return true;
}

bool dvi__density_read_probes(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_density *s = scene->density;
  if (!dvi__want_mapping(scene, section, "probes")) return false;
  s->probe = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *s->probe);
  if (s->probe == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!read_probe(scene, section->key[i], section->child[i], s->probe + i)) return false;
  s->probes = section->count;
  return true;
}

/* ---- values ---- */

/* The state as coefficients, and the variables of the function at all points. */
typedef struct state {
  double *U, *rate, *z, *f;
} state;

dvi_status dvi__density_velocity(const dvi_scene *scene, double t, const double *q, const double *p,
                                 double **v)
{
  const dvi_system *system = dvi_scene_system(scene);
  *v = dvi__heap_take((size_t)scene->nv, sizeof **v);
  if (*v == NULL) return DVI_NO_MEMORY;
  return system == NULL ? DVI_UNSUPPORTED : dvi_system_velocity(system, t, q, p, *v);
}

/* Find the rates of all coefficients. */
static dvi_status find_rates(const dvi_scene *scene, double t, const double *q, const double *p,
                             double *rate)
{
  double *v;
  dvi_status status = dvi__density_velocity(scene, t, q, p, &v);
  if (status == DVI_OK) status = dvi_density_lift_rate(scene->density->density, t, v, rate);
  dvi__heap_free(v);
  return status;
}

static dvi_status find_variables(const struct dvi__density_probe *probe, int64_t points,
                                 const state *at)
{
  const struct dvi__scene_density *s = probe->scene->density;
  dvi_status status = DVI_OK;
  for (int k = 0; k < probe->function->variables && status == DVI_OK; k++) {
    const dvi_jet *jet = probe->function->variable + k;
    const double *of = (jet->rate ? at->rate : at->U) + jet->component * s->functions;
    double *values = at->z + k * points;
    status = probe->is_integral
                 ? dvi_space_apply(s->space, jet->order, of, values)
                 : dvi_space_evaluate(s->space, jet->order, of, 1, probe->point, values);
  }
  return status;
}

static int evaluate(const struct dvi__density_probe *probe, double t, int64_t points,
                    const double *x, const double *weight, const state *at, double *value)
{
  const dvi__local *f = probe->function;
  int failed = 0;
  *value = 0;
  for (int k = 0; k < points; k++) at->f[k] = 0;
  if (f->term != NULL)
    failed = dvi__local_density((int)points, t, x, at->z, at->f, NULL, NULL, (void *)f);
  for (int64_t k = 0; k < points && failed == 0; k++) *value += weight[k] * at->f[k];
  return failed;
}

static int probe_value(double t, const double *q, const double *p, double *value, void *user)
{
  static const double one = 1;
  const struct dvi__density_probe *probe = user;
  const struct dvi__scene_density *s = probe->scene->density;
  const double *x = probe->point, *weight = &one;
  const int64_t points = probe->is_integral ? dvi_space_points(s->space, &x, &weight) : 1;
  const size_t coefficients = (size_t)(s->jets.components * s->functions),
               variables = (size_t)probe->function->variables + 1;
  double *room = dvi__heap_take(2 * coefficients + variables * (size_t)points, sizeof *room);
  if (room == NULL) return DVI_NO_MEMORY;
  const state at = {room, room + coefficients, room + 2 * coefficients + points,
                    room + 2 * coefficients};
  dvi_status status = dvi_density_lift(s->density, t, q, at.U);
  if (status == DVI_OK && probe->has_rates) status = find_rates(probe->scene, t, q, p, at.rate);
  if (status == DVI_OK) status = find_variables(probe, points, &at);
  const int failed = status != DVI_OK ? (int)status
                                      : evaluate(probe, t, points, x, weight, &at, value);
  dvi__heap_free(room);
  return failed;
}

/* ---- making ---- */

/* Refuse derivatives that the space does not have. */
static bool check_order(dvi_scene *scene, const dvi__local *f, int k)
{
  const dvi_space *space = scene->density->space;
  for (int d = 0; d < scene->jets->dimension; d++)
    if (f->variable[k].order[d] > dvi_space_smoothness(space, d))
      return dvi__refuse_order(scene, f, k, d);
  return true;
}

/* A probe of a field on a mesh that moves. */
static int moving_value(double t, const double *q, const double *p, double *value, void *user)
{
  const struct dvi__density_probe *probe = user;
  return dvi__moving_value(probe->scene, probe->function, probe->has_rates, t, q, p,
                           probe->is_integral ? NULL : probe->point, value);
}

/* A probe of a field of rotations. */
static int turning_value(double t, const double *q, const double *p, double *value, void *user)
{
  const struct dvi__density_probe *probe = user;
  return dvi__rotations_value(probe->scene, probe->function, t, probe->node, q, p, value);
}

static bool try_turning(dvi_scene *scene, struct dvi__density_probe *probe)
{
  if (probe->is_integral)
    return dvi__scene_refuse(scene, probe->span,
                             "a field of rotations has probes at nodes, and no integrals, as in "
                             "'{of: \"%s[1,1]\", at: POINT}'",
                             scene->density->field->name);
  return dvi__rotations_check_probe(scene, probe->function, probe->name, probe->span, probe->point,
                                    &probe->node);
}

static bool try_probe(dvi_scene *scene, struct dvi__density_probe *probe)
{
  const struct dvi__scene_density *s = scene->density;
  if (s->moving != NULL)
    return dvi__moving_check_probe(scene, probe->function, probe->is_integral ? NULL : probe->point,
                                   probe->name, probe->span);
  if (s->rotations != NULL) return try_turning(scene, probe);
  const int none[DVI_AXES_MAX] = {0};
  double *U = dvi__heap_take((size_t)s->functions, sizeof *U), value;
  if (U == NULL) return dvi__scene_no_memory(scene);
  const dvi_status status = probe->is_integral
                                ? DVI_OK
                                : dvi_space_evaluate(s->space, none, U, 1, probe->point, &value);
  dvi__heap_free(U);
  if (status != DVI_OK)
    return dvi__complain(scene->complaint, status, probe->span, "the probe '%s': %s", probe->name,
                         dvi_last_error());
  for (int k = 0; k < probe->function->variables; k++)
    if (!check_order(scene, probe->function, k)) return false;
  return true;
}

static bool name_is_new(dvi_scene *scene, const struct dvi__density_probe *probe)
{
  for (int i = 0; i < scene->terms.symmetry_count; i++)
    if (strcmp(scene->terms.symmetries[i].name, probe->name) == 0)
      return dvi__scene_refuse(scene, probe->span,
                               "there is a column '%s' already; choose another name", probe->name);
  return dvi__column_is_new(scene, probe->name, probe->span, NULL);
}

bool dvi__density_make_probes(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  dvi_invariant *list = dvi__arena_take(&scene->arena, (size_t)s->probes + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < s->probes; i++) {
    struct dvi__density_probe *probe = s->probe + i;
    if (!name_is_new(scene, probe) || !try_probe(scene, probe)) return false;
    list[i] = (dvi_invariant){.name = probe->name,
                              .value = s->moving != NULL      ? moving_value
                                       : s->rotations != NULL ? turning_value
                                                              : probe_value,
                              .user = probe};
  }
  scene->terms.invariants = list;
  scene->terms.invariant_count = s->probes;
  return true;
}
