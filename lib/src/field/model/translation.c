/* Translations q -> q + epsilon D_a q of a linear field on a mesh that repeats itself along all
 * axes, with
 *
 *     (D_a u)_v = -1/(2 m_v) sum over neighbours w of  M_1(v,w) (x_w - x_v)_a u_w ,
 *
 * which is the negative central difference on a grid. It moves the field along the axis, so that
 * p.D_a q is positive for waves that run there, as -int u' u_x is. If all vertices have equal
 * surroundings, D_a commutes with K and p.D_a q is conserved as every quadratic invariant with a
 * linear symmetry is. Whether that holds is tested on a random field. */
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/model/field.h"

/* Part of its terms that the commutator may leave. */
static const double roundoff = 1e-12;

/* ---- the matrix ---- */

/* D_a has the pattern of K, whose entries are -M_1. */
static dvi_status make(const dvi_field *f, int axis, dvi__csr *D)
{
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 0);
  double to[DVI_MESH_SPACE_MAX];
  DVI_TRY(dvi__csr_copy(&K, D));
  for (int64_t i = 0; i < D->rows; i++)
    for (int64_t e = D->start[i]; e < D->start[i + 1]; e++) {
      dvi__mesh_difference(f->mesh, f->unknown[i], f->unknown[D->column[e]], to);
      D->value[e] *= to[axis] / (2 * f->weight[i]);
    }
  return DVI_OK;
}

/* ---- the test ---- */

static double largest(int64_t n, const double *x)
{
  double most = 0;
  for (int64_t i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* A D + D^T A = 0 with the symmetric matrix A, on the field r. x and y have room for n numbers. */
static int keeps(const dvi_matrix *A, const dvi_matrix *D, const double *r, double *x, double *y,
                 double *z)
{
  const int64_t n = A->rows;
  dvi_matrix_multiply(D, 0, r, x);
  dvi_matrix_multiply(A, 0, x, y);
  dvi_matrix_multiply(A, 0, r, x);
  dvi_matrix_multiply(D, 1, x, z);
  const double size = largest(n, y);
  for (int64_t i = 0; i < n; i++) y[i] += z[i];
  return largest(n, y) <= roundoff * size;
}

static int is_symmetry(const dvi_field *f, const dvi__csr *D, double *room)
{
  const int64_t n = f->unknowns;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1), M = dvi__csr_view(&f->mass, 1),
                   translation = dvi__csr_view(D, 0);
  (void)dvi__fill_random(n, 7, room);
  return largest(D->start[n], D->value) > 0 &&
         keeps(&K, &translation, room, room + n, room + 2 * n, room + 3 * n) &&
         keeps(&M, &translation, room, room + n, room + 2 * n, room + 3 * n);
}

/* ---- all ---- */

static int may_have_translations(const dvi_field *f)
{
  if (f->potential.density != NULL || f->unknowns < f->cells || f->mesh->space != f->mesh->n)
    return 0;
  for (int64_t i = 0; i < f->unknowns; i++)
    if (f->load[i] != 0) return 0;
  for (int l = 0; l < f->mesh->space; l++)
    if (f->mesh->period[l] > 0) return 1;
  return 0;
}

dvi_status dvi__field_find_translations(dvi_field *field)
{
  dvi_status status = DVI_OK;
  if (!may_have_translations(field)) return DVI_OK;
  double *room = DVI_NEW(double, 4 * field->unknowns);
  if (room == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for translations");
  for (int a = 0; a < field->mesh->space && status == DVI_OK; a++) {
    dvi__translation *found = field->translation + field->translations;
    if (!(field->mesh->period[a] > 0)) continue;
    status = make(field, a, &found->D);
    if (status != DVI_OK) continue;
    if (is_symmetry(field, &found->D, room)) {
      (void)snprintf(found->name, sizeof found->name, "momentum_%c", "xyzwabcd"[a]);
      field->translations++;
    } else {
      dvi__csr_clear(&found->D);
    }
  }
  dvi__release(room);
  return status;
}
