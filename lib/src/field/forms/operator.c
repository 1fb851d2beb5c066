/* Operators of forms as sparse matrices. */
#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"

static dvi_status check(const dvi_star *star, int k, int least, const void *result)
{
  if (star == NULL || result == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: the star and a place for the result are needed");
  if (k >= least && k <= star->mesh->n)
    return dvi__refuse_share(star->mesh, "forms: an inverse of a star");
  return dvi__fail(DVI_BAD_ARGUMENT, "forms: degree %d is not from %d to %d", k, least,
                   star->mesh->n);
}

/* ---- solutions ---- */

static dvi_status refuse_zero(const dvi_star *star, int k, int64_t cell)
{
  const dvi__cell_name name = dvi__name_cell(star->mesh, k, cell);
  return dvi__fail(DVI_SINGULAR,
                   "star: M_%d has the entry 0 at %s: take a barycentric or a "
                   "Whitney star, or other points",
                   k, name.text);
}

static dvi_status divide(const dvi_star *star, int k, double *b)
{
  const int64_t count = star->mesh->count[k];
  const double *diagonal = star->diagonal[k];
  for (int64_t i = 0; i < count; i++)
    if (diagonal[i] == 0) return refuse_zero(star, k, i);
  for (int64_t i = 0; i < count; i++) b[i] /= diagonal[i];
  return DVI_OK;
}

dvi_status dvi_star_solve(const dvi_star *star, int k, double *b)
{
  dvi_matrix M;
  DVI_TRY(check(star, k, 0, b));
  if (star->diagonal[k] != NULL) return divide(star, k, b);
  DVI_TRY(dvi_star_matrix(star, k, &M));
  double *x = DVI_NEW(double, M.rows);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory for a solution");
  const dvi__products products = dvi__products_of(&M);
  const dvi_status status = dvi__conjugate_gradients(&products, 1e-16, b, x, NULL);
  for (int64_t i = 0; i < M.rows && status == DVI_OK; i++) b[i] = x[i];
  dvi__release(x);
  return status;
}

/* ---- matrices ---- */

/* Make M_{k-1}^-1 d_{k-1}^T M_k. */
static dvi_status make_codifferential(const dvi_star *star, int k, dvi__csr *result)
{
  dvi_matrix d, M;
  const double *diagonal = star->diagonal[k - 1];
  if (diagonal == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "forms: M_%d of this star is not diagonal, so that its inverse is full: take "
                     "the circumcentric star, or solve with dvi_star_solve",
                     k - 1);
  for (int64_t i = 0; i < star->mesh->count[k - 1]; i++)
    if (diagonal[i] == 0) return refuse_zero(star, k - 1, i);
  DVI_TRY(dvi_mesh_incidence(star->mesh, k - 1, &d));
  DVI_TRY(dvi_star_matrix(star, k, &M));
  DVI_TRY(dvi__csr_transposed_product(&d, &M, result));
  for (int64_t i = 0; i < result->rows; i++)
    for (int64_t e = result->start[i]; e < result->start[i + 1]; e++)
      result->value[e] /= diagonal[i];
  return DVI_OK;
}

dvi_status dvi_form_codifferential_create(const dvi_star *star, int k, dvi_matrix **codifferential)
{
  dvi__csr matrix = {0};
  DVI_TRY(check(star, k, 1, codifferential));
  *codifferential = NULL;
  DVI_TRY(make_codifferential(star, k, &matrix));
  return dvi__csr_give(&matrix, 0, codifferential);
}

dvi_status dvi__stiffness(const dvi_star *star, int k, dvi__csr *stiffness)
{
  dvi_matrix d, M;
  DVI_TRY(dvi_mesh_incidence(star->mesh, k, &d));
  DVI_TRY(dvi_star_matrix(star, k + 1, &M));
  return dvi__csr_square(&d, &M, stiffness);
}

/* Make M_k d_{k-1} M_{k-1}^-1 d_{k-1}^T M_k. */
static dvi_status make_lower_part(const dvi_star *star, int k, dvi__csr *part)
{
  dvi__csr codifferential = {0}, product = {0};
  dvi_matrix d, M;
  DVI_TRY(dvi_mesh_incidence(star->mesh, k - 1, &d));
  DVI_TRY(dvi_star_matrix(star, k, &M));
  DVI_TRY(make_codifferential(star, k, &codifferential));
  const dvi_matrix right = dvi__csr_view(&codifferential, 0);
  dvi_status status = dvi__csr_product(&d, &right, &product);
  const dvi_matrix inner = dvi__csr_view(&product, 0);
  if (status == DVI_OK) status = dvi__csr_product(&M, &inner, part);
  dvi__csr_clear(&codifferential);
  dvi__csr_clear(&product);
  return status;
}

static dvi_status make_laplacian(const dvi_star *star, int k, dvi__csr *laplacian)
{
  dvi__csr upper = {0}, lower = {0};
  if (k == 0) return dvi__stiffness(star, 0, laplacian);
  if (k == star->mesh->n) return make_lower_part(star, k, laplacian);
  dvi_status status = dvi__stiffness(star, k, &upper);
  if (status == DVI_OK) status = make_lower_part(star, k, &lower);
  const dvi_matrix a = dvi__csr_view(&upper, 1), b = dvi__csr_view(&lower, 1);
  if (status == DVI_OK) status = dvi__csr_sum(&a, &b, laplacian);
  dvi__csr_clear(&upper);
  dvi__csr_clear(&lower);
  return status;
}

dvi_status dvi_form_laplacian_create(const dvi_star *star, int k, dvi_matrix **laplacian)
{
  dvi__csr matrix = {0};
  DVI_TRY(check(star, k, 0, laplacian));
  *laplacian = NULL;
  DVI_TRY(make_laplacian(star, k, &matrix));
  return dvi__csr_give(&matrix, 1, laplacian);
}
