#include "scene/terms/factors.h"

#include "scene/elaborate/model.h"

/* ---- factors ---- */

static int is_line(const dvi__coordinate *x)
{
  return x->kind == DVI__LINES;
}

/* Add a factor R^n of neighbouring numbers and vectors. */
static void add_lines(dvi_scene *scene, dvi_factor *factors, const dvi__coordinate *x)
{
  const int joins = x > scene->coordinate && is_line(x - 1);
  dvi_factor *factor = &factors[scene->terms.factor_count - joins];
  factor->kind = DVI_RN;
  factor->size += x->size * x->q.components;
  scene->terms.factor_count += !joins;
}

static size_t most_factors(const dvi_scene *scene)
{
  size_t most = 0;
  for (int k = 0; k < scene->coordinate_count; k++)
    most += is_line(&scene->coordinate[k]) ? 1U : (size_t)scene->coordinate[k].size;
  return most;
}

/* Make the factors, without masses. of[k] is the first one of coordinate k. */
static dvi_factor *lay_out(dvi_scene *scene, int *of)
{
  static const dvi_factor_kind kind[] = {DVI_RN, DVI_SO3, DVI_SE3, DVI_S2, DVI_U1};
  dvi_factor *factors = dvi__arena_take(&scene->arena, most_factors(scene), sizeof *factors);
  for (int k = 0; k < scene->coordinate_count && factors != NULL; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    of[k] = scene->terms.factor_count;
    if (is_line(x)) add_lines(scene, factors, x);
    for (int i = 0; i < x->size && !is_line(x); i++)
      factors[scene->terms.factor_count++].kind = kind[x->kind];
  }
  scene->terms.factors = factors;
  return factors;
}

/* ---- velocities of the state and their inertias ---- */

/* Refuse a product as omega(R)[1]*x', which has no constant mass. A coefficient that is constant in
 * omega(R) is not so in the rates of R, nor the other way round. */
static bool refuse_coupling(dvi_scene *scene, int state, int other)
{
  const int n = scene->n;
  const dvi__coordinate *a = &scene->coordinate[dvi__coordinate_at(scene, state - n, 1)],
                        *b =
                            &scene->coordinate[other < n ? dvi__coordinate_at(scene, other, 0)
                                                         : dvi__coordinate_at(scene, other - n, 1)];
  return dvi__scene_refuse(scene, a->span,
                           "in L %s(%s) is multiplied by the velocity of %s: what couples must "
                           "have constant coefficients in rates of "
                           "what is stored; say it by points, as (R*c)', of an angle (l*u)'",
                           a->kind == DVI__ANGLE ? "rate" : "omega", a->name, b->name);
}

/* Add an entry of an inertia, by the numbers `row` and `column` of v. */
static bool add_inertia(dvi_scene *scene, dvi_factor *factors, const int *of, int row, int column,
                        double value)
{
  const int k = dvi__coordinate_at(scene, row, 1);
  const dvi__coordinate *x = &scene->coordinate[k];
  const int member = (row - x->v.first) / x->v.stride, start = x->v.first + member * x->v.stride;
  if (column < start || column >= start + x->v.stride)
    return refuse_coupling(scene, scene->n + column, scene->n + row);
  dvi_factor *factor = &factors[of[k] + member];
  if (x->kind == DVI__ANGLE) {
    factor->mass = value;
    return value > 0 || dvi__scene_refuse(scene, x->span,
                                          "the moment of inertia of %s is %g, and must be positive",
                                          x->name, value);
  }
  double *J = (double *)factor->inertia;
  if (J == NULL) J = dvi__arena_take(&scene->arena, 9, sizeof *J);
  if (J == NULL) return dvi__scene_no_memory(scene);
  J[3 * (row - start) + column - start] = value;
  factor->inertia = J;
  return true;
}

/* ---- the form, entry by entry ---- */

/* The destinations of the entries of the mass. */
typedef struct parts {
  dvi_factor *factors;
  int *of, *start, *row, count; /* columns of the mass by stored numbers */
  double *value;
  char *heavy; /* [n + nv] 1 for columns that are not zero */
} parts;

static bool add_mass_entry(dvi_scene *scene, parts *to, int row, int column, double value)
{
  const int n = scene->n;
  if (!(value < 0) && !(value > 0)) return true;
  to->heavy[column] = 1;
  if (row >= n && column >= n)
    return add_inertia(scene, to->factors, to->of, row - n, column - n, value);
  if (row >= n || column >= n)
    return refuse_coupling(scene, row >= n ? row : column, row >= n ? column : row);
  to->row[to->count] = row;
  to->value[to->count++] = value;
  return true;
}

static bool add_columns(dvi_scene *scene, parts *to, const dvi_pattern *pattern,
                        const double *values)
{
  const int all = scene->velocities, full = pattern->start == NULL;
  bool good = true;
  for (int j = 0; j < all && good; j++) {
    const int first = full ? j * all : pattern->start[j],
              end = full ? first + all : pattern->start[j + 1];
    for (int e = first; e < end && good; e++)
      good = add_mass_entry(scene, to, full ? e - first : pattern->row[e], j, values[e]);
    if (j < scene->n) to->start[j + 1] = to->count;
  }
  return good;
}

/* Return 1 if any of some columns is heavy. */
static int any_is_heavy(const char *heavy, int count)
{
  int found = 0;
  for (int i = 0; i < count && !found; i++) found = heavy[i] != 0;
  return found;
}

/* Return true if all masses are there. Numbers have masses one by one, and a manifold coordinate
 * needs some mass at all. */
static bool is_heavy(const dvi_scene *scene, const dvi__coordinate *x, const char *heavy)
{
  const int numbers = is_line(x) ? 1 : x->q.components;
  for (int m = 0; m < x->size; m++)
    for (int k = 0; k < x->q.components; k += numbers) {
      const char *q = heavy + x->q.first + (ptrdiff_t)m * x->q.stride + k;
      const char *v = heavy + scene->n + x->v.first + (ptrdiff_t)m * x->v.stride;
      if (!any_is_heavy(q, numbers) && (is_line(x) || !any_is_heavy(v, x->v.components)))
        return false;
    }
  return true;
}

static bool all_are_heavy(dvi_scene *scene, const char *heavy)
{
  for (int k = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    for (int part = 0; part < (x->kind == DVI__MOTION ? 2 : 1); part++) {
      const dvi__coordinate *one = x->kind == DVI__MOTION ? &x->part[part] : x;
      if (is_heavy(scene, one, heavy)) continue;
      const char dot[3] = {one->part_name != 0 ? '.' : '\0', one->part_name, '\0'};
      return dvi__scene_refuse(
          scene, x->span, "the velocity of %s%s has no mass: L has no square of it", x->name, dot);
    }
  }
  return true;
}

bool dvi__make_factors(dvi_scene *scene, const dvi_pattern *pattern, const double *values)
{
  const size_t n = (size_t)scene->n, all = (size_t)scene->velocities;
  const size_t entries = pattern->start == NULL ? all * all : (size_t)pattern->start[all];
  parts to = {.of = dvi__arena_take(&scene->arena, (size_t)scene->coordinate_count, sizeof *to.of),
              .start = dvi__arena_take(&scene->arena, n + 1, sizeof *to.start),
              .row = dvi__arena_take(&scene->arena, entries + 1, sizeof *to.row),
              .value = dvi__arena_take(&scene->arena, entries + 1, sizeof *to.value),
              .heavy = dvi__arena_take(&scene->arena, all, 1)};
  if (to.of == NULL || to.start == NULL || to.row == NULL || to.value == NULL || to.heavy == NULL)
    return dvi__scene_no_memory(scene);
  to.factors = lay_out(scene, to.of);
  if (to.factors == NULL) return dvi__scene_no_memory(scene);
  if (!add_columns(scene, &to, pattern, values) || !all_are_heavy(scene, to.heavy)) return false;
  if (to.count > 0)
    scene->terms.mass = (dvi_mass){.values = to.value, .pattern = {to.start, to.row}};
  scene->mass = to.count > 0 ? "sparse" : "inertias";
  return true;
}

/* ---- inertias ---- */

/* Return 1 if a body could have this inertia, so that a system could be made of it alone. */
static int is_of_body(const dvi_factor *factor)
{
  dvi_system *alone;
  const dvi_factor turning = {.kind = DVI_SO3, .inertia = factor->inertia};
  const dvi_system_terms terms = {.factors = &turning, .factor_count = 1, .autonomous = 1};
  const dvi_status status = dvi_system_create(&terms, &alone);
  dvi_system_destroy(&alone);
  return status != DVI_BAD_ARGUMENT;
}

bool dvi__inertias_are_of_bodies(dvi_scene *scene)
{
  for (int k = 0, f = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    const int has_inertia = x->kind == DVI__ROTATION || x->kind == DVI__MOTION,
              joined = is_line(x) && k > 0 && is_line(x - 1);
    for (int i = 0; i < x->size && has_inertia; i++)
      if (scene->terms.factors[f + i].inertia != NULL && !is_of_body(&scene->terms.factors[f + i]))
        return dvi__scene_refuse(scene, x->span,
                                 "the inertia of %s is that of no body: its principal moments must "
                                 "be positive, and none larger "
                                 "than the sum of the others",
                                 x->name);
    f += is_line(x) ? !joined : x->size;
  }
  return true;
}
