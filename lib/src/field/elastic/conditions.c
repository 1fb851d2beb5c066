/* Displacements that are given, and the numbers of those that are not. */
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/assemble.h"
#include "field/elastic/contacts.h"
#include "field/elastic/create.h"
#include "field/mesh/share.h"

/* ---- values ---- */

/* Give u and its rate [n] of a condition at a vertex. */
static int evaluate(const dvi_elastic *e, const dvi_elastic_condition *condition, int64_t vertex,
                    double t, double *u, double *rate)
{
  for (int i = 0; i < e->n; i++) u[i] = rate[i] = 0;
  if (condition->displacement == NULL) return 0;
  const int returned = condition->displacement(t, e->point + vertex * e->n, u, rate,
                                               condition->user);
  for (int i = 0; i < e->n && condition->is_steady; i++) rate[i] = 0;
  for (int i = 0; i < e->n && returned == 0; i++)
    if (!isfinite(u[i]) || !isfinite(rate[i])) return -1;
  return returned;
}

/* Give the depth of a node in an obstacle, beyond roundings, if what is given alone tells it. */
static double depth_of_given(const dvi_elastic *e, int64_t vertex, const double *u,
                             const dvi_obstacle *o)
{
  double x[DVI_ELASTIC_DIMENSION_MAX], normal[DVI_ELASTIC_DIMENSION_MAX], size = o->radius;
  for (int i = 0; i < e->n; i++) {
    const int is_given = e->condition[vertex * e->n + i] >= 0;
    if (!is_given && (o->kind != DVI_OBSTACLE_PLANE || o->normal[i] != 0)) return 0;
    x[i] = e->point[vertex * e->n + i] + (is_given ? u[i] : 0);
    size += fabs(x[i]) + fabs(o->point[i]);
  }
  return -dvi__solid_gap(o, e->n, x, normal) - 1e-12 * size;
}

/* Obstacles cannot hold a node that a condition moves. */
static int check_obstacles(const dvi_elastic *e, int64_t vertex, const double *u)
{
  for (int k = 0; k < e->obstacles && e->is_outer[vertex]; k++)
    if (dvi__solid_node_is_driven(e, vertex) && depth_of_given(e, vertex, u, e->obstacle + k) > 0)
      return dvi__return_because(DVI__GIVEN_INSIDE,
                                 "a displacement that is given moves %s into the obstacle \"%s\"",
                                 dvi__name_cell(e->mesh, 0, vertex).text, e->obstacle[k].name);
  return 0;
}

int dvi__solid_given(const dvi_elastic *e, int64_t vertex, double t, double *u, double *rate)
{
  const int n = e->n, *of = e->condition + vertex * n;
  for (int i = 0; i < n; i++) {
    double own[DVI_ELASTIC_DIMENSION_MAX], own_rate[DVI_ELASTIC_DIMENSION_MAX];
    int is_known = of[i] < 0;
    for (int j = 0; j < i; j++) is_known |= of[j] == of[i];
    if (is_known) continue;
    const int returned = evaluate(e, e->conditions + of[i], vertex, t, own, own_rate);
    if (returned != 0) return returned;
    for (int j = i; j < n; j++) {
      if (of[j] != of[i]) continue;
      u[j] = own[j];
      if (rate != NULL) rate[j] = own_rate[j];
    }
  }
  return check_obstacles(e, vertex, u);
}

dvi_status dvi__solid_refuse_given(const dvi_elastic *e, int64_t vertex, int returned)
{
  const dvi__cell_name name = dvi__name_cell(e->mesh, 0, vertex);
  if (returned == DVI__GIVEN_INSIDE) {
    char reason[DVI__SENTENCE_SIZE];
    dvi__take_reason(reason);
    return dvi__fail(DVI_CALLBACK_FAILED,
                     "elastic: %s: let it stop there, or leave the component along the obstacle's "
                     "normal free",
                     reason);
  }
  if (returned == -1)
    return dvi__fail(DVI_NOT_FINITE,
                     "elastic: a displacement that is given at %s, or its rate, is not finite, or "
                     "cannot be computed",
                     name.text);
  return dvi__fail(DVI_CALLBACK_FAILED, "elastic: a displacement that is given at %s returned %d",
                   name.text, returned);
}

/* ---- creation ---- */

static int is_time_dependent(const dvi_elastic_condition *condition)
{
  return condition->displacement != NULL && !condition->is_steady;
}

static dvi_status check(const dvi_elastic *e, const dvi_elastic_condition *condition)
{
  int64_t count;
  if (condition->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a condition has no part of the mesh");
  (void)dvi_mesh_part_cells(e->mesh, condition->part, 0, &count);
  if (e->n == 2 && condition->component[2] != 0)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "elastic: the condition on part \"%s\" is on component 2, but displacements in "
        "a plane have 0 and 1",
        condition->part);
  if (count >= 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "elastic: a condition is set on part \"%s\", which the mesh has not",
                   condition->part);
}

/* Of two conditions on a component the first counts. */
static void mark(dvi_elastic *e, int c)
{
  const dvi_elastic_condition *condition = e->conditions + c;
  int64_t count;
  const int *vertex = dvi_mesh_part_cells(e->mesh, condition->part, 0, &count);
  int are_all = 1;
  for (int i = 0; i < e->n; i++) are_all = are_all && condition->component[i] == 0;
  for (int64_t k = 0; k < count; k++)
    for (int i = 0; i < e->n; i++) {
      int *of = e->condition + (int64_t)vertex[k] * e->n + i;
      if ((are_all || condition->component[i] != 0) && *of < 0) *of = c;
    }
}

static void number(dvi_elastic *e)
{
  int count = 0;
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    e->unknown[k] = e->condition[k] < 0 ? count++ : -1;
  e->unknowns = count;
}

dvi_status dvi__solid_count_unknowns(dvi_elastic *e)
{
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    e->whole_unknowns += e->unknown[k] >= 0 && dvi__owns(e->mesh, 0, k / e->n);
  DVI_TRY(dvi__count_all(e->mesh, 1, &e->whole_unknowns));
  if (e->whole_unknowns > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "elastic: all displacements of the %lld vertices are given, and nothing is "
                   "unknown: hold a smaller part",
                   (long long)dvi__whole_count(e->mesh, 0));
}

/* Evaluate all conditions once, at time 0, and keep the values of those without time. */
static dvi_status evaluate_all(dvi_elastic *e)
{
  for (int64_t v = 0; v < e->vertices; v++) {
    double *u = e->steady + v * e->n;
    const int returned = dvi__solid_given(e, v, 0, u, NULL);
    if (returned != 0) return dvi__solid_refuse_given(e, v, returned);
    for (int i = 0; i < e->n; i++) {
      const int c = e->condition[v * e->n + i];
      if (c >= 0 && is_time_dependent(e->conditions + c)) u[i] = 0;
    }
  }
  return DVI_OK;
}

dvi_status dvi__solid_take_conditions(dvi_elastic *e, const dvi_elastic_terms *terms)
{
  if (terms->conditions < 0 || (terms->conditions > 0 && terms->condition == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: %d conditions, but none is given",
                     terms->conditions);
  if (e->vertices > INT_MAX / e->n)
    return dvi__fail(DVI_BAD_SIZE, "elastic: an int cannot number the displacements of %lld nodes",
                     (long long)e->vertices);
  e->conditions = DVI_NEW(dvi_elastic_condition, terms->conditions);
  e->unknown = DVI_NEW(int, e->vertices * e->n);
  e->condition = DVI_NEW(int, e->vertices * e->n);
  e->steady = DVI_NEW(double, e->vertices * e->n);
  if (!e->conditions || !e->unknown || !e->condition || !e->steady)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for conditions");
  for (int64_t k = 0; k < e->vertices * e->n; k++) e->condition[k] = -1;
  for (int c = 0; c < terms->conditions; c++) {
    const dvi_elastic_condition *condition = terms->condition + c;
    DVI_TRY(check(e, condition));
    e->conditions[c] = *condition;
    e->conditions[c].part = NULL;
    e->condition_count = c + 1;
    DVI_TRY(dvi__solid_copy_name(condition->part, &e->conditions[c].part));
    mark(e, c);
    e->is_driven |= is_time_dependent(condition);
  }
  number(e);
  return evaluate_all(e);
}
