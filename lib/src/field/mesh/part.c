#include "field/mesh/part.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/complex.h"

enum { ALL, BOUNDARY, DECLARED };

static dvi_status no_memory(const char *name)
{
  return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for the part \"%s\"", name);
}

/* Take the marked k-cells into the part. */
static dvi_status take_marked(const dvi_mesh *mesh, dvi__part *part, int k, const char *marked)
{
  int64_t count = 0;
  for (int64_t c = 0; c < mesh->count[k]; c++) count += marked[c];
  part->count[k] = part->total[k] = count;
  part->cell[k] = DVI_NEW(int, count);
  if (part->cell[k] == NULL) return no_memory(part->name);
  for (int64_t c = 0, i = 0; c < mesh->count[k]; c++)
    if (marked[c]) part->cell[k][i++] = (int)c;
  return DVI_OK;
}

/* Mark the facets of the part's k-cells. */
static void mark_facets(const dvi_mesh *mesh, const dvi__part *part, int k, char *marked)
{
  const int slots = dvi__facets(mesh->kind, k);
  memset(marked, 0, (size_t)mesh->count[k - 1]);
  for (int64_t i = 0; i < part->count[k]; i++)
    for (int slot = 0; slot < slots; slot++)
      marked[mesh->facet[k][(size_t)part->cell[k][i] * (size_t)slots + (size_t)slot]] = 1;
}

static int64_t largest_count(const dvi_mesh *mesh)
{
  int64_t largest = 0;
  for (int k = 0; k <= mesh->n; k++)
    if (mesh->count[k] > largest) largest = mesh->count[k];
  return largest;
}

/* Take the marked cells of the part's degree, and all their faces. `marked` has room for the cells
 * of any degree. */
static dvi_status take_closure(const dvi_mesh *mesh, dvi__part *part, char *marked)
{
  DVI_TRY(take_marked(mesh, part, part->degree, marked));
  for (int k = part->degree; k > 0; k--) {
    mark_facets(mesh, part, k, marked);
    DVI_TRY(take_marked(mesh, part, k - 1, marked));
  }
  return DVI_OK;
}

/* ---- declared parts ---- */

static dvi_status find_by_number(const dvi_mesh *mesh, const dvi_mesh_part *declared, int64_t i,
                                 int64_t *cell)
{
  *cell = declared->cell[i];
  if (*cell >= 0 && *cell < mesh->count[declared->degree]) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT, "mesh: part \"%s\" has cell %lld of degree %d, beyond the %lld of the mesh",
      declared->name, (long long)*cell, declared->degree, (long long)mesh->count[declared->degree]);
}

static int has_vertices(const dvi_mesh *mesh, int64_t cell, const int *vertex)
{
  const int corners = dvi__corners(mesh->kind, mesh->n);
  return cell >= 0 && dvi__relative_orientation(mesh->kind, mesh->n, vertex,
                                                mesh->corner[mesh->n] + cell * corners) != 0;
}

/* The n-cells, which are not sorted, are known by those of one facet. A facet with more than two
 * cells does not know all of them. */
static int64_t find_whole_cell(const dvi_mesh *mesh, const int *vertex)
{
  const int n = mesh->n;
  int local[DVI__FACET_CORNERS], facet[DVI__FACET_CORNERS];
  dvi__facet_corners(mesh->kind, n, 0, local);
  for (int c = 0; c < dvi__corners(mesh->kind, n - 1); c++) facet[c] = vertex[local[c]];
  const int64_t at = dvi__complex_find(mesh, n - 1, facet);
  for (int i = 0; at >= 0 && i < 2; i++)
    if (has_vertices(mesh, mesh->coface[2 * at + i], vertex)) return mesh->coface[2 * at + i];
  const int64_t all = at >= 0 && mesh->branching >= 0 ? mesh->count[n] : 0;
  for (int64_t cell = 0; cell < all; cell++)
    if (has_vertices(mesh, cell, vertex)) return cell;
  return -1;
}

static dvi_status find_by_vertices(const dvi_mesh *mesh, const dvi_mesh_part *declared, int64_t i,
                                   int64_t *cell)
{
  const int corners = dvi__corners(mesh->kind, declared->degree),
            *vertex = declared->vertex + i * corners;
  for (int c = 0; c < corners; c++)
    if (vertex[c] < 0 || vertex[c] >= mesh->count[0])
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "mesh: part \"%s\" has vertex %d, beyond the %lld of the mesh",
                       declared->name, vertex[c], (long long)mesh->count[0]);
  *cell = declared->degree == mesh->n ? find_whole_cell(mesh, vertex)
                                      : dvi__complex_find(mesh, declared->degree, vertex);
  if (*cell >= 0) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "mesh: part \"%s\" has %s %lld with the vertices %d, %d%s, which the mesh has not",
      declared->name, dvi__degree_name(mesh->kind, declared->degree), (long long)i, vertex[0],
      vertex[corners > 1], corners > 2 ? ", .." : "");
}

static dvi_status mark_declared(const dvi_mesh *mesh, const dvi_mesh_part *declared, char *marked)
{
  int64_t cell = -1;
  memset(marked, 0, (size_t)mesh->count[declared->degree]);
  for (int64_t i = 0; i < declared->count; i++) {
    DVI_TRY(declared->cell != NULL ? find_by_number(mesh, declared, i, &cell)
                                   : find_by_vertices(mesh, declared, i, &cell));
    marked[cell] = 1;
  }
  return DVI_OK;
}

static dvi_status check_part(const dvi_mesh *mesh, const dvi_mesh_part *declared, int i)
{
  if (declared->name == NULL || declared->name[0] == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: part %d has no name", i);
  const int by_number = declared->cell != NULL;
  for (int p = 0; p < DECLARED + i; p++)
    if (strcmp(mesh->part[p].name, declared->name) == 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       p < DECLARED ? "mesh: every mesh has a part \"%s\": take another name"
                                    : "mesh: there are two parts with the name \"%s\"",
                       declared->name);
  if (declared->degree < 0 || declared->degree > mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: part \"%s\" has degree %d, which is not 0 to %d",
                     declared->name, declared->degree, mesh->n);
  if (declared->count < 1 || (declared->vertex != NULL) == by_number)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "mesh: part \"%s\" needs cells, by their vertices or by their numbers",
                     declared->name);
  if (by_number && declared->degree > 0 && declared->degree < mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "mesh: part \"%s\" of degree %d needs the vertices of its cells: only points "
                     "and whole cells are known by numbers",
                     declared->name, declared->degree);
  return DVI_OK;
}

static dvi_status name_part(dvi__part *part, const char *name, int degree)
{
  part->degree = degree;
  part->name = dvi__duplicate(name, strlen(name) + 1, 1);
  return part->name != NULL ? DVI_OK : no_memory(name);
}

/* ---- all parts ---- */

static dvi_status create_all(dvi_mesh *mesh)
{
  dvi__part *part = mesh->part + ALL;
  const int64_t largest = largest_count(mesh);
  int *numbers = DVI_NEW(int, largest);
  if (numbers == NULL) return no_memory("all");
  for (int64_t i = 0; i < largest; i++) numbers[i] = (int)i;
  for (int k = 0; k <= mesh->n; k++) {
    part->cell[k] = numbers; /* of all degrees */
    part->count[k] = part->total[k] = mesh->count[k];
  }
  return name_part(part, "all", mesh->n);
}

static dvi_status create_boundary(dvi_mesh *mesh, char *marked)
{
  dvi__part *part = mesh->part + BOUNDARY;
  DVI_TRY(name_part(part, "boundary", mesh->n - 1));
  for (int64_t f = 0; f < mesh->count[mesh->n - 1]; f++) marked[f] = mesh->coface[2 * f + 1] < 0;
  return take_closure(mesh, part, marked);
}

static dvi_status create_parts(dvi_mesh *mesh, const dvi_mesh_terms *terms, char *marked)
{
  DVI_TRY(create_boundary(mesh, marked));
  for (int i = 0; i < terms->parts; i++) {
    const dvi_mesh_part *declared = terms->part + i;
    DVI_TRY(check_part(mesh, declared, i));
    DVI_TRY(name_part(mesh->part + DECLARED + i, declared->name, declared->degree));
    DVI_TRY(mark_declared(mesh, declared, marked));
    DVI_TRY(take_closure(mesh, mesh->part + DECLARED + i, marked));
  }
  return DVI_OK;
}

dvi_status dvi__parts_create(dvi_mesh *mesh, const dvi_mesh_terms *terms)
{
  mesh->part = DVI_NEW(dvi__part, DECLARED + terms->parts);
  if (mesh->part == NULL) return no_memory("all");
  mesh->parts = DECLARED + terms->parts;
  DVI_TRY(create_all(mesh));
  char *marked = DVI_NEW(char, largest_count(mesh));
  const dvi_status status = marked != NULL ? create_parts(mesh, terms, marked)
                                           : no_memory("boundary");
  dvi__release(marked);
  return status;
}

dvi_status dvi__part_add(dvi_mesh *mesh, const char *name, int degree, char *marked)
{
  const size_t parts = (size_t)mesh->parts;
  dvi__part *more = DVI_NEW(dvi__part, parts + 1);
  if (more == NULL) return no_memory(name);
  memcpy(more, mesh->part, parts * sizeof *more);
  dvi__release(mesh->part);
  mesh->part = more;
  mesh->parts++;
  DVI_TRY(name_part(more + parts, name, degree));
  return take_closure(mesh, more + parts, marked);
}

dvi_status dvi__parts_resize(dvi_mesh *mesh, int parts)
{
  dvi__parts_clear(mesh);
  mesh->parts = 0;
  mesh->part = DVI_NEW(dvi__part, parts);
  if (mesh->part == NULL) return no_memory("all");
  mesh->parts = parts;
  return DVI_OK;
}

dvi_status dvi__part_take(dvi_mesh *mesh, int p, const dvi__part *whole, int k, const char *marked)
{
  dvi__part *part = mesh->part + p;
  if (part->name == NULL) DVI_TRY(name_part(part, whole->name, whole->degree));
  DVI_TRY(take_marked(mesh, part, k, marked));
  part->total[k] = whole->total[k];
  return DVI_OK;
}

void dvi__parts_clear(dvi_mesh *mesh)
{
  for (int p = 0; p < mesh->parts; p++) {
    dvi__part *part = mesh->part + p;
    dvi__release(part->name);
    const int is_one_list = p == ALL && part->cell[0] == part->cell[mesh->n];
    for (int k = 0; k <= (is_one_list ? 0 : mesh->n); k++) dvi__release(part->cell[k]);
  }
  dvi__release(mesh->part);
}

static const dvi__part *find_part(const dvi_mesh *mesh, const char *name)
{
  int p = 0;
  while (p < mesh->parts && strcmp(mesh->part[p].name, name) != 0) p++;
  return p < mesh->parts ? mesh->part + p : NULL;
}

const int *dvi_mesh_part_cells(const dvi_mesh *mesh, const char *name, int k, int64_t *count)
{
  int64_t unasked;
  if (count == NULL) count = &unasked;
  *count = -1;
  if (mesh == NULL || name == NULL || k < 0 || k > mesh->n) return NULL;
  const dvi__part *part = find_part(mesh, name);
  if (part == NULL) return NULL;
  *count = part->count[k];
  return part->cell[k];
}

int64_t dvi__part_total(const dvi_mesh *mesh, const char *name, int k)
{
  const dvi__part *part = find_part(mesh, name);
  return part != NULL ? part->total[k] : -1;
}

const char *dvi_mesh_part_name(const dvi_mesh *mesh, int i)
{
  return mesh != NULL && i >= 0 && i < mesh->parts ? mesh->part[i].name : NULL;
}

int dvi_mesh_part_degree(const dvi_mesh *mesh, int i)
{
  return mesh != NULL && i >= 0 && i < mesh->parts ? mesh->part[i].degree : -1;
}
