#include "step/split/quadratic.h"

#include "core/memory.h"
#include "core/status.h"

static dvi_status quadratic_no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "quadratic potentials: no memory");
}

/* Write the values of a part at their indices in the whole pattern. */
static dvi_status quadratic_spread(const dvi__pattern *part, double sign, const double *values,
                                   const dvi__pattern *whole, double *to)
{
  int *where = DVI_NEW(int, dvi__pattern_entries(part));
  if (where == NULL) return quadratic_no_memory();
  dvi__pattern_embed(part, whole, where);
  for (int e = 0; e < dvi__pattern_entries(part); e++) to[where[e]] = sign * values[e];
  dvi__release(where);
  return DVI_OK;
}

/* Find L_qq = -K, which is the same everywhere. */
static dvi_status find_stiffness(const dvi_system *s, dvi__evaluator *evaluator, dvi__quadratic *m)
{
  const double t = 0;
  double *origin = DVI_NEW(double, s->n), *L_qq = DVI_NEW(double, dvi__pattern_entries(&s->qq));
  dvi_status status = origin != NULL && L_qq != NULL ? DVI_OK : quadratic_no_memory();
  if (status == DVI_OK) {
    status = dvi__lagrangian_hessian(evaluator, 1, &t, origin, NULL, L_qq, NULL, NULL);
    if (status != DVI_OK) status = dvi__fail_in(status, "quadratic potentials at t = 0, q = 0");
  }
  if (status == DVI_OK) status = quadratic_spread(&s->qq, -1, L_qq, &m->pattern, m->stiffness);
  dvi__release(origin);
  dvi__release(L_qq);
  return status;
}

dvi_status dvi__quadratic_fill(const dvi_system *s, dvi__evaluator *evaluator, dvi__quadratic *m)
{
  DVI_TRY(dvi__pattern_union(&s->vv, &s->qq, &m->pattern));
  m->mass = DVI_NEW(double, dvi__pattern_entries(&m->pattern));
  m->stiffness = DVI_NEW(double, dvi__pattern_entries(&m->pattern));
  if (m->mass == NULL || m->stiffness == NULL) return quadratic_no_memory();
  DVI_TRY(quadratic_spread(&s->vv, 1, s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values,
                           &m->pattern, m->mass));
  return find_stiffness(s, evaluator, m);
}

void dvi__quadratic_clear(dvi__quadratic *quadratic)
{
  dvi__pattern_clear(&quadratic->pattern);
  dvi__release(quadratic->mass);
  dvi__release(quadratic->stiffness);
}
