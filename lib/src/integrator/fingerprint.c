#include "integrator/fingerprint.h"

#include <math.h>

#include "core/hash.h"
#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "system/evaluate/dynamics.h"

/* Another machine's mathematical functions differ by a few roundings; other parameters by more
 * than this. */
static const double same_number = 1e-9;

static dvi__sum weighted(int count, const double *numbers)
{
  dvi__sum sum = {0, 0};
  for (int i = 0; i < count; i++) {
    const double part = dvi__weight((size_t)i) * numbers[i];
    sum.value += part;
    sum.size += fabs(part);
  }
  return sum;
}

static dvi_status constraint(const dvi_integrator *I, const double *q, const double *p,
                             dvi__sum *distance)
{
  const dvi__state_constraint *of_states = I->system->dynamics->constraint;
  if (of_states == NULL) return DVI_OK;
  DVI_TRY(of_states->size(I->evaluator, q, p, &distance->size));
  return of_states->distance(I->evaluator, q, p, &distance->value);
}

static dvi_status monitor(const dvi_integrator *I, const double *q, dvi__fingerprint *f)
{
  if (I->monitored == NULL) return DVI_OK;
  DVI_TRY(dvi__monitored_time_monitor(I->monitored, q, &f->monitor.value));
  DVI_TRY(dvi__monitored_time_slope(I->monitored, q, I->monitored->g_q));
  f->monitor.size = f->monitor.value;
  f->monitor_slope = weighted(I->system->n, I->monitored->g_q);
  return DVI_OK;
}

static dvi_status take(const dvi_integrator *I, const dvi__moment *at, dvi__fingerprint *f)
{
  const int n = I->system->n;
  double *v = I->v, *forces = I->last_v;
  const double *second = dvi__second(I->system, v, at->p);
  if (I->system->dynamics->searches_velocity)
    dvi__guess_velocity(n, at->q, at->last_q, at->last_p, at->last_h, v);
  DVI_TRY(dvi__legendre_inverse(I->evaluator, at->t, at->q, at->p, v));
  DVI_TRY(I->system->dynamics->value(I->evaluator, at->t, at->q, second, &f->lagrangian.value));
  DVI_TRY(I->system->dynamics->forces(I->evaluator, at->t, at->q, second, forces));
  f->lagrangian.size = fabs(f->lagrangian.value);
  for (int i = 0; i < n; i++) f->lagrangian.size += fabs(at->p[i] * v[i]);
  f->forces = weighted(n, forces);
  DVI_TRY(constraint(I, at->q, at->p, &f->distance));
  return monitor(I, at->q, f);
}

dvi_status dvi__fingerprint_take(const dvi_integrator *I, const dvi__moment *at,
                                 dvi__fingerprint *fingerprint)
{
  const dvi__sum nothing = {(double)NAN, (double)NAN};
  *fingerprint = (dvi__fingerprint){0};
  const dvi_status status = take(I, at, fingerprint);
  if (status != DVI_OK)
    *fingerprint = (dvi__fingerprint){nothing, nothing, nothing, nothing, nothing};
  return status;
}

/* What could not be computed when the file was written does not speak against it. */
static int differ(const dvi__sum *a, const dvi__sum *b)
{
  return fabs(a->value - b->value) > same_number * (a->size + b->size);
}

static dvi_status complain(const char *what, const char *number, const dvi__sum *saved,
                           const dvi__sum *here)
{
  return dvi__fail(DVI_BAD_FILE, "%s; at its state %s was %.12g, here it is %.12g", what, number,
                   saved->value, here->value);
}

dvi_status dvi__fingerprint_compare(const dvi__fingerprint *saved, const dvi__fingerprint *here)
{
  const char *other = "of another system or other parameters",
             *slower = "of another monitor or other parameters";
  if (differ(&saved->lagrangian, &here->lagrangian))
    return complain(other, "the Lagrangian", &saved->lagrangian, &here->lagrangian);
  if (differ(&saved->forces, &here->forces))
    return complain(other, "a weighted sum of the forces", &saved->forces, &here->forces);
  if (differ(&saved->distance, &here->distance))
    return complain("of a system with another constraint or other parameters",
                    "the distance from it", &saved->distance, &here->distance);
  if (differ(&saved->monitor, &here->monitor))
    return complain(slower, "the monitor g", &saved->monitor, &here->monitor);
  if (differ(&saved->monitor_slope, &here->monitor_slope))
    return complain(slower, "a weighted sum of the monitor's gradient", &saved->monitor_slope,
                    &here->monitor_slope);
  return DVI_OK;
}
