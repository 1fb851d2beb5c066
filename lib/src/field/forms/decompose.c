/* Hodge's decomposition by conjugate gradients.
 *
 *     exact part    d a,             d^T M_k d a = d^T M_k form                     (degree k-1)
 *     coexact part  M_k^-1 d^T y,    d M_k^-1 d^T y = d form                        (degree k+1)
 *
 * Both matrices are semidefinite, and the right sides lie in their ranges. Entries on the
 * held cells are zero (Hirani 2003, ch. 6; Desbrun et al.
 * 2005). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/forms/hodge.h"
#include "field/mesh/share.h"

/* Part of a right side that conjugate gradients may leave. */
static const double roundoff = 1e-15;

void dvi__hodge_hold(const dvi__hodge *h, int degree, double *form)
{
  int64_t count = 0;
  const int *cell = h->held != NULL ? dvi_mesh_part_cells(h->star->mesh, h->held, degree, &count)
                                    : NULL;
  for (int64_t i = 0; i < count; i++) form[cell[i]] = 0;
}

/* M of a degree among the forms that vanish on the held cells. */
typedef struct held_star {
  const dvi__hodge *h;
  int degree;
  dvi_matrix M;
} held_star;

static dvi_status times_held(void *of, const double *x, double *y)
{
  const held_star *s = of;
  dvi_matrix_multiply(&s->M, 0, x, y);
  dvi__hodge_hold(s->h, s->degree, y);
  return DVI_OK;
}

/* A full star couples the held cells to the others. */
static dvi_status divide_among_held(const dvi__hodge *h, int degree, double *form)
{
  held_star s = {.h = h, .degree = degree};
  DVI_TRY(dvi_star_matrix(h->star, degree, &s.M));
  const dvi__products products = {.size = s.M.rows, .times = times_held, .of = &s};
  double *right = dvi__duplicate(form, (size_t)s.M.rows, sizeof *form);
  if (right == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  const dvi_status status = dvi__conjugate_gradients(&products, roundoff, right, form, NULL);
  dvi__release(right);
  return status;
}

dvi_status dvi__hodge_divide(const dvi__hodge *h, int degree, double *form)
{
  dvi__hodge_hold(h, degree, form);
  if (h->held != NULL && h->star->diagonal[degree] == NULL)
    return divide_among_held(h, degree, form);
  return dvi_star_solve(h->star, degree, form);
}

double dvi__hodge_product(const dvi__hodge *h, const double *a, const double *b)
{
  double sum = 0;
  dvi_matrix_multiply(&h->M, 0, b, h->work);
  for (int64_t i = 0; i < h->count; i++) sum += a[i] * h->work[i];
  return sum;
}

/* d^T M d of the forms below. */
static dvi_status times_below(void *of, const double *x, double *y)
{
  const dvi__hodge *h = of;
  dvi_matrix_multiply(&h->d_below, 0, x, h->work);
  dvi__hodge_hold(h, h->k, h->work);
  dvi_matrix_multiply(&h->M, 0, h->work, h->more);
  dvi__hodge_hold(h, h->k, h->more);
  dvi_matrix_multiply(&h->d_below, 1, h->more, y);
  dvi__hodge_hold(h, h->k - 1, y);
  return DVI_OK;
}

/* d M^-1 d^T of the forms above. */
static dvi_status times_above(void *of, const double *x, double *y)
{
  const dvi__hodge *h = of;
  dvi_matrix_multiply(&h->d, 1, x, h->work);
  DVI_TRY(dvi__hodge_divide(h, h->k, h->work));
  dvi_matrix_multiply(&h->d, 0, h->work, y);
  dvi__hodge_hold(h, h->k + 1, y);
  return DVI_OK;
}

static double length(int64_t count, const double *x)
{
  double sum = 0;
  for (int64_t i = 0; i < count; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

static dvi_status find_exact(dvi__hodge *h, const double *form, double *exact)
{
  memset(exact, 0, (size_t)h->count * sizeof *exact);
  if (h->k == 0) return DVI_OK;
  double *a = DVI_NEW(double, 2 * h->below);
  if (a == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory for a decomposition");
  double *b = a + h->below;
  dvi_matrix_multiply(&h->M, 0, form, h->work);
  dvi__hodge_hold(h, h->k, h->work);
  dvi_matrix_multiply(&h->d_below, 1, h->work, b);
  dvi__hodge_hold(h, h->k - 1, b);
  const dvi__products products = {.size = h->below,
                                  .times = times_below,
                                  .of = h,
                                  .roundoff = roundoff * length(h->count, h->work)};
  const dvi_status status = dvi__conjugate_gradients(&products, roundoff, b, a, NULL);
  if (status == DVI_OK) dvi_matrix_multiply(&h->d_below, 0, a, exact);
  dvi__hodge_hold(h, h->k, exact);
  dvi__release(a);
  return status;
}

static dvi_status find_coexact(dvi__hodge *h, const double *form, double *coexact)
{
  memset(coexact, 0, (size_t)h->count * sizeof *coexact);
  if (h->k == h->star->mesh->n) return DVI_OK;
  double *a = DVI_NEW(double, 2 * h->above);
  if (a == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory for a decomposition");
  double *b = a + h->above;
  dvi_matrix_multiply(&h->d, 0, form, b);
  dvi__hodge_hold(h, h->k + 1, b);
  const dvi__products products = {.size = h->above,
                                  .times = times_above,
                                  .of = h,
                                  .roundoff = roundoff * length(h->count, form)};
  dvi_status status = dvi__conjugate_gradients(&products, roundoff, b, a, NULL);
  if (status == DVI_OK) dvi_matrix_multiply(&h->d, 1, a, coexact);
  if (status == DVI_OK) status = dvi__hodge_divide(h, h->k, coexact);
  dvi__release(a);
  return status;
}

/* Refuse a diagonal star that is not positive before an iteration stumbles over it. */
static dvi_status check_definite(const dvi_star *star, int k)
{
  const double *entry = star->diagonal[k];
  for (int64_t s = 0; s < star->mesh->count[k] && entry != NULL; s++) {
    if (entry[s] > 0) continue;
    const dvi__cell_name name = dvi__name_cell(star->mesh, k, s);
    return dvi__fail(DVI_SINGULAR,
                     "forms: M_%d has the entry %g at %s, which is not positive: take the "
                     "barycentric star or Whitney's, or repair the mesh (dvi mesh --repair)",
                     k, entry[s], name.text);
  }
  return DVI_OK;
}

static dvi_status check_held(const dvi_mesh *mesh, const char *held)
{
  int64_t count = 0;
  if (held != NULL) (void)dvi_mesh_part_cells(mesh, held, 0, &count);
  if (count >= 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "forms: the mesh has no part \"%s\" to be held", held);
}

dvi_status dvi__hodge_begin(const dvi_star *star, int k, const char *held, dvi__hodge *h)
{
  if (star == NULL || k < 0 || k > star->mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "forms: the star and a degree from 0 to %d are needed, not "
                     "%d",
                     star != NULL ? star->mesh->n : 0, k);
  const dvi_mesh *mesh = star->mesh;
  DVI_TRY(dvi__refuse_share(mesh, "forms: a decomposition"));
  DVI_TRY(check_held(mesh, held));
  DVI_TRY(check_definite(star, k));
  *h = (dvi__hodge){.star = star, .k = k, .held = held};
  h->count = mesh->count[k];
  if (k > 0) h->below = mesh->count[k - 1];
  if (k < mesh->n) h->above = mesh->count[k + 1];
  if (k > 0) DVI_TRY(dvi_mesh_incidence(mesh, k - 1, &h->d_below));
  if (k < mesh->n) DVI_TRY(dvi_mesh_incidence(mesh, k, &h->d));
  DVI_TRY(dvi_star_matrix(star, k, &h->M));
  h->work = DVI_NEW(double, 2 * h->count);
  h->more = h->work + h->count;
  return h->work != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "forms: no memory");
}

void dvi__hodge_end(dvi__hodge *h)
{
  dvi__release(h->work);
}

/* What one pass leaves of the first two parts in the harmonic one, by roundoff, a second pass takes
 * out. */
dvi_status dvi__hodge_split(dvi__hodge *h, const double *form, double *part)
{
  double *exact = part, *coexact = part + h->count, *harmonic = part + 2 * h->count;
  double *found = DVI_NEW(double, h->count);
  dvi_status status = found != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  memset(part, 0, 2 * (size_t)h->count * sizeof *part);
  memcpy(harmonic, form, (size_t)h->count * sizeof *form);
  dvi__hodge_hold(h, h->k, harmonic);
  for (int pass = 0; pass < 4 && status == DVI_OK; pass++) {
    double *to = pass % 2 == 0 ? exact : coexact;
    status = (pass % 2 == 0 ? find_exact : find_coexact)(h, harmonic, found);
    for (int64_t i = 0; i < h->count && status == DVI_OK; i++) {
      to[i] += found[i];
      harmonic[i] -= found[i];
    }
  }
  dvi__release(found);
  return status;
}

static void copy_part(const double *part, int64_t count, double *to)
{
  if (to != NULL) memcpy(to, part, (size_t)count * sizeof *part);
}

dvi_status dvi_form_decompose(const dvi_star *star, int k, const char *held, const double *form,
                              double *exact, double *coexact, double *harmonic)
{
  dvi__hodge h;
  if (form == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "forms: a form is needed");
  DVI_TRY(dvi__hodge_begin(star, k, held, &h));
  double *part = DVI_NEW(double, 3 * h.count);
  dvi_status status = part != NULL ? dvi__hodge_split(&h, form, part)
                                   : dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  if (status == DVI_OK) {
    copy_part(part, h.count, exact);
    copy_part(part + h.count, h.count, coexact);
    copy_part(part + 2 * h.count, h.count, harmonic);
  }
  dvi__release(part);
  dvi__hodge_end(&h);
  return status;
}
