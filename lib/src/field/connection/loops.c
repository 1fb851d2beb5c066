/* Loops of triangles: from the two triangles at a free edge to the triangle where their ways to the
 * root of the tree meet. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/connection.h"
#include "field/connection/surface.h"

/* Set the number of steps to the root. */
static void find_depths(const dvi__surface *s, int *depth)
{
  for (int64_t i = 1; i < s->mesh->count[2]; i++) {
    const int cell = s->order[i];
    depth[cell] = depth[dvi__cell_behind(s->mesh, cell, s->parent[cell])] + 1;
  }
}

/* Write the loop: down from where the ways meet to the first triangle, through the edge to the
 * second, and up. Returns its length. With `loop` NULL it is only measured. */
static int64_t trace(const dvi__surface *s, const int *depth, int64_t edge, int *loop)
{
  const int *pair = s->mesh->coface + 2 * edge;
  int a = pair[0], b = pair[1];
  int64_t before = 1, after = 1;
  for (int left = a, right = b; left != right;) {
    const int is_left = depth[left] >= depth[right];
    const int cell = is_left ? left : right, up = dvi__cell_behind(s->mesh, cell, s->parent[cell]);
    *(is_left ? &left : &right) = up;
    *(is_left ? &before : &after) += 1;
  }
  if (loop == NULL) return before + after;
  for (int64_t i = before - 1; i >= 0; i--) {
    loop[i] = a;
    if (i > 0) a = dvi__cell_behind(s->mesh, a, s->parent[a]);
  }
  loop[before] = b;
  for (int64_t i = before + 1; i < before + after; i++) {
    b = dvi__cell_behind(s->mesh, b, s->parent[b]);
    loop[i] = b;
  }
  return before + after;
}

static dvi_status store(const dvi__surface *s, const int *depth, dvi_connection *c)
{
  for (int64_t e = 0; e < s->mesh->count[1]; e++) c->loops += s->role[e] == DVI__EDGE_FREE;
  c->loop_start = DVI_NEW(int64_t, c->loops + 1);
  if (c->loop_start == NULL) return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for loops");
  int64_t loop = 0;
  for (int64_t e = 0; e < s->mesh->count[1]; e++) {
    if (s->role[e] != DVI__EDGE_FREE) continue;
    c->loop_start[loop + 1] = c->loop_start[loop] + trace(s, depth, e, NULL);
    loop++;
  }
  c->loop_cell = DVI_NEW(int, c->loop_start[c->loops]);
  if (c->loop_cell == NULL) return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for loops");
  loop = 0;
  for (int64_t e = 0; e < s->mesh->count[1]; e++)
    if (s->role[e] == DVI__EDGE_FREE)
      (void)trace(s, depth, e, c->loop_cell + c->loop_start[loop++]);
  return DVI_OK;
}

dvi_status dvi__find_loops(dvi_connection *c)
{
  dvi__surface s;
  int is_surface;
  DVI_TRY(dvi__is_surface(c->mesh, &is_surface));
  if (!is_surface) return DVI_OK;
  DVI_TRY(dvi__surface_create(c->mesh, 0, &s));
  int *depth = DVI_NEW(int, c->mesh->count[2]);
  dvi_status status = DVI_NO_MEMORY;
  if (depth != NULL) {
    find_depths(&s, depth);
    status = store(&s, depth, c);
  } else {
    status = dvi__fail(DVI_NO_MEMORY, "curvature: no memory for loops");
  }
  dvi__release(depth);
  dvi__surface_clear(&s);
  return status;
}

int64_t dvi_connection_loops(const dvi_connection *connection)
{
  return connection != NULL ? connection->loops : 0;
}

const int *dvi_connection_loop(const dvi_connection *connection, int64_t loop, int64_t *count)
{
  if (count != NULL) *count = 0;
  if (connection == NULL || loop < 0 || loop >= connection->loops) return NULL;
  const int64_t first = connection->loop_start[loop];
  if (count != NULL) *count = connection->loop_start[loop + 1] - first;
  return connection->loop_cell + first;
}
