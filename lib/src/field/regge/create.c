#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/complex.h"
#include "field/mesh/volume.h"
#include "field/regge/regge.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "regge: no memory for the complex");
}

/* ---- edges and hinges ---- */

/* Give the number of the face of a cell with these corners, of which there are k + 1. */
static int face_of(const dvi_mesh *mesh, int k, const int *vertex, const int *corner)
{
  int found[DVI__CORNERS_OF_SIMPLEX];
  for (int i = 0; i <= k; i++) found[i] = vertex[corner[i]];
  return (int)dvi__complex_find(mesh, k, found);
}

static void number_faces(dvi_regge *r, int64_t cell)
{
  const int n = r->n, *vertex = r->mesh->corner[n] + cell * (n + 1);
  for (int a = 0; a <= n; a++)
    for (int b = a + 1; b <= n; b++) {
      const int64_t at = cell * r->pairs + dvi__pair(n, a, b);
      int others[DVI__CORNERS_OF_SIMPLEX], count = 0;
      for (int i = 0; i <= n; i++)
        if (i != a && i != b) others[count++] = i;
      r->edge[at] = face_of(r->mesh, 1, vertex, (const int[]){a, b});
      r->hinge[at] = face_of(r->mesh, n - 2, vertex, others);
      r->owner[r->hinge[at]] = at;
    }
}

static void mark_boundary(const dvi_mesh *mesh, int k, unsigned char *marked, int64_t *count)
{
  const int *cell = dvi_mesh_part_cells(mesh, "boundary", k, count);
  for (int64_t i = 0; i < *count; i++) marked[cell[i]] = 1;
}

/* ---- the pattern ---- */

/* The cells at each edge. */
typedef struct stars {
  int64_t *start; /* [edges+1] */
  int *cell;
  int *seen;  /* [edges] the last edge, plus 1, in whose row an edge was found */
  int *found; /* [edges] */
} stars;

static void list_stars(const dvi_regge *r, stars *s)
{
  const int64_t places = r->cells * r->pairs;
  for (int64_t i = 0; i < places; i++) s->start[r->edge[i] + 1]++;
  for (int64_t e = 0; e < r->edges; e++) s->start[e + 1] += s->start[e];
  for (int64_t i = 0; i < places; i++) s->cell[s->start[r->edge[i]]++] = (int)(i / r->pairs);
  for (int64_t e = r->edges; e > 0; e--) s->start[e] = s->start[e - 1];
  s->start[0] = 0;
}

static void sort(int count, int *number)
{
  for (int i = 1; i < count; i++) {
    const int next = number[i];
    int at = i;
    for (; at > 0 && number[at - 1] > next; at--) number[at] = number[at - 1];
    number[at] = next;
  }
}

/* Find the columns of row e, ascending. Returns their number. */
static int find_row(const dvi_regge *r, stars *s, int64_t e)
{
  int count = 0;
  for (int64_t i = s->start[e]; i < s->start[e + 1]; i++)
    for (int p = 0; p < r->pairs; p++) {
      const int f = r->edge[(int64_t)s->cell[i] * r->pairs + p];
      if (s->seen[f] == (int)e + 1) continue;
      s->seen[f] = (int)e + 1;
      s->found[count++] = f;
    }
  sort(count, s->found);
  return count;
}

static dvi_status fill_pattern(dvi_regge *r, stars *s)
{
  int64_t entries = 0;
  list_stars(r, s);
  for (int64_t e = 0; e < r->edges; e++) entries += find_row(r, s, e);
  if (entries > INT_MAX / 2)
    return dvi__fail(DVI_BAD_SIZE, "regge: an int cannot number %lld entries of the Hessian",
                     (long long)entries);
  DVI_TRY(dvi__csr_allocate(r->edges, r->edges, entries, &r->pattern));
  memset(s->seen, 0, (size_t)r->edges * sizeof *s->seen);
  for (int64_t e = 0, at = 0; e < r->edges; e++) {
    const int count = find_row(r, s, e);
    memcpy(r->pattern.column + at, s->found, (size_t)count * sizeof(int));
    at += count;
    r->pattern.start[e + 1] = at;
  }
  return DVI_OK;
}

static dvi_status make_pattern(dvi_regge *r)
{
  stars s = {.start = DVI_NEW(int64_t, r->edges + 1),
             .cell = DVI_NEW(int, r->cells * r->pairs),
             .seen = DVI_NEW(int, r->edges),
             .found = DVI_NEW(int, r->edges)};
  dvi_status status = s.start != NULL && s.cell != NULL && s.seen != NULL && s.found != NULL
                          ? fill_pattern(r, &s)
                          : no_memory();
  dvi__release(s.start);
  dvi__release(s.cell);
  dvi__release(s.seen);
  dvi__release(s.found);
  return status;
}

/* ---- the complex ---- */

static dvi_status check_terms(const dvi_regge_terms *terms)
{
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: set terms.size to sizeof(dvi_regge_terms)");
  if (terms->mesh == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "regge: a mesh is needed");
  if (!isfinite(terms->lambda))
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: Lambda is %g, and must be finite", terms->lambda);
  const dvi_mesh *mesh = terms->mesh;
  if (mesh->kind != DVI_SIMPLICES || mesh->n < 3)
    return dvi__fail(DVI_UNSUPPORTED,
                     "regge: the mesh has cells of kind '%s', and tetrahedra or 4-simplices are "
                     "needed: divide boxes as the generator kuhn does; the action of a surface "
                     "does not depend on its lengths",
                     dvi__degree_name(mesh->kind, mesh->n));
  if (mesh->branching < 0) return DVI_OK;
  const dvi__cell_name name = dvi__name_cell(mesh, mesh->n - 1, mesh->branching);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "regge: %s belongs to more than two cells, so that deficits mean nothing there: "
                   "take the cells that are too many out of the mesh",
                   name.text);
}

static dvi_status build(dvi_regge *r)
{
  int64_t rim;
  r->edge = DVI_NEW(int, r->cells * r->pairs);
  r->hinge = DVI_NEW(int, r->cells * r->pairs);
  r->owner = DVI_NEW(int64_t, r->hinges);
  r->outer = DVI_NEW(unsigned char, r->hinges);
  r->rim = DVI_NEW(unsigned char, r->edges);
  if (r->edge == NULL || r->hinge == NULL || r->owner == NULL || r->outer == NULL || r->rim == NULL)
    return no_memory();
  for (int64_t c = 0; c < r->cells; c++) number_faces(r, c);
  mark_boundary(r->mesh, r->n - 2, r->outer, &r->boundary_hinges);
  mark_boundary(r->mesh, 1, r->rim, &rim);
  return make_pattern(r);
}

dvi_status dvi_regge_create(const dvi_regge_terms *terms, dvi_regge **regge)
{
  if (terms == NULL || regge == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: terms and a complex are needed");
  *regge = NULL;
  DVI_TRY(check_terms(terms));
  dvi_regge *r = DVI_NEW(dvi_regge, 1);
  if (r == NULL) return no_memory();
  const int n = terms->mesh->n;
  r->mesh = dvi_mesh_share(terms->mesh);
  r->n = n;
  r->pairs = dvi__pairs(n);
  r->lambda = terms->lambda;
  r->cells = terms->mesh->count[n];
  r->edges = terms->mesh->count[1];
  r->hinges = terms->mesh->count[n - 2];
  const dvi_status status = build(r);
  if (status != DVI_OK) dvi_regge_destroy(&r);
  *regge = r;
  return status;
}

void dvi_regge_destroy(dvi_regge **regge)
{
  if (regge == NULL || *regge == NULL) return;
  dvi_regge *r = *regge;
  dvi_mesh_destroy(&r->mesh);
  dvi__release(r->edge);
  dvi__release(r->hinge);
  dvi__release(r->owner);
  dvi__release(r->outer);
  dvi__release(r->rim);
  dvi__csr_clear(&r->pattern);
  dvi__release(r);
  *regge = NULL;
}

const dvi_mesh *dvi_regge_mesh(const dvi_regge *regge)
{
  return regge->mesh;
}

dvi_status dvi_regge_lengths(const dvi_regge *regge, double *length)
{
  DVI_TRY(dvi__regge_check(regge, length));
  for (int64_t e = 0; e < regge->edges; e++) length[e] = dvi__cell_volume(regge->mesh, 1, e);
  return DVI_OK;
}
