/* Shares of a mesh: the cells of one process, those around them, and their owners. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/part.h"
#include "field/mesh/share.h"

/* A cut. Lists of the whole mesh are [cells]. */
typedef struct cut {
  const dvi_mesh *whole;
  const int *owner; /* of the n-cells */
  dvi_ranks ranks;
  int *owners[DVI__DEGREES]; /* of the k-cells */
  char *taken[DVI__DEGREES]; /* cells of the share */
  int *place;                /* of the vertices in the share */
  double *point;
  int *vertex; /* of the share's n-cells */
  char *marked;
  int64_t points, cells;
} cut;

/* ---- checks ---- */

static dvi_status check_ranks(const dvi_ranks *ranks)
{
  if (ranks->size != sizeof *ranks)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: set ranks.size to sizeof(dvi_ranks)");
  if (ranks->count < 1 || ranks->rank < 0 || ranks->rank >= ranks->count)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: there is no process %d of %d", ranks->rank,
                     ranks->count);
  if (ranks->refresh == NULL || ranks->sum == NULL || ranks->largest == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: the processes need refresh, sum and largest");
  return DVI_OK;
}

/* Every process has cells. */
static dvi_status check_owners(const dvi_mesh *mesh, const int *owner, int processes)
{
  char *has_cells = DVI_NEW(char, processes);
  dvi_status status = has_cells != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "mesh: no memory");
  for (int64_t c = 0; c < mesh->count[mesh->n] && status == DVI_OK; c++) {
    if (owner[c] >= 0 && owner[c] < processes)
      has_cells[owner[c]] = 1;
    else
      status = dvi__fail(DVI_BAD_ARGUMENT, "mesh: cell %lld is of process %d, and there are %d",
                         (long long)c, owner[c], processes);
  }
  for (int r = 0; r < processes && status == DVI_OK; r++)
    if (!has_cells[r])
      status = dvi__fail(DVI_BAD_ARGUMENT,
                         "mesh: process %d of %d has no cell of %lld: take fewer processes", r,
                         processes, (long long)mesh->count[mesh->n]);
  dvi__release(has_cells);
  return status;
}

/* ---- owners ---- */

/* A k-cell belongs to the owner of the first n-cell around it. The owners of (k+1)-cells are known,
 * but a first n-cell comes before others by its number, and not by its owner's. `first` [k+1-cells]
 * are those n-cells, and become those of the k-cells. */
static int *find_first(const dvi_mesh *mesh, int k, const int *first)
{
  const int slots = dvi__facets(mesh->kind, k + 1);
  int *found = DVI_NEW(int, mesh->count[k]);
  for (int64_t c = 0; c < mesh->count[k] && found != NULL; c++) found[c] = -1;
  for (int64_t i = 0; i < mesh->count[k + 1] * slots && found != NULL; i++) {
    int *here = found + mesh->facet[k + 1][i];
    const int cell = first != NULL ? first[i / slots] : (int)(i / slots);
    if (*here < 0 || cell < *here) *here = cell;
  }
  return found;
}

static dvi_status find_owners(cut *c)
{
  const dvi_mesh *mesh = c->whole;
  const int n = mesh->n;
  c->owners[n] = dvi__duplicate(c->owner, (size_t)mesh->count[n], sizeof *c->owner);
  int *above = NULL, has_memory = c->owners[n] != NULL;
  for (int k = n - 1; k >= 0 && has_memory; k--) {
    int *first = find_first(mesh, k, above);
    c->owners[k] = DVI_NEW(int, mesh->count[k]);
    has_memory = first != NULL && c->owners[k] != NULL;
    for (int64_t i = 0; i < mesh->count[k] && has_memory; i++) c->owners[k][i] = c->owner[first[i]];
    dvi__release(above);
    above = first;
  }
  dvi__release(above);
  return has_memory ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "mesh: no memory for owners");
}

/* ---- cells ---- */

/* Mark the faces of all marked cells. */
static void mark_faces(const cut *c)
{
  const dvi_mesh *mesh = c->whole;
  for (int k = mesh->n; k > 0; k--) {
    const int slots = dvi__facets(mesh->kind, k);
    for (int64_t i = 0; i < mesh->count[k] * slots; i++)
      if (c->taken[k][i / slots]) c->taken[k - 1][mesh->facet[k][i]] = 1;
  }
}

/* Take the n-cells of the process, those that touch them, and all faces. */
static dvi_status take_cells(cut *c)
{
  const dvi_mesh *mesh = c->whole;
  const int n = mesh->n, corners = dvi__corners(mesh->kind, n), *corner = mesh->corner[n];
  int has_memory = 1;
  for (int k = 0; k <= n; k++) {
    c->taken[k] = DVI_NEW(char, mesh->count[k]);
    has_memory = has_memory && c->taken[k] != NULL;
  }
  if (!has_memory || c->taken[0] == NULL || c->taken[n] == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
  for (int64_t i = 0; i < mesh->count[n] * corners; i++)
    if (c->owner[i / corners] == c->ranks.rank) c->taken[0][corner[i]] = 1;
  for (int64_t i = 0; i < mesh->count[n] * corners; i++)
    if (c->taken[0][corner[i]]) c->taken[n][i / corners] = 1;
  mark_faces(c);
  return DVI_OK;
}

/* ---- the mesh ---- */

static int64_t count_marked(const char *marked, int64_t count)
{
  int64_t sum = 0;
  for (int64_t i = 0; i < count && marked != NULL; i++) sum += marked[i];
  return sum;
}

static dvi_status copy_points(cut *c)
{
  const dvi_mesh *mesh = c->whole;
  const int space = mesh->space;
  c->points = count_marked(c->taken[0], mesh->count[0]);
  c->place = DVI_NEW(int, mesh->count[0]);
  c->point = DVI_NEW(double, c->points *space);
  if (c->place == NULL || c->point == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
  int kept = 0;
  for (int64_t v = 0; v < mesh->count[0]; v++) {
    if (!c->taken[0][v]) continue;
    memcpy(c->point + (int64_t)kept * space, mesh->point + v * space,
           (size_t)space * sizeof(double));
    c->place[v] = kept++;
  }
  return DVI_OK;
}

static dvi_status copy_cells(cut *c)
{
  const dvi_mesh *mesh = c->whole;
  const int n = mesh->n, corners = dvi__corners(mesh->kind, n);
  c->cells = count_marked(c->taken[n], mesh->count[n]);
  c->vertex = DVI_NEW(int, c->cells *corners);
  if (c->vertex == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
  int64_t kept = 0;
  for (int64_t i = 0; i < mesh->count[n] * corners; i++)
    if (c->taken[n][i / corners]) c->vertex[kept++] = c->place[mesh->corner[n][i]];
  return DVI_OK;
}

/* Number the cells as the whole mesh does. Both are in the same order. */
static dvi_status number_cells(const cut *c, dvi_mesh *made)
{
  dvi__share *share = made->share;
  for (int k = 0; k <= made->n; k++) {
    share->total[k] = c->whole->count[k];
    share->number[k] = DVI_NEW(int64_t, made->count[k]);
    share->owner[k] = DVI_NEW(int, made->count[k]);
    if (share->number[k] == NULL || share->owner[k] == NULL)
      return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
    int64_t kept = 0;
    for (int64_t i = 0; i < c->whole->count[k] && c->taken[k] != NULL; i++) {
      if (!c->taken[k][i]) continue;
      share->number[k][kept] = i;
      share->owner[k][kept++] = c->owners[k][i];
    }
  }
  return DVI_OK;
}

/* Mark the share's cells of a part. Those at its edge may belong to a part by n-cells beyond. */
static void mark_part(const cut *c, const dvi_mesh *made, const dvi__part *part, int k)
{
  const int64_t *number = made->share->number[k];
  int64_t here = 0;
  memset(c->marked, 0, (size_t)made->count[k]);
  for (int64_t i = 0; i < part->count[k]; i++) {
    while (here < made->count[k] && number[here] < part->cell[k][i]) here++;
    if (here < made->count[k] && number[here] == part->cell[k][i]) c->marked[here] = 1;
  }
}

/* Give the share the parts of the whole mesh, also those of which it has no cell. */
static dvi_status take_parts(const cut *c, dvi_mesh *made)
{
  DVI_TRY(dvi__parts_resize(made, c->whole->parts));
  for (int p = 0; p < made->parts; p++) {
    const dvi__part *part = c->whole->part + p;
    for (int k = 0; k <= part->degree; k++) {
      mark_part(c, made, part, k);
      DVI_TRY(dvi__part_take(made, p, part, k, c->marked));
    }
  }
  return DVI_OK;
}

/* In R^n cells are oriented as it is. A surface has the orientations of the whole mesh. */
static void copy_orientation(const cut *c, dvi_mesh *made)
{
  const int64_t *number = made->share->number[made->n];
  if (c->whole->orientation == NULL) {
    dvi__release(made->orientation);
    made->orientation = NULL;
  }
  for (int64_t i = 0; i < made->count[made->n] && made->orientation != NULL; i++)
    made->orientation[i] = c->whole->orientation[number[i]];
}

static void find_least(const dvi_mesh *whole, double *least)
{
  for (int64_t i = 0; i < whole->count[0] * whole->space; i++) {
    double *axis = least + i % whole->space;
    if (i < whole->space || whole->point[i] < *axis) *axis = whole->point[i];
  }
}

static dvi_status complete(cut *c, dvi_mesh *made)
{
  int64_t largest = 0;
  made->share = DVI_NEW(dvi__share, 1);
  if (made->share == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
  made->share->ranks = c->ranks;
  DVI_TRY(number_cells(c, made));
  find_least(c->whole, made->share->least);
  copy_orientation(c, made);
  for (int k = 0; k <= made->n; k++)
    if (made->count[k] > largest) largest = made->count[k];
  c->marked = DVI_NEW(char, largest);
  if (c->marked == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
  return take_parts(c, made);
}

static dvi_status make(cut *c, dvi_mesh **made)
{
  const dvi_mesh *mesh = c->whole;
  DVI_TRY(check_owners(mesh, c->owner, c->ranks.count));
  DVI_TRY(find_owners(c));
  DVI_TRY(take_cells(c));
  DVI_TRY(copy_points(c));
  DVI_TRY(copy_cells(c));
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = mesh->kind,
                                .dimension = mesh->n,
                                .space = mesh->space,
                                .points = c->points,
                                .point = c->point,
                                .cells = c->cells,
                                .vertex = c->vertex,
                                .metric = mesh->metric,
                                .period = mesh->period};
  DVI_TRY(dvi_mesh_create(&terms, made));
  return complete(c, *made);
}

static void clear(cut *c)
{
  for (int k = 0; k < DVI__DEGREES; k++) {
    dvi__release(c->owners[k]);
    dvi__release(c->taken[k]);
  }
  dvi__release(c->place);
  dvi__release(c->point);
  dvi__release(c->vertex);
  dvi__release(c->marked);
}

dvi_status dvi_mesh_cut(const dvi_mesh *mesh, const int *owner, const dvi_ranks *ranks,
                        dvi_mesh **share)
{
  if (mesh == NULL || owner == NULL || ranks == NULL || share == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: a mesh, owners and processes are needed");
  *share = NULL;
  DVI_TRY(check_ranks(ranks));
  if (mesh->share == NULL || mesh->share->ranks.count > 1) /* one process has the whole mesh */
    DVI_TRY(dvi__refuse_share(mesh, "mesh: a cut"));
  cut c = {.whole = mesh, .owner = owner, .ranks = *ranks};
  const dvi_status status = dvi__agree_among(ranks, make(&c, share));
  clear(&c);
  if (status != DVI_OK) dvi_mesh_destroy(share);
  return status;
}

const int64_t *dvi_mesh_share_numbers(const dvi_mesh *share, int k)
{
  const int known = share != NULL && share->share != NULL && k >= 0 && k <= share->n;
  return known ? share->share->number[k] : NULL;
}

const int *dvi_mesh_share_owners(const dvi_mesh *share, int k)
{
  const int known = share != NULL && share->share != NULL && k >= 0 && k <= share->n;
  return known ? share->share->owner[k] : NULL;
}
