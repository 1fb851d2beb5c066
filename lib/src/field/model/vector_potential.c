/* A potential of a field B: the solution of K A = d^T M_{k+1} B by conjugate gradients. K is
 * semidefinite, and the right side is in its range. Where B has no potential, dA is the part of B
 * that has one, which the difference tells. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/algebra/conjugate.h"
#include "field/model/vector_potential.h"

/* Part of B that dA may miss. */
static const double roundoff = 1e-14, negligible = 1e-9;

static dvi_status times(void *of, const double *x, double *y)
{
  const dvi_matrix K = dvi__csr_view(&((const dvi__inverse *)of)->field->stiffness, 1);
  dvi_matrix_multiply(&K, 0, x, y);
  return DVI_OK;
}

/* The diagonal of M keeps directions in the range of M^-1 K, if M is diagonal. */
static void precondition(void *of, const double *r, double *z)
{
  const dvi_field *f = ((const dvi__inverse *)of)->field;
  for (int64_t i = 0; i < f->unknowns; i++)
    z[i] = r[i] / f->mass.value[dvi__csr_find(&f->mass, i, (int)i)];
}

static dvi_status check(const dvi__inverse *v, const double *A)
{
  const dvi_mesh *mesh = v->field->mesh;
  double most[2] = {0, 0};
  dvi_matrix_multiply(&v->d, 0, A, v->H);
  for (int64_t i = 0; i < v->d.rows; i++) {
    if (!dvi__owns(mesh, v->field->degree + 1, i)) continue;
    most[0] = fmax(most[0], fabs(v->H[i] - v->B[i]));
    most[1] = fmax(most[1], fabs(v->B[i]));
  }
  DVI_TRY(dvi__largest_of_all(mesh, 2, most));
  if (most[0] <= negligible * most[1]) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "maxwell: no potential has this field B, %.2g of which is left: it has a "
                   "divergence, passes through an electric wall, or winds around a hole",
                   most[0] / most[1]);
}

static dvi_status solve_alone(dvi__inverse *v)
{
  const dvi_field *f = v->field;
  dvi_matrix_multiply(&v->M, 0, v->B, v->H);
  dvi_matrix_multiply(&v->d, 1, v->H, v->curl);
  for (int64_t i = 0; i < f->unknowns; i++) v->right[i] = v->curl[f->unknown[i]];
  const dvi__products products = {
      .size = f->unknowns, .times = times, .precondition = precondition, .of = v};
  return dvi__conjugate_gradients(&products, roundoff, v->right, v->x, NULL);
}

static dvi_status solve(dvi__inverse *v, double *A)
{
  const dvi_field *f = v->field;
  DVI_TRY(f->mesh->share != NULL ? dvi__potential_on_all(v) : solve_alone(v));
  memset(v->curl, 0, (size_t)f->cells * sizeof *v->curl);
  for (int64_t i = 0; i < f->unknowns; i++) v->curl[f->unknown[i]] = v->x[i];
  DVI_TRY(check(v, v->curl));
  memcpy(A, v->curl, (size_t)f->cells * sizeof *A);
  return DVI_OK;
}

/* Prepare the matrices, the room, and B of this process's cells. */
static dvi_status prepare(dvi__inverse *v, const double *B, double **room)
{
  const dvi_field *f = v->field;
  DVI_TRY(dvi_mesh_incidence(f->mesh, f->degree, &v->d));
  DVI_TRY(dvi_star_matrix(f->star, f->degree + 1, &v->M));
  *room = DVI_NEW(double, 2 * f->unknowns + 2 * v->d.rows + f->cells);
  if (*room == NULL) return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for a potential");
  v->right = *room;
  v->x = v->right + f->unknowns;
  v->H = v->x + f->unknowns;
  v->curl = v->H + v->d.rows;
  double *own = v->curl + f->cells;
  memcpy(own, B, (size_t)v->d.rows * sizeof *own);
  v->B = own;
  return DVI_OK;
}

dvi_status dvi_field_vector_potential(const dvi_field *field, const double *B, double *A)
{
  dvi__inverse v = {.field = field};
  double *room = NULL;
  if (field == NULL || B == NULL || A == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a field, B and a place for A are needed");
  dvi_status status = dvi__agree(field->mesh, prepare(&v, B, &room));
  if (status == DVI_OK && room != NULL)
    status = dvi__refresh(field->mesh, field->degree + 1, room + (v.B - room));
  if (status == DVI_OK) status = solve(&v, A);
  dvi__release(room);
  return status;
}
