/* VTK's unstructured grids. A text in XML describes the arrays, which follow it as bytes, each with
 * their number before it (VTK file formats, "appended, raw"). */
#include <math.h>

#include "core/memory.h"
#include "field/mesh/file/list.h"
#include "field/mesh/file/write.h"

/* A point that is drawn: a vertex, moved by some periods. */
typedef struct copy {
  int vertex;
  double shift[3];
} copy;

/* The grid that is drawn. Where space repeats itself, cells that reach over its end have points of
 * their own behind the end. */
typedef struct grid {
  const dvi_mesh *mesh;
  int corners, type;
  int64_t points;
  int *point;     /* [cells*corners] */
  dvi__list copy; /* of points after the vertices */
  int views;
  const dvi_view *view;
  dvi__sink *sink;
  int64_t offset; /* of the next array in the bytes */
} grid;

/* ---- points and cells ---- */

/* Give the periods by which a vertex is moved to be drawn beside another one. Returns whether it is
 * moved at all. */
static int find_shift(const dvi_mesh *mesh, int from, int vertex, double *shift)
{
  int is_moved = 0;
  for (int axis = 0; axis < mesh->space; axis++) {
    const double period = mesh->period[axis],
                 gap = mesh->point[(int64_t)vertex * mesh->space + axis] -
                       mesh->point[(int64_t)from * mesh->space + axis];
    shift[axis] = period > 0 ? -period * nearbyint(gap / period) : 0;
    is_moved |= shift[axis] != 0;
  }
  return is_moved;
}

static dvi_status take_cells(grid *g)
{
  const dvi_mesh *mesh = g->mesh;
  int vertex[DVI__CORNERS];
  g->point = DVI_NEW(int, mesh->count[mesh->n] * g->corners);
  if (g->point == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for cells");
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    dvi__oriented_cell(mesh, mesh->n, c, vertex);
    for (int i = 0; i < g->corners; i++) {
      copy moved = {.vertex = vertex[i]};
      g->point[c * g->corners + i] = vertex[i];
      if (!find_shift(mesh, vertex[0], vertex[i], moved.shift)) continue;
      copy *kept = dvi__list_add(&g->copy, sizeof *kept);
      if (kept == NULL) return DVI_NO_MEMORY;
      *kept = moved;
      g->point[c * g->corners + i] = (int)(mesh->count[0] + g->copy.count - 1);
    }
  }
  g->points = mesh->count[0] + g->copy.count;
  return DVI_OK;
}

/* ---- the description ---- */

/* Describe an array and the place of its bytes. */
static void describe(grid *g, const char *type, const char *name, int components, int64_t bytes)
{
  dvi__put(g->sink, "        <DataArray type=\"%s\" Name=\"", type);
  dvi__put_xml(g->sink, name);
  dvi__put(g->sink, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%lld\"/>\n",
           components, (long long)g->offset);
  g->offset += 8 + bytes;
}

static int64_t cells_of_view(const grid *g, const dvi_view *view)
{
  return view->degree == 0 ? g->points : g->mesh->count[g->mesh->n];
}

static int64_t bytes_of_view(const grid *g, const dvi_view *view)
{
  return 8 * cells_of_view(g, view) * view->components;
}

static void describe_views(grid *g, const char *section, int degree)
{
  dvi__put(g->sink, "      <%s>\n", section);
  for (int i = 0; i < g->views; i++)
    if (g->view[i].degree == degree)
      describe(g, "Float64", g->view[i].name, g->view[i].components, bytes_of_view(g, g->view + i));
  dvi__put(g->sink, "      </%s>\n", section);
}

static void describe_all(grid *g)
{
  const int64_t cells = g->mesh->count[g->mesh->n];
  dvi__put(g->sink, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                    "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n");
  dvi__put(g->sink,
           "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"%lld\" NumberOfCells=\"%lld\">\n",
           (long long)g->points, (long long)cells);
  describe_views(g, "PointData", 0);
  describe_views(g, "CellData", g->mesh->n);
  dvi__put(g->sink, "      <Points>\n");
  describe(g, "Float64", "Points", 3, 24 * g->points);
  dvi__put(g->sink, "      </Points>\n      <Cells>\n");
  describe(g, "Int64", "connectivity", 1, 8 * cells * g->corners);
  describe(g, "Int64", "offsets", 1, 8 * cells);
  describe(g, "UInt8", "types", 1, cells);
  dvi__put(g->sink, "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n");
}

/* ---- the bytes ---- */

/* Give a point that is drawn, a vertex in its place or a copy. */
static copy point_at(const grid *g, int64_t i)
{
  const int64_t vertices = g->mesh->count[0];
  if (i < vertices || g->copy.at == NULL) return (copy){.vertex = (int)i};
  return ((const copy *)g->copy.at)[i - vertices];
}

static void put_view(const grid *g, const dvi_view *view)
{
  dvi__put_little_endian(g->sink, (uint64_t)bytes_of_view(g, view), 8);
  for (int64_t i = 0; i < cells_of_view(g, view); i++) {
    const int64_t cell = view->degree == 0 ? point_at(g, i).vertex : i;
    for (int c = 0; c < view->components; c++)
      dvi__put_double(g->sink, view->values[cell * view->components + c]);
  }
}

static void put_views(const grid *g, int degree)
{
  for (int i = 0; i < g->views; i++)
    if (g->view[i].degree == degree) put_view(g, g->view + i);
}

static void put_points(const grid *g)
{
  const dvi_mesh *mesh = g->mesh;
  dvi__put_little_endian(g->sink, (uint64_t)(24 * g->points), 8);
  for (int64_t i = 0; i < g->points; i++) {
    const copy drawn = point_at(g, i);
    const double *x = mesh->point + (int64_t)drawn.vertex * mesh->space;
    for (int axis = 0; axis < 3; axis++)
      dvi__put_double(g->sink, axis < mesh->space ? x[axis] + drawn.shift[axis] : 0);
  }
}

static void put_cells(const grid *g)
{
  const int64_t cells = g->mesh->count[g->mesh->n];
  dvi__put_little_endian(g->sink, (uint64_t)(8 * cells * g->corners), 8);
  for (int64_t i = 0; i < cells * g->corners; i++)
    dvi__put_little_endian(g->sink, (uint64_t)g->point[i], 8);
  dvi__put_little_endian(g->sink, (uint64_t)(8 * cells), 8);
  for (int64_t c = 1; c <= cells; c++)
    dvi__put_little_endian(g->sink, (uint64_t)(c * g->corners), 8);
  dvi__put_little_endian(g->sink, (uint64_t)cells, 8);
  for (int64_t c = 0; c < cells; c++) dvi__put_little_endian(g->sink, (uint64_t)g->type, 1);
}

/* The arrays come in the order of their descriptions. */
static void put_all(grid *g)
{
  describe_all(g);
  dvi__put(g->sink, "  <AppendedData encoding=\"raw\">\n_");
  put_views(g, 0);
  put_views(g, g->mesh->n);
  put_points(g);
  put_cells(g);
  dvi__put(g->sink, "\n  </AppendedData>\n</VTKFile>\n");
}

dvi_status dvi__write_vtu(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink)
{
  grid g = {.mesh = mesh,
            .corners = dvi__corners(mesh->kind, mesh->n),
            .type = dvi__shape_facts_of[dvi__shape_of(mesh->kind, mesh->n)].vtk,
            .views = views,
            .view = view,
            .sink = sink};
  const dvi_status status = take_cells(&g);
  if (status == DVI_OK) put_all(&g);
  dvi__release(g.point);
  dvi__release(g.copy.at);
  return status;
}
