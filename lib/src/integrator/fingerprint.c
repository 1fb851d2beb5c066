#include "integrator/fingerprint.h"

#include <math.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "system/evaluate/dynamics.h"

/* Relative difference of numbers that count as equal. Mathematical functions of another machine
 * differ by a few roundings, values with other parameters by more than this. */
static const double same_number = 1e-9;

static dvi__sum weighted_sum(int count, const double *numbers)
{
  dvi__sum sum = {.value = 0, .size = 0};
  for (int i = 0; i < count; i++) {
    const double part = dvi__weight((size_t)i) * numbers[i];
    sum.value += part;
    sum.size += fabs(part);
  }
  return sum;
}

static dvi_status fingerprint_constraint(const dvi_integrator *I, double t, const double *q,
                                         const double *p, dvi__sum *distance)
{
  const dvi__state_constraint *of_states = I->system->dynamics->constraint;
  if (of_states == NULL) return DVI_OK;
  DVI_TRY(of_states->size(I->evaluator, t, q, p, &distance->size));
  return of_states->distance(I->evaluator, t, q, p, &distance->value);
}

static dvi_status fingerprint_monitor(const dvi_integrator *I, const double *q, dvi__fingerprint *f)
{
  if (I->monitored == NULL) return DVI_OK;
  DVI_TRY(dvi__monitored_time_value(I->monitored, q, &f->monitor.value));
  DVI_TRY(dvi__monitored_time_gradient(I->monitored, q, I->monitored->g_q));
  f->monitor.size = f->monitor.value;
  f->monitor_gradient = weighted_sum(I->system->n, I->monitored->g_q);
  return DVI_OK;
}

/* Forces of constraints need the rank of their rows. */
static dvi_status find_rank(const dvi_integrator *I, const dvi__moment *at)
{
  const dvi__state_constraint *of_states = I->system->dynamics->constraint;
  int side;
  if (of_states == NULL || !of_states->has_rank) return DVI_OK;
  return of_states->side(I->evaluator, at->t, at->q, at->p, 0, &side);
}

/* v, forces [n] are work. */
static dvi_status fingerprint_evaluate(const dvi_integrator *I, const dvi__moment *at, double *v,
                                       double *forces, dvi__fingerprint *f)
{
  const int n = I->system->n;
  const double *second = dvi__second(I->system, v, at->p);
  if (I->system->dynamics->searches_velocity)
    dvi__guess_velocity(n, at->q, at->last_q, at->last_p, at->last_h, v);
  DVI_TRY(find_rank(I, at));
  DVI_TRY(dvi__legendre_inverse(I->evaluator, at->t, at->q, at->p, v));
  DVI_TRY(I->system->dynamics->value(I->evaluator, at->t, at->q, second, &f->lagrangian.value));
  DVI_TRY(I->system->dynamics->forces(I->evaluator, at->t, at->q, second, forces));
  f->lagrangian.size = fabs(f->lagrangian.value);
  for (int i = 0; i < n; i++) f->lagrangian.size += fabs(at->p[i] * v[i]);
  f->forces = weighted_sum(n, forces);
  DVI_TRY(fingerprint_constraint(I, at->t, at->q, at->p, &f->distance));
  return fingerprint_monitor(I, at->q, f);
}

dvi_status dvi__fingerprint_take(const dvi_integrator *I, const dvi__moment *at,
                                 dvi__fingerprint *fingerprint)
{
  const dvi__sum nothing = {.value = (double)NAN, .size = (double)NAN};
  *fingerprint = (dvi__fingerprint){0};
  const size_t n = (size_t)I->system->n;
  double *work = DVI_NEW(double, 2 * n);
  const dvi_status status = work != NULL
                                ? fingerprint_evaluate(I, at, work, work + n, fingerprint)
                                : dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu numbers",
                                            2 * n);
  dvi__release(work);
  if (status != DVI_OK)
    *fingerprint = (dvi__fingerprint){nothing, nothing, nothing, nothing, nothing};
  return status;
}

/* Test whether two sums differ. A NaN, of a number that could not be evaluated when the file was
 * written, is no difference. */
static int sums_differ(const dvi__sum *a, const dvi__sum *b)
{
  return fabs(a->value - b->value) > same_number * (a->size + b->size);
}

static dvi_status refuse_fingerprint(const char *what, const char *number, const dvi__sum *saved,
                                     const dvi__sum *here)
{
  return dvi__fail(DVI_BAD_FILE, "%s; at its state %s was %.12g, here it is %.12g", what, number,
                   saved->value, here->value);
}

dvi_status dvi__fingerprint_compare(const dvi__fingerprint *saved, const dvi__fingerprint *here)
{
  const char *other = "of another system or other parameters",
             *slower = "of another monitor or other parameters";
  if (sums_differ(&saved->lagrangian, &here->lagrangian))
    return refuse_fingerprint(other, "the Lagrangian", &saved->lagrangian, &here->lagrangian);
  if (sums_differ(&saved->forces, &here->forces))
    return refuse_fingerprint(other, "a weighted sum of the forces", &saved->forces, &here->forces);
  if (sums_differ(&saved->distance, &here->distance))
    return refuse_fingerprint("of a system with another constraint or other parameters",
                              "the distance from it", &saved->distance, &here->distance);
  if (sums_differ(&saved->monitor, &here->monitor))
    return refuse_fingerprint(slower, "the monitor g", &saved->monitor, &here->monitor);
  if (sums_differ(&saved->monitor_gradient, &here->monitor_gradient))
    return refuse_fingerprint(slower, "a weighted sum of the monitor's gradient",
                              &saved->monitor_gradient, &here->monitor_gradient);
  return DVI_OK;
}
