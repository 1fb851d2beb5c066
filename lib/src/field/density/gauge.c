/* The two-form of a one-form alpha(q),  Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j,  of fields of
 * first order.
 *
 * With a potential phi in periodic axes, as in phi_x phi_t/2 of Korteweg and de Vries, constants
 * are in the kernel of Omega, and of the gradient of H. One coefficient of phi then stays 0, and
 * the others move as before. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/algebra/random.h"
#include "field/density/density.h"
#include "num/finite.h"

/* Part of its terms that a sum of zero may leave. */
static const double roundoff = 1e-11;

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for a two-form");
}

/* ---- constants ---- */

static int one(int64_t count, const double *x, double *f, void *user)
{
  (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 1;
  return 0;
}

/* Tell if all parts have derivatives in space of a component alone, beside its rate. */
static int has_no_value(const dvi_density *density, int component)
{
  for (int p = 0; p < density->parts; p++)
    for (int a = 0; a < density->part[p].given.variables; a++) {
      const dvi_jet *jet = density->part[p].given.variable + a;
      const int is_value = jet->order[0] == 0 && jet->order[1] == 0 && jet->order[2] == 0;
      if (jet->component == component && is_value && !jet->rate) return 0;
    }
  return 1;
}

/* Omega w is the change of alpha along w less the gradient of alpha.w. Set y [n] to the gradient of
 * alpha.w at q, or to alpha at q. */
static dvi_status differentiate(const dvi_density *density, const double *q, const double *w,
                                double *y)
{
  const dvi__density_point at = {.q = q, .v = w};
  const dvi__density_sums gradient = {.q = y}, alpha = {.v = y};
  const int failed = dvi__integral_evaluate(&density->one_form, &at,
                                            w != NULL ? &gradient : &alpha);
  return dvi__density_refuse(failed, "a one-form");
}

/* Tell if constants w of a component are in the kernel of Omega at a state, where alpha is
 * unchanged along w. room has 4 n numbers. */
static dvi_status is_in_kernel(const dvi_density *density, int component, double *room, int *answer)
{
  const int64_t n = density->unknowns;
  double *q = room, *w = q + n, *first = w + n, *second = first + n;
  (void)dvi__fill_random(n, 11, q);
  for (int64_t i = 0; i < n; i++) {
    const int64_t place = density->unknown[i];
    w[i] = place / density->functions == component ? density->constant[place % density->functions]
                                                   : 0;
  }
  DVI_TRY(differentiate(density, q, w, first));
  const double of_gradient = dvi__largest((size_t)n, first);
  DVI_TRY(differentiate(density, q, NULL, second));
  for (int64_t i = 0; i < n; i++) q[i] += w[i];
  DVI_TRY(differentiate(density, q, NULL, first));
  const double size = dvi__largest((size_t)n, second) + dvi__largest((size_t)n, first);
  double change = 0;
  for (int64_t i = 0; i < n; i++) change = fmax(change, fabs(first[i] - second[i]));
  *answer = of_gradient <= roundoff * size && change <= roundoff * size;
  return DVI_OK;
}

static dvi_status find_gauge(dvi_density *density, double *room, int *gauges)
{
  DVI_TRY(dvi_space_interpolate(density->space, one, NULL, density->constant));
  for (int c = 0; c < density->components; c++) {
    if (!has_no_value(density, c)) continue;
    DVI_TRY(is_in_kernel(density, c, room, density->gauge + c));
    *gauges += density->gauge[c];
  }
  return DVI_OK;
}

/* Leave out the first coefficient of components whose constants do not move. */
static dvi_status leave_out(dvi_density *density)
{
  for (int c = 0; c < density->components; c++)
    if (density->gauge[c]) density->number[c * density->functions] = -1;
  return dvi__density_number(density);
}

dvi_status dvi__density_fix_gauge(dvi_density *density)
{
  int gauges = 0;
  double *room = DVI_NEW(double, 4 * density->unknowns);
  density->constant = DVI_NEW(double, density->functions);
  if (room == NULL || density->constant == NULL) {
    dvi__release(room);
    return no_memory();
  }
  dvi_status status = find_gauge(density, room, &gauges);
  dvi__release(room);
  if (status != DVI_OK || gauges == 0) return status;
  DVI_TRY(leave_out(density));
  for (int p = 0; p < density->parts; p++) {
    dvi__density_unbind(density->part + p);
    DVI_TRY(dvi__density_bind(density, density->part + p));
  }
  dvi__integral_clear(&density->one_form);
  return dvi__density_make_one_form(density);
}

/* ---- the rest ---- */

static dvi_status refuse_odd(const dvi_density *density)
{
  int gauges = 0;
  for (int c = 0; c < density->components; c++) gauges += density->gauge[c];
  return dvi__fail(DVI_SINGULAR,
                   "density: the two-form of an odd number of coordinates, %lld%s, is singular: "
                   "take one cell more or less, or another number of modes",
                   (long long)density->unknowns, gauges > 0 ? " without the constants" : "");
}

/* Omega is minus the gradients of alpha, row by row, and their transpose. */
static dvi_status two_form_of(const dvi_density *density, dvi__csr *Omega)
{
  const dvi_matrix gradients = dvi__csr_view(&density->gradients, 0);
  double *minus = DVI_NEW(double, gradients.rows);
  dvi__csr turned = {0};
  if (minus == NULL) return no_memory();
  for (int64_t i = 0; i < gradients.rows; i++) minus[i] = -1;
  const dvi_matrix minus_identity = {.rows = gradients.rows,
                                     .columns = gradients.rows,
                                     .width = 1,
                                     .symmetric = 1,
                                     .value = minus};
  dvi_status status = dvi__csr_transposed_product(&gradients, &minus_identity, &turned);
  const dvi_matrix other = dvi__csr_view(&turned, 0);
  if (status == DVI_OK) status = dvi__csr_sum(&gradients, &other, Omega);
  dvi__csr_clear(&turned);
  dvi__release(minus);
  return status;
}

/* Refuse a singular two-form. One that is not finite at a state that the motion need not have is
 * left to the start of a run. */
static dvi_status check_regular(const dvi_density *density)
{
  dvi__csr Omega = {0};
  dvi__definite solver = {0};
  DVI_TRY(two_form_of(density, &Omega));
  const dvi_matrix two_form = dvi__csr_view(&Omega, 0);
  const dvi_status status = dvi__regular_create(&two_form, &solver);
  dvi__definite_clear(&solver);
  dvi__csr_clear(&Omega);
  if (status != DVI_SINGULAR) return status;
  return dvi__fail(
      DVI_SINGULAR,
      "density: the two-form is singular: some combination of coordinates has no rate. "
      "Take an odd number of cells or points, another kind of space, or give every "
      "component a rate");
}

/* Give the gradients of a sparse field's alpha at a state, which need not be one of the motion. */
static dvi_status evaluate_gradients(dvi_density *density, const double *q)
{
  DVI_TRY(dvi__matrix_of_pattern(&density->one_form.patterns.qv, &density->gradients));
  const int failed = dvi__integral_evaluate(&density->one_form, &(dvi__density_point){.q = q},
                                            &(dvi__density_sums){.qv = density->gradients.value});
  return dvi__density_refuse(failed, "a one-form");
}

static dvi_status make_gradients(dvi_density *density)
{
  int is_constant;
  if (!density->is_fourier) {
    double *q = DVI_NEW(double, density->unknowns);
    if (q == NULL) return no_memory();
    (void)dvi__fill_random(density->unknowns, 5, q);
    const dvi_status status = evaluate_gradients(density, q);
    dvi__release(q);
    return status;
  }
  if (!density->is_linear) return DVI_OK;
  DVI_TRY(dvi__fourier_matrix(&density->one_form, &density->gradients, &is_constant));
  if (is_constant) return DVI_OK;
  density->is_linear = 0;
  dvi__csr_clear(&density->gradients);
  return DVI_OK;
}

dvi_status dvi__density_check_two_form(dvi_density *density)
{
  density->is_linear = 1;
  for (int p = 0; p < density->one_form.parts; p++)
    if (!density->one_form.part[p]->is_constant) density->is_linear = 0;
  if (density->unknowns % 2 != 0) return refuse_odd(density);
  DVI_TRY(make_gradients(density));
  if (density->gradients.rows > 0) return check_regular(density);
  if (density->one_form.has_hessian) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "density: a one-form that is not linear with constant coefficients has a full "
                   "matrix on fourier, which is for at most %d coordinates, not %lld: take "
                   "kind=spline or fem",
                   (int)DVI__MODES_WITH_HESSIAN, (long long)density->unknowns);
}
