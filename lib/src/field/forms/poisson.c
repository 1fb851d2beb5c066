/* Poisson's equation for forms, L_k u = f, by conjugate gradients with
 *
 *     M_k L_k = d_k^T M_{k+1} d_k + M_k d_{k-1} M_{k-1}^-1 d_{k-1}^T M_k.
 *
 * The kernel is the harmonic forms. A right side without harmonic part lies in the range. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/forms/hodge.h"

/* Part of a right side that conjugate gradients may leave, and that may be harmonic. */
static const double roundoff = 1e-15, negligible = 1e-8;

typedef struct poisson {
  dvi__hodge hodge;
  dvi_matrix M_above;  /* M_{k+1} */
  double *form, *flux; /* [cells of the neighbouring degrees] */
} poisson;

static void add_upper_part(const poisson *p, const double *x, double *y)
{
  const dvi__hodge *h = &p->hodge;
  dvi_matrix_multiply(&h->d, 0, x, p->form);
  dvi_matrix_multiply(&p->M_above, 0, p->form, p->flux);
  dvi_matrix_multiply(&h->d, 1, p->flux, h->work);
  for (int64_t i = 0; i < h->count; i++) y[i] += h->work[i];
}

static dvi_status add_lower_part(const poisson *p, const double *x, double *y)
{
  const dvi__hodge *h = &p->hodge;
  dvi_matrix_multiply(&h->M, 0, x, h->work);
  dvi_matrix_multiply(&h->d_below, 1, h->work, p->form);
  DVI_TRY(dvi__hodge_divide(h, h->k - 1, p->form));
  dvi_matrix_multiply(&h->d_below, 0, p->form, h->work);
  dvi_matrix_multiply(&h->M, 0, h->work, h->more);
  for (int64_t i = 0; i < h->count; i++) y[i] += h->more[i];
  return DVI_OK;
}

static dvi_status times_laplacian(void *of, const double *x, double *y)
{
  const poisson *p = of;
  const dvi__hodge *h = &p->hodge;
  memset(y, 0, (size_t)h->count * sizeof *y);
  if (h->k < h->star->mesh->n) add_upper_part(p, x, y);
  if (h->k > 0) DVI_TRY(add_lower_part(p, x, y));
  dvi__hodge_hold(h, h->k, y);
  return DVI_OK;
}

/* Refuse a right side with a harmonic part. */
static dvi_status check_range(dvi__hodge *h, const double *f)
{
  double *part = DVI_NEW(double, 3 * h->count);
  if (part == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  double *harmonic = part + 2 * h->count;
  dvi_status status = dvi__hodge_split(h, f, part);
  if (status == DVI_OK) {
    const double size = sqrt(fabs(dvi__hodge_product(h, harmonic, harmonic))),
                 whole = sqrt(fabs(dvi__hodge_product(h, f, f)));
    if (size > negligible * whole)
      status = dvi__fail(DVI_BAD_ARGUMENT,
                         "forms: the right side has a harmonic part of length %g, of %g: no "
                         "solution exists; subtract the part (dvi_form_decompose)",
                         size, whole);
  }
  dvi__release(part);
  return status;
}

static dvi_status solve(poisson *p, const double *f, double *u)
{
  dvi__hodge *h = &p->hodge;
  const dvi__products products = {.size = h->count, .times = times_laplacian, .of = p};
  double *right = DVI_NEW(double, 4 * h->count);
  if (right == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  double *part = right + h->count;
  memcpy(u, f, (size_t)h->count * sizeof *u);
  dvi__hodge_hold(h, h->k, u);
  dvi_matrix_multiply(&h->M, 0, u, right);
  dvi__hodge_hold(h, h->k, right);
  dvi_status status = dvi__conjugate_gradients(&products, roundoff, right, u, NULL);
  if (status == DVI_OK) status = dvi__hodge_split(h, u, part);
  for (int64_t i = 0; i < h->count && status == DVI_OK; i++) u[i] = part[i] + part[h->count + i];
  dvi__release(right);
  return status;
}

static int64_t larger(int64_t a, int64_t b)
{
  return a > b ? a : b;
}

dvi_status dvi_form_solve(const dvi_star *star, int k, const char *held, const double *f, double *u)
{
  poisson p = {0};
  if (f == NULL || u == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: the right side and the solution are needed");
  DVI_TRY(dvi__hodge_begin(star, k, held, &p.hodge));
  const int64_t size = larger(p.hodge.below, p.hodge.above);
  p.form = DVI_NEW(double, 2 * size + 1);
  p.flux = p.form + size;
  dvi_status status = p.form != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  if (status == DVI_OK && k < star->mesh->n) status = dvi_star_matrix(star, k + 1, &p.M_above);
  if (status == DVI_OK) status = check_range(&p.hodge, f);
  if (status == DVI_OK) status = solve(&p, f, u);
  dvi__release(p.form);
  dvi__hodge_end(&p.hodge);
  return status;
}
