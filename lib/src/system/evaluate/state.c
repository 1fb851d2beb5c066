/* Functions at one state that several kinds of dynamics share. */
#include "core/status.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/factor.h"

dvi_status dvi__value_of_point(dvi__evaluator *e, double t, const double *q, const double *v,
                               double *L)
{
  return dvi__lagrangian_value(e, 1, &t, q, v, L);
}

dvi_status dvi__forces_of_point(dvi__evaluator *e, double t, const double *q, const double *v,
                                double *L_q)
{
  const double gamma = e->system->damping;
  double *p = e->point[2];
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, L_q, gamma > 0 ? p : NULL));
  for (int i = 0; i < e->system->n && gamma > 0; i++) L_q[i] -= gamma * p[i];
  return DVI_OK;
}

dvi_status dvi__momentum_of_point(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *p)
{
  return dvi__lagrangian_gradient(e, 1, &t, q, v, NULL, p);
}

/* Compute p.v - L. */
dvi_status dvi__energy_of_lagrangian(dvi__evaluator *e, double t, const double *q, const double *v,
                                     const double *p, double *E)
{
  double L, pv = 0;
  DVI_TRY(e->system->dynamics->value(e, t, q, v, &L));
  for (int i = 0; i < e->system->nv; i++) pv += p[i] * v[i];
  *E = pv - L;
  return DVI_OK;
}

dvi_status dvi__motion_of_lagrangian(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v, double *pdot, double *multiplier)
{
  (void)multiplier;
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  if (pdot == NULL) return DVI_OK;
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, pdot, NULL));
  for (int i = 0; i < e->system->n && e->system->damping > 0; i++)
    pdot[i] -= e->system->damping * p[i];
  return DVI_OK;
}

dvi_status dvi__lagrangian_is_degenerate(double t)
{
  return dvi__fail_in(DVI_SINGULAR,
                      "the Lagrangian is degenerate at t = %.6g: d2L/dv2 cannot be inverted", t);
}

dvi_status dvi__state_check(const dvi__evaluator *e, const double *q, const double *second)
{
  return dvi__factors_check(e->system, q, second);
}

dvi_status dvi__legendre_inverse(dvi__evaluator *e, double t, const double *q, const double *p,
                                 double *v)
{
  return e->system->dynamics->velocity(e, t, q, p, v);
}

dvi_status dvi__legendre_regular(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const dvi__dynamics *dynamics = e->system->dynamics;
  return dynamics->regular != NULL ? dynamics->regular(e, t, q, v) : DVI_OK;
}

dvi_status dvi__state_rates(dvi__evaluator *e, double t, const double *q, const double *p,
                            double *v, double *pdot, double *multiplier)
{
  return e->system->dynamics->motion(e, t, q, p, v, pdot, multiplier);
}
