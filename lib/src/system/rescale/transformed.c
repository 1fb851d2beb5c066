#include "system/rescale/transformed_struct.h"

#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"

typedef dvi__transformed_work work;

/* Numbers of the Hessians for which there is room at first. Most steps of small systems need no
 * more. */
enum { SMALL_HESSIANS = 64 };

/* ---- room for batches ---- */

static dvi_status work_allocate(const dvi_system *base, int capacity, work *w)
{
  const size_t points = (size_t)capacity, n = (size_t)base->n * points;
  const size_t qq = (size_t)dvi__pattern_entries(&base->qq) * points,
               qv = (size_t)dvi__pattern_entries(&base->qv) * points;
  const size_t vv = (size_t)dvi__pattern_entries(&base->vv) * points, full = (size_t)base->n * n;
  double **const part[] = {&w->v,   &w->g_q, &w->L_q,  &w->L_v,     &w->d,       &w->Mv,     &w->g,
                           &w->lag, &w->vMv, &w->g_qq, &w->base_qq, &w->base_qv, &w->base_vv};
  const size_t size[] = {n, n, n, n, n, n, points, points, points, full, qq, qv, vv};
  double *at = w->numbers = DVI_NEW(double, 6 * n + 3 * points + full + qq + qv + vv);
  if (at == NULL)
    return dvi__fail(DVI_NO_MEMORY, "time transform: no memory for %d points in %d dimensions",
                     capacity, base->n);
  for (size_t i = 0; i < sizeof part / sizeof *part; at += size[i++]) *part[i] = at;
  return DVI_OK;
}

static dvi_status transformed_reserve(void *of, int capacity)
{
  dvi__transformed *x = of;
  work room = {0};
  dvi__monitor *monitor = NULL;
  dvi__evaluator *evaluator = NULL;
  if (capacity <= x->capacity) return DVI_OK;
  dvi_status status = dvi__evaluator_create(x->base, capacity, DVI__HESSIANS, x->counters,
                                            &evaluator);
  if (status == DVI_OK)
    status = dvi__monitor_create(x->base, &x->given, capacity, DVI__HESSIANS, x->counters,
                                 &monitor);
  if (status == DVI_OK) status = work_allocate(x->base, capacity, &room);
  if (status != DVI_OK) {
    dvi__evaluator_destroy(&evaluator);
    dvi__monitor_destroy(&monitor);
    return status;
  }
  dvi__evaluator_destroy(&x->evaluator);
  dvi__monitor_destroy(&x->monitor);
  dvi__release(x->work.numbers);
  x->evaluator = evaluator;
  x->monitor = monitor;
  x->work = room;
  x->capacity = capacity;
  dvi__monitor_set_energy(monitor, x->energy);
  return DVI_OK;
}

/* ---- evaluation ---- */

dvi_status dvi__transformed_velocities(dvi__transformed *x, int count, const double *q,
                                       const double *w)
{
  const size_t points = (size_t)count;
  DVI_TRY(dvi__monitor_value(x->monitor, count, q, x->work.g));
  for (size_t i = 0; i < (size_t)x->base->n; i++)
    for (size_t k = 0; k < points; k++)
      x->work.v[i * points + k] = w[i * points + k] / x->work.g[k];
  return DVI_OK;
}

/* The calling evaluator counts the same points. The system's own evaluator counts true
 * evaluations. */
static dvi_status transformed_value(void *of, int count, const double *t, const double *q,
                                    const double *w, double *L)
{
  dvi__transformed *x = of;
  x->counters->values -= count;
  DVI_TRY(dvi__transformed_velocities(x, count, q, w));
  DVI_TRY(dvi__lagrangian_value(x->evaluator, count, t, q, x->work.v, L));
  for (int k = 0; k < count; k++) L[k] = x->work.g[k] * (L[k] + x->energy);
  return DVI_OK;
}

/* Compute lag <- L - L_v.v + E0 = E0 - E, from L. */
static void find_lag(const dvi__transformed *x, int count)
{
  const work *at = &x->work;
  const size_t points = (size_t)count;
  for (size_t i = 0; i < (size_t)x->base->n; i++)
    for (size_t k = 0; k < points; k++)
      at->lag[k] -= at->L_v[i * points + k] * at->v[i * points + k];
  for (size_t k = 0; k < points; k++) at->lag[k] += x->energy;
}

dvi_status dvi__transformed_first_order(dvi__transformed *x, int count, const double *t,
                                        const double *q, const double *w)
{
  const work *at = &x->work;
  DVI_TRY(dvi__transformed_velocities(x, count, q, w));
  DVI_TRY(dvi__monitor_gradient(x->monitor, count, q, at->g_q));
  DVI_TRY(dvi__lagrangian_value(x->evaluator, count, t, q, at->v, at->lag));
  DVI_TRY(dvi__lagrangian_gradient(x->evaluator, count, t, q, at->v, at->L_q, at->L_v));
  find_lag(x, count);
  return DVI_OK;
}

static dvi_status transformed_gradient(void *of, int count, const double *t, const double *q,
                                       const double *w, double *L_q, double *L_w)
{
  dvi__transformed *x = of;
  const work *at = &x->work;
  const size_t n = (size_t)x->base->n, points = (size_t)count;
  x->counters->gradients -= count;
  DVI_TRY(dvi__transformed_first_order(x, count, t, q, w));
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < points; k++)
      L_q[i * points + k] = at->g[k] * at->L_q[i * points + k] +
                            at->lag[k] * at->g_q[i * points + k];
  memcpy(L_w, at->L_v, n * points * sizeof *L_w);
  if (dvi__first_not_finite(n * points, L_q) < 0 && dvi__first_not_finite(n * points, L_w) < 0)
    return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "time transform: the gradient is not finite");
}

static double transformed_noise(const void *of)
{
  const dvi__transformed *x = of;
  return fmax(dvi__hessian_noise(x->base), dvi__monitor_noise(x->monitor));
}

static const dvi__computed computed = {.value = transformed_value,
                                       .gradient = transformed_gradient,
                                       .hessian = dvi__transformed_hessian,
                                       .noise = transformed_noise,
                                       .reserve = transformed_reserve};

/* ---- create, destroy ---- */

/* Create the patterns. g depends on all coordinates, so L_qq and L_qw are full. L_ww has the
 * pattern of the system's L_vv. */
static dvi_status make_full_patterns(dvi_system *s, const dvi_system *base)
{
  const dvi_pattern full = {0};
  dvi__lagrangian_term *term = s->lagrangian;
  DVI_TRY(dvi__pattern_copy(&full, base->n, "time transform", &term->qq));
  DVI_TRY(dvi__pattern_copy(&full, base->n, "time transform", &term->qv));
  DVI_TRY(dvi__pattern_copy(&full, base->n, "time transform", &s->qv));
  DVI_TRY(dvi__pattern_union(&base->vv, &base->vv, &term->vv));
  return dvi__pattern_union(&base->vv, &base->vv, &s->vv);
}

static dvi_status make_transformed_system(dvi__transformed *x)
{
  dvi_system *s = x->system = DVI_NEW(dvi_system, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "time transform: no memory");
  s->n = s->nv = s->nx = x->base->n;
  s->dynamics = &dvi__dynamics_time_transformed;
  s->terms = DVI__LAGRANGIAN;
  s->autonomous = 1;
  s->lagrangian = DVI_NEW(dvi__lagrangian_term, 1);
  if (s->lagrangian == NULL) return dvi__fail(DVI_NO_MEMORY, "time transform: no memory");
  s->lagrangian->name = "Lagrangian";
  s->lagrangian->computed = &computed;
  s->lagrangian->of = x;
  return make_full_patterns(s, x->base);
}

static dvi_status transformed_fill(dvi__transformed *x, const dvi_system *system,
                                   const dvi_monitor *monitor, dvi_counters *counters)
{
  x->base = system;
  x->given = *monitor;
  x->counters = counters;
  x->energy = (double)NAN;
  if (!system->autonomous)
    return dvi__fail(DVI_UNSUPPORTED, "the system is not declared autonomous: its energy need not "
                                      "be conserved, and no function of q "
                                      "alone can stand for its time");
  if (!system->dynamics->has_kinetic_energy)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "the system declares a %s: its Lagrangian has no mass that could be divided by the monitor",
        system->lagrangian->name);
  if (system->force_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "the system declares forces without a potential, which change "
                     "the energy that the transform conserves");
  if (system->damping > 0)
    return dvi__fail(DVI_UNSUPPORTED, "the system declares damping, which takes the energy that "
                                      "the transform conserves");
  if (system->row_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "the system declares %sholonomic constraints, which the transform does not "
                     "carry over",
                     system->place_rows > 0 ? "" : "non");
  if (system->contact_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "the system declares contacts, whose hits the transform does not carry over");
  if (system->terms & DVI__NOISE)
    return dvi__fail(DVI_UNSUPPORTED,
                     "the system declares noise, which is that of equal steps of time");
  DVI_TRY(dvi__system_prepare_hessian(system));
  DVI_TRY(transformed_reserve(x, 1 + SMALL_HESSIANS / system->n / system->n));
  return make_transformed_system(x);
}

dvi_status dvi__transformed_create(const dvi_system *system, const dvi_monitor *monitor,
                                   dvi_counters *counters, dvi__transformed **transformed)
{
  *transformed = NULL;
  dvi__transformed *x = DVI_NEW(dvi__transformed, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "time transform: no memory");
  const dvi_status status = transformed_fill(x, system, monitor, counters);
  if (status != DVI_OK) dvi__transformed_destroy(&x);
  *transformed = x;
  return status;
}

void dvi__transformed_destroy(dvi__transformed **transformed)
{
  dvi__transformed *x = *transformed;
  if (x == NULL) return;
  dvi_system_destroy(&x->system);
  dvi__monitor_destroy(&x->monitor);
  dvi__evaluator_destroy(&x->evaluator);
  dvi__release(x->work.numbers);
  dvi__release(x);
  *transformed = NULL;
}

const dvi_system *dvi__transformed_system(const dvi__transformed *x)
{
  return x->system;
}

dvi__transformed *dvi__transformed_of(const dvi_system *system)
{
  const dvi__lagrangian_term *term = system->lagrangian;
  return term != NULL && term->computed == &computed ? term->of : NULL;
}

const double *dvi__transformed_masses(const dvi__transformed *x)
{
  const dvi_system *base = x->base;
  return base->lagrangian == NULL && base->vector == NULL && base->slots == NULL
             ? base->mass_diagonal
             : NULL;
}

dvi_status dvi__transformed_evaluate(dvi__transformed *x, int count, const double *t,
                                     const double *q, const dvi__rescaled *at)
{
  double *term = x->work.lag;
  DVI_TRY(dvi__monitor_rates(x->monitor, count, q, at->g, at->g_q));
  x->counters->values += count;
  for (int k = 0; k < count; k++) at->V[k] = -x->energy;
  for (int p = 0; p < x->base->potential_count; p++) {
    DVI_TRY(
        dvi__potential_value(&x->base->potentials[p], &x->evaluator->scratch, count, t, q, term));
    for (int k = 0; k < count; k++) at->V[k] += term[k];
  }
  return dvi__potentials_gradient(x->evaluator, count, t, q, at->V_q);
}

const dvi_system *dvi__transformed_base(const dvi__transformed *x)
{
  return x->base;
}

dvi__monitor *dvi__transformed_monitor(const dvi__transformed *x)
{
  return x->monitor;
}

void dvi__transformed_set_energy(dvi__transformed *x, double energy)
{
  x->energy = energy;
  dvi__monitor_set_energy(x->monitor, energy);
}
