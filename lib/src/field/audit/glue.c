/* Simplices glued to boxes. Neighbours whose common facet has a dual edge of no length have one
 * circumcentre. A group of such neighbours is a box if its vertices are the corners of one. */
#include <dvi/audit.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/connected.h"
#include "field/mesh/part.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

static const double negligible = 1e-10;

typedef struct gluing {
  const dvi_mesh *mesh;
  int n, corners; /* of a box */
  int *group;     /* [simplices] number of the box */
  int *first;     /* [simplices] for each box its first simplex */
  int *found;     /* [boxes] number of vertices found so far */
  int *vertex;    /* [boxes*corners] */
  int64_t boxes;
} gluing;

/* ---- groups ---- */

/* Join neighbours, and number the groups. */
static void find_groups(gluing *g, const double *dual)
{
  const dvi_mesh *mesh = g->mesh;
  const int64_t cells = mesh->count[g->n];
  double most = 0;
  for (int64_t f = 0; f < mesh->count[g->n - 1]; f++) most = fmax(most, fabs(dual[f]));
  for (int c = 0; c < cells; c++) g->group[c] = c;
  for (int64_t f = 0; f < mesh->count[g->n - 1]; f++) {
    const int *cell = mesh->coface + 2 * f;
    if (cell[1] < 0 || fabs(dual[f]) > negligible * most) continue;
    (void)dvi__join(g->group, cell[0], cell[1]);
  }
  for (int c = 0; c < cells; c++) { /* roots come before their members */
    const int root = g->group[c];
    if (root == c) g->first[g->boxes] = c;
    g->group[c] = root == c ? (int)g->boxes++ : g->group[root];
  }
}

static dvi_status refuse(const gluing *g, int64_t cell, const char *why)
{
  const dvi__cell_name name = dvi__name_cell(g->mesh, g->n, cell);
  return dvi__fail(DVI_UNSUPPORTED, "glue: %s and those with the same circumcentre %s", name.text,
                   why);
}

static dvi_status add_vertices(gluing *g, int64_t cell)
{
  const int *corner = g->mesh->corner[g->n] + cell * (g->n + 1);
  const int64_t box = g->group[cell];
  int *vertex = g->vertex + box * g->corners;
  for (int c = 0; c <= g->n; c++) {
    int i = 0;
    while (i < g->found[box] && vertex[i] != corner[c]) i++;
    if (i < g->found[box]) continue;
    if (i == g->corners) return refuse(g, cell, "have more vertices than a box");
    vertex[g->found[box]++] = corner[c];
  }
  return DVI_OK;
}

/* ---- boxes ---- */

/* Put the vertices of a box in the order of its corners. */
static int order_corners(const gluing *g, int64_t box)
{
  int *vertex = g->vertex + box * g->corners, ordered[DVI__CORNERS];
  double x[DVI__CORNERS][DVI_MESH_SPACE_MAX], least[DVI_MESH_DIMENSION_MAX],
      most[DVI_MESH_DIMENSION_MAX];
  if (g->found[box] != g->corners) return 0;
  for (int a = 0; a < g->n; a++) {
    least[a] = INFINITY;
    most[a] = -INFINITY;
    for (int c = 0; c < g->corners; c++) {
      dvi__mesh_difference(g->mesh, vertex[0], vertex[c], x[c]);
      least[a] = fmin(least[a], x[c][a]);
      most[a] = fmax(most[a], x[c][a]);
    }
  }
  for (int c = 0; c < g->corners; c++) ordered[c] = -1;
  for (int c = 0; c < g->corners; c++) {
    int place = 0;
    for (int a = 0; a < g->n; a++) {
      const double part = (x[c][a] - least[a]) / (most[a] - least[a]);
      if (fabs(part - round(part)) > 1e-9) return 0;
      place |= (part > 0.5) << a;
    }
    if (ordered[place] >= 0) return 0;
    ordered[place] = vertex[c];
  }
  memcpy(vertex, ordered, (size_t)g->corners * sizeof *vertex);
  return 1;
}

static dvi_status make_boxes(gluing *g)
{
  const int64_t cells = g->mesh->count[g->n];
  for (int64_t c = 0; c < cells; c++) DVI_TRY(add_vertices(g, c));
  for (int64_t box = 0; box < g->boxes; box++)
    if (!order_corners(g, box)) return refuse(g, g->first[box], "make no box along the axes");
  return DVI_OK;
}

/* ---- parts ---- */

/* Mark the boxes whose simplices all belong to a part. */
static dvi_status mark_boxes(const gluing *g, const dvi__part *part, char *marked)
{
  for (int64_t i = 0; i < part->count[g->n]; i++) marked[g->group[part->cell[g->n][i]]] = 1;
  int64_t inside = 0;
  for (int64_t c = 0; c < g->mesh->count[g->n]; c++) inside += marked[g->group[c]];
  if (inside == part->count[g->n]) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "glue: part \"%s\" has a part of a box only", part->name);
}

/* Mark the faces whose corners all belong to a part, and compare their sizes. */
static dvi_status mark_faces(const gluing *g, const dvi__part *part, const dvi_mesh *glued,
                             char *marked)
{
  const int k = part->degree, corners = dvi__corners(DVI_BOXES, k);
  double before = 0, after = 0;
  char *vertex = DVI_NEW(char, glued->count[0]);
  if (vertex == NULL) return dvi__fail(DVI_NO_MEMORY, "glue: no memory");
  for (int64_t i = 0; i < part->count[0]; i++) vertex[part->cell[0][i]] = 1;
  for (int64_t i = 0; i < part->count[k]; i++)
    before += dvi__cell_volume(g->mesh, k, part->cell[k][i]);
  for (int64_t c = 0; c < glued->count[k]; c++) {
    int all = 1;
    for (int i = 0; i < corners; i++)
      all = all && vertex[k > 0 ? glued->corner[k][c * corners + i] : c];
    marked[c] = (char)all;
    if (all) after += dvi__cell_volume(glued, k, c);
  }
  dvi__release(vertex);
  if (fabs(after - before) <= 1e-9 * before) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "glue: part \"%s\" does not consist of faces of boxes",
                   part->name);
}

static dvi_status add_parts(const gluing *g, dvi_mesh *glued)
{
  int64_t most = 0;
  for (int k = 0; k <= g->n; k++) most = glued->count[k] > most ? glued->count[k] : most;
  char *marked = DVI_NEW(char, most);
  dvi_status status = marked != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "glue: no memory");
  for (int i = 2; i < g->mesh->parts && status == DVI_OK; i++) {
    const dvi__part *part = g->mesh->part + i;
    memset(marked, 0, (size_t)most);
    status = part->degree == g->n ? mark_boxes(g, part, marked)
                                  : mark_faces(g, part, glued, marked);
    if (status == DVI_OK) status = dvi__part_add(glued, part->name, part->degree, marked);
  }
  dvi__release(marked);
  return status;
}

/* ---- the new mesh ---- */

static dvi_status glue(gluing *g, dvi_mesh **glued)
{
  const dvi_mesh *mesh = g->mesh;
  dvi_star *star = NULL;
  DVI_TRY(dvi_star_create(mesh, NULL, &star));
  find_groups(g, star->dual[g->n - 1]);
  dvi_star_destroy(&star);
  g->found = DVI_NEW(int, g->boxes);
  g->vertex = DVI_NEW(int, g->boxes * g->corners);
  if (g->found == NULL || g->vertex == NULL) return dvi__fail(DVI_NO_MEMORY, "glue: no memory");
  DVI_TRY(make_boxes(g));
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = DVI_BOXES,
                                .dimension = g->n,
                                .points = mesh->count[0],
                                .point = mesh->point,
                                .cells = g->boxes,
                                .vertex = g->vertex,
                                .metric = mesh->metric,
                                .period = mesh->period};
  DVI_TRY(dvi_mesh_create(&terms, glued));
  const dvi_status status = add_parts(g, *glued);
  if (status != DVI_OK) dvi_mesh_destroy(glued);
  return status;
}

dvi_status dvi_mesh_glue(const dvi_mesh *mesh, dvi_mesh **glued)
{
  if (mesh == NULL || glued == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "glue: a mesh and a place for the new one are needed");
  *glued = NULL;
  DVI_TRY(dvi__refuse_share(mesh, "glue: a seam"));
  if (mesh->kind != DVI_SIMPLICES || mesh->space != mesh->n || mesh->n < 2)
    return dvi__fail(DVI_UNSUPPORTED, "glue: the cells are no simplices of two dimensions or more "
                                      "that fill their space");
  gluing g = {.mesh = mesh,
              .n = mesh->n,
              .corners = dvi__corners(DVI_BOXES, mesh->n),
              .group = DVI_NEW(int, mesh->count[mesh->n]),
              .first = DVI_NEW(int, mesh->count[mesh->n])};
  const dvi_status status = g.group != NULL && g.first != NULL
                                ? glue(&g, glued)
                                : dvi__fail(DVI_NO_MEMORY, "glue: no memory");
  dvi__release(g.group);
  dvi__release(g.first);
  dvi__release(g.found);
  dvi__release(g.vertex);
  return status;
}
