/* Meshes on which functions are shown, with a vertex for about each function. */
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/space/msfem.h"

enum { PARTS_MOST = 4096 /* of an axis */ };

/* The vertices along each axis, the first one slowest. */
typedef struct grid {
  int dimension;
  int64_t count[DVI_AXES_MAX]; /* of vertices */
  double *place[DVI_AXES_MAX];
} grid;

/* ---- axes ---- */

/* Return the parts of a cell, k for polynomials of degree k. A trigonometric polynomial has as many
 * as there are functions. */
static int64_t parts_of(const dvi__line *line)
{
  if (line->kind == &dvi__msfem) return line->value[DVI__MSFEM_FINE];
  return line->degree > 0 ? line->degree : line->functions / line->cells;
}

static double place_of(const dvi__line *line, int64_t parts, int64_t i)
{
  const int64_t cell = i / parts, part = i % parts;
  const double start = line->node[cell];
  return part == 0 ? start
                   : start + (line->node[cell + 1] - start) * ((double)part / (double)parts);
}

/* Divide the cells of an axis. Of too many parts every second, third and so on ends one. */
static dvi_status divide(const dvi__line *line, int d, grid *g)
{
  const int64_t parts = parts_of(line), all = parts * line->cells,
                stride = (all + PARTS_MOST - 1) / PARTS_MOST, count = (all + stride - 1) / stride;
  g->place[d] = DVI_NEW(double, count + 1);
  if (g->place[d] == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld vertices", (long long)count + 1);
  for (int64_t i = 0; i < count; i++) g->place[d][i] = place_of(line, parts, i * stride);
  g->place[d][count] = line->to;
  g->count[d] = count + 1;
  return DVI_OK;
}

/* ---- products ---- */

/* Step to the next vertex, or with far = 1 to the next cell. */
static void advance(const grid *g, int far, int64_t *index)
{
  for (int d = g->dimension - 1; d >= 0; d--) {
    if (++index[d] < g->count[d] - far) return;
    index[d] = 0;
  }
}

static void place_vertices(const grid *g, int64_t vertices, double *point)
{
  int64_t index[DVI_AXES_MAX] = {0};
  for (int64_t v = 0; v < vertices; v++, advance(g, 0, index))
    for (int d = 0; d < g->dimension; d++) point[v * g->dimension + d] = g->place[d][index[d]];
}

static int corners_of(const grid *g)
{
  int corners = 1;
  for (int d = 0; d < g->dimension; d++) corners *= 2;
  return corners;
}

/* Number the corners of each cell, of which bit d tells if it is at the far end of axis d. */
static void connect(const grid *g, int64_t cells, int *vertex)
{
  int64_t index[DVI_AXES_MAX] = {0};
  const int corners = corners_of(g);
  for (int64_t c = 0; c < cells; c++, advance(g, 1, index))
    for (int corner = 0; corner < corners; corner++) {
      int64_t v = 0;
      for (int d = 0; d < g->dimension; d++) v = v * g->count[d] + index[d] + (corner >> d & 1);
      vertex[c * corners + corner] = (int)v;
    }
}

static dvi_status make_mesh(const grid *g, dvi_mesh **mesh)
{
  int64_t vertices = 1, cells = 1;
  for (int d = 0; d < g->dimension; d++) {
    vertices *= g->count[d];
    cells *= g->count[d] - 1;
  }
  if (vertices > INT_MAX / (2 * DVI_AXES_MAX))
    return dvi__fail(DVI_BAD_SIZE, "space: a mesh of %lld vertices is too large to be shown",
                     (long long)vertices);
  double *point = DVI_NEW(double, vertices * g->dimension);
  int *vertex = DVI_NEW(int, cells *(1 << g->dimension));
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld vertices",
                                (long long)vertices);
  if (point != NULL && vertex != NULL) {
    place_vertices(g, vertices, point);
    connect(g, cells, vertex);
    status = dvi_mesh_create(&(dvi_mesh_terms){.size = sizeof(dvi_mesh_terms),
                                               .kind = DVI_BOXES,
                                               .dimension = g->dimension,
                                               .points = vertices,
                                               .point = point,
                                               .cells = cells,
                                               .vertex = vertex},
                             mesh);
  }
  dvi__release(point);
  dvi__release(vertex);
  return status;
}

dvi_status dvi_space_mesh(const dvi_space *space, dvi_mesh **mesh)
{
  if (mesh == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "space: the place for the mesh is NULL");
  *mesh = NULL;
  if (space == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "space: the space is missing");
  if (space->mesh != NULL) {
    *mesh = dvi_mesh_share(space->mesh);
    return DVI_OK;
  }
  grid g = {.dimension = space->dimension};
  dvi_status status = DVI_OK;
  for (int d = 0; d < space->dimension && status == DVI_OK; d++)
    status = divide(&space->line[d], d, &g);
  if (status == DVI_OK) status = make_mesh(&g, mesh);
  for (int d = 0; d < space->dimension; d++) dvi__release(g.place[d]);
  return status;
}
