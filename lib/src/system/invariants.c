/* Energy, momentum maps of the declared symmetries, and declared invariants. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "system/evaluator_struct.h"

static dvi_status callback(int returned, const char *name)
{
  if (returned == 0) return DVI_OK;
  return dvi__fail(returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY, "invariant '%s': the callback returned %d", name,
                   returned);
}

/* J = p.xi(q)  (Marsden and West 2001, eq. 1.2.6). */
static dvi_status momentum_map(dvi__evaluator *e, const dvi_symmetry *symmetry, const double *q, const double *p, double *J)
{
  double *xi = e->point[2];
  *J = 0;
  DVI_TRY(callback(symmetry->generator(q, xi, symmetry->user), symmetry->name));
  for (int i = 0; i < e->system->nv; i++) *J += p[i] * xi[i];
  return DVI_OK;
}

/* H, or p.v - L; the Hamiltonian -L(t,q,0) of a one-form wants no velocity. */
static dvi_status energy(dvi__evaluator *e, double t, const double *q, const double *v, const double *p, double *E)
{
  double L, pv = 0, *rest = e->point[2];
  const int degenerate = (e->system->terms & DVI__ONE_FORM) != 0;
  if (e->system->terms & DVI__PHASE_SPACE) return dvi__lagrangian_value(e, 1, &t, q, p, E);
  memset(rest, 0, (size_t)e->system->n * sizeof(double));
  DVI_TRY(dvi__state_lagrangian(e, t, q, degenerate ? rest : v, &L));
  for (int i = 0; i < e->system->nv && !degenerate; i++) pv += p[i] * v[i];
  *E = pv - L;
  return DVI_OK;
}

dvi_status dvi__invariant(dvi__evaluator *e, double t, const double *q, const double *v, const double *p, int i, double *value)
{
  const dvi_system *s = e->system;
  const char *name = s->invariant_names[i];
  const int declared = i - 1 - s->symmetry_count;
  if (i == 0)
    DVI_TRY(energy(e, t, q, v, p, value));
  else if (declared < 0)
    DVI_TRY(momentum_map(e, &s->symmetries[i - 1], q, p, value));
  else
    DVI_TRY(callback(s->invariants[declared].value(t, q, p, value, s->invariants[declared].user), name));
  return isfinite(*value) ? DVI_OK : dvi__fail(DVI_NOT_FINITE, "invariant '%s' is %g at t = %.6g", name, *value, t);
}

dvi_status dvi__invariants(dvi__evaluator *e, double t, const double *q, const double *v, const double *p, double *value)
{
  const int count = dvi_system_invariant_count(e->system);
  for (int i = 0; i < count; i++) DVI_TRY(dvi__invariant(e, t, q, v, p, i, &value[i]));
  return DVI_OK;
}
