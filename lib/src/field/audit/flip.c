/* Flips of edges. An inner edge has a negative dual if the angles opposite to it sum to more than
 * pi. The other diagonal of its two triangles has a positive one then. Each pass flips edges whose
 * triangles no other flip of the pass has, and makes the mesh anew. */
#include <dvi/audit.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/complex.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

/* In a plane flips come to an end, and on a surface they need not. */
enum { PASSES_ON_SURFACES = 400 };

static const double negligible = 1e-12;

typedef struct flipper {
  const dvi_mesh *mesh;
  char *kept;    /* [edges] edges of parts */
  char *touched; /* [triangles] in this pass */
  char *joined;  /* [vertices] by a new edge in this pass */
  int *vertex;   /* [3*triangles] of the new mesh, oriented alike */
  int64_t flips;
} flipper;

/* ---- what stays ---- */

/* Edges of parts stay, and edges between a cell of a part and another one. */
static void mark_kept(flipper *f)
{
  const dvi_mesh *mesh = f->mesh;
  for (int i = 2; i < mesh->parts; i++) {
    const dvi__part *part = mesh->part + i;
    if (part->degree == 1)
      for (int64_t k = 0; k < part->count[1]; k++) f->kept[part->cell[1][k]] = 1;
    if (part->degree < 2) continue;
    for (int64_t k = 0; k < part->count[2]; k++) f->touched[part->cell[2][k]] = 1;
    for (int64_t e = 0; e < mesh->count[1]; e++) {
      const int *cell = mesh->coface + 2 * e;
      if (cell[1] >= 0 && f->touched[cell[0]] != f->touched[cell[1]]) f->kept[e] = 1;
    }
    for (int64_t k = 0; k < part->count[2]; k++) f->touched[part->cell[2][k]] = 0;
  }
}

/* Orient all triangles as the mesh is. */
static void copy_triangles(flipper *f)
{
  const dvi_mesh *mesh = f->mesh;
  for (int64_t c = 0; c < mesh->count[2]; c++) {
    const int *corner = mesh->corner[2] + 3 * c;
    const int turned = mesh->orientation != NULL && mesh->orientation[c] < 0;
    f->vertex[3 * c] = corner[0];
    f->vertex[3 * c + 1] = corner[turned ? 2 : 1];
    f->vertex[3 * c + 2] = corner[turned ? 1 : 2];
  }
}

/* ---- a pass ---- */

static int find_corner(const int *triangle, int other_than, int or_than)
{
  int i = 0;
  while (triangle[i] == other_than || triangle[i] == or_than) i++;
  return i;
}

/* Tell if c and d can be joined across the edge of a: no other edge joins them, and where space
 * repeats itself no shorter way does. */
static int can_join(const flipper *f, int a, int c, int d)
{
  const int ends[] = {c, d};
  double ca[DVI_MESH_SPACE_MAX], ad[DVI_MESH_SPACE_MAX], cd[DVI_MESH_SPACE_MAX];
  if (c == d || (f->joined[c] && f->joined[d]) || dvi__complex_find(f->mesh, 1, ends) >= 0)
    return 0;
  dvi__mesh_difference(f->mesh, c, a, ca);
  dvi__mesh_difference(f->mesh, a, d, ad);
  dvi__mesh_difference(f->mesh, c, d, cd);
  for (int l = 0; l < f->mesh->space; l++)
    if (f->mesh->period[l] > 0 && fabs(ca[l] + ad[l] - cd[l]) > 0.25 * f->mesh->period[l]) return 0;
  return 1;
}

/* Replace (c, a, b) and (d, b, a) by (c, a, d) and (d, b, c). */
static void flip(flipper *f, int64_t e)
{
  const int *edge = f->mesh->corner[1] + 2 * e, *cell = f->mesh->coface + 2 * e;
  int *one = f->vertex + 3 * (int64_t)cell[0], *two = f->vertex + 3 * (int64_t)cell[1];
  const int at = find_corner(one, edge[0], edge[1]), other = find_corner(two, edge[0], edge[1]),
            c = one[at], d = two[other], a = one[(at + 1) % 3], b = one[(at + 2) % 3];
  const int first[] = {c, a, d}, second[] = {d, b, c};
  if (!can_join(f, a, c, d)) return;
  f->joined[c] = f->joined[d] = 1;
  for (int i = 0; i < 3; i++) {
    one[i] = first[i];
    two[i] = second[i];
  }
  f->touched[cell[0]] = f->touched[cell[1]] = 1;
  f->flips++;
}

static int64_t flip_some(flipper *f, const double *dual)
{
  const dvi_mesh *mesh = f->mesh;
  const int64_t before = f->flips;
  double most = 0;
  for (int64_t e = 0; e < mesh->count[1]; e++) most = fmax(most, fabs(dual[e]));
  for (int64_t e = 0; e < mesh->count[1]; e++) {
    const int *cell = mesh->coface + 2 * e;
    if (cell[1] < 0 || f->kept[e] || !(dual[e] < -negligible * most)) continue;
    if (!f->touched[cell[0]] && !f->touched[cell[1]]) flip(f, e);
  }
  return f->flips - before;
}

/* ---- the new mesh ---- */

static dvi_status make_again(const dvi_mesh *mesh, const int *vertex, dvi_mesh **again)
{
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = mesh->space,
                                .points = mesh->count[0],
                                .point = mesh->point,
                                .cells = mesh->count[2],
                                .vertex = vertex,
                                .metric = mesh->metric,
                                .period = mesh->period};
  dvi_mesh_terms all = terms;
  dvi_mesh_part *part = DVI_NEW(dvi_mesh_part, mesh->parts + 1);
  int **room = DVI_NEW(int *, mesh->parts + 1);
  dvi_status status = part != NULL && room != NULL ? DVI_OK
                                                   : dvi__fail(DVI_NO_MEMORY, "flip: no memory");
  for (int i = 2; i < mesh->parts && status == DVI_OK; i++) {
    const dvi__part *old = mesh->part + i;
    dvi_mesh_part *copy = part + all.parts++;
    *copy = (dvi_mesh_part){
        .name = old->name, .degree = old->degree, .count = old->count[old->degree]};
    if (old->degree != 1) {
      copy->cell = old->cell[old->degree];
      continue;
    }
    copy->vertex = room[i] = DVI_NEW(int, 2 * copy->count);
    if (room[i] == NULL) status = dvi__fail(DVI_NO_MEMORY, "flip: no memory");
    for (int64_t k = 0; k < 2 * copy->count && status == DVI_OK; k++)
      room[i][k] = mesh->corner[1][2 * (int64_t)old->cell[1][k / 2] + k % 2];
  }
  all.part = part;
  if (status == DVI_OK) status = dvi_mesh_create(&all, again);
  for (int i = 0; i < mesh->parts && room != NULL; i++) dvi__release(room[i]);
  dvi__release(room);
  dvi__release(part);
  return status;
}

/* Flip once, and make the next mesh if anything was flipped. */
static dvi_status pass(const dvi_mesh *mesh, int64_t *flips, dvi_mesh **next)
{
  dvi_star *star = NULL;
  flipper f = {.mesh = mesh,
               .kept = DVI_NEW(char, mesh->count[1]),
               .touched = DVI_NEW(char, mesh->count[2]),
               .joined = DVI_NEW(char, mesh->count[0]),
               .vertex = DVI_NEW(int, 3 * mesh->count[2])};
  dvi_status status = f.kept && f.touched && f.joined && f.vertex
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "flip: no memory");
  if (status == DVI_OK) status = dvi_star_create(mesh, NULL, &star);
  if (status == DVI_OK) {
    mark_kept(&f);
    copy_triangles(&f);
    *flips = flip_some(&f, star->dual[1]);
    if (*flips > 0) status = make_again(mesh, f.vertex, next);
  }
  dvi_star_destroy(&star);
  dvi__release(f.kept);
  dvi__release(f.touched);
  dvi__release(f.joined);
  dvi__release(f.vertex);
  return status;
}

dvi_status dvi_mesh_flip(const dvi_mesh *mesh, dvi_mesh **flipped, int64_t *flips)
{
  int64_t all = 0, now = 1;
  if (mesh == NULL || flipped == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "flip: a mesh and a place for the new one are needed");
  *flipped = NULL;
  DVI_TRY(dvi__refuse_share(mesh, "flip: a flip of edges"));
  if (mesh->n != 2 || mesh->kind != DVI_SIMPLICES)
    return dvi__fail(DVI_UNSUPPORTED,
                     "flip: the cells are no triangles: take the barycentric or Whitney's star, or "
                     "dvi_mesh_delaunay of the points");
  for (int l = 0; l < mesh->space; l++)
    if (mesh->metric[l] < 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "flip: axis %d of the mesh's metric is timelike, where a negative dual does "
                       "not ask for a flip",
                       l);
  dvi_mesh *current = dvi_mesh_share(mesh);
  dvi_status status = DVI_OK;
  const int is_plane = mesh->space == 2;
  for (int i = 0; (is_plane || i < PASSES_ON_SURFACES) && now > 0 && status == DVI_OK; i++) {
    dvi_mesh *next = NULL;
    now = 0;
    status = pass(current, &now, &next);
    all += now;
    if (status != DVI_OK || now == 0) continue;
    dvi_mesh_destroy(&current);
    current = next;
  }
  if (status == DVI_OK && now > 0)
    status = dvi__fail(DVI_NOT_CONVERGED, "flip: %lld edges were flipped without coming to an end",
                       (long long)all);
  if (status == DVI_OK) *flipped = dvi_mesh_share(current);
  dvi_mesh_destroy(&current);
  if (flips != NULL) *flips = all;
  return status;
}
