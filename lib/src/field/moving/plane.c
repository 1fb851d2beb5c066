/* The nodes and cells of a mesh of triangles, and what its boundary knows. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/mesh.h"
#include "field/mesh/share.h"
#include "field/moving/moving.h"

enum { AXES = 2, CORNERS };

static dvi_status no_memory(const dvi_moving *m)
{
  return dvi__fail(DVI_NO_MEMORY, "moving: no memory for %d triangles", m->cells);
}

/* ---- nodes and cells ---- */

static dvi_status check_jump(const dvi_moving *m)
{
  for (int k = 0; k < AXES * m->components; k++)
    if (m->mesh->period[k / m->components] == 0 && fabs(m->jump[k]) > 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "moving: a jump of %g along %c needs a mesh that is periodic along it",
                       m->jump[k], "xy"[k / m->components]);
  return DVI_OK;
}

static dvi_status check_mesh(const dvi_mesh *mesh)
{
  if (mesh->kind != DVI_SIMPLICES || mesh->n != AXES || mesh->space != AXES)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "moving: the mesh has %s of dimension %d in a space of %d, but cells that move "
        "are triangles in a plane",
        mesh->kind == DVI_SIMPLICES ? "simplices" : "boxes", mesh->n, mesh->space);
  if (mesh->count[0] > INT_MAX / (2 * DVI__NODE_NUMBERS) || mesh->count[2] > INT_MAX / 16)
    return dvi__fail(DVI_BAD_SIZE, "moving: a mesh of %lld triangles is too large",
                     (long long)mesh->count[2]);
  return DVI_OK;
}

/* Set the corners of a cell, images next to its first one, counterclockwise. Return its area. */
static double take_cell(dvi_moving *m, int cell)
{
  const int *vertex = m->mesh->corner[AXES] + (size_t)cell * CORNERS;
  dvi__corner *corner = m->cell.corner + (size_t)cell * CORNERS;
  double y[CORNERS * DVI__NODE_NUMBERS];
  for (int a = 0; a < CORNERS; a++) {
    corner[a] = (dvi__corner){.node = vertex[a]};
    for (int i = 0; i < AXES && m->period[i] > 0; i++) {
      const double *x = m->node + i * m->listed;
      corner[a].turn[i] = (int)lround((x[vertex[0]] - x[vertex[a]]) / m->period[i]);
    }
    dvi__moving_reference(m, corner + a, y + a * m->numbers);
  }
  const double area = dvi__moving_volume(m, y);
  if (area > 0) return area;
  const dvi__corner last = corner[2];
  corner[2] = corner[1];
  corner[1] = last;
  return -area;
}

/* ---- the boundary ---- */

/* Hold nodes of the boundary. Those that slide are held across their edges, along an axis. */
static void hold(const dvi_moving_terms *terms, dvi_moving *m)
{
  int64_t edges;
  const int *edge = dvi_mesh_part_cells(m->mesh, "boundary", 1, &edges);
  for (int64_t e = 0; e < edges; e++) {
    const int *end = m->mesh->corner[1] + 2 * (size_t)edge[e];
    double along[DVI_MESH_SPACE_MAX];
    dvi__mesh_difference(m->mesh, end[0], end[1], along);
    for (int i = 0; i < AXES; i++)
      for (int a = 0; a < 2 && !(terms->slide && along[1 - i] == 0); a++)
        m->unknown[end[a] * m->numbers + i] = -1;
  }
}

static dvi_status check_condition(const dvi_moving *m, const dvi_density_condition *c, int i)
{
  int64_t count;
  if (c->part == NULL || dvi_mesh_part_cells(m->mesh, c->part, 0, &count) == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: condition %d is set on \"%s\", which is no part of "
                     "the mesh",
                     i, c->part != NULL ? c->part : "");
  if (c->component < -1 || c->component >= m->components)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the condition on \"%s\" is of component %d of %d",
                     c->part, c->component, m->components);
  if (c->kind != DVI_FREE && c->kind != DVI_FIXED)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the condition on \"%s\" has no kind %d", c->part,
                     (int)c->kind);
  if (c->robin != 0 || c->rate != NULL || (c->kind == DVI_FREE && c->datum != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: the condition on \"%s\" has a flux, a rate or robin, but nodes that "
                     "move know values at rest alone: leave it out",
                     c->part);
  return DVI_OK;
}

static dvi_status fix_node(dvi_moving *m, const dvi_density_condition *condition, int node)
{
  double X[AXES], value = 0;
  dvi__moving_reference(m, &(dvi__corner){.node = node}, X);
  const int returned = condition->datum != NULL ? condition->datum(1, 0, X, &value, condition->user)
                                                : 0;
  if (returned != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "moving: the datum on \"%s\" returned %d",
                     condition->part, returned);
  if (!isfinite(value))
    return dvi__fail(DVI_NOT_FINITE, "moving: the datum on \"%s\" is %g at (%.6g, %.6g)",
                     condition->part, value, X[0], X[1]);
  for (int c = 0; c < m->components; c++) {
    const int at = node * m->numbers + AXES + c;
    if (condition->component >= 0 && condition->component != c) continue;
    m->unknown[at] = -1;
    m->known[at] = value;
  }
  return DVI_OK;
}

static dvi_status bound(const dvi_moving_terms *terms, dvi_moving *m)
{
  m->unknown = DVI_NEW(int, m->nodes * m->numbers);
  m->known = DVI_NEW(double, m->nodes * m->numbers);
  if (m->unknown == NULL || m->known == NULL) return no_memory(m);
  for (int k = 0; k < m->nodes * AXES; k++) {
    const int node = k / AXES, i = k % AXES;
    m->known[node * m->numbers + i] = m->node[i * m->listed + node];
    if (!dvi__moving_is_free(m)) m->unknown[node * m->numbers + i] = -1;
  }
  hold(terms, m);
  for (int i = 0; i < terms->conditions; i++) {
    const dvi_density_condition *condition = terms->condition + i;
    DVI_TRY(check_condition(m, condition, i));
    if (condition->kind == DVI_FREE) continue;
    int64_t count;
    const int *node = dvi_mesh_part_cells(m->mesh, condition->part, 0, &count);
    for (int64_t k = 0; k < count; k++) DVI_TRY(fix_node(m, condition, node[k]));
  }
  return DVI_OK;
}

dvi_status dvi__moving_take_mesh(const dvi_moving_terms *terms, dvi_moving *m)
{
  DVI_TRY(check_mesh(terms->mesh));
  DVI_TRY(dvi__refuse_share(terms->mesh, "moving: a density"));
  m->mesh = dvi_mesh_share(terms->mesh);
  DVI_TRY(check_jump(m));
  m->cells = (int)m->mesh->count[AXES];
  m->nodes = m->listed = (int)m->mesh->count[0];
  memcpy(m->period, m->mesh->period, sizeof m->period);
  m->node = DVI_NEW(double, AXES * m->listed);
  m->cell = (dvi__stencils){
      .count = m->cells, .nodes = CORNERS, .corner = DVI_NEW(dvi__corner, CORNERS * m->cells)};
  if (m->node == NULL || m->cell.corner == NULL) return no_memory(m);
  for (int k = 0; k < m->nodes * AXES; k++)
    m->node[k % AXES * m->listed + k / AXES] = m->mesh->point[k];
  for (int cell = 0; cell < m->cells; cell++) m->volume += take_cell(m, cell);
  return bound(terms, m);
}
