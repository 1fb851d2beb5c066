/* Positions and values of a state, and the field at points. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

dvi_status dvi_moving_lift(const dvi_moving *moving, double t, const double *q, double *x,
                           double *u)
{
  if (moving == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and coordinates are needed");
  const dvi__moving_state state = {.t = t, .q = q};
  const int nodes = moving->listed, n = moving->dimension;
  for (int k = 0; k < nodes; k++) {
    double y[2 * DVI__NODE_NUMBERS];
    const dvi__corner corner = n == 1 ? dvi__moving_corner(moving, k) : (dvi__corner){.node = k};
    const int returned = dvi__moving_gather(moving, &state, &corner, 1, y);
    if (returned != 0) return dvi__moving_refuse(DVI_CALLBACK_FAILED, returned);
    for (int i = 0; i < n && x != NULL; i++) x[i * nodes + k] = y[i];
    for (int c = 0; c < moving->components && u != NULL; c++) u[c * nodes + k] = y[n + c];
  }
  return DVI_OK;
}

/* ---- cells that contain points ---- */

/* Find the cell of a point among ascending nodes, or -1. */
static int find_cell(int cells, const double *node, double x)
{
  int first = 0, last = cells;
  if (!(x >= node[0] && x <= node[cells])) return -1;
  while (last - first > 1) {
    const int middle = first + (last - first) / 2;
    if (x < node[middle])
      last = middle;
    else
      first = middle;
  }
  return first;
}

static void find_on_axis(const dvi_moving *m, const double *node, int64_t count, const double *x,
                         int *cell)
{
  for (int64_t k = 0; k < count; k++) {
    const double turn = m->periodic ? floor((x[k] - node[0]) / m->volume) : 0;
    const double shifted = x[k] - turn * m->volume;
    const int repeats = m->periodic && isfinite(shifted);
    cell[k] = find_cell(m->cells, node,
                        repeats ? fmin(fmax(shifted, node[0]), node[m->cells]) : x[k]);
  }
}

static dvi_status find_in_plane(const dvi_moving *m, const double *node, int64_t count,
                                const double *x, int *cell)
{
  dvi_mesh *mesh = NULL;
  double *point = DVI_NEW(double, 5 * (size_t)count);
  dvi_status status = point != NULL ? dvi__moving_mesh_of(m, node, &mesh) : DVI_NO_MEMORY;
  for (int64_t k = 0; k < 2 * count && status == DVI_OK; k++) point[k] = x[k % 2 * count + k / 2];
  if (status == DVI_OK) status = dvi_mesh_locate(mesh, count, point, cell, point + 2 * count);
  dvi_mesh_destroy(&mesh);
  dvi__release(point);
  return point != NULL ? status : dvi__fail(DVI_NO_MEMORY, "moving: no memory for points");
}

dvi_status dvi__moving_find_cells(const dvi_moving *m, const double *node, int64_t count,
                                  const double *x, int *cell)
{
  if (m->dimension == 2) return find_in_plane(m, node, count, x, cell);
  find_on_axis(m, node, count, x, cell);
  return DVI_OK;
}

dvi_status dvi__moving_refuse_point(const dvi_moving *m, const double *node, const double *x,
                                    int64_t stride)
{
  if (m->dimension == 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the point x = %.6g is outside of %.6g to %.6g", *x,
                     node[0], node[m->cells]);
  return dvi__fail(DVI_BAD_ARGUMENT, "moving: the point (%.6g, %.6g) is outside of the mesh", x[0],
                   x[stride]);
}

/* ---- values there ---- */

void dvi__moving_place(const dvi__moving_element *e, int64_t stride, const double *x, double *place,
                       double *turn)
{
  const dvi_moving *m = e->m;
  for (int i = 0; i < m->dimension; i++) {
    double middle = 0;
    for (int a = 0; a < e->nodes; a++) middle += e->y[a * m->numbers + i] / e->nodes;
    turn[i] = m->period[i] > 0 ? round((x[i * stride] - middle) / m->period[i]) : 0;
  }
  for (int a = 0; a < e->nodes; a++) {
    place[a] = a == 0;
    for (int i = 0; i < m->dimension; i++)
      place[a] += e->simplex.gradient[a][i] * (x[i * stride] - turn[i] * m->period[i] - e->y[i]);
  }
}

static void evaluate_at(const dvi__moving_element *e, int slope, int64_t stride, const double *x,
                        double *u)
{
  const dvi_moving *m = e->m;
  double turn[DVI_MOVING_AXES_MAX], place[DVI__CELL_NODES];
  dvi__moving_place(e, stride, x, place, turn);
  for (int c = 0; c < m->components; c++) {
    dvi_jet jet = {.component = c};
    if (slope) jet.order[slope - 1] = 1;
    u[c * stride] = dvi__moving_variable(e, place, &jet);
    for (int i = 0; i < m->dimension && !slope; i++)
      u[c * stride] += turn[i] * m->jump[i * m->components + c];
  }
}

static dvi_status evaluate(const dvi_moving *m, const dvi__moving_state *state, const double *node,
                           int slope, int64_t count, const double *x, int *cell, double *u)
{
  DVI_TRY(dvi__moving_find_cells(m, node, count, x, cell));
  for (int64_t k = 0; k < count; k++) {
    dvi__moving_element e;
    if (cell[k] < 0) return dvi__moving_refuse_point(m, node, x + k, count);
    const int returned = dvi__moving_element_at(m, state, cell[k], &e);
    if (returned != 0) return dvi__moving_refuse(DVI_BAD_ARGUMENT, returned);
    evaluate_at(&e, slope, count, x + k, u + k);
  }
  return DVI_OK;
}

dvi_status dvi_moving_evaluate(const dvi_moving *moving, double t, const double *q, int slope,
                               int64_t count, const double *x, double *u)
{
  if (moving == NULL || q == NULL || count < 0 || (count > 0 && (x == NULL || u == NULL)))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field, coordinates and points are needed");
  if (slope < 0 || slope > moving->dimension)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: there is no axis %d to derive along", slope);
  const dvi__moving_state state = {.t = t, .q = q};
  DVI_TRY(dvi__moving_check(moving, &state));
  double *node = DVI_NEW(double, moving->dimension * moving->listed);
  int *cell = DVI_NEW(int, count);
  dvi_status status = node != NULL && cell != NULL
                          ? dvi_moving_lift(moving, t, q, node, NULL)
                          : dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  if (status == DVI_OK) status = evaluate(moving, &state, node, slope, count, x, cell, u);
  dvi__release(node);
  dvi__release(cell);
  return status;
}
