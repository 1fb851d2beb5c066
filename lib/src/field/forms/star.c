#include "field/forms/star.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/gram.h"
#include "field/mesh/share.h"

/* ---- diagonals ---- */

dvi_status dvi__refuse_null(const dvi_mesh *mesh, int k, int64_t cell)
{
  const dvi__cell_name name = dvi__name_cell(mesh, k, cell);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "star: %s has no volume in the mesh's metric: move its vertices", name.text);
}

/* Each vertex gets the same share of each cell around it. */
static dvi_status lump_vertices(dvi_star *star)
{
  const dvi_mesh *mesh = star->mesh;
  const int n = mesh->n, corners = dvi__corners(mesh->kind, n);
  double *vertex = star->diagonal[0] = DVI_NEW(double, mesh->count[0]);
  if (vertex == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory");
  for (int64_t c = 0; c < mesh->count[n]; c++) {
    const double factor = star->factor[0] != NULL ? star->factor[0][c] : 1,
                 share = factor * fabs(dvi__metric_volume(mesh, n, c)) / corners;
    for (int i = 0; i < corners; i++) vertex[mesh->corner[n][c * corners + i]] += share;
  }
  return DVI_OK;
}

/* An n-form is a constant in each cell. */
static dvi_status invert_volumes(dvi_star *star)
{
  const dvi_mesh *mesh = star->mesh;
  const int n = mesh->n;
  double *cell = star->diagonal[n] = DVI_NEW(double, mesh->count[n]);
  if (cell == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory");
  for (int64_t c = 0; c < mesh->count[n]; c++) {
    const double volume = dvi__metric_volume(mesh, n, c);
    if (volume == 0) return dvi__refuse_null(mesh, n, c);
    cell[c] = (star->factor[n] != NULL ? star->factor[n][c] : 1) / volume;
  }
  return DVI_OK;
}

/* ---- create ---- */

static dvi_status check_mesh(const dvi_mesh *mesh, dvi_star_kind kind)
{
  if ((unsigned)kind > DVI_SPECTRAL)
    return dvi__fail(DVI_BAD_ARGUMENT, "star: there is no kind %d", (int)kind);
  if (mesh->branching < 0) return DVI_OK;
  const dvi__cell_name name = dvi__name_cell(mesh, mesh->n - 1, mesh->branching);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "star: the mesh is no manifold: %s belongs to more than two %s", name.text,
                   "cells");
}

static dvi_status take_factors(dvi_star *star, const double *const *factor)
{
  const dvi_mesh *mesh = star->mesh;
  const int64_t cells = mesh->count[mesh->n];
  for (int k = 0; factor != NULL && k <= mesh->n; k++) {
    if (factor[k] == NULL) continue;
    star->factor[k] = dvi__duplicate(factor[k], (size_t)cells, sizeof(double));
    if (star->factor[k] == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory for factors");
    for (int64_t c = 0; c < cells; c++)
      if (!isfinite(factor[k][c]))
        return dvi__fail(DVI_BAD_ARGUMENT, "star: the factor of degree %d in cell %lld is %g", k,
                         (long long)c, factor[k][c]);
  }
  return DVI_OK;
}

static dvi_status make_spectral(const dvi_star *star, const dvi_star_options *options)
{
  for (int k = 0; options->factor != NULL && k <= star->mesh->n; k++)
    if (options->factor[k] != NULL)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "star: the spectral star takes no factors: its waves go through the whole "
                       "grid");
  return dvi__spectral_check(star->mesh);
}

static dvi_status make(dvi_star *star, const dvi_star_options *options)
{
  DVI_TRY(check_mesh(star->mesh, star->kind));
  DVI_TRY(take_factors(star, options->factor));
  if (star->kind == DVI_SPECTRAL) return make_spectral(star, options);
  if (star->kind == DVI_CIRCUMCENTRIC) return dvi__circumcentric_star(star);
  if (star->kind == DVI_BARYCENTRIC) DVI_TRY(lump_vertices(star));
  return invert_volumes(star);
}

dvi_status dvi__star_create(const dvi_mesh *mesh, const dvi_star_options *options, dvi_star **star)
{
  const dvi_star_options defaults = {.size = sizeof defaults};
  *star = NULL;
  if (options == NULL) options = &defaults;
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "star: set options.size to sizeof(dvi_star_options)");
  dvi_star *made = DVI_NEW(dvi_star, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory");
  atomic_init(&made->owners, 1);
  (void)pthread_mutex_init(&made->making, NULL);
  made->mesh = dvi_mesh_share(mesh);
  made->kind = options->kind;
  const dvi_status status = make(made, options);
  if (status == DVI_OK)
    *star = made;
  else
    dvi_star_destroy(&made);
  return status;
}

dvi_status dvi_star_create(const dvi_mesh *mesh, const dvi_star_options *options, dvi_star **star)
{
  if (mesh == NULL || star == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "star: mesh and star are needed");
  const dvi_status status = dvi__agree(mesh, dvi__star_create(mesh, options, star));
  if (status != DVI_OK) dvi_star_destroy(star);
  return status;
}

dvi_star *dvi_star_share(const dvi_star *star)
{
  dvi_star *shared = (dvi_star *)star;
  if (shared != NULL) atomic_fetch_add(&shared->owners, 1);
  return shared;
}

void dvi_star_destroy(dvi_star **star)
{
  if (star == NULL || *star == NULL) return;
  dvi_star *s = *star;
  *star = NULL;
  if (atomic_fetch_sub(&s->owners, 1) > 1) return;
  for (int k = 0; k < DVI__DEGREES; k++) {
    dvi__release(s->factor[k]);
    dvi__release(s->diagonal[k]);
    dvi__release(s->dual[k]);
    dvi__csr_clear(&s->matrix[k]);
  }
  (void)pthread_mutex_destroy(&s->making);
  dvi_mesh_destroy(&s->mesh);
  dvi__release(s);
}

/* ---- access ---- */

const dvi_mesh *dvi_star_mesh(const dvi_star *star)
{
  return star != NULL ? star->mesh : NULL;
}

const double *dvi_star_duals(const dvi_star *star, int k)
{
  return star != NULL && k >= 0 && k <= star->mesh->n ? star->dual[k] : NULL;
}

/* Make the matrix unless another thread has done so. */
static dvi_status make_once(dvi_star *star, int k)
{
  (void)pthread_mutex_lock(&star->making);
  dvi_status status = DVI_OK;
  if (star->matrix[k].value == NULL)
    status = star->kind == DVI_SPECTRAL ? dvi__spectral_star(star, k) : dvi__whitney_star(star, k);
  (void)pthread_mutex_unlock(&star->making);
  return status;
}

dvi_status dvi_star_matrix(const dvi_star *star, int k, dvi_matrix *matrix)
{
  if (star == NULL || matrix == NULL || k < 0 || k > star->mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "star: there is no matrix of degree %d", k);
  const int64_t count = star->mesh->count[k];
  *matrix = (dvi_matrix){
      .rows = count, .columns = count, .symmetric = 1, .width = 1, .value = star->diagonal[k]};
  if (star->diagonal[k] != NULL) return DVI_OK;
  DVI_TRY(make_once((dvi_star *)star, k));
  *matrix = dvi__csr_view(&star->matrix[k], 1);
  return DVI_OK;
}

/* ---- other factors ---- */

dvi_status dvi__star_with_factor(const dvi_star *star, int k, const double *factor,
                                 dvi__csr *matrix)
{
  const double *factors[DVI__DEGREES] = {NULL};
  dvi_star *made = NULL;
  dvi_matrix M;
  factors[k] = factor;
  const dvi_star_options options = {.size = sizeof options, .kind = star->kind, .factor = factors};
  dvi_status status = dvi__star_create(star->mesh, &options, &made);
  if (status == DVI_OK) status = dvi_star_matrix(made, k, &M);
  if (status == DVI_OK) status = dvi__csr_copy(&M, matrix);
  dvi_star_destroy(&made);
  return status;
}

dvi_status dvi__star_of_part(const dvi_star *star, int k, const char *mark, int which,
                             dvi__csr *matrix)
{
  const int64_t cells = star->mesh->count[star->mesh->n];
  const double *whole = star->factor[k];
  double *factor = DVI_NEW(double, cells);
  if (factor == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory for a part");
  for (int64_t c = 0; c < cells; c++)
    factor[c] = mark[c] != which ? 0 : whole != NULL ? whole[c] : 1;
  const dvi_status status = dvi__star_with_factor(star, k, factor, matrix);
  dvi__release(factor);
  return status;
}
