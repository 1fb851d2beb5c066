/* The Lagrangian at a state: q with a velocity as it is stored, which with factors is not the rate of q. */
#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/factor.h"

/* The rate of the stored coordinates. */
static const double *rate_of(dvi__evaluator *e, const double *q, const double *v)
{
  if (e->system->cells == NULL) return v;
  dvi__factors_rate(e->system, q, v, e->rate);
  return e->rate;
}

dvi_status dvi__state_lagrangian(dvi__evaluator *e, double t, const double *q, const double *v, double *L)
{
  return dvi__lagrangian_value(e, 1, &t, q, rate_of(e, q, v), L);
}

dvi_status dvi__state_forces(dvi__evaluator *e, double t, const double *q, const double *v, double *L_q)
{
  return dvi__lagrangian_gradient(e, 1, &t, q, rate_of(e, q, v), L_q, NULL);
}

dvi_status dvi__state_momentum(dvi__evaluator *e, double t, const double *q, const double *v, double *p)
{
  if (e->system->cells == NULL) return dvi__lagrangian_gradient(e, 1, &t, q, v, NULL, p);
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, rate_of(e, q, v), NULL, e->point[0]));
  dvi__factors_momentum(e->system, q, e->point[0], p);
  return DVI_OK;
}

dvi_status dvi__state_check(const dvi__evaluator *e, const double *q, const double *second)
{
  return dvi__factors_check(e->system, q, second);
}
