#include "system/rescale/monitor.h"

#include <dvi/number.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/evaluate/dynamics.h"
#include "system/term/term.h"

struct dvi__monitor {
  dvi_system *system; /* system of unit mass, with the monitor as its potential */
  dvi__scratch scratch;
  double *t;              /* zeros [capacity], because a monitor has no time */
  dvi__built_in built_in; /* not used for a user's function */
  char name[DVI__MONITOR_NAME];
};

/* ---- declaration ---- */

static dvi_status check_power(const char *name, double power)
{
  if (isfinite(power) && power >= 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "monitor %s: power %g; a positive number is needed", name,
                   power);
}

static dvi_status read_distance(const dvi_system *system, const dvi_monitor *given,
                                dvi__built_in *own, char *name)
{
  own->power = given->power > 0 ? given->power : 1.5;
  own->bodies = given->bodies != 0 ? given->bodies : 1;
  own->dimension = given->dimension != 0 ? given->dimension : system->n / own->bodies;
  if (own->bodies < 1 || own->dimension < 1 || system->n % own->bodies != 0 ||
      system->n / own->bodies != own->dimension)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "monitor distance: %d points of %d coordinates are not the %d coordinates of the system",
        own->bodies, own->dimension, system->n);
  char power[DVI_NUMBER_SIZE];
  dvi_number_write(own->power, power);
  (void)snprintf(name, DVI__MONITOR_NAME, "distance:power=%s,bodies=%d,dimension=%d", power,
                 own->bodies, own->dimension);
  return check_power("distance", given->power);
}

static dvi_status read_motion(const dvi_system *system, const dvi_monitor *given,
                              dvi__built_in *own, char *name)
{
  const int arclength = given->kind == DVI_MONITOR_ARCLENGTH;
  const char *what = arclength ? "arclength" : "acceleration";
  if (system->lagrangian != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "monitor %s: the system declares a %s; a constant mass is needed", what,
                     system->dynamics->name);
  if (arclength && !system->autonomous)
    return dvi__fail(DVI_UNSUPPORTED, "monitor arclength: the system is not declared autonomous, "
                                      "and has no energy to take the speed from");
  own->power = given->power > 0 ? given->power : 0.75;
  char power[DVI_NUMBER_SIZE];
  dvi_number_write(own->power, power);
  (void)snprintf(name, DVI__MONITOR_NAME, "%s%s%s", what,
                 arclength ? "" : ":power=", arclength ? "" : power);
  return check_power(what, given->power);
}

/* Parameters that the kind does not have are refused, not dropped. */
static dvi_status check_unused(const dvi_monitor *given)
{
  const int distance = given->kind == DVI_MONITOR_DISTANCE,
            acceleration = given->kind == DVI_MONITOR_ACCELERATION;
  if (given->power != 0 && !distance && !acceleration)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "monitor: a power (%g) belongs to distance or acceleration alone",
                     given->power);
  if ((given->bodies != 0 || given->dimension != 0) && !distance)
    return dvi__fail(DVI_BAD_ARGUMENT, "monitor: bodies and dimension belong to distance alone");
  const dvi_potential *f = &given->function;
  if (given->kind != DVI_MONITOR_FUNCTION &&
      (f->value || f->value_batch || f->gradient || f->gradient_batch))
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "monitor: a function is given beside a built-in monitor; one of them is possible");
  if (f->qq.start != NULL || f->qq.row != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "monitor: a pattern is given; leave it out, the Hessian is full");
  return DVI_OK;
}

/* Declare the monitor as a potential. */
static dvi_status declare_monitor(dvi__monitor *m, const dvi_system *system,
                                  const dvi_monitor *given, dvi_potential *function)
{
  DVI_TRY(check_unused(given));
  m->built_in.system = system;
  m->built_in.n = system->n;
  m->built_in.energy = (double)NAN;
  switch (given->kind) {
  case DVI_MONITOR_FUNCTION:
    *function = given->function;
    (void)snprintf(m->name, DVI__MONITOR_NAME, "%s",
                   function->name != NULL ? function->name : "function");
    break;
  case DVI_MONITOR_DISTANCE:
    DVI_TRY(read_distance(system, given, &m->built_in, m->name));
    dvi__distance_callbacks(function);
    break;
  case DVI_MONITOR_ARCLENGTH:
    DVI_TRY(read_motion(system, given, &m->built_in, m->name));
    dvi__arclength_callbacks(function);
    break;
  case DVI_MONITOR_ACCELERATION:
    DVI_TRY(read_motion(system, given, &m->built_in, m->name));
    dvi__acceleration_callbacks(function);
    break;
  default: return dvi__fail(DVI_BAD_ARGUMENT, "monitor: there is no kind %d", (int)given->kind);
  }
  if (given->kind != DVI_MONITOR_FUNCTION) function->user = &m->built_in;
  function->name = m->name;
  function->qq = (dvi_pattern){0};
  return DVI_OK;
}

/* ---- create, destroy ---- */

static dvi_status allocate_built_in(dvi__built_in *own, const dvi_monitor *given, size_t capacity,
                                    dvi_counters *counters)
{
  const size_t numbers = (size_t)own->n * capacity;
  if (given->kind == DVI_MONITOR_FUNCTION) return DVI_OK;
  own->g = DVI_NEW(double, capacity);
  own->square = DVI_NEW(double, capacity);
  own->rate = DVI_NEW(double, capacity);
  own->V_q = DVI_NEW(double, numbers);
  own->a = DVI_NEW(double, numbers);
  if (!own->g || !own->square || !own->rate || !own->V_q || !own->a)
    return dvi__fail(DVI_NO_MEMORY, "monitor: no memory");
  if (given->kind == DVI_MONITOR_DISTANCE) return DVI_OK;
  DVI_TRY(
      dvi__evaluator_create(own->system, (int)capacity, DVI__HESSIANS, counters, &own->evaluator));
  own->zero = DVI_NEW(double, numbers);
  own->V_qq = DVI_NEW(double, (1 + (size_t)dvi__pattern_entries(&own->system->qq)) * capacity);
  return own->zero && own->V_qq ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "monitor: no memory");
}

static dvi_status monitor_fill(dvi__monitor *m, const dvi_system *system, const dvi_monitor *given,
                               int capacity, dvi__derivatives most, dvi_counters *counters)
{
  const int hessians = most == DVI__HESSIANS;
  dvi_potential function = {0};
  DVI_TRY(declare_monitor(m, system, given, &function));
  const dvi_system_terms terms = {.dimension = system->n,
                                  .mass.scalar = 1,
                                  .potentials = &function,
                                  .potential_count = 1,
                                  .autonomous = 1};
  DVI_TRY(allocate_built_in(&m->built_in, given, (size_t)capacity, counters));
  m->t = DVI_NEW(double, capacity);
  if (m->t == NULL) return dvi__fail(DVI_NO_MEMORY, "monitor: no memory");
  DVI_TRY(dvi_system_create(&terms, &m->system));
  if (hessians) DVI_TRY(dvi__system_prepare_hessian(m->system));
  return dvi__scratch_create(m->system, capacity, hessians, &m->scratch);
}

dvi_status dvi__monitor_create(const dvi_system *system, const dvi_monitor *given, int capacity,
                               dvi__derivatives most, dvi_counters *counters,
                               dvi__monitor **monitor)
{
  *monitor = NULL;
  dvi__monitor *m = DVI_NEW(dvi__monitor, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "monitor: no memory");
  const dvi_status status = monitor_fill(m, system, given, capacity, most, counters);
  if (status != DVI_OK) dvi__monitor_destroy(&m);
  *monitor = m;
  return status;
}

void dvi__monitor_destroy(dvi__monitor **monitor)
{
  dvi__monitor *m = *monitor;
  if (m == NULL) return;
  dvi__built_in *own = &m->built_in;
  double *const owned[] = {own->g,   own->square, own->rate, own->zero,
                           own->V_q, own->a,      own->V_qq, m->t};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__evaluator_destroy(&own->evaluator);
  dvi__scratch_clear(&m->scratch);
  dvi_system_destroy(&m->system);
  dvi__release(m);
  *monitor = NULL;
}

double dvi__monitor_noise(const dvi__monitor *monitor)
{
  return dvi__hessian_noise(monitor->system);
}

const char *dvi__monitor_name(const dvi__monitor *monitor)
{
  return monitor->name;
}

void dvi__monitor_set_energy(dvi__monitor *monitor, double energy)
{
  monitor->built_in.energy = energy;
}

/* ---- evaluation ---- */

/* Every comparison with NaN is false. */
static int is_positive(double g)
{
  return (g > 0) & (g <= DBL_MAX) & (1 / g <= DBL_MAX);
}

static dvi_status check_positive(const dvi__monitor *m, int count, const double *g)
{
  int positive = 1;
  for (int k = 0; k < count; k++) positive &= is_positive(g[k]);
  for (int k = 0; k < count && !positive; k++)
    if (!is_positive(g[k]))
      return dvi__fail(DVI_NOT_FINITE,
                       "monitor %s is %g; it must be positive and finite, and so must 1/g", m->name,
                       g[k]);
  return DVI_OK;
}

dvi_status dvi__monitor_value(dvi__monitor *m, int count, const double *q, double *g)
{
  DVI_TRY(dvi__potential_value(&m->system->potentials[0], &m->scratch, count, m->t, q, g));
  return check_positive(m, count, g);
}

dvi_status dvi__monitor_gradient(dvi__monitor *m, int count, const double *q, double *g_q)
{
  return dvi__potential_gradient(&m->system->potentials[0], &m->scratch, count, m->t, q, g_q);
}

dvi_status dvi__monitor_rates(dvi__monitor *m, int count, const double *q, double *g, double *g_q)
{
  const double *built_in = m->built_in.g;
  if (built_in == NULL) {
    DVI_TRY(dvi__monitor_value(m, count, q, g));
    return dvi__monitor_gradient(m, count, q, g_q);
  }
  const dvi_status status = dvi__monitor_gradient(m, count, q, g_q);
  if (status > 0) DVI_TRY(dvi__monitor_value(m, count, q, g)); /* its sentence comes first */
  if (status != DVI_OK) return status;
  memcpy(g, built_in, (size_t)count * sizeof *g);
  return check_positive(m, count, g);
}

dvi_status dvi__monitor_hessian(dvi__monitor *m, int count, const double *q, double *g_qq)
{
  return dvi__potential_hessian(&m->system->potentials[0], &m->scratch, count, m->t, q, g_qq);
}

/* ---- the check ---- */

static dvi_status check_at(dvi__monitor *m, const double *q, double tolerance,
                           dvi_derivative_check *check)
{
  /* At rest the system's own kinetic part vanishes. */
  double g, *v = DVI_NEW(double, m->system->n);
  if (v == NULL) return dvi__fail(DVI_NO_MEMORY, "monitor check: no memory");
  dvi_status status = dvi__monitor_value(m, 1, q, &g);
  if (status == DVI_OK) status = dvi_system_check(m->system, 0, q, v, tolerance, check);
  dvi__release(v);
  return status;
}

dvi_status dvi_monitor_check(const dvi_system *system, const dvi_monitor *monitor, const double *q,
                             double tolerance, dvi_derivative_check *check)
{
  dvi__monitor *m;
  dvi_counters counters = {0};
  if (system == NULL || monitor == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "monitor check: an argument is NULL");
  if (monitor->kind != DVI_MONITOR_FUNCTION)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "monitor check: a built-in monitor has no callbacks to check");
  DVI_TRY(dvi__monitor_create(system, monitor, 1, DVI__HESSIANS, &counters, &m));
  const dvi_status status = check_at(m, q, tolerance, check);
  dvi__monitor_destroy(&m);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "monitor, g in the place of V");
}
