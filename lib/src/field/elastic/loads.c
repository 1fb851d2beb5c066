/* Loads of cells and of facets of the boundary, and obstacles. Those of a node are the parts of its
 * cells and facets, each with the value at the centre. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/cell.h"
#include "field/elastic/create.h"
#include "field/mesh/normal.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

/* ---- one load ---- */

static dvi_status check_load(const dvi_elastic *e, const dvi_elastic_load *load)
{
  if (load->part == NULL || load->force == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a load has no %s",
                     load->part == NULL ? "part of the mesh" : "force");
  const int64_t count = dvi__part_total(e->mesh, load->part, e->n - 1);
  if (count <= 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: a load is set on part \"%s\", %s: name a part of %s, or of %s of "
                     "the boundary",
                     load->part, count < 0 ? "which the mesh has not" : "which has neither",
                     e->n == 3 ? "tetrahedra" : "triangles", e->n == 3 ? "triangles" : "edges");
  return DVI_OK;
}

/* Return the cells of a load's part, or its facets. */
static const int *cells_of(const dvi_elastic *e, const dvi_elastic_load *load, int *is_facet,
                           int64_t *count)
{
  const int *cell = dvi_mesh_part_cells(e->mesh, load->part, e->n, count);
  *is_facet = dvi__part_total(e->mesh, load->part, e->n) == 0;
  return *is_facet ? dvi_mesh_part_cells(e->mesh, load->part, e->n - 1, count) : cell;
}

/* Return whether a displacement of the nodes of a facet is unknown. */
static int is_movable(const dvi_elastic *e, int facet)
{
  const int n = e->n, *vertex = e->mesh->corner[n - 1] + (int64_t)facet * n;
  for (int k = 0; k < n * n; k++)
    if (e->unknown[(int64_t)vertex[k / n] * n + k % n] >= 0) return 1;
  return 0;
}

/* A traction acts on facets of the boundary. */
static dvi_status check_facets(const dvi_elastic *e, const dvi_elastic_load *load)
{
  int is_facet;
  int64_t count;
  const int *facet = cells_of(e, load, &is_facet, &count);
  for (int64_t i = 0; i < count && is_facet; i++) {
    if (dvi__is_outer(e->mesh, facet[i])) continue;
    const dvi__cell_name name = dvi__name_cell(e->mesh, e->n - 1, facet[i]);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: the load on part \"%s\" acts on %s, which is not at the boundary: "
                     "name a part of the boundary",
                     load->part, name.text);
  }
  return DVI_OK;
}

/* A traction moves something. */
static dvi_status check_effect(const dvi_elastic *e, const dvi_elastic_load *load)
{
  int is_facet;
  int64_t count, movable = 0;
  const int *facet = cells_of(e, load, &is_facet, &count);
  for (int64_t i = 0; i < count && is_facet; i++) movable += is_movable(e, facet[i]);
  DVI_TRY(dvi__count_all(e->mesh, 1, &movable));
  if (movable > 0 || !is_facet) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "elastic: the load on part \"%s\" does nothing, because all displacements there "
                   "are given: leave it out, or hold a component less",
                   load->part);
}

static void set_load(const dvi_elastic *e, int load, int is_facet, int number, dvi__solid_load *of)
{
  const int n = e->n;
  const int64_t cell = is_facet ? e->mesh->coface[2 * (int64_t)number] : number;
  const int *vertex = e->vertex + cell * (n + 1),
            *corner = is_facet ? e->mesh->corner[n - 1] + (int64_t)number * n : vertex;
  const int nodes = is_facet ? n : n + 1;
  *of = (dvi__solid_load){.load = load, .is_facet = is_facet};
  of->weight = dvi__cell_volume(e->mesh, is_facet ? n - 1 : n, number) / nodes;
  for (int a = 0; a <= n; a++)
    for (int b = 0; b < nodes; b++) {
      if (vertex[a] != corner[b]) continue;
      of->nodes |= 1U << a;
      for (int i = 0; i < n; i++) of->at[i] += e->point[(int64_t)vertex[a] * n + i] / nodes;
    }
  if (is_facet) dvi__facet_normal(e->mesh, number, cell, of->normal);
}

/* ---- all loads ---- */

/* Count the loads of each cell, or place them if there is room. */
static void place(dvi_elastic *e, int64_t *next)
{
  for (int l = 0; l < e->load_count; l++) {
    int is_facet;
    int64_t count;
    const int *number = cells_of(e, e->loads + l, &is_facet, &count);
    for (int64_t i = 0; i < count; i++) {
      const int64_t cell = is_facet ? e->mesh->coface[2 * (int64_t)number[i]] : number[i];
      if (e->load_of != NULL) set_load(e, l, is_facet, number[i], e->load_of + next[cell]);
      next[cell]++;
    }
  }
}

/* After the second pass each start is that of the next cell. */
static dvi_status distribute(dvi_elastic *e)
{
  int64_t *start = e->load_start = DVI_NEW(int64_t, e->cells + 1), sum = 0;
  if (start == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for loads");
  place(e, start);
  for (int64_t c = 0; c <= e->cells; c++) {
    const int64_t count = start[c];
    start[c] = sum;
    sum += count;
  }
  e->load_of = DVI_NEW(dvi__solid_load, sum);
  if (e->load_of == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for loads");
  place(e, start);
  memmove(start + 1, start, (size_t)e->cells * sizeof *start);
  start[0] = 0;
  return DVI_OK;
}

static dvi_status evaluate_all(const dvi_elastic *e)
{
  for (int64_t c = 0; c < e->cells; c++) {
    double f[DVI__SOLID_NUMBERS] = {0};
    const int returned = dvi__solid_add_load(e, c, 0, f);
    const dvi__cell_name name = dvi__name_cell(e->mesh, e->n, c);
    if (returned != 0)
      return dvi__fail(DVI_CALLBACK_FAILED, "elastic: a load returned %d at %s", returned,
                       name.text);
    for (int k = 0; k < (e->n + 1) * e->n; k++)
      if (!isfinite(f[k]))
        return dvi__fail(DVI_NOT_FINITE, "elastic: a load at %s is not finite", name.text);
  }
  return DVI_OK;
}

dvi_status dvi__solid_take_loads(dvi_elastic *e, const dvi_elastic_terms *terms)
{
  e->has_steady_loads = 1;
  if (terms->loads < 0 || (terms->loads > 0 && terms->load == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: %d loads, but none is given", terms->loads);
  if (terms->loads == 0) return DVI_OK;
  e->loads = DVI_NEW(dvi_elastic_load, terms->loads);
  if (e->loads == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for loads");
  for (int l = 0; l < terms->loads; l++) {
    const dvi_elastic_load *load = terms->load + l;
    DVI_TRY(check_load(e, load));
    DVI_TRY(check_facets(e, load));
    e->loads[l] = *load;
    e->loads[l].part = NULL;
    e->load_count = l + 1;
    DVI_TRY(dvi__solid_copy_name(load->part, &e->loads[l].part));
    e->has_steady_loads = e->has_steady_loads && load->is_steady;
  }
  DVI_TRY(distribute(e));
  return evaluate_all(e);
}

dvi_status dvi__solid_check_loads(const dvi_elastic *e)
{
  for (int l = 0; l < e->load_count; l++) DVI_TRY(check_effect(e, e->loads + l));
  return DVI_OK;
}

/* ---- obstacles ---- */

static dvi_status refuse_obstacle(const dvi_obstacle *o, const char *what, double value,
                                  const char *range)
{
  return dvi__fail(DVI_BAD_ARGUMENT, "elastic: the %s of obstacle \"%s\" is %g; %s is needed", what,
                   o->name, value, range);
}

/* Check an obstacle, and make the length of its normal 1. */
static dvi_status check_obstacle(int n, dvi_obstacle *o)
{
  double length = 0;
  if (o->kind != DVI_OBSTACLE_PLANE && o->kind != DVI_OBSTACLE_BALL &&
      o->kind != DVI_OBSTACLE_HOLLOW)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: obstacle \"%s\" has no kind %d", o->name,
                     (int)o->kind);
  for (int i = 0; i < n; i++) {
    if (!isfinite(o->point[i]))
      return refuse_obstacle(o, "point", o->point[i], "a place of finite coordinates");
    length = hypot(length, o->normal[i]);
  }
  if (o->kind == DVI_OBSTACLE_PLANE && !(length > 0 && isfinite(length)))
    return refuse_obstacle(o, "length of the normal", length, "a finite one above 0");
  if (o->kind != DVI_OBSTACLE_PLANE && !(o->radius > 0 && isfinite(o->radius)))
    return refuse_obstacle(o, "radius", o->radius, "a finite one above 0");
  if (!(o->restitution >= 0 && o->restitution <= 1))
    return refuse_obstacle(o, "restitution", o->restitution, "a number from 0 to 1");
  if (!(o->friction >= 0 && isfinite(o->friction)))
    return refuse_obstacle(o, "friction", o->friction, "a finite number of at least 0");
  for (int i = 0; i < n && o->kind == DVI_OBSTACLE_PLANE; i++) o->normal[i] /= length;
  return DVI_OK;
}

static void mark_outer(dvi_elastic *e)
{
  int64_t count;
  const int *vertex = dvi_mesh_part_cells(e->mesh, "boundary", 0, &count);
  for (int64_t i = 0; i < count; i++) e->is_outer[vertex[i]] = 1;
}

dvi_status dvi__solid_take_obstacles(dvi_elastic *e, const dvi_elastic_terms *terms)
{
  if (terms->obstacles < 0 || (terms->obstacles > 0 && terms->obstacle == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: %d obstacles, but none is given",
                     terms->obstacles);
  if (terms->obstacles > 0) DVI_TRY(dvi__refuse_share(e->mesh, "elastic: an obstacle"));
  e->obstacle = DVI_NEW(dvi_obstacle, terms->obstacles);
  e->is_outer = DVI_NEW(int8_t, e->vertices);
  if (e->obstacle == NULL || e->is_outer == NULL)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for obstacles");
  mark_outer(e);
  for (int i = 0; i < terms->obstacles; i++) {
    dvi_obstacle *o = e->obstacle + i;
    *o = terms->obstacle[i];
    o->name = NULL;
    e->obstacles = i + 1;
    if (terms->obstacle[i].name == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "elastic: obstacle %d has no name", i);
    DVI_TRY(dvi__solid_copy_name(terms->obstacle[i].name, &o->name));
    DVI_TRY(check_obstacle(e->n, o));
  }
  return DVI_OK;
}
