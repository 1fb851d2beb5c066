/* Small oscillations of a field about a static state, K x = omega^2 M x, with the Hessian K of the
 * parts without rates. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

enum { DEFAULT_COUNT = 6 };

/* The mass of a general Lagrangian is that at rest. */
static dvi_status make_mass(const dvi_density *density, const double *q, dvi__csr *mass)
{
  const dvi_matrix M = dvi__csr_view(&density->mass, 1);
  if (density->mass.rows > 0) return dvi__csr_copy(&M, mass);
  const dvi__integral *general = &density->lagrangian;
  if (density->is_fourier)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: a general part of fourier has no modes: take kind=spline or fem");
  DVI_TRY(dvi__matrix_of_pattern(&general->patterns.vv, mass));
  const int failed = dvi__integral_evaluate(general, &(dvi__density_point){.q = q},
                                            &(dvi__density_sums){.vv = mass->value});
  return dvi__density_refuse(failed, general->part[0]->name);
}

/* Spread vectors of coordinates over all coefficients, with 0 where they are fixed. */
static void spread(const dvi_density *density, int count, const double *vector, double *mode)
{
  for (int m = 0; m < count && mode != NULL; m++) {
    double *U = mode + m * density->places;
    memset(U, 0, (size_t)density->places * sizeof *U);
    for (int64_t i = 0; i < density->unknowns; i++)
      U[density->unknown[i]] = vector[m * density->unknowns + i];
  }
}

/* room has 1 + count times the unknowns. */
static dvi_status find(const dvi_density *density, const dvi_modes_options *options,
                       const double *U, double *room, double *eigenvalue, double *mode)
{
  double *q = room, *vector = room + density->unknowns;
  dvi__csr K = {0}, M = {0};
  dvi__density_take(density, U, q);
  dvi_status status = dvi__density_hessian(density, q, &K);
  if (status == DVI_OK) status = make_mass(density, q, &M);
  if (status == DVI_OK) {
    const dvi_matrix stiffness = dvi__csr_view(&K, 1), mass = dvi__csr_view(&M, 1);
    status = dvi_matrix_modes(&stiffness, &mass, options, eigenvalue, mode ? vector : NULL);
  }
  if (status == DVI_OK) spread(density, options->count, vector, mode);
  dvi__csr_clear(&K);
  dvi__csr_clear(&M);
  return status;
}

dvi_status dvi_density_modes(const dvi_density *density, const dvi_modes_options *options,
                             const double *U, double *eigenvalue, double *mode)
{
  if (density == NULL || eigenvalue == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field and a place for eigenvalues are needed");
  dvi_modes_options own = {.size = sizeof own};
  if (options != NULL) own = *options;
  if (own.count == 0) own.count = DEFAULT_COUNT;
  if (own.dimension == 0) own.dimension = density->dimension;
  if (density->one_form.parts > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: modes of a field of first order are those of its two-form, not of a "
                     "mass, and are not computed: run it by vprk, and find the frequencies of a "
                     "probe by dvi spectrum");
  if (density->mass.rows == 0 && density->lagrangian.parts == 0)
    return dvi__fail(DVI_UNSUPPORTED, "density: the field has no mass, against which its Hessian "
                                      "has eigenvalues: give it a kinetic part");
  if (own.count < 1 || own.count > density->unknowns)
    return dvi__fail(DVI_BAD_SIZE, "density: %d modes of %lld unknowns asked", own.count,
                     (long long)density->unknowns);
  double *room = DVI_NEW(double, (own.count + 1) * density->unknowns);
  if (room == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for modes");
  const dvi_status status = find(density, &own, U, room, eigenvalue, mode);
  dvi__release(room);
  return status;
}
