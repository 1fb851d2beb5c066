/* Grids of boxes, and Kuhn's simplices of their boxes: one for each order of the axes, in which a
 * path goes along the edges from the lowest corner of a box to its highest one (Kuhn 1960). */
#include "core/status.h"
#include "field/mesh/generate/draft.h"

/* A place in a grid. */
typedef struct place {
  int at[DVI_MESH_DIMENSION_MAX];
} place;

/* Go on to the next place below `count` in each axis, the first axis fastest. */
static void advance(int n, const int *count, place *p)
{
  for (int axis = 0; axis < n; axis++) {
    if (++p->at[axis] < count[axis]) return;
    p->at[axis] = 0;
  }
}

static void fill_points(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int n = sizes->dimension;
  int count[DVI_MESH_DIMENSION_MAX] = {0};
  place p = {{0}};
  for (int axis = 0; axis < n; axis++) count[axis] = dvi__nodes_along(sizes, axis);
  for (int64_t v = 0; v < draft->terms.points; v++, advance(n, count, &p))
    for (int axis = 0; axis < n; axis++) {
      draft->point[v * n + axis] = dvi__node_at(sizes, axis, p.at[axis]);
      if (sizes->periodic[axis]) continue;
      if (p.at[axis] == 0) draft->side[v] |= (unsigned char)(1 << (2 * axis));
      if (p.at[axis] == sizes->cells[axis]) draft->side[v] |= (unsigned char)(2 << (2 * axis));
    }
}

/* Give the vertex at a corner of the box at a place. */
static int vertex_at(const dvi__sizes *sizes, const place *p, int corner)
{
  int vertex = 0, stride = 1;
  for (int axis = 0; axis < sizes->dimension; axis++) {
    const int nodes = dvi__nodes_along(sizes, axis), at = p->at[axis] + (corner >> axis & 1);
    vertex += stride * (at == nodes ? 0 : at);
    stride *= nodes;
  }
  return vertex;
}

static dvi_status prepare(const dvi__sizes *sizes, int simplices, dvi__draft *draft)
{
  static const char *const side[] = {"left", "right", "bottom", "top",
                                     "back", "front", "start",  "end"};
  const int n = sizes->dimension;
  double points = 1, cells = simplices;
  draft->terms.dimension = n;
  for (int axis = 0; axis < n; axis++) {
    points *= dvi__nodes_along(sizes, axis);
    cells *= sizes->cells[axis];
    if (sizes->periodic[axis]) {
      draft->period[axis] = sizes->extent[axis];
      continue;
    }
    draft->name[2 * axis] = side[2 * axis];
    draft->name[2 * axis + 1] = side[2 * axis + 1];
  }
  DVI_TRY(dvi__draft_allocate(draft, simplices > 1 ? "kuhn" : "box", points, cells));
  fill_points(sizes, draft);
  return DVI_OK;
}

dvi_status dvi__generate_box(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int n = sizes->dimension;
  place p = {{0}};
  int *vertex;
  draft->terms.kind = DVI_BOXES;
  DVI_TRY(prepare(sizes, 1, draft));
  vertex = draft->vertex;
  for (int64_t c = 0; c < draft->terms.cells; c++, advance(n, sizes->cells, &p))
    for (int corner = 0; corner < 1 << n; corner++) *vertex++ = vertex_at(sizes, &p, corner);
  return DVI_OK;
}

/* Give order number i of n axes, from 0 to n! - 1. */
static void order_of(int n, int i, int *order)
{
  int left[DVI_MESH_DIMENSION_MAX] = {0, 1, 2, 3};
  for (int count = n; count > 0; count--) {
    const int at = i % count;
    i /= count;
    order[n - count] = left[at];
    for (int j = at; j + 1 < count; j++) left[j] = left[j + 1];
  }
}

dvi_status dvi__generate_kuhn(const dvi__sizes *sizes, dvi__draft *draft)
{
  static const int factorial[] = {1, 1, 2, 6, 24};
  const int n = sizes->dimension, simplices = factorial[n];
  place p = {{0}};
  DVI_TRY(prepare(sizes, simplices, draft));
  int *vertex = draft->vertex;
  for (int64_t c = 0; c < draft->terms.cells; c += simplices, advance(n, sizes->cells, &p))
    for (int i = 0; i < simplices; i++) {
      int order[DVI_MESH_DIMENSION_MAX], corner = 0;
      order_of(n, i, order);
      *vertex++ = vertex_at(sizes, &p, 0);
      for (int step = 0; step < n; step++)
        *vertex++ = vertex_at(sizes, &p, corner |= 1 << order[step]);
    }
  return DVI_OK;
}
