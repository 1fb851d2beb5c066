/* The steps of an ensemble, one block after the other. The members of a block are stepped side by
 * side where the method can do this. The driver of a single integrator steps all other members, and
 * those that a step side by side leaves out. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "integrator/ensemble_struct.h"
#include "method/damping.h"
#include "num/finite.h"

/* A member that is left out goes on alone for one step, and for twice as many each time that it is
 * left out at its return, up to this many. The factors that a thread keeps for one member
 * (dvi__decoupled) then serve several steps. */
enum { LONGEST_ABSENCE = 32 };

/* ---- side by side ---- */

static void lay_out_lanes(const dvi_ensemble *e, const dvi__block *block, dvi__members *m)
{
  const size_t count = (size_t)block->count, n = (size_t)e->n;
  m->count = block->count;
  m->t = dvi__row(block, DVI__MEMBER_T);
  m->t_compensation = dvi__row(block, DVI__MEMBER_T_COMPENSATION);
  m->q = dvi__row(block, DVI__MEMBER_Q);
  m->p = m->q + n * count;
  m->q_compensation = m->p + n * count;
  m->p_compensation = m->q_compensation + n * count;
  m->memory = m->p_compensation + n * count;
}

/* Choose the members for step number i, and return their number. Members that are ahead have taken
 * the step already, and members that have failed take no more steps. The driver refuses a member
 * whose time h does not move. */
static int choose_lanes(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block, long i)
{
  dvi__members *m = &w->members;
  int chosen = 0;
  for (int k = 0; k < m->count; k++) {
    m->left[k] = w->ahead[k] > i || e->status[block->first + k] != DVI_OK ||
                 m->t[k] + e->task.h == m->t[k];
    chosen += !m->left[k];
  }
  return chosen;
}

/* Leave out members with a new state that is not finite, which the driver checks, too. */
static void leave_not_finite(const dvi_ensemble *e, dvi__members *m)
{
  const size_t count = (size_t)m->count, rows = 2 * (size_t)e->n;
  if (dvi__first_not_finite(count, m->t) < 0 && dvi__first_not_finite(rows * count, m->q) < 0)
    return;
  for (size_t k = 0; k < count; k++) {
    int finite = isfinite(m->t[k]) != 0;
    for (size_t i = 0; i < rows; i++) finite &= isfinite(m->q[i * count + k]) != 0;
    if (!finite) m->left[k] = 1;
  }
}

static void take_back_lane(const dvi_ensemble *e, const dvi__worker *w, const dvi__block *block,
                           size_t k)
{
  const size_t count = (size_t)block->count;
  for (size_t i = 0; i < e->state_numbers; i++)
    block->numbers[i * count + k] = w->numbers[i * count + k];
}

/* Keep what the driver keeps of a general Lagrangian's step, and count the velocity Hessian with
 * which each fixed point iteration is solved. */
static void accept_general(const dvi_ensemble *e, const dvi__worker *w, const dvi__block *block,
                           size_t k)
{
  const size_t count = (size_t)block->count;
  for (size_t i = 0; i < (size_t)e->n; i++)
    dvi__driver_row(e, block,
                    DVI__MEMBER_LAST + i)[k] = w->numbers[(DVI__MEMBER_Q + i) * count + k];
  w->integrator->counters.hessians += w->members.fixed[k];
}

static void accept_lanes(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block)
{
  const dvi__members *m = &w->members;
  double *last_h = dvi__driver_row(e, block, DVI__MEMBER_LAST_H),
         *steps = dvi__driver_row(e, block, DVI__MEMBER_STEPS);
  dvi_counters *counters = &w->integrator->counters;
  for (size_t k = 0; k < (size_t)block->count; k++) {
    if (m->left[k]) {
      take_back_lane(e, w, block, k);
      continue;
    }
    last_h[k] = e->task.h;
    steps[k]++;
    w->steps++;
    counters->residuals += m->residuals[k];
    counters->gradients += m->gradients[k];
    counters->fixed_points += m->fixed[k];
    counters->simplified += m->simplified[k];
    counters->jacobians += m->jacobians[k];
    counters->hessians += m->hessians[k];
    if (e->system_is_general) accept_general(e, w, block, k);
  }
}

/* ---- alone ---- */

static void step_member_alone(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block, int k,
                              long steps)
{
  dvi_integrator *I = w->integrator;
  dvi_status status = DVI_OK;
  dvi__member_load(e, w, block, k);
  const long before = I->counters.steps;
  for (long i = 0; i < steps && status == DVI_OK; i++) status = dvi_integrator_step(I, e->task.h);
  w->steps += I->counters.steps - before;
  dvi__member_store(e, w, block, k);
  e->status[block->first + k] = status;
  if (status != DVI_OK) dvi__worker_note(w, block->first + k, status);
}

/* ---- blocks ---- */

/* Step a block's members side by side. The step works on the block itself, and w->numbers keeps the
 * old numbers. */
static void step_block_lanes(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block)
{
  dvi__members *m = &w->members;
  const size_t count = (size_t)block->count;
  memcpy(w->numbers, block->numbers, e->state_numbers * count * sizeof(double));
  long *const counts[] = {m->residuals,  m->gradients, m->fixed,
                          m->simplified, m->jacobians, m->hessians};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    memset(counts[i], 0, count * sizeof(long));
  dvi__take_step_lanes(&w->integrator->stepper, m, e->task.h);
  leave_not_finite(e, m);
  accept_lanes(e, w, block);
}

/* Step member k alone, which was left out at step number i. */
static void send_ahead(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block, int k,
                       long i)
{
  const long remaining = e->task.steps - i;
  const int again = w->absence[k] > 0 && w->ahead[k] == i;
  w->absence[k] = !again                            ? 1
                  : w->absence[k] < LONGEST_ABSENCE ? 2 * w->absence[k]
                                                    : LONGEST_ABSENCE;
  const long steps = w->absence[k] < remaining ? w->absence[k] : remaining;
  step_member_alone(e, w, block, k, steps);
  w->ahead[k] = i + steps;
}

static void advance_lanes(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block)
{
  const size_t count = (size_t)block->count;
  const dvi_status *status = e->status + block->first;
  int going = 1;
  lay_out_lanes(e, block, &w->members);
  memset(w->ahead, 0, count * sizeof *w->ahead);
  memset(w->absence, 0, count * sizeof *w->absence);
  for (long i = 0; i < e->task.steps && going > 0; i++) {
    if (choose_lanes(e, w, block, i) > 0) step_block_lanes(e, w, block);
    if (memchr(w->members.left, 1, count) == NULL) continue;
    going = 0;
    for (int k = 0; k < block->count; k++) {
      if (w->members.left[k] && w->ahead[k] <= i && status[k] == DVI_OK)
        send_ahead(e, w, block, k, i);
      going += status[k] == DVI_OK;
    }
  }
}

static void advance_block(void *of, int thread, int item)
{
  dvi_ensemble *e = of;
  dvi__worker *w = &e->workers[thread];
  const dvi__block *block = &e->blocks[item];
  dvi__worker_bind(w, block);
  const dvi_status status = dvi__stepper_check_step(&w->integrator->stepper, e->task.h);
  for (int k = 0; k < block->count; k++) {
    e->status[block->first + k] = status;
    if (status != DVI_OK) dvi__worker_note(w, block->first + k, status);
  }
  if (status != DVI_OK) return;
  if (w->integrator->stepper.lanes != NULL && block->count > 1)
    advance_lanes(e, w, block);
  else
    for (int k = 0; k < block->count; k++) step_member_alone(e, w, block, k, e->task.steps);
}

dvi_status dvi_ensemble_advance(dvi_ensemble *e, double h, long steps)
{
  if (e == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: it is NULL");
  if (!e->started)
    return dvi__fail(DVI_BAD_STATE,
                     "ensemble: its members have no state yet; call dvi_ensemble_start first");
  if (steps < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: %ld steps asked, 0 or more are possible", steps);
  DVI_TRY(dvi__check_step(0.0, h));
  e->task = (dvi__block_task){.h = h, .steps = steps};
  dvi__ensemble_clear_failures(e);
  dvi__team_share(e->team, e->block_count, advance_block, e);
  return dvi__ensemble_verdict(e);
}

dvi_status dvi_ensemble_step(dvi_ensemble *e, double h)
{
  return dvi_ensemble_advance(e, h, 1);
}
