/* The driver of one step. The driver owns the states, so that a failed step of any method leaves
 * the integrator unchanged. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/attempt.h"
#include "integrator/held.h"
#include "integrator/hits.h"
#include "num/finite.h"
#include "space/user_basis.h"
#include "system/dynamics/holonomic.h"
#include "system/evaluate/dynamics.h"

void dvi__state_lay_out(const dvi_integrator *I, dvi__state *state, double **at)
{
  const size_t n = (size_t)I->system->n;
  double **const part[] = {&state->q, &state->p, &state->q_compensation, &state->p_compensation};
  for (int i = 0; i < 4; i++, *at += n) *part[i] = *at;
  if (I->balances == 0) return;
  state->supplied = *at;
  state->supplied_compensation = *at + I->balances;
  *at += 2 * I->balances;
}

size_t dvi__state_numbers(const dvi_integrator *I)
{
  return 4 * (size_t)I->system->n + 2 * I->balances;
}

/* ---- start ---- */

static dvi_status check_start_state(const dvi_integrator *I, double t, const double *q,
                                    const double *second, char name)
{
  if (!isfinite(t)) return dvi__fail(DVI_NOT_FINITE, "the time is %g", t);
  const ptrdiff_t in_q = dvi__first_not_finite((size_t)I->system->n, q);
  const ptrdiff_t in_second = dvi__first_not_finite((size_t)I->system->nv, second);
  if (in_q >= 0) return dvi__fail(DVI_NOT_FINITE, "the start's q[%td] = %g", in_q, q[in_q]);
  if (in_second >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the start's %c[%td] = %g", name, in_second,
                     second[in_second]);
  return dvi__state_check(I->evaluator, q, second);
}

/* Start from a complete state. The arguments may be the integrator's own. Until all checks have
 * passed only `next` is written. */
static dvi_status start_from_state(dvi_integrator *I, double t, const double *q, const double *v,
                                   const double *p)
{
  const size_t bytes = (size_t)I->system->n * sizeof(double),
               v_bytes = (size_t)I->system->nv * sizeof(double);
  const double *w = I->monitored != NULL ? I->last_v : v, *second = dvi__second(I->system, v, p);
  double L, density = 0;
  DVI_TRY(I->system->dynamics->value(I->evaluator, t, q, second, &L));
  DVI_TRY(I->system->dynamics->forces(I->evaluator, t, q, second, I->next.p_compensation));
  if (I->monitored != NULL) DVI_TRY(dvi__monitored_time_start(I, t, q, v, p, I->last_v, &density));
  for (size_t i = 0; i < I->balances; i++)
    DVI_TRY(dvi__invariant(I->evaluator, t, q, v, p, (int)i, &I->next.supplied[i]));
  for (size_t i = 0; i < I->balances; i++) {
    I->at_start[i] = I->next.supplied[i];
    I->now.supplied[i] = I->now.supplied_compensation[i] = 0;
  }
  DVI_TRY(dvi__hits_start(I, t, q, v));
  memmove(I->now.q, q, bytes);
  memmove(I->now.p, p, v_bytes);
  memset(I->now.q_compensation, 0, bytes);
  memset(I->now.p_compensation, 0, bytes);
  memcpy(I->last.p, v, v_bytes);
  I->now.t = t;
  I->now.t_compensation = 0;
  I->now.density = density;
  I->now.side = I->next.side;
  I->started = 1;
  dvi__integrator_begin(I, w);
  return DVI_OK;
}

void dvi__integrator_begin(dvi_integrator *I, const double *v)
{
  I->last_h = 0;
  memset(I->stepper.memory, 0, I->stepper.memory_count * sizeof(double));
  dvi__stepper_start(&I->stepper, v);
}

void dvi__integrator_begin_anew(dvi_integrator *I, const double *v)
{
  const size_t bytes = (size_t)I->system->n * sizeof(double);
  memset(I->now.p_compensation, 0, bytes);
  I->now.side = 0;
  memcpy(I->last.p, v, bytes);
  dvi__integrator_begin(I, v);
}

/* Start without a contact that is held, or leave the integrator as it was. */
static dvi_status start_verdict(dvi_integrator *I, double t, int held, dvi_status status)
{
  if (status == DVI_OK) return DVI_OK;
  dvi__bodies_choose(I, held);
  return dvi__fail_in(status, "%s: cannot start at t = %.6g", I->stepper.method->name, t);
}

static int free_contacts(dvi_integrator *I)
{
  const int held = dvi__bodies_held(I);
  dvi__bodies_choose(I, -1);
  return held;
}

/* Project a start onto the constraint of all states, in the integrator's own memory, or only check
 * the constraint. */
static dvi_status constrain_start(dvi_integrator *I, double t, int project, const double **q,
                                  const double **p)
{
  const dvi__state_constraint *constraint = I->system->dynamics->constraint;
  I->next.side = 0;
  if (constraint == NULL) return DVI_OK;
  if (!I->admitted && constraint->admit != NULL) DVI_TRY(constraint->admit(I->evaluator, t, *q));
  I->admitted = 1;
  if (!project) {
    DVI_TRY(constraint->check(I->evaluator, t, *q, *p));
  } else {
    memmove(I->next.p, *p, (size_t)I->system->nv * sizeof **p);
    memmove(I->next.q, *q, (size_t)I->system->n * sizeof **q);
    *q = I->next.q;
    *p = I->next.p;
    DVI_TRY(constraint->project(I->evaluator, t, I->next.q, I->next.p));
  }
  if (!constraint->has_rank) return DVI_OK;
  return constraint->side(I->evaluator, t, *q, *p, 0, &I->next.side);
}

static dvi_status start_by_momentum(dvi_integrator *I, double t, const double *q, const double *p,
                                    int project)
{
  double *v = I->next.q_compensation;
  memset(v, 0, (size_t)I->system->nv * sizeof(double));
  DVI_TRY(check_start_state(I, t, q, p, 'p'));
  DVI_TRY(constrain_start(I, t, project, &q, &p));
  DVI_TRY(dvi__legendre_inverse(I->evaluator, t, q, p, v));
  return start_from_state(I, t, q, v, p);
}

static dvi_status start_by_velocity(dvi_integrator *I, double t, const double *q, const double *v)
{
  double *p = I->next.p;
  DVI_TRY(check_start_state(I, t, q, v, 'v'));
  if (I->system->dynamics->by_momentum)
    return dvi__fail(DVI_UNSUPPORTED, "the system declares a Hamiltonian; start with q and p");
  DVI_TRY(I->system->dynamics->momentum(I->evaluator, t, q, v, p));
  if (dvi__first_not_finite((size_t)I->system->nv, p) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the momentum is not finite");
  DVI_TRY(dvi__legendre_regular(I->evaluator, t, q, v));
  const double *momentum = p;
  DVI_TRY(constrain_start(I, t, 0, &q, &momentum));
  return start_from_state(I, t, q, v, p);
}

dvi_status dvi_integrator_start_with(dvi_integrator *I, double t, const double *q, const double *p,
                                     const dvi_start_options *options)
{
  if (I == NULL || q == NULL || p == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "start: an argument is NULL");
  const int held = free_contacts(I), project = options != NULL && options->project;
  return start_verdict(I, t, held, start_by_momentum(I, t, q, p, project));
}

dvi_status dvi_integrator_start(dvi_integrator *I, double t, const double *q, const double *p)
{
  return dvi_integrator_start_with(I, t, q, p, NULL);
}

dvi_status dvi_integrator_start_velocity(dvi_integrator *I, double t, const double *q,
                                         const double *v)
{
  if (I == NULL || q == NULL || v == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "start: an argument is NULL");
  const int held = free_contacts(I);
  return start_verdict(I, t, held, start_by_velocity(I, t, q, v));
}

/* ---- step ---- */

void dvi__state_copy(const dvi_integrator *I, const dvi__state *from, dvi__state *to)
{
  to->t = from->t;
  to->t_compensation = from->t_compensation;
  to->density = from->density;
  to->side = from->side;
  const size_t bytes = 2 * (size_t)I->system->n * sizeof(double);
  memcpy(to->q, from->q, bytes);
  memcpy(to->q_compensation, from->q_compensation, bytes);
  if (I->balances > 0) memcpy(to->supplied, from->supplied, 2 * I->balances * sizeof(double));
}

void dvi__share_compensations(dvi_integrator *I)
{
  I->next.q_compensation = I->last.q_compensation;
  I->next.p_compensation = I->last.p_compensation;
}

static dvi_status check_state(const dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n;
  if (I->monitored != NULL && I->next.t == I->now.t)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "monitor %s is so small that the step does not move the time",
                     I->monitored->name);
  if (!isfinite(I->next.t) || dvi__first_not_finite(2 * n, I->next.q) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the new state is not finite");
  return dvi__lagrangian_admit(I->evaluator, I->next.t, I->next.q);
}

void dvi__integrator_accept(dvi_integrator *I, double h)
{
  const dvi__state oldest = I->last;
  I->last = I->now;
  I->now = I->next;
  I->next = oldest;
  dvi__share_compensations(I);
  I->last_h_before = I->last_h;
  if (I->monitored != NULL) I->monitored->expanded = 0;
  /* Only the clock knows the length in time that a transform or the control gives to h. The
   * compensations contain its last digits. */
  I->last_h = I->monitored != NULL
                  ? (I->now.t - I->last.t) - (I->now.t_compensation - I->last.t_compensation)
                  : h;
  I->counters.steps++;
}

void dvi__exchange_memory(dvi_integrator *I)
{
  double *memory = I->stepper.memory;
  I->stepper.memory = I->memory_before;
  I->memory_before = memory;
}

void dvi__integrator_take_back(dvi_integrator *I)
{
  if (dvi_integrator_hit_count(I) > 0)
    dvi__hits_take_back(I);
  else
    dvi__integrator_smooth_back(I);
}

/* `next` still holds the former `last`. */
void dvi__integrator_smooth_back(dvi_integrator *I)
{
  dvi__state oldest = I->next;
  oldest.q_compensation = I->now.q_compensation;
  oldest.p_compensation = I->now.p_compensation;
  I->next = I->now;
  I->now = I->last;
  I->last = oldest;
  I->last_h = I->last_h_before;
  I->counters.steps--;
  if (I->monitored != NULL) I->monitored->expanded = 0;
  dvi__exchange_memory(I);
}

dvi_status dvi__integrator_undo(dvi_integrator *I, dvi_status status)
{
  dvi__integrator_take_back(I);
  I->counters.failed_steps++;
  return dvi__fail_in(status, "the step from t = %.9g is taken back", I->now.t);
}

static dvi_status refuse_step(dvi_integrator *I, double h, dvi_status status)
{
  dvi__exchange_memory(I);
  I->counters.failed_steps++;
  return dvi__fail_in(status, "%s: step %ld from t = %.9g with h = %.3g failed%s",
                      I->stepper.method->name, I->counters.steps + 1, I->now.t, h,
                      status > 0 && status != DVI_JUMP
                          ? "; the state is unchanged, try a smaller step"
                          : "; the state is unchanged");
}

dvi_status dvi__check_step(double t, double h)
{
  if (!isfinite(h) || h == 0 || t + h == t)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "step: h = %g does not move the time from t = %.17g; a finite step other than 0 is needed",
        h, t);
  return isnormal(h) ? DVI_OK
                     : dvi__fail(DVI_BAD_ARGUMENT,
                                 "step: h = %g is so small that 1/h cannot be computed", h);
}

/* Advance from `now` and memory_before to `next` and the stepper's memory. */
static dvi_status advance_state(dvi_integrator *I, double h)
{
  const dvi__method *method = I->stepper.method;
  double length;
  DVI_TRY(dvi__integrator_find_side(I));
  DVI_TRY(dvi__control_begin(I, h, &length));
  const double density = I->next.density;
  /* a method with a pass takes no forces, which supply something */
  if (method->pass != NULL && I->balances > 0)
    memcpy(I->next.supplied, I->now.supplied, 2 * I->balances * sizeof(double));
  if (method->pass != NULL &&
      method->pass(&I->stepper, &I->now, I->memory_before, &I->next, &length, 1) &&
      isfinite(I->next.t))
    return dvi__control_end(I, h);
  const dvi_status status = dvi__attempt(I, length, density);
  if (status != DVI_OK) return dvi__name_trajectory_end(I, length, status);
  DVI_TRY(check_state(I));
  DVI_TRY(dvi__check_side(I));
  return dvi__control_end(I, h);
}

dvi_status dvi_integrator_step(dvi_integrator *I, double h)
{
  if (I == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "step: the integrator is NULL");
  if (!I->started)
    return dvi__fail(DVI_BAD_STATE,
                     "step: the integrator has no state yet; call dvi_integrator_start first");
  DVI_TRY(dvi__check_step(I->monitored != NULL ? 0 : I->now.t, h));
  DVI_TRY(dvi__stepper_check_step(&I->stepper, h));
  return dvi__hits_divide(I) ? dvi__hits_step(I, h) : dvi__integrator_smooth_step(I, h);
}

dvi_status dvi__integrator_smooth_step(dvi_integrator *I, double h)
{
  dvi__exchange_memory(I);
  const long before = dvi__allocation_count();
  const dvi_status status = advance_state(I, h);
  I->counters.allocations += dvi__allocation_count() - before;
  if (status != DVI_OK) return refuse_step(I, h, status);
  dvi__integrator_accept(I, I->stepper.method->chooses_steps ? I->stepper.taken : h);
  return DVI_OK;
}

dvi_status dvi__integrator_step_exactly(dvi_integrator *I, double h)
{
  I->stepper.exact = 1;
  const dvi_status status = dvi_integrator_step(I, h);
  I->stepper.exact = 0;
  return status;
}

/* ---- queries ---- */

double dvi_integrator_time(const dvi_integrator *integrator)
{
  return integrator != NULL ? integrator->now.t : (double)NAN;
}

const double *dvi_integrator_q(const dvi_integrator *integrator)
{
  return integrator != NULL ? integrator->now.q : NULL;
}

const double *dvi_integrator_p(const dvi_integrator *integrator)
{
  return integrator != NULL ? integrator->now.p : NULL;
}

const dvi_system *dvi_integrator_system(const dvi_integrator *integrator)
{
  return integrator != NULL ? dvi__declared_system(integrator) : NULL;
}

int dvi_integrator_order(const dvi_integrator *integrator)
{
  return integrator != NULL ? integrator->stepper.order : 0;
}

double dvi_integrator_jump(const dvi_integrator *I, double *jump)
{
  if (I == NULL || !I->started || I->stepper.method->jump == NULL) return (double)NAN;
  const double *now = I->stepper.method->jump(&I->stepper);
  if (jump != NULL) memcpy(jump, now, (size_t)I->system->n * sizeof *jump);
  return dvi__largest((size_t)I->system->n, now);
}

double dvi_integrator_traffic(const dvi_integrator *integrator)
{
  return integrator != NULL && integrator->stepper.method->traffic != NULL
             ? integrator->stepper.method->traffic(&integrator->stepper, 1)
             : 0;
}

double dvi_integrator_last_step(const dvi_integrator *integrator)
{
  if (dvi_integrator_hit_count(integrator) > 0) return dvi__hits_length(integrator);
  return integrator != NULL ? integrator->last_h : 0;
}

int dvi_integrator_chooses_steps(const dvi_integrator *integrator)
{
  return integrator != NULL &&
         (integrator->monitored != NULL || integrator->stepper.method->chooses_steps);
}

dvi_status dvi_integrator_energy_balance(const dvi_integrator *I, dvi_energy_balance *balance)
{
  if (I == NULL || balance == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "energy balance: an argument is NULL");
  if (I->stepper.method->balance == NULL)
    return dvi__fail(DVI_UNSUPPORTED, "energy balance: %s conserves no discrete energy; sem does",
                     I->stepper.method->name);
  if (I->last_h == 0) return dvi__fail(DVI_BAD_STATE, "energy balance: no step was taken yet");
  I->stepper.method->balance(&I->stepper, balance);
  return DVI_OK;
}

const char *dvi_integrator_method(const dvi_integrator *integrator)
{
  return integrator != NULL ? integrator->stepper.specification : NULL;
}

void dvi_integrator_counters(const dvi_integrator *integrator, dvi_counters *counters)
{
  if (counters != NULL) *counters = integrator != NULL ? integrator->counters : (dvi_counters){0};
}

void dvi__guess_velocity(int n, const double *q, const double *last_q, const double *last_p,
                         double last_h, double *v)
{
  for (int i = 0; i < n; i++) v[i] = last_h != 0 ? (q[i] - last_q[i]) / last_h : last_p[i];
}

dvi_status dvi__state_velocity(dvi_integrator *I, const dvi__state *state, double *v)
{
  if (I->system->dynamics->searches_velocity)
    dvi__guess_velocity(I->system->n, I->now.q, I->last.q, I->last.p, I->last_h, v);
  return dvi__legendre_inverse(I->evaluator, state->t, state->q, state->p, v);
}

dvi_status dvi__integrator_velocity(dvi_integrator *I, double *v)
{
  return dvi__state_velocity(I, &I->now, v);
}

dvi_status dvi_integrator_invariants(dvi_integrator *I, double *value)
{
  if (I == NULL || value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "invariants: an argument is NULL");
  if (!I->started)
    return dvi__fail(
        DVI_BAD_STATE,
        "invariants: the integrator has no state yet; call dvi_integrator_start first");
  DVI_TRY(dvi__integrator_velocities(I));
  DVI_TRY(dvi__state_velocity(I, &I->now, I->v));
  return dvi__invariants(I->evaluator, I->now.t, I->now.q, I->v, I->now.p, value);
}

dvi_status dvi_integrator_invariant(dvi_integrator *I, int i, double *value)
{
  if (I == NULL || value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "invariant: an argument is NULL");
  if (!I->started)
    return dvi__fail(DVI_BAD_STATE,
                     "invariant: the integrator has no state yet; call dvi_integrator_start first");
  if (i < 0 || i >= dvi_system_invariant_count(I->system))
    return dvi__fail(DVI_BAD_ARGUMENT, "invariant: there is none of index %d; there are %d", i,
                     dvi_system_invariant_count(I->system));
  if (i == 0) {
    DVI_TRY(dvi__integrator_velocities(I));
    DVI_TRY(dvi__state_velocity(I, &I->now, I->v));
  }
  return dvi__invariant(I->evaluator, I->now.t, I->now.q, I->v, I->now.p, i, value);
}

dvi_status dvi_integrator_constraint(dvi_integrator *I, double *distance)
{
  if (I == NULL || distance == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "constraint: an argument is NULL");
  const dvi__state_constraint *constraint = dvi__declared_system(I)->dynamics->constraint;
  if (constraint == NULL)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "constraint: the system declares no one-form, no Hamiltonian with constraints, and no "
        "holonomic or nonholonomic constraints");
  if (!I->started)
    return dvi__fail(
        DVI_BAD_STATE,
        "constraint: the integrator has no state yet; call dvi_integrator_start first");
  return constraint->distance(I->evaluator, I->now.t, I->now.q, I->now.p, distance);
}

double dvi_integrator_supplied(const dvi_integrator *I, int i)
{
  return I != NULL && I->started && i >= 0 && (size_t)i < I->balances ? I->now.supplied[i]
                                                                      : (double)NAN;
}

dvi_status dvi_integrator_balance(dvi_integrator *I, int i, double *defect)
{
  double now = 0;
  if (I == NULL || defect == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "balance: an argument is NULL");
  if (I->balances == 0)
    return dvi__fail(DVI_BAD_STATE,
                     "balance: the integrator keeps none; create it with the option balances");
  if (i < 0 || (size_t)i >= I->balances)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "balance: there is none of index %d; there are %zu, of the energy and of the "
                     "momenta of symmetries",
                     i, I->balances);
  DVI_TRY(dvi_integrator_invariant(I, i, &now));
  *defect = (now - I->at_start[i]) - I->now.supplied[i] + I->now.supplied_compensation[i];
  return DVI_OK;
}

dvi_status dvi_integrator_temperature(dvi_integrator *I, double *temperature)
{
  if (I == NULL || temperature == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "temperature: an argument is NULL");
  if (I->stepper.method->temperature == NULL)
    return dvi__fail(DVI_UNSUPPORTED, "temperature: the system declares no noise");
  if (!I->started)
    return dvi__fail(
        DVI_BAD_STATE,
        "temperature: the integrator has no state yet; call dvi_integrator_start first");
  return I->stepper.method->temperature(&I->stepper, &I->now, temperature);
}

dvi_status dvi_integrator_reactions(dvi_integrator *I, double *lambda)
{
  if (I == NULL || lambda == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "reactions: an argument is NULL");
  if (dvi__declared_system(I)->row_count == 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "reactions: the system has neither holonomic nor nonholonomic "
                     "constraints");
  if (!I->started)
    return dvi__fail(DVI_BAD_STATE,
                     "reactions: the integrator has no state yet; call dvi_integrator_start first");
  DVI_TRY(dvi__integrator_velocities(I));
  DVI_TRY(dvi__state_velocity(I, &I->now, I->v));
  return I->system->dynamics->reactions(I->evaluator, I->now.t, I->now.q, I->v, lambda);
}

const double *dvi_integrator_multiplier(const dvi_integrator *I)
{
  if (I == NULL || I->last_h == 0 || I->stepper.method->multiplier == NULL) return NULL;
  return I->stepper.method->multiplier(&I->stepper);
}

size_t dvi_integrator_explain(const dvi_integrator *integrator, char *text, size_t size)
{
  dvi__text out = {text, size, 0};
  if (size > 0) text[0] = 0;
  if (integrator == NULL) return 0;
  dvi__text_add(&out, "method: %s, order %d%s\n", integrator->stepper.specification,
                integrator->stepper.order, integrator->stepper.symmetric ? ", symmetric" : "");
  if (integrator->monitored != NULL) dvi__monitored_time_explain(integrator->monitored, &out);
  integrator->stepper.method->explain(&integrator->stepper, &out);
  dvi__explain_dependent_rows(integrator, &out);
  return out.length;
}
