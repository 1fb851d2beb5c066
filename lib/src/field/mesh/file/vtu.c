/* VTK's unstructured grids. A text in XML describes the arrays, which follow it as bytes, each with
 * their number before it (VTK file formats, "appended, raw"). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/list.h"
#include "field/mesh/file/write.h"
#include "field/mesh/share.h"

/* A point that is drawn: a vertex, moved by some periods, for an n-cell. Numbers are those of the
 * whole mesh. */
typedef struct copy {
  int vertex; /* of the mesh */
  int64_t cell;
  double shift[3];
} copy;

/* The grid that is drawn. Where space repeats itself, cells that reach over its end have points of
 * their own behind the end, which follow the vertices. Each process knows those of its share, and
 * the owner of the vertex fills them. */
typedef struct grid {
  const dvi_mesh *mesh;
  int corners, type;
  int64_t vertices, cells, copies; /* of the whole mesh */
  int *point;                      /* [cells*corners] vertices, and from `count[0]` on copies */
  dvi__list copy;
  int64_t *number; /* [copy.count] of copies, from 0 */
  int64_t counted; /* copies that have a number */
  int views;
  const dvi_view *view;
  dvi__sink *sink;
  int64_t *room;  /* of dvi__gather_rows */
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

static dvi_status take_cell(grid *g, int64_t c)
{
  const dvi_mesh *mesh = g->mesh;
  int vertex[DVI__CORNERS];
  dvi__oriented_cell(mesh, mesh->n, c, vertex);
  for (int i = 0; i < g->corners; i++) {
    copy moved = {.vertex = vertex[i], .cell = dvi__whole_number(mesh, mesh->n, c)};
    g->point[c * g->corners + i] = vertex[i];
    if (!find_shift(mesh, vertex[0], vertex[i], moved.shift)) continue;
    copy *kept = dvi__list_add(&g->copy, sizeof *kept);
    if (kept == NULL) return DVI_NO_MEMORY;
    *kept = moved;
    g->point[c * g->corners + i] = (int)(mesh->count[0] + g->copy.count - 1);
  }
  return DVI_OK;
}

static dvi_status take_cells(grid *g)
{
  const dvi_mesh *mesh = g->mesh;
  int width = g->corners;
  for (int i = 0; i < g->views; i++)
    if (g->view[i].components > width) width = g->view[i].components;
  g->point = DVI_NEW(int, mesh->count[mesh->n] * g->corners);
  g->room = DVI_NEW(int64_t, dvi__whole_room(width));
  if (g->point == NULL || g->room == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for cells");
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) DVI_TRY(take_cell(g, c));
  g->number = DVI_NEW(int64_t, g->copy.count);
  return g->number != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for cells");
}

/* ---- rows of the whole mesh ---- */

static const copy *copy_at(const grid *g, int64_t i)
{
  return (const copy *)g->copy.at + i;
}

/* Describe rows of the vertices or the n-cells. */
static dvi__whole_rows rows_of(const grid *g, int k, int width)
{
  const dvi_mesh *mesh = g->mesh;
  return (dvi__whole_rows){.total = k == 0 ? g->vertices : g->cells,
                           .listed = mesh->count[k],
                           .number = mesh->share != NULL ? mesh->share->number[k] : NULL,
                           .width = width};
}

static dvi__whole_rows rows_of_copies(const grid *g, int width)
{
  return (dvi__whole_rows){
      .total = g->copies, .listed = g->copy.count, .number = g->number, .width = width};
}

/* Count copies of the cells. */
static void fill_copies(const void *of, int64_t c, int64_t *word)
{
  const grid *g = of;
  for (int i = 0; i < g->corners && dvi__owns(g->mesh, g->mesh->n, c); i++)
    *word += g->point[c * g->corners + i] >= g->mesh->count[0];
}

/* Number copies in the order of their cells. */
static void take_numbers(void *to, int64_t count, const int64_t *copies)
{
  grid *g = to;
  for (int64_t i = 0; i < count; i++) {
    for (int64_t k = 0; k < copies[i] && g->counted < g->copy.count; k++)
      if (copy_at(g, g->counted)->cell == g->cells + i) g->number[g->counted++] = g->copies + k;
    g->copies += copies[i];
  }
  g->cells += count;
}

static dvi_status number_copies(grid *g)
{
  dvi__whole_rows rows = rows_of(g, g->mesh->n, 1);
  rows.fill = fill_copies;
  rows.of = g;
  g->cells = 0; /* those that have been looked at */
  return dvi__gather_rows(g->mesh, &rows, g->room, take_numbers, g);
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

static int64_t bytes_of_view(const grid *g, const dvi_view *view)
{
  return 8 * (view->degree == 0 ? g->vertices + g->copies : g->cells) * view->components;
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
  const int64_t cells = g->cells, points = g->vertices + g->copies;
  dvi__put(g->sink, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                    "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n");
  dvi__put(g->sink,
           "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"%lld\" NumberOfCells=\"%lld\">\n",
           (long long)points, (long long)cells);
  describe_views(g, "PointData", 0);
  describe_views(g, "CellData", g->mesh->n);
  dvi__put(g->sink, "      <Points>\n");
  describe(g, "Float64", "Points", 3, 24 * points);
  dvi__put(g->sink, "      </Points>\n      <Cells>\n");
  describe(g, "Int64", "connectivity", 1, 8 * cells * g->corners);
  describe(g, "Int64", "offsets", 1, 8 * cells);
  describe(g, "UInt8", "types", 1, cells);
  dvi__put(g->sink, "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n");
}

/* ---- the bytes ---- */

static void put_words(void *to, int64_t count, const int64_t *word)
{
  const grid *g = to;
  for (int64_t i = 0; i < count; i++) dvi__put_little_endian(g->sink, (uint64_t)word[i], 8);
}

/* Put rows that `fill` knows of the grid, or of one of its views. */
static dvi_status put_rows(grid *g, dvi__whole_rows rows,
                           void (*fill)(const void *of, int64_t i, int64_t *word), const void *of)
{
  rows.fill = fill;
  rows.of = of;
  return dvi__gather_rows(g->mesh, &rows, g->room, put_words, g);
}

/* A view of the grid. */
typedef struct shown {
  const grid *g;
  const dvi_view *view;
} shown;

static void put_value(const dvi_view *view, int64_t cell, int64_t *word)
{
  memcpy(word, view->values + cell * view->components, (size_t)view->components * sizeof *word);
}

static void fill_value(const void *of, int64_t i, int64_t *word)
{
  const shown *s = of;
  if (dvi__owns(s->g->mesh, s->view->degree, i)) put_value(s->view, i, word);
}

static void fill_value_of_copy(const void *of, int64_t i, int64_t *word)
{
  const shown *s = of;
  const int vertex = copy_at(s->g, i)->vertex;
  if (dvi__owns(s->g->mesh, 0, vertex)) put_value(s->view, vertex, word);
}

static dvi_status put_view(grid *g, const dvi_view *view)
{
  const shown s = {g, view};
  dvi__put_little_endian(g->sink, (uint64_t)bytes_of_view(g, view), 8);
  DVI_TRY(put_rows(g, rows_of(g, view->degree, view->components), fill_value, &s));
  return view->degree > 0
             ? DVI_OK
             : put_rows(g, rows_of_copies(g, view->components), fill_value_of_copy, &s);
}

static dvi_status put_views(grid *g, int degree)
{
  for (int i = 0; i < g->views; i++)
    if (g->view[i].degree == degree) DVI_TRY(put_view(g, g->view + i));
  return DVI_OK;
}

static void put_point(const grid *g, int64_t vertex, const double *shift, int64_t *word)
{
  const int space = g->mesh->space;
  for (int axis = 0; axis < space; axis++) {
    const double x = g->mesh->point[vertex * space + axis] + (shift != NULL ? shift[axis] : 0);
    memcpy(word + axis, &x, sizeof x);
  }
}

static void fill_point(const void *of, int64_t i, int64_t *word)
{
  const grid *g = of;
  if (dvi__owns(g->mesh, 0, i)) put_point(g, i, NULL, word);
}

static void fill_point_of_copy(const void *of, int64_t i, int64_t *word)
{
  const grid *g = of;
  const copy *moved = copy_at(g, i);
  if (dvi__owns(g->mesh, 0, moved->vertex)) put_point(g, moved->vertex, moved->shift, word);
}

static dvi_status put_points(grid *g)
{
  dvi__put_little_endian(g->sink, (uint64_t)(24 * (g->vertices + g->copies)), 8);
  DVI_TRY(put_rows(g, rows_of(g, 0, 3), fill_point, g));
  return put_rows(g, rows_of_copies(g, 3), fill_point_of_copy, g);
}

static void fill_cell(const void *of, int64_t c, int64_t *word)
{
  const grid *g = of;
  if (!dvi__owns(g->mesh, g->mesh->n, c)) return;
  for (int i = 0; i < g->corners; i++) {
    const int64_t point = g->point[c * g->corners + i], moved = point - g->mesh->count[0];
    word[i] = moved < 0 ? dvi__whole_number(g->mesh, 0, point) : g->vertices + g->number[moved];
  }
}

static dvi_status put_cells(grid *g)
{
  dvi__put_little_endian(g->sink, (uint64_t)(8 * g->cells * g->corners), 8);
  DVI_TRY(put_rows(g, rows_of(g, g->mesh->n, g->corners), fill_cell, g));
  dvi__put_little_endian(g->sink, (uint64_t)(8 * g->cells), 8);
  for (int64_t c = 1; c <= g->cells; c++)
    dvi__put_little_endian(g->sink, (uint64_t)(c * g->corners), 8);
  dvi__put_little_endian(g->sink, (uint64_t)g->cells, 8);
  for (int64_t c = 0; c < g->cells; c++) dvi__put_little_endian(g->sink, (uint64_t)g->type, 1);
  return DVI_OK;
}

/* The arrays come in the order of their descriptions. */
static dvi_status put_all(grid *g)
{
  describe_all(g);
  dvi__put(g->sink, "  <AppendedData encoding=\"raw\">\n_");
  DVI_TRY(put_views(g, 0));
  DVI_TRY(put_views(g, g->mesh->n));
  DVI_TRY(put_points(g));
  DVI_TRY(put_cells(g));
  dvi__put(g->sink, "\n  </AppendedData>\n</VTKFile>\n");
  return DVI_OK;
}

dvi_status dvi__write_vtu(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink)
{
  grid g = {.mesh = mesh,
            .corners = dvi__corners(mesh->kind, mesh->n),
            .type = dvi__shape_facts_of[dvi__shape_of(mesh->kind, mesh->n)].vtk,
            .vertices = dvi__whole_count(mesh, 0),
            .cells = dvi__whole_count(mesh, mesh->n),
            .views = views,
            .view = view,
            .sink = sink};
  dvi_status status = dvi__agree(mesh, take_cells(&g));
  if (status == DVI_OK) status = number_copies(&g);
  if (status == DVI_OK) status = put_all(&g);
  dvi__release(g.point);
  dvi__release(g.room);
  dvi__release(g.number);
  dvi__release(g.copy.at);
  return status;
}
