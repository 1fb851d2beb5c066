/* Norm, energies, position and momentum of a wave function. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/schroedinger/schroedinger.h"
#include "num/finite.h"

/* Give the values, or derivatives along an axis, of both parts at the points. */
static void show(const dvi__space_operator *B, int64_t functions, int64_t points, const double *psi,
                 double *u, double *work)
{
  for (int c = 0; c < 2; c++) dvi__operator_apply(B, psi + c * functions, u + c * points, work);
}

static void add_point(const dvi_schroedinger *s, const double *V, const double *u, int64_t k,
                      dvi_schroedinger_values *values)
{
  const double *v = u + s->points, density = u[k] * u[k] + v[k] * v[k],
               part = s->weight[k] * density;
  values->norm += part;
  values->potential += V[k] * part;
  if (s->beta != NULL) values->interaction += 0.5 * s->beta[k] * density * part;
  for (int d = 0; d < s->dimension; d++) values->position[d] += s->x[d * s->points + k] * part;
}

static void add_slopes(const dvi_schroedinger *s, const double *u, const double *slope, int d,
                       dvi_schroedinger_values *values)
{
  const double *v = u + s->points, *v_d = slope + s->points, by = s->hbar * s->hbar / (2 * s->mass);
  for (int64_t k = 0; k < s->points; k++) {
    const double w = s->weight[k];
    values->kinetic += by * w * (slope[k] * slope[k] + v_d[k] * v_d[k]);
    values->momentum[d] += s->hbar * w * (u[k] * v_d[k] - v[k] * slope[k]);
  }
}

void dvi__schroedinger_measure_at(const dvi_schroedinger *s, const double *V, const double *psi,
                                  double *u, double *work, dvi_schroedinger_values *values)
{
  double *slope = u + 2 * s->points;
  *values = (dvi_schroedinger_values){0};
  show(&s->values, s->functions, s->points, psi, u, work);
  for (int64_t k = 0; k < s->points; k++) add_point(s, V, u, k, values);
  for (int d = 0; d < s->dimension; d++) {
    if (values->norm > 0) values->position[d] /= values->norm;
    show(s->slope + d, s->functions, s->points, psi, slope, work);
    add_slopes(s, u, slope, d, values);
  }
  values->energy = values->kinetic + values->potential + values->interaction;
}

static dvi_status measure(const dvi_schroedinger *s, double t, const double *psi, double *room,
                          double *work, dvi_schroedinger_values *values)
{
  double *V = room, *u = V + s->points, *own = u + 4 * s->points, *z = own + 2 * s->functions;
  DVI_TRY(dvi__schroedinger_potential(s, t, V));
  for (int c = 0; c < 2; c++) {
    dvi__schroedinger_restrict(s, psi + c * s->functions, z);
    dvi__schroedinger_extend(s, z, own + c * s->functions);
  }
  dvi__schroedinger_measure_at(s, V, own, u, work, values);
  return DVI_OK;
}

dvi_status dvi_schroedinger_measure(const dvi_schroedinger *equation, double t, const double *psi,
                                    dvi_schroedinger_values *values)
{
  const dvi_schroedinger *s = equation;
  dvi_schroedinger_values found = {0};
  if (s == NULL || psi == NULL || values == NULL || !isfinite(t))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: an equation, a finite time, an amplitude and a place for the "
                     "values are needed");
  const ptrdiff_t bad = dvi__first_not_finite(2 * (size_t)s->functions, psi);
  if (bad >= 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "schroedinger: coefficient %lld of psi is %g",
                     (long long)bad, psi[bad]);
  double *room = DVI_NEW(double, 5 * s->points + 3 * s->functions),
         *work = DVI_NEW(double, dvi__operator_work(s->space));
  const dvi_status status = room != NULL && work != NULL
                                ? measure(s, t, psi, room, work, &found)
                                : dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for values");
  dvi__release(room);
  dvi__release(work);
  DVI_TRY(status);
  if (!isfinite(found.norm) || !isfinite(found.energy))
    return dvi__fail(DVI_NOT_FINITE, "schroedinger: psi has the norm %g and the energy %g",
                     found.norm, found.energy);
  *values = found;
  return DVI_OK;
}
