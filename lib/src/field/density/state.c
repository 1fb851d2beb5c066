/* States of a field: all coefficients from coordinates, and coordinates with momenta from them. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

dvi_status dvi_density_lift(const dvi_density *density, double t, const double *q, double *U)
{
  if (density == NULL || q == NULL || U == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field, coordinates and coefficients are needed");
  double *G = DVI_NEW(double, density->moving);
  if (G == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for a state");
  const int failed = dvi__density_moving(density, t, G, NULL, NULL);
  for (int64_t i = 0; i < density->places && failed == 0; i++) {
    const int number = density->number[i];
    U[i] = number >= 0 ? q[number] : number < -1 ? G[-2 - number] : density->fixed[i];
  }
  dvi__release(G);
  return dvi__density_refuse(failed, "a value that moves");
}

dvi_status dvi_density_lift_rate(const dvi_density *density, double t, const double *v,
                                 double *rate)
{
  if (density == NULL || v == NULL || rate == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field, velocities and rates are needed");
  double *G_rate = DVI_NEW(double, density->moving);
  if (G_rate == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for a state");
  const int failed = dvi__density_moving(density, t, NULL, G_rate, NULL);
  for (int64_t i = 0; i < density->places && failed == 0; i++) {
    const int number = density->number[i];
    rate[i] = number >= 0 ? v[number] : number < -1 ? G_rate[-2 - number] : 0;
  }
  dvi__release(G_rate);
  return dvi__density_refuse(failed, "the rate of a value that moves");
}

/* A component with a gauge loses as much of a constant as makes its first coefficient 0. */
void dvi__density_take(const dvi_density *density, const double *U, double *q)
{
  for (int64_t i = 0; i < density->unknowns; i++) {
    const int64_t place = density->unknown[i], component = place / density->functions;
    q[i] = U != NULL ? U[place] : 0;
    if (U == NULL || !density->gauge[component]) continue;
    const int64_t first = component * density->functions;
    q[i] -= U[first] / density->constant[0] * density->constant[place - first];
  }
}

/* p = dL/dv of the term with rates. */
static dvi_status find_momenta(const dvi_density *density, const double *q, const double *v,
                               double *p)
{
  const dvi__integral *const of = density->one_form.parts > 0     ? &density->one_form
                                  : density->lagrangian.parts > 0 ? &density->lagrangian
                                                                  : &density->kinetic;
  if (of->parts == 0)
    return dvi__fail(DVI_UNSUPPORTED, "density: the field has no rates, and no momenta");
  const int failed = dvi__integral_evaluate(of, &(dvi__density_point){.q = q, .v = v},
                                            &(dvi__density_sums){.v = p});
  return dvi__density_refuse(failed, "a part with rates");
}

dvi_status dvi_density_project(const dvi_density *density, const double *U, const double *rate,
                               double *q, double *v, double *p)
{
  if (density == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "density: a field is needed");
  if (q != NULL) dvi__density_take(density, U, q);
  if (v != NULL) dvi__density_take(density, rate, v);
  if (p == NULL) return DVI_OK;
  double *state = DVI_NEW(double, 2 * density->unknowns);
  if (state == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for a state");
  dvi__density_take(density, U, state);
  dvi__density_take(density, rate, state + density->unknowns);
  const dvi_status status = find_momenta(density, state, state + density->unknowns, p);
  dvi__release(state);
  return status;
}
