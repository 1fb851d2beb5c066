/* Energy, momentum maps of the declared symmetries, and declared invariants. */
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
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
  if (e->system->terms & DVI__HAMILTONIAN) return dvi__lagrangian_value(e, 1, &t, q, p, E);
  memset(rest, 0, (size_t)e->system->n * sizeof(double));
  DVI_TRY(dvi__state_lagrangian(e, t, q, degenerate ? rest : v, &L));
  for (int i = 0; i < e->system->nv && !degenerate; i++) pv += p[i] * v[i];
  *E = pv - L;
  return DVI_OK;
}

dvi_status dvi__invariants(dvi__evaluator *e, double t, const double *q, const double *v, const double *p, double *value)
{
  const dvi_system *s = e->system;
  DVI_TRY(energy(e, t, q, v, p, value));
  for (int i = 0; i < s->symmetry_count; i++) DVI_TRY(momentum_map(e, &s->symmetries[i], q, p, value + 1 + i));
  for (int i = 0; i < s->invariant_count; i++) {
    const dvi_invariant *invariant = &s->invariants[i];
    double *I = value + 1 + s->symmetry_count + i;
    DVI_TRY(callback(invariant->value(t, q, p, I, invariant->user), s->invariant_names[1 + s->symmetry_count + i]));
  }
  const ptrdiff_t bad = dvi__first_not_finite((size_t)dvi_system_invariant_count(s), value);
  if (bad < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "invariant '%s' is %g at t = %.6g", s->invariant_names[bad], value[bad], t);
}
