/* The public functions of a system at one point. Each creates an evaluator for the call. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"

static dvi_status check_point(const dvi_system *system, double t, const double *q,
                              const double *second, const void *result)
{
  if (system == NULL || q == NULL || second == NULL || result == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: an argument is NULL");
  if (!isfinite(t) || dvi__first_not_finite((size_t)system->n, q) >= 0 ||
      dvi__first_not_finite((size_t)system->nv, second) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "system: the point (t = %g) is not finite", t);
  return DVI_OK;
}

static dvi_status needs_lagrangian(const dvi_system *system)
{
  if (!system->dynamics->by_momentum) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "system: a Hamiltonian is declared, no Lagrangian; ask at q "
                                    "and p: dvi_system_invariants, dvi_system_velocity");
}

dvi_status dvi_system_lagrangian(const dvi_system *system, double t, const double *q,
                                 const double *v, double *L)
{
  dvi__evaluator *e;
  double value = 0;
  DVI_TRY(check_point(system, t, q, v, L));
  DVI_TRY(needs_lagrangian(system));
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__STATES, NULL, &e));
  dvi_status status = dvi__state_check(e, q, v);
  if (status == DVI_OK) status = system->dynamics->value(e, t, q, v, &value);
  dvi__evaluator_destroy(&e);
  if (status == DVI_OK) *L = value;
  return status;
}

dvi_status dvi_system_momentum(const dvi_system *system, double t, const double *q, const double *v,
                               double *p)
{
  dvi__evaluator *e;
  DVI_TRY(check_point(system, t, q, v, p));
  DVI_TRY(needs_lagrangian(system));
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__STATES, NULL, &e));
  dvi_status status = dvi__state_check(e, q, v);
  if (status == DVI_OK) status = system->dynamics->momentum(e, t, q, v, p);
  dvi__evaluator_destroy(&e);
  if (status == DVI_OK && dvi__first_not_finite((size_t)system->nv, p) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "system: the momentum at t = %g is not finite", t);
  return status;
}

dvi_status dvi_system_velocity(const dvi_system *system, double t, const double *q, const double *p,
                               double *v)
{
  dvi__evaluator *e;
  DVI_TRY(check_point(system, t, q, p, v));
  if (system->dynamics->searches_velocity && dvi__first_not_finite((size_t)system->n, v) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "system: the starting velocity is not finite");
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__STATES, NULL, &e));
  dvi_status status = dvi__state_check(e, q, p);
  if (status == DVI_OK) status = dvi__legendre_inverse(e, t, q, p, v);
  dvi__evaluator_destroy(&e);
  return status;
}

static dvi_status invariants_at(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *v, double *value)
{
  DVI_TRY(dvi__state_check(e, q, p));
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  return dvi__invariants(e, t, q, v, p, value);
}

dvi_status dvi_system_invariants(const dvi_system *system, double t, const double *q,
                                 const double *p, double *value)
{
  dvi__evaluator *e;
  DVI_TRY(check_point(system, t, q, p, value));
  double *v = DVI_NEW(double, system->n);
  if (v == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for a velocity");
  dvi_status status = dvi__evaluator_create(system, 1, DVI__STATES, NULL, &e);
  if (status == DVI_OK) status = invariants_at(e, t, q, p, v, value);
  dvi__evaluator_destroy(&e);
  dvi__release(v);
  return status;
}
