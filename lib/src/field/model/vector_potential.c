/* A potential of a field B: the solution of K A = d^T M_{k+1} B by conjugate gradients. K is
 * semidefinite, and the right side is in its range. Where B has no potential, dA is the part of B
 * that has one, which the difference tells. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/algebra/conjugate.h"
#include "field/model/field.h"

/* Part of B that dA may miss. */
static const double roundoff = 1e-14, negligible = 1e-9;

typedef struct inverse {
  const dvi_field *field;
  dvi_matrix d, M;
  double *right, *x; /* [unknowns] */
  double *H, *curl;  /* [(k+1)-cells], [k-cells] */
} inverse;

static dvi_status times(void *of, const double *x, double *y)
{
  const dvi_matrix K = dvi__csr_view(&((const inverse *)of)->field->stiffness, 1);
  dvi_matrix_multiply(&K, 0, x, y);
  return DVI_OK;
}

/* The diagonal of M keeps directions in the range of M^-1 K, if M is diagonal. */
static void precondition(void *of, const double *r, double *z)
{
  const dvi_field *f = ((const inverse *)of)->field;
  for (int64_t i = 0; i < f->unknowns; i++)
    z[i] = r[i] / f->mass.value[dvi__csr_find(&f->mass, i, (int)i)];
}

static dvi_status check(const inverse *v, const double *B, const double *A)
{
  double left = 0, size = 0;
  dvi_matrix_multiply(&v->d, 0, A, v->H);
  for (int64_t i = 0; i < v->d.rows; i++) {
    left = fmax(left, fabs(v->H[i] - B[i]));
    size = fmax(size, fabs(B[i]));
  }
  if (left <= negligible * size) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "maxwell: no potential has this field B, %.2g of which is left: it has a "
                   "divergence, passes through an electric wall, or winds around a hole",
                   left / size);
}

static dvi_status solve(inverse *v, const double *B, double *A)
{
  const dvi_field *f = v->field;
  dvi_matrix_multiply(&v->M, 0, B, v->H);
  dvi_matrix_multiply(&v->d, 1, v->H, v->curl);
  for (int64_t i = 0; i < f->unknowns; i++) v->right[i] = v->curl[f->unknown[i]];
  const dvi__products products = {
      .size = f->unknowns, .times = times, .precondition = precondition, .of = v};
  DVI_TRY(dvi__conjugate_gradients(&products, roundoff, v->right, v->x, NULL));
  memset(v->curl, 0, (size_t)f->cells * sizeof *v->curl);
  for (int64_t i = 0; i < f->unknowns; i++) v->curl[f->unknown[i]] = v->x[i];
  DVI_TRY(check(v, B, v->curl));
  memcpy(A, v->curl, (size_t)f->cells * sizeof *A);
  return DVI_OK;
}

dvi_status dvi_field_vector_potential(const dvi_field *field, const double *B, double *A)
{
  inverse v = {.field = field};
  if (field == NULL || B == NULL || A == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a field, B and a place for A are needed");
  DVI_TRY(dvi__refuse_share_but(field->mesh, "maxwell: a start by B, whose potential is sought,",
                                "a start by A"));
  DVI_TRY(dvi_mesh_incidence(field->mesh, field->degree, &v.d));
  DVI_TRY(dvi_star_matrix(field->star, field->degree + 1, &v.M));
  v.right = DVI_NEW(double, 2 * field->unknowns + v.d.rows + field->cells);
  if (v.right == NULL) return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for a potential");
  v.x = v.right + field->unknowns;
  v.H = v.x + field->unknowns;
  v.curl = v.H + v.d.rows;
  const dvi_status status = solve(&v, B, A);
  dvi__release(v.right);
  return status;
}
