#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"
#include "field/regge/regge.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "regge: no memory for the complex");
}

/* ---- edges and hinges ---- */

static void number_faces(dvi_regge *r, int64_t cell)
{
  const int n = r->n, whole = (2 << n) - 1;
  int64_t number[DVI__CORNER_SETS];
  dvi__number_faces(r->mesh, cell, number);
  for (int a = 0; a <= n; a++)
    for (int b = a + 1; b <= n; b++) {
      const int64_t at = cell * r->pairs + dvi__pair(n, a, b);
      const int pair = 1 << a | 1 << b;
      r->edge[at] = (int)number[pair];
      r->hinge[at] = (int)number[whole & ~pair];
      r->owner[r->hinge[at]] = at;
    }
}

static void mark_boundary(const dvi_mesh *mesh, int k, unsigned char *marked, int64_t *count)
{
  const int *cell = dvi_mesh_part_cells(mesh, "boundary", k, count);
  for (int64_t i = 0; i < *count; i++) marked[cell[i]] = 1;
}

/* ---- the pattern ---- */

/* Edges of one simplex are coupled, as the incidence B of cells and edges has them in B^T B. */
static dvi_status make_pattern(dvi_regge *r)
{
  const int64_t places = r->cells * r->pairs;
  int8_t *one = DVI_NEW(int8_t, places);
  if (one == NULL) return no_memory();
  memset(one, 1, (size_t)places);
  const dvi_matrix B = {
      .rows = r->cells, .columns = r->edges, .width = r->pairs, .column = r->edge, .sign = one};
  const dvi_status status = dvi__csr_transposed_product(&B, &B, &r->pattern);
  dvi__release(one);
  if (status != DVI_OK) return status;
  const int64_t entries = r->pattern.start[r->edges];
  if (entries <= INT_MAX / 2) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "regge: an int cannot number %lld entries of the Hessian",
                   (long long)entries);
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
  DVI_TRY(dvi__refuse_share(terms->mesh, "regge: a complex"));
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
