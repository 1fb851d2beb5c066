/* The multisymplectic form formula on a set K of n-cells.
 *
 *     S_K = 1/2 (d a).M_{k+1} (d a)  with the star of K's cells alone,    d S_K . b = b.(R a)
 *
 * The second derivative of S_K is symmetric, so that b.(R a) = a.(R b) over all k-cells of K. Where
 * the rows R a and R b vanish inside of K, what is left are the cells on its boundary. Cut off at
 * K, a cell's dual is the sum of its pieces in K: the star of a material that is 0 outside of K.
 * Source: Marsden, Patrick and Shkoller 1998; Stern 2009, sec. 3.5.1. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"

/* K, and the rows of two forms. */
typedef struct formula {
  const dvi_star *star;
  int k;
  double *factor;             /* [n-cells] of the material, 0 outside of K */
  char *is_rim[DVI__DEGREES]; /* [cells of degree k to n-1] 1 on the boundary of K */
  double *du, *flux, *row[2]; /* [(k+1)-cells] twice, [k-cells] twice */
} formula;

static dvi_status check(const dvi_star *star, int k, int64_t cells, const int *cell)
{
  const dvi_mesh *mesh = star->mesh;
  if (star->kind == DVI_SPECTRAL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "forms: the spectral star is no sum over cells: take another star");
  if (k < 0 || k >= mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: degree %d is not from 0 to %d", k, mesh->n - 1);
  for (int64_t i = 0; i < cells; i++)
    if (cell[i] < 0 || cell[i] >= mesh->count[mesh->n])
      return dvi__fail(DVI_BAD_ARGUMENT, "forms: cell %d is not from 0 to %lld", cell[i],
                       (long long)mesh->count[mesh->n] - 1);
  return dvi__refuse_share(mesh, "forms: the multisymplectic formula");
}

static dvi_status allocate(formula *f)
{
  const dvi_mesh *mesh = f->star->mesh;
  int complete = 1;
  for (int degree = f->k; degree < mesh->n; degree++) {
    f->is_rim[degree] = DVI_NEW(char, mesh->count[degree]);
    complete = complete && f->is_rim[degree] != NULL;
  }
  f->factor = DVI_NEW(double, mesh->count[mesh->n]);
  f->du = DVI_NEW(double, mesh->count[f->k + 1]);
  f->flux = DVI_NEW(double, mesh->count[f->k + 1]);
  for (int i = 0; i < 2; i++) {
    f->row[i] = DVI_NEW(double, mesh->count[f->k]);
    complete = complete && f->row[i] != NULL;
  }
  return complete && f->factor && f->du && f->flux
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "forms: no memory for %lld cells",
                         (long long)mesh->count[mesh->n]);
}

static void clear(formula *f)
{
  for (int degree = 0; degree < DVI__DEGREES; degree++) dvi__release(f->is_rim[degree]);
  dvi__release(f->factor);
  dvi__release(f->du);
  dvi__release(f->flux);
  for (int i = 0; i < 2; i++) dvi__release(f->row[i]);
}

/* ---- the boundary of K ---- */

/* A facet is on the boundary if it belongs to one of K's cells, and to no second one: a mesh with a
 * star has no third one. */
static dvi_status find_facets(const formula *f, int64_t cells, const int *cell)
{
  const dvi_mesh *mesh = f->star->mesh;
  const int n = mesh->n, facets = dvi__facets(mesh->kind, n);
  char *in_K = DVI_NEW(char, mesh->count[n]);
  if (in_K == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory for a set of cells");
  dvi_status status = DVI_OK;
  for (int64_t i = 0; i < cells && status == DVI_OK; i++) {
    if (in_K[cell[i]])
      status = dvi__fail(DVI_BAD_ARGUMENT, "forms: cell %d is given twice", cell[i]);
    in_K[cell[i]] = 1;
    f->factor[cell[i]] = f->star->factor[f->k + 1] ? f->star->factor[f->k + 1][cell[i]] : 1;
    for (int j = 0; j < facets; j++)
      f->is_rim[n - 1][mesh->facet[n][(int64_t)cell[i] * facets + j]] ^= 1;
  }
  dvi__release(in_K);
  return status;
}

/* The faces of a boundary's facets are on the boundary, too. */
static void find_faces(const formula *f)
{
  const dvi_mesh *mesh = f->star->mesh;
  for (int degree = mesh->n - 1; degree > f->k; degree--) {
    const int facets = dvi__facets(mesh->kind, degree);
    for (int64_t i = 0; i < mesh->count[degree]; i++)
      for (int j = 0; j < facets && f->is_rim[degree][i]; j++)
        f->is_rim[degree - 1][mesh->facet[degree][i * facets + j]] = 1;
  }
}

/* ---- rows ---- */

static void find_row(const formula *f, const dvi_matrix *d, const dvi_matrix *M, const double *u,
                     double *row)
{
  dvi_matrix_multiply(d, 0, u, f->du);
  dvi_matrix_multiply(M, 0, f->du, f->flux);
  dvi_matrix_multiply(d, 1, f->flux, row);
}

static dvi_status find_rows(const formula *f, const double *a, const double *b)
{
  dvi_matrix d, M;
  dvi_star *star = NULL;
  const double *factor[DVI__DEGREES] = {NULL};
  factor[f->k + 1] = f->factor;
  const dvi_star_options options = {
      .size = sizeof options, .kind = f->star->kind, .factor = factor};
  DVI_TRY(dvi_star_create(f->star->mesh, &options, &star));
  dvi_status status = dvi_mesh_incidence(f->star->mesh, f->k, &d);
  if (status == DVI_OK) status = dvi_star_matrix(star, f->k + 1, &M);
  if (status == DVI_OK) {
    find_row(f, &d, &M, a, f->row[0]);
    find_row(f, &d, &M, b, f->row[1]);
  }
  dvi_star_destroy(&star);
  return status;
}

static dvi_status add_up(const formula *f, const double *a, const double *b, double *sum,
                         double *size)
{
  double total = 0, all = 0;
  for (int64_t s = 0; s < f->star->mesh->count[f->k]; s++) {
    if (!f->is_rim[f->k][s]) continue;
    const double ab = a[s] * f->row[1][s], ba = b[s] * f->row[0][s];
    total += ab - ba;
    all += fabs(ab) + fabs(ba);
  }
  if (!isfinite(all))
    return dvi__fail(DVI_NOT_FINITE, "forms: a product of the two forms is %g", all);
  *sum = total;
  if (size != NULL) *size = all;
  return DVI_OK;
}

dvi_status dvi_form_multisymplectic(const dvi_star *star, int k, int64_t cells, const int *cell,
                                    const double *a, const double *b, double *sum, double *size)
{
  if (star == NULL || cell == NULL || cells < 0 || a == NULL || b == NULL || sum == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "forms: a star, cells, two forms and a place for the sum are needed");
  DVI_TRY(check(star, k, cells, cell));
  formula f = {.star = star, .k = k};
  dvi_status status = allocate(&f);
  if (status == DVI_OK) status = find_facets(&f, cells, cell);
  if (status == DVI_OK) find_faces(&f);
  if (status == DVI_OK) status = find_rows(&f, a, b);
  if (status == DVI_OK) status = add_up(&f, a, b, sum, size);
  clear(&f);
  return status;
}
