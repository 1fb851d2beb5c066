/* Continuous functions on triangles and tetrahedra, linear or quadratic in each.
 *
 * In the barycentric coordinates l_i of a cell the functions are l_i, or l_i (2 l_i - 1) of
 * vertices and 4 l_i l_j of edges. The quadrature is exact for the products of two of them. Source:
 * Strang and Fix 1973, secs. 1.9 and 4.3. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/mesh.h"
#include "field/space/kind.h"
#include "field/space/simplex_rule.h"

enum { DEGREE, POINTS, CORNERS_MOST = 4, FUNCTIONS_MOST = 10, SPACE_MOST = 3 };

/* What a space on a mesh has of its own. Local functions are those of the corners, then those of
 * the pairs of corners (0,1), (0,2), (1,2), .., with the larger one slowest. */
typedef struct simplices {
  int n, degree, locals;
  const dvi__simplex_rule *rule;
  int *function; /* [cells*locals] */
} simplices;

/* A cell: its edges from corner 0 and the gradients of the barycentric coordinates. */
typedef struct cell_frame {
  double origin[SPACE_MOST], edge[SPACE_MOST][SPACE_MOST], gradient[CORNERS_MOST][SPACE_MOST];
  double volume;
} cell_frame;

/* ---- one cell ---- */

/* Invert the matrix of the edges by its cofactors. Rows of the inverse are gradients. */
static void find_gradients(int n, cell_frame *frame)
{
  double(*e)[SPACE_MOST] = frame->edge, (*g)[SPACE_MOST] = frame->gradient + 1;
  double determinant = 0;
  for (int i = 0; i < n; i++)
    for (int a = 0; a < n; a++) {
      const int j = (i + 1) % n, k = (i + 2) % n, b = (a + 1) % n, c = (a + 2) % n;
      g[i][a] = n == 3 ? e[j][b] * e[k][c] - e[j][c] * e[k][b] : (i == a ? 1 : -1) * e[j][b];
    }
  for (int a = 0; a < n; a++) determinant += e[0][a] * g[0][a];
  for (int a = 0; a < n; a++) {
    frame->gradient[0][a] = 0;
    for (int i = 0; i < n; i++) {
      g[i][a] /= determinant;
      frame->gradient[0][a] -= g[i][a];
    }
  }
  frame->volume = fabs(determinant) / (n == 3 ? 6 : 2);
}

static void frame_cell(const dvi_mesh *mesh, int64_t cell, cell_frame *frame)
{
  const int n = mesh->n, *corner = mesh->corner[n] + cell * (n + 1);
  memcpy(frame->origin, mesh->point + (int64_t)corner[0] * n, (size_t)n * sizeof(double));
  for (int i = 0; i < n; i++) dvi__mesh_difference(mesh, corner[0], corner[i + 1], frame->edge[i]);
  find_gradients(n, frame);
}

/* Give the local functions at a place l, or their derivatives along axis d if d is not -1. */
static void local_functions(const simplices *own, const double *l, const cell_frame *frame, int d,
                            double *value)
{
  const int corners = own->n + 1;
  int at = corners;
  for (int i = 0; i < corners; i++) {
    const double slope = d >= 0 ? frame->gradient[i][d] : 0;
    value[i] = d >= 0 ? slope : l[i];
    if (own->degree == 2) value[i] = d >= 0 ? (4 * l[i] - 1) * slope : l[i] * (2 * l[i] - 1);
  }
  for (int j = 1; j < corners && own->degree == 2; j++)
    for (int i = 0; i < j; i++)
      value[at++] = d >= 0 ? 4 * (l[i] * frame->gradient[j][d] + l[j] * frame->gradient[i][d])
                           : 4 * l[i] * l[j];
}

/* Give the functions of a cell at a place, or a derivative of them, as a row with ascending
 * columns. */
static void fill_row(const dvi_space *space, int64_t cell, const double *l, int d, int *column,
                     double *entry)
{
  const simplices *own = space->own;
  const int *function = own->function + cell * own->locals;
  double value[FUNCTIONS_MOST] = {0};
  cell_frame frame;
  if (d >= 0) frame_cell(space->mesh, cell, &frame);
  local_functions(own, l, &frame, d, value);
  for (int i = 0; i < own->locals; i++) {
    int at = i;
    for (; at > 0 && column[at - 1] > function[i]; at--) {
      column[at] = column[at - 1];
      entry[at] = entry[at - 1];
    }
    column[at] = function[i];
    entry[at] = value[i];
  }
}

/* The axis of a first derivative, or -1 for values. */
static int axis_of(const dvi_space *space, const int *order)
{
  for (int d = 0; d < space->dimension; d++)
    if (order[d] > 0) return d;
  return -1;
}

/* ---- creation ---- */

static int is_edge_between(const dvi_mesh *mesh, int edge, int a, int b)
{
  const int *end = mesh->corner[1] + 2 * (int64_t)edge;
  return (end[0] == a && end[1] == b) || (end[0] == b && end[1] == a);
}

/* Find the edge between two vertices among those of a k-cell. */
static int find_edge(const dvi_mesh *mesh, int k, int64_t cell, int a, int b)
{
  if (k == 1) return is_edge_between(mesh, (int)cell, a, b) ? (int)cell : -1;
  for (int f = 0; f <= k; f++) {
    const int edge = find_edge(mesh, k - 1, mesh->facet[k][cell * (k + 1) + f], a, b);
    if (edge >= 0) return edge;
  }
  return -1;
}

static dvi_status number_functions(const dvi_mesh *mesh, simplices *own)
{
  const int corners = own->n + 1;
  own->function = DVI_NEW(int, mesh->count[own->n] * own->locals);
  if (own->function == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for its functions");
  for (int64_t c = 0; c < mesh->count[own->n]; c++) {
    const int *corner = mesh->corner[own->n] + c * corners;
    int *at = own->function + c * own->locals;
    for (int i = 0; i < corners; i++) *at++ = corner[i];
    for (int j = 1; j < corners && own->degree == 2; j++)
      for (int i = 0; i < j; i++)
        *at++ = (int)mesh->count[0] + find_edge(mesh, own->n, c, corner[i], corner[j]);
  }
  return DVI_OK;
}

static dvi_status check_mesh(const dvi_mesh *mesh)
{
  if (mesh->kind != DVI_SIMPLICES || mesh->n < 2 || mesh->n > 3)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "space: the mesh has %s of dimension %d; triangles and tetrahedra are possible, "
        "and axes for boxes",
        mesh->kind == DVI_SIMPLICES ? "simplices" : "boxes", mesh->n);
  if (mesh->space != mesh->n)
    return dvi__fail(DVI_UNSUPPORTED,
                     "space: the mesh has cells of dimension %d in %d coordinates; cells that fill "
                     "their space are possible",
                     mesh->n, mesh->space);
  return DVI_OK;
}

static dvi_status choose_rule(int points, simplices *own)
{
  own->rule = dvi__simplex_rule_of(own->n, own->degree, points);
  if (own->rule != NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "space: fem: points=%d; %s are possible in %s", points,
                   own->n == 2 ? "1, 3 and 6" : "1, 4 and 14",
                   own->n == 2 ? "triangles" : "tetrahedra");
}

static dvi_status read_options(const dvi_space_options *options, simplices *own)
{
  static const dvi__spec_form form = {
      .name = "fem",
      .key = {[DEGREE] = {"degree", 1, 2, 1, NULL}, [POINTS] = {"points", 1, 14, 0, NULL}}};
  const dvi__spec_form *const forms[] = {&form};
  int number, value[DVI__SPACE_KEYS];
  DVI_TRY(
      dvi__spec_read(options->kind != NULL ? options->kind : form.name, 1, forms, &number, value));
  own->n = options->mesh->n;
  own->degree = value[DEGREE];
  own->locals = own->degree == 1 ? own->n + 1 : (own->n + 1) * (own->n + 2) / 2;
  return choose_rule(value[POINTS], own);
}

static void place_points(dvi_space *space, const simplices *own)
{
  const dvi__simplex_rule *rule = own->rule;
  cell_frame frame;
  for (int64_t k = 0; k < space->points; k++) {
    const double *l = rule->place[k % rule->points];
    if (k % rule->points == 0) frame_cell(space->mesh, k / rule->points, &frame);
    space->weight[k] = frame.volume * rule->weight[k % rule->points];
    for (int d = 0; d < own->n; d++) {
      double x = frame.origin[d];
      for (int i = 0; i < own->n; i++) x += l[i + 1] * frame.edge[i][d];
      space->x[d * space->points + k] = x;
    }
  }
}

/* The functions of a part are those of its vertices and edges. */
static dvi_status add_part(dvi_space *space, const char *name, int degree)
{
  dvi__space_part *part = &space->part[space->parts++];
  int64_t vertices, edges = 0;
  const int *vertex = dvi_mesh_part_cells(space->mesh, name, 0, &vertices),
            *edge = degree == 2 ? dvi_mesh_part_cells(space->mesh, name, 1, &edges) : NULL;
  *part = (dvi__space_part){name, vertices + edges, DVI_NEW(int, vertices + edges)};
  if (part->function == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for a boundary");
  for (int64_t i = 0; i < vertices; i++) part->function[i] = vertex[i];
  for (int64_t i = 0; i < edges; i++)
    part->function[vertices + i] = (int)space->mesh->count[0] + edge[i];
  return DVI_OK;
}

static dvi_status add_parts(dvi_space *space, int degree)
{
  int parts = 0;
  while (dvi_mesh_part_name(space->mesh, parts) != NULL) parts++;
  space->part = DVI_NEW(dvi__space_part, parts);
  if (space->part == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for a boundary");
  for (int i = 0; i < parts; i++)
    DVI_TRY(add_part(space, dvi_mesh_part_name(space->mesh, i), degree));
  return DVI_OK;
}

static dvi_status simplices_create(const dvi_space_options *options, dvi_space *space)
{
  const dvi_mesh *mesh = options->mesh;
  DVI_TRY(check_mesh(mesh));
  simplices *own = space->own = DVI_NEW(simplices, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  DVI_TRY(read_options(options, own));
  space->functions = mesh->count[0] + (own->degree == 2 ? mesh->count[1] : 0);
  space->points = mesh->count[own->n] * own->rule->points;
  space->row_entries = own->locals;
  DVI_TRY(dvi__space_check_sizes((double)space->functions, (double)space->points));
  space->x = DVI_NEW(double, own->n * space->points);
  space->weight = DVI_NEW(double, space->points);
  if (space->x == NULL || space->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld points", (long long)space->points);
  for (int d = 0; d < own->n; d++) space->smoothness[d] = 1;
  place_points(space, own);
  DVI_TRY(number_functions(mesh, own));
  return add_parts(space, own->degree);
}

static void simplices_destroy(void *of)
{
  simplices *own = of;
  if (own != NULL) dvi__release(own->function);
  dvi__release(own);
}

/* ---- operators ---- */

static dvi_status simplices_check_order(const dvi_space *space, const int *order)
{
  int sum = 0;
  for (int d = 0; d < space->dimension; d++) sum += order[d];
  return sum <= 1 ? DVI_OK
                  : dvi__fail(DVI_UNSUPPORTED,
                              "space: a derivative of order %d is asked, but functions on a mesh "
                              "have first ones only",
                              sum);
}

static dvi_status simplices_matrix(const dvi_space *space, const int *order, dvi__csr *made)
{
  const simplices *own = space->own;
  const int d = axis_of(space, order);
  DVI_TRY(dvi__csr_allocate(space->points, space->functions, space->points * own->locals, made));
  for (int64_t k = 0; k < space->points; k++) {
    fill_row(space, k / own->rule->points, own->rule->place[k % own->rule->points], d,
             made->column + k * own->locals, made->value + k * own->locals);
    made->start[k + 1] = (k + 1) * own->locals;
  }
  return DVI_OK;
}

static dvi_status simplices_row(const dvi_space *space, const int *order, const double *x,
                                int *column, double *value, int64_t *count)
{
  double l[CORNERS_MOST];
  int cell;
  *count = 0;
  DVI_TRY(dvi_mesh_locate(space->mesh, 1, x, &cell, l));
  if (cell < 0) return DVI_OK;
  *count = space->row_entries;
  fill_row(space, cell, l, axis_of(space, order), column, value);
  return DVI_OK;
}

/* ---- points anywhere ---- */

static dvi_status sum_rows(const dvi_space *space, const int *order, const double *U, int64_t count,
                           const double *point, const int *cell, const double *l, double *values)
{
  const int d = axis_of(space, order), corners = space->dimension + 1;
  int column[FUNCTIONS_MOST] = {0};
  double value[FUNCTIONS_MOST] = {0};
  for (int64_t i = 0; i < count; i++) {
    if (cell[i] < 0) return dvi__space_outside(space, point + i * space->dimension);
    fill_row(space, cell[i], l + i * corners, d, column, value);
    values[i] = 0;
    for (int j = 0; j < space->row_entries; j++) values[i] += value[j] * U[column[j]];
  }
  return DVI_OK;
}

static dvi_status simplices_evaluate(const dvi_space *space, const int *order, const double *U,
                                     int64_t count, const double *x, double *values)
{
  const int n = space->dimension;
  double *point = DVI_NEW(double, n *count), *l = DVI_NEW(double, (n + 1) * count);
  int *cell = DVI_NEW(int, count);
  dvi_status status = point != NULL && l != NULL && cell != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld points",
                                      (long long)count);
  for (int64_t i = 0; i < n * count && status == DVI_OK; i++) point[i] = x[i % n * count + i / n];
  if (status == DVI_OK) status = dvi_mesh_locate(space->mesh, count, point, cell, l);
  if (status == DVI_OK) status = sum_rows(space, order, U, count, point, cell, l, values);
  dvi__release(point);
  dvi__release(l);
  dvi__release(cell);
  return status;
}

/* The nodes are the vertices and the middles of the edges. */
static void place_nodes(const dvi_space *space, double *x)
{
  const dvi_mesh *mesh = space->mesh;
  for (int64_t i = 0; i < space->functions; i++) {
    const int64_t edge = i - mesh->count[0];
    const int *end = edge >= 0 ? mesh->corner[1] + 2 * edge : NULL;
    double across[SPACE_MOST] = {0};
    if (end != NULL) dvi__mesh_difference(mesh, end[0], end[1], across);
    for (int d = 0; d < mesh->n; d++)
      x[d * space->functions + i] = mesh->point[(end != NULL ? end[0] : i) * mesh->n + d] +
                                    across[d] / 2;
  }
}

static dvi_status simplices_interpolate(const dvi_space *space, const dvi__sampled *f, double *U)
{
  double *x = DVI_NEW(double, space->dimension * space->functions),
         *values = DVI_NEW(double, space->functions);
  dvi_status status = x != NULL && values != NULL ? DVI_OK
                                                  : dvi__fail(DVI_NO_MEMORY, "space: no memory");
  if (status == DVI_OK) place_nodes(space, x);
  if (status == DVI_OK)
    status = dvi__space_sample(space->dimension, f, space->functions, x, values);
  if (status == DVI_OK) memcpy(U, values, (size_t)space->functions * sizeof *U);
  dvi__release(x);
  dvi__release(values);
  return status;
}

static void simplices_explain(const dvi_space *space, dvi__note *note)
{
  const simplices *own = space->own;
  dvi__note_add(note,
                "mesh of %lld %s: fem, degree %d: %lld functions, %d points a cell, exact for "
                "polynomials of degree %d\n",
                (long long)space->mesh->count[own->n], own->n == 2 ? "triangles" : "tetrahedra",
                own->degree, (long long)space->functions, own->rule->points, own->rule->degree);
}

const dvi__domain dvi__simplices = {
    .create = simplices_create,
    .destroy = simplices_destroy,
    .check_order = simplices_check_order,
    .matrix = simplices_matrix,
    .row = simplices_row,
    .evaluate = simplices_evaluate,
    .interpolate = simplices_interpolate,
    .explain = simplices_explain,
};
