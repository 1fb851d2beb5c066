#include "field/connection/surface.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/ring.h"
#include "field/mesh/connected.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for a surface");
}

/* ---- nodes ---- */

/* Number the nodes by their lowest vertices. */
static dvi_status find_nodes(dvi__surface *s)
{
  const int64_t vertices = s->mesh->count[0];
  int64_t count;
  const int *rim = dvi_mesh_part_cells(s->mesh, "boundary", 1, &count);
  int *root = DVI_NEW(int, vertices);
  if (root == NULL) return no_memory();
  for (int v = 0; v < vertices; v++) root[v] = v;
  for (int64_t i = 0; i < count; i++) {
    const int *end = s->mesh->corner[1] + 2 * (int64_t)rim[i];
    (void)dvi__join(root, end[0], end[1]);
    s->role[rim[i]] = DVI__EDGE_BOUNDARY;
  }
  for (int v = 0; v < vertices; v++) {
    const int r = dvi__root_of(root, v);
    s->node[v] = r == v ? (int)s->nodes++ : s->node[r];
  }
  dvi__release(root);
  return DVI_OK;
}

/* ---- trees ---- */

static void grow_triangles(dvi__surface *s, int64_t root)
{
  int64_t length = 1;
  for (int64_t c = 0; c < s->mesh->count[2]; c++) s->parent[c] = -2;
  s->order[0] = (int)root;
  s->parent[root] = -1;
  for (int64_t done = 0; done < length; done++)
    for (int slot = 0; slot < 3; slot++) {
      const int64_t cell = s->order[done], edge = s->mesh->facet[2][3 * cell + slot];
      const int next = dvi__cell_behind(s->mesh, cell, slot);
      if (next < 0 || s->parent[next] != -2) continue;
      s->parent[next] = 0;
      while (s->mesh->facet[2][3 * (int64_t)next + s->parent[next]] != edge) s->parent[next]++;
      s->role[edge] = DVI__EDGE_OF_TRIANGLES;
      s->order[length++] = next;
    }
}

/* Edges that join two parts of the forest of nodes belong to it. */
static dvi_status grow_nodes(dvi__surface *s)
{
  int *root = DVI_NEW(int, s->nodes);
  if (root == NULL) return no_memory();
  for (int i = 0; i < s->nodes; i++) root[i] = i;
  for (int64_t e = 0; e < s->mesh->count[1]; e++) {
    const int *end = s->mesh->corner[1] + 2 * e;
    if (s->role[e] == DVI__EDGE_FREE && dvi__join(root, s->node[end[0]], s->node[end[1]]))
      s->role[e] = DVI__EDGE_OF_NODES;
  }
  dvi__release(root);
  return DVI_OK;
}

/* ---- all ---- */

dvi_status dvi__is_surface(const dvi_mesh *mesh, int *is_surface)
{
  *is_surface = 0;
  if (mesh->n != 2 || mesh->kind != DVI_SIMPLICES || mesh->orientation == NULL) return DVI_OK;
  int *root = DVI_NEW(int, mesh->count[0]);
  if (root == NULL) return no_memory();
  dvi__find_components(mesh, root);
  *is_surface = 1;
  for (int64_t v = 0; v < mesh->count[0] && *is_surface; v++) *is_surface = root[v] == 0;
  dvi__release(root);
  return DVI_OK;
}

dvi_status dvi__check_surface(const dvi_mesh *mesh)
{
  int is_surface;
  DVI_TRY(dvi__is_surface(mesh, &is_surface));
  if (is_surface) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "curvature: directions are for connected orientable surfaces of triangles, and "
                   "this mesh %s",
                   mesh->n != 2                ? "has cells of another dimension"
                   : mesh->orientation == NULL ? "is not orientable"
                                               : "is not connected; take its components alone");
}

static dvi_status make(dvi__surface *s, int64_t root)
{
  s->node = DVI_NEW(int, s->mesh->count[0]);
  s->order = DVI_NEW(int, s->mesh->count[2]);
  s->parent = DVI_NEW(int, s->mesh->count[2]);
  s->role = DVI_NEW(char, s->mesh->count[1]);
  if (s->node == NULL || s->order == NULL || s->parent == NULL || s->role == NULL)
    return no_memory();
  DVI_TRY(find_nodes(s));
  grow_triangles(s, root);
  return grow_nodes(s);
}

dvi_status dvi__surface_create(const dvi_mesh *mesh, int64_t root, dvi__surface *surface)
{
  *surface = (dvi__surface){.mesh = mesh};
  const dvi_status status = make(surface, root);
  if (status != DVI_OK) dvi__surface_clear(surface);
  return status;
}

void dvi__surface_clear(dvi__surface *surface)
{
  dvi__release(surface->node);
  dvi__release(surface->order);
  dvi__release(surface->parent);
  dvi__release(surface->role);
  memset(surface, 0, sizeof *surface);
}

int dvi__edge_sense(const dvi_mesh *mesh, int64_t edge)
{
  const int64_t cell = mesh->coface[2 * edge];
  int slot = 0;
  while (mesh->facet[2][3 * cell + slot] != edge) slot++;
  return mesh->sign[2][3 * cell + slot] * mesh->orientation[cell];
}
