/* The corners of all n-cells are joined across the facets that have them. At a vertex that is not
 * pinched all corners are then one set. Pairs of corners are joined in the same way for edges. */
#include "field/audit/pinch.h"

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/complex.h"
#include "field/mesh/connected.h"

typedef struct sets {
  const dvi_mesh *mesh;
  int corners, width; /* of an n-cell; sets of a cell: its corners, or pairs of them */
  int *parent;        /* [cells*width] */
} sets;

/* Find the corner of a cell at a vertex, or -1. */
static int corner_at(const sets *s, int64_t cell, int vertex)
{
  const int *corner = s->mesh->corner[s->mesh->n] + cell * s->corners;
  for (int c = 0; c < s->corners; c++)
    if (corner[c] == vertex) return c;
  return -1;
}

/* Join the corners, or the pairs of corners, of two cells that their common facet has. */
static void join_cells(sets *s, int64_t one, int64_t other)
{
  const int *corner = s->mesh->corner[s->mesh->n] + one * s->corners;
  int same[DVI__CORNERS];
  for (int c = 0; c < s->corners; c++) same[c] = corner_at(s, other, corner[c]);
  for (int a = 0; a < s->corners; a++)
    for (int b = s->width > s->corners ? 0 : a; b <= a; b++) {
      if (same[a] < 0 || same[b] < 0 || (s->width > s->corners && a == b)) continue;
      const int high = same[a] > same[b] ? same[a] : same[b],
                low = same[a] > same[b] ? same[b] : same[a],
                here = s->width > s->corners ? a * s->corners + b : a,
                there = s->width > s->corners ? high * s->corners + low : same[a];
      (void)dvi__join(s->parent, (int)(one * s->width + here), (int)(other * s->width + there));
    }
}

static dvi_status join_all(sets *s)
{
  const dvi_mesh *mesh = s->mesh;
  const int64_t count = mesh->count[mesh->n] * s->width;
  if (count > INT32_MAX)
    return dvi__fail(DVI_BAD_SIZE, "audit: an int cannot number %lld corners", (long long)count);
  s->parent = DVI_NEW(int, count);
  if (s->parent == NULL) return dvi__fail(DVI_NO_MEMORY, "audit: no memory");
  for (int i = 0; i < count; i++) s->parent[i] = i;
  for (int64_t f = 0; f < mesh->count[mesh->n - 1]; f++)
    if (mesh->coface[2 * f + 1] >= 0) join_cells(s, mesh->coface[2 * f], mesh->coface[2 * f + 1]);
  return DVI_OK;
}

/* Count the sets that a vertex has beside its first one. */
static dvi_status count_vertices(sets *s, int64_t *count, int64_t *vertex)
{
  const dvi_mesh *mesh = s->mesh;
  const int64_t all = mesh->count[mesh->n] * s->corners;
  char *seen = DVI_NEW(char, mesh->count[0]);
  if (seen == NULL) return dvi__fail(DVI_NO_MEMORY, "audit: no memory");
  for (int i = 0; i < all; i++) {
    const int v = mesh->corner[mesh->n][i];
    if (dvi__root_of(s->parent, i) != i) continue;
    *count += seen[v] == 1;
    if (seen[v] == 1) *vertex = v;
    if (seen[v] < 2) seen[v]++;
  }
  dvi__release(seen);
  return DVI_OK;
}

/* Count the edges that have more than one set. */
static dvi_status count_edges(sets *s, int64_t *count)
{
  const dvi_mesh *mesh = s->mesh;
  char *seen = DVI_NEW(char, mesh->count[1]);
  if (seen == NULL) return dvi__fail(DVI_NO_MEMORY, "audit: no memory");
  for (int64_t cell = 0; cell < mesh->count[mesh->n]; cell++)
    for (int a = 0; a < s->corners; a++)
      for (int b = 0; b < a; b++) {
        const int i = (int)(cell * s->width) + a * s->corners + b,
                  *corner = mesh->corner[mesh->n] + cell * s->corners,
                  pair[] = {corner[a], corner[b]};
        if (dvi__root_of(s->parent, i) != i) continue;
        const int64_t edge = dvi__complex_find(mesh, 1, pair);
        *count += seen[edge] == 1;
        if (seen[edge] < 2) seen[edge]++;
      }
  dvi__release(seen);
  return DVI_OK;
}

dvi_status dvi__find_pinches(const dvi_mesh *mesh, int64_t *count, int64_t *vertex)
{
  const int corners = dvi__corners(mesh->kind, mesh->n);
  sets s = {.mesh = mesh, .corners = corners, .width = corners};
  *count = 0;
  *vertex = -1;
  if (mesh->n < 2) return DVI_OK;
  dvi_status status = join_all(&s);
  if (status == DVI_OK) status = count_vertices(&s, count, vertex);
  dvi__release(s.parent);
  if (status != DVI_OK || mesh->n < 3 || mesh->kind != DVI_SIMPLICES) return status;
  s.width = corners * corners;
  status = join_all(&s);
  if (status == DVI_OK) status = count_edges(&s, count);
  dvi__release(s.parent);
  return status;
}
