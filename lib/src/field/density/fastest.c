/* The largest frequency of a field, of its quadratic parts or of all about a state. With a mass it
 * is that of M u'' = -K u. With a constant two-form Omega it is that of Omega u' = K u. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/algebra/largest.h"
#include "field/algebra/random.h"
#include "field/algebra/vectors.h"
#include "field/density/density.h"

/* ---- of second order ---- */

static int has_positive_diagonal(const dvi__csr *matrix)
{
  for (int64_t i = 0; i < matrix->rows; i++) {
    const int64_t place = dvi__csr_find(matrix, i, (int)i);
    if (place < 0 || !(matrix->value[place] > 0)) return 0;
  }
  return 1;
}

static dvi_status find_of_mass(const dvi_density *density, const dvi_matrix *K, double *omega)
{
  dvi_matrix M;
  DVI_TRY(dvi_density_matrix(density, DVI_FIELD_MASS, &M));
  const dvi__pencil pencil = {.K = K, .M = &M, .dimension = density->dimension};
  if (!has_positive_diagonal(&density->mass)) return DVI_OK;
  double bound = 0;
  const dvi_status status = dvi__largest_eigenvalue(&pencil, NULL, &bound);
  if (status == DVI_SINGULAR) return DVI_OK; /* an indefinite mass has no largest frequency */
  const double roundoff = 1e-12 * dvi__largest_entry(K) / dvi__largest_entry(&M);
  *omega = isfinite(bound) && bound > roundoff ? sqrt(bound) : 0;
  return status;
}

/* ---- of first order ---- */

/* Return the largest omega, or 0 if K is neither positive nor negative. Omega^-1 K is skew in the
 * scalar product of K. The quotient u'.K u'/(u.K u) of a rate u' and its field u is then Rayleigh's
 * for omega^2, which grows as powers of Omega^-1 K turn u to the fastest fields. */
static dvi_status iterate(const dvi_matrix *K, const dvi__definite *two_form, double *room,
                          double *omega)
{
  enum { MOST = 400 };
  const double enough = 1e-5; /* growth of a quotient that ends the iteration */
  const int64_t n = K->rows;
  double *u = room, *Ku = u + n, *rate = Ku + n, last = 0;
  (void)dvi__fill_random(n, 31, u);
  dvi_matrix_multiply(K, 0, u, Ku);
  double energy = dvi__dot(n, u, Ku);
  for (int k = 0; k < MOST; k++) {
    DVI_TRY(dvi__definite_solve(two_form, Ku, rate, NULL));
    dvi_matrix_multiply(K, 0, rate, Ku);
    const double next = dvi__dot(n, rate, Ku), square = next / energy;
    if (!(square > 0) || !isfinite(square)) return DVI_OK;
    const double shrink = 1 / sqrt(fabs(next));
    for (int64_t i = 0; i < n; i++) Ku[i] *= shrink;
    energy = next > 0 ? 1 : -1;
    *omega = sqrt(square);
    if (k > 10 && square <= last * (1 + enough)) return DVI_OK;
    last = square;
  }
  return DVI_OK;
}

/* Tell if the gradients of alpha are skew, without a gauge beside the two-form. */
static int is_skew(const dvi__csr *gradients)
{
  const dvi_matrix view = dvi__csr_view(gradients, 0);
  const double roundoff = 1e-12 * dvi__largest_entry(&view);
  for (int64_t i = 0; i < gradients->rows; i++)
    for (int64_t e = gradients->start[i]; e < gradients->start[i + 1]; e++) {
      const int64_t other = dvi__csr_find(gradients, gradients->column[e], (int)i);
      const double turned = other < 0 ? 0 : gradients->value[other];
      if (fabs(gradients->value[e] + turned) > roundoff) return 0;
    }
  return 1;
}

static dvi_status find_of_two_form(dvi_density *density)
{
  const dvi_matrix K = dvi__csr_view(&density->stiffness, 1),
                   half = dvi__csr_view(&density->gradients, 0);
  dvi__definite solver = {0};
  if (!density->is_linear || density->gradients.rows == 0 || !is_skew(&density->gradients))
    return DVI_OK;
  double *room = DVI_NEW(double, 3 * density->unknowns);
  dvi_status status = room != NULL ? dvi__regular_create(&half, &solver)
                                   : dvi__fail(DVI_NO_MEMORY, "density: no memory for a frequency");
  if (status == DVI_OK) status = iterate(&K, &solver, room, &density->fastest);
  density->fastest /= 2; /* skew gradients are half of the two-form, up to the sign */
  dvi__definite_clear(&solver);
  dvi__release(room);
  return status;
}

/* ---- of a field ---- */

dvi_status dvi__density_find_fastest(dvi_density *density)
{
  if (density->quadratic.parts == 0) return DVI_OK;
  const dvi_matrix K = dvi__csr_view(&density->stiffness, 1);
  if (density->mass.rows > 0) return find_of_mass(density, &K, &density->fastest);
  return density->one_form.parts > 0 ? find_of_two_form(density) : DVI_OK;
}

dvi_status dvi_density_fastest_at(const dvi_density *density, const double *q, double *omega)
{
  if (q == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "density: a state is needed");
  DVI_TRY(dvi_density_fastest(density, omega));
  dvi__csr hessian = {0};
  if (density->potentials == 0) return DVI_OK;
  DVI_TRY(dvi__density_hessian(density, q, &hessian));
  const dvi_matrix K = dvi__csr_view(&hessian, 1);
  *omega = 0;
  const dvi_status status = find_of_mass(density, &K, omega);
  dvi__csr_clear(&hessian);
  return status;
}
