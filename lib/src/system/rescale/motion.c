/* Monitors of the motion itself, for a constant mass. With a = M^-1 V_q and the speed by the
 * energy,
 *
 *     arclength:     1/g^2 = 2 (E0 - V) + V_q.a,      g_q = g^3 (V_q - V_qq a)
 *     acceleration:  g = (V_q.a)^(-p/2),              g_q = -p g (V_qq a)/(V_q.a). */
#include <math.h>

#include "core/status.h"
#include "system/rescale/monitor.h"

/* Compute V_q and a, and their product in square [count]. */
static dvi_status find_accelerations(const dvi__built_in *own, int count, const double *t,
                                     const double *q, double *square)
{
  DVI_TRY(dvi__potentials_gradient(own->evaluator, count, t, q, own->V_q));
  dvi__mass_solve(own->evaluator, count, own->V_q, own->a);
  for (int k = 0; k < count; k++) square[k] = 0;
  for (size_t i = 0; i < (size_t)own->n; i++)
    for (size_t k = 0, points = (size_t)count; k < points; k++)
      square[k] += own->V_q[i * points + k] * own->a[i * points + k];
  return DVI_OK;
}

/* Compute g_q <- -V_qq a, by L_qq = -V_qq. */
static dvi_status curvature_along(const dvi__built_in *own, int count, const double *t,
                                  const double *q, double *g_q)
{
  const dvi__pattern *qq = &own->system->qq;
  const size_t points = (size_t)count;
  DVI_TRY(dvi__lagrangian_hessian(own->evaluator, count, t, q, own->zero, own->V_qq, NULL, NULL));
  for (size_t i = 0; i < (size_t)own->n * points; i++) g_q[i] = 0;
  for (size_t j = 0; j < (size_t)own->n; j++)
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++)
      for (size_t k = 0; k < points; k++)
        g_q[(size_t)qq->row[e] * points + k] += own->V_qq[(size_t)e * points + k] *
                                                own->a[j * points + k];
  return DVI_OK;
}

/* ---- arc length ---- */

static dvi_status arclength_at(const dvi__built_in *own, int count, const double *t,
                               const double *q, double *g)
{
  double *minus_V = own->V_qq; /* free until the Hessian is asked for */
  DVI_TRY(dvi__lagrangian_value(own->evaluator, count, t, q, own->zero, minus_V));
  DVI_TRY(find_accelerations(own, count, t, q, g));
  for (int k = 0; k < count; k++) g[k] = 1 / sqrt(2 * (own->energy + minus_V[k]) + g[k]);
  return DVI_OK;
}

static int arclength_value(int count, const double *t, const double *q, double *g, void *user)
{
  return (int)arclength_at(user, count, t, q, g);
}

static int arclength_gradient(int count, const double *t, const double *q, double *g_q, void *user)
{
  const dvi__built_in *own = user;
  dvi_status status = arclength_at(own, count, t, q, own->g);
  if (status == DVI_OK) status = curvature_along(own, count, t, q, g_q);
  for (size_t i = 0, k = 0; status == DVI_OK && i < (size_t)own->n * (size_t)count;
       i++, k = i % (size_t)count)
    g_q[i] = own->g[k] * own->g[k] * own->g[k] * (own->V_q[i] + g_q[i]);
  return (int)status;
}

void dvi__arclength_callbacks(dvi_potential *function)
{
  function->value_batch = arclength_value;
  function->gradient_batch = arclength_gradient;
}

/* ---- acceleration ---- */

static int acceleration_value(int count, const double *t, const double *q, double *g, void *user)
{
  const dvi__built_in *own = user;
  const dvi_status status = find_accelerations(own, count, t, q, g);
  for (int k = 0; k < count && status == DVI_OK; k++) g[k] = pow(g[k], -0.5 * own->power);
  return (int)status;
}

static int acceleration_gradient(int count, const double *t, const double *q, double *g_q,
                                 void *user)
{
  const dvi__built_in *own = user;
  const size_t points = (size_t)count;
  dvi_status status = find_accelerations(own, count, t, q, own->square);
  if (status == DVI_OK) status = curvature_along(own, count, t, q, g_q);
  if (status != DVI_OK) return (int)status;
  for (size_t k = 0; k < points; k++) own->g[k] = pow(own->square[k], -0.5 * own->power);
  for (size_t i = 0; i < (size_t)own->n; i++)
    for (size_t k = 0; k < points; k++)
      g_q[i * points + k] *= own->power * own->g[k] / own->square[k];
  return DVI_OK;
}

void dvi__acceleration_callbacks(dvi_potential *function)
{
  function->value_batch = acceleration_value;
  function->gradient_batch = acceleration_gradient;
}
