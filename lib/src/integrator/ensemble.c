/* The members of an ensemble: start, numbers, failures and queries. */
#include <dvi/ensemble.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/ensemble_struct.h"

/* ---- members and integrators ---- */

static void load_rows(size_t count, const double *row, size_t members, double *x)
{
  for (size_t i = 0; i < count; i++) x[i] = row[i * members];
}

static void store_rows(size_t count, const double *x, size_t members, double *row)
{
  for (size_t i = 0; i < count; i++) row[i * members] = x[i];
}

void dvi__member_load(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block, int k)
{
  dvi_integrator *I = w->integrator;
  const size_t n = (size_t)e->n, members = (size_t)block->count;
  I->now.t = dvi__row(block, DVI__MEMBER_T)[k];
  I->now.t_compensation = dvi__row(block, DVI__MEMBER_T_COMPENSATION)[k];
  I->now.side = 0;
  /* q and p are contiguous, and their compensations are, too */
  load_rows(2 * n, dvi__row(block, DVI__MEMBER_Q) + k, members, I->now.q);
  load_rows(2 * n, dvi__row(block, DVI__MEMBER_Q + 2 * n) + k, members, I->now.q_compensation);
  load_rows(I->stepper.memory_count, dvi__row(block, DVI__MEMBER_Q + 4 * n) + k, members,
            I->stepper.memory);
  I->last_h = dvi__driver_row(e, block, DVI__MEMBER_LAST_H)[k];
  I->counters.steps = (long)dvi__driver_row(e, block, DVI__MEMBER_STEPS)[k];
  if (e->system_is_general) {
    load_rows(n, dvi__driver_row(e, block, DVI__MEMBER_LAST) + k, members, I->last.q);
    memcpy(I->last.p, I->last.q, n * sizeof(double));
  }
}

/* Store a member's state, and the numbers of earlier states that dvi__guess_velocity uses. */
void dvi__member_store(const dvi_ensemble *e, const dvi__worker *w, const dvi__block *block, int k)
{
  const dvi_integrator *I = w->integrator;
  const size_t n = (size_t)e->n, members = (size_t)block->count;
  dvi__row(block, DVI__MEMBER_T)[k] = I->now.t;
  dvi__row(block, DVI__MEMBER_T_COMPENSATION)[k] = I->now.t_compensation;
  store_rows(2 * n, I->now.q, members, dvi__row(block, DVI__MEMBER_Q) + k);
  store_rows(2 * n, I->now.q_compensation, members, dvi__row(block, DVI__MEMBER_Q + 2 * n) + k);
  store_rows(I->stepper.memory_count, I->stepper.memory, members,
             dvi__row(block, DVI__MEMBER_Q + 4 * n) + k);
  dvi__driver_row(e, block, DVI__MEMBER_LAST_H)[k] = I->last_h;
  dvi__driver_row(e, block, DVI__MEMBER_STEPS)[k] = (double)I->counters.steps;
  if (e->system_is_general)
    store_rows(n, I->last_h != 0 ? I->last.q : I->last.p, members,
               dvi__driver_row(e, block, DVI__MEMBER_LAST) + k);
}

static const dvi__block *block_of(const dvi_ensemble *e, int member)
{
  int low = 0, high = e->block_count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (e->blocks[middle].first <= member)
      low = middle;
    else
      high = middle - 1;
  }
  return &e->blocks[low];
}

/* ---- failures ---- */

void dvi__ensemble_clear_failures(dvi_ensemble *e)
{
  for (int i = 0; i < e->threads; i++) {
    e->workers[i].worst.status = DVI_OK;
    e->workers[i].failures = 0;
  }
}

/* Order failures independently of the threads. Fatal failures come first, then the first member. */
static int is_worse(dvi_status status, int member, const dvi__worst_failure *than)
{
  if (than->status == DVI_OK || (status < 0) != (than->status < 0))
    return than->status == DVI_OK || status < 0;
  return member < than->member;
}

void dvi__worker_note(dvi__worker *w, int member, dvi_status status)
{
  w->failures++;
  if (!is_worse(status, member, &w->worst)) return;
  w->worst.status = status;
  w->worst.member = member;
  (void)snprintf(w->worst.sentence, sizeof w->worst.sentence, "%s", dvi_last_error());
}

dvi_status dvi__ensemble_verdict(const dvi_ensemble *e)
{
  const dvi__worst_failure *worst = &e->workers[0].worst;
  long failures = 0;
  for (int i = 0; i < e->threads; i++) {
    const dvi__worst_failure *here = &e->workers[i].worst;
    failures += e->workers[i].failures;
    if (here->status != DVI_OK && is_worse(here->status, here->member, worst)) worst = here;
  }
  if (failures == 0) return DVI_OK;
  if (failures == 1)
    return dvi__fail(worst->status, "ensemble: member %d: %s", worst->member, worst->sentence);
  return dvi__fail(worst->status, "ensemble: member %d, one of %ld that failed: %s", worst->member,
                   failures, worst->sentence);
}

/* ---- start ---- */

static void start_block(void *of, int thread, int item)
{
  dvi_ensemble *e = of;
  dvi__worker *w = &e->workers[thread];
  dvi__block block = e->blocks[item];
  const dvi__start_task *from = &e->start_task;
  const size_t n = (size_t)e->n, nv = (size_t)block.system->nv, members = (size_t)e->members;
  block.numbers = from->numbers + (size_t)block.first * e->member_numbers;
  dvi__worker_bind(w, &block);
  for (int k = 0; k < block.count; k++) {
    const int member = block.first + k;
    load_rows(n, from->q + member, members, w->point[0]);
    load_rows(nv, from->second + member, members, w->point[1]);
    w->integrator->counters.steps = 0;
    w->integrator->stepper.member = (uint32_t)member;
    const dvi_status status =
        from->by_velocity
            ? dvi_integrator_start_velocity(w->integrator, from->t, w->point[0], w->point[1])
            : dvi_integrator_start(w->integrator, from->t, w->point[0], w->point[1]);
    if (status == DVI_OK)
      dvi__member_store(e, w, &block, k);
    else
      dvi__worker_note(w, member, status);
  }
}

/* Start all members. The new states replace the old ones once all members have started. */
static dvi_status ensemble_start_members(dvi_ensemble *e, double t, const double *q,
                                         const double *second, int by_velocity)
{
  if (e == NULL || q == NULL || second == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: start: an argument is NULL");
  double *numbers = DVI_NEW(double, (size_t)e->members * e->member_numbers);
  if (numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "ensemble: start: no memory for %d members", e->members);
  e->allocations++;
  e->start_task = (dvi__start_task){
      .t = t, .q = q, .second = second, .by_velocity = by_velocity, .numbers = numbers};
  dvi__ensemble_clear_failures(e);
  dvi__team_share(e->team, e->block_count, start_block, e);
  const dvi_status status = dvi__ensemble_verdict(e);
  if (status != DVI_OK) {
    dvi__release(numbers);
    return status;
  }
  dvi__release(e->numbers);
  e->numbers = numbers;
  for (int i = 0; i < e->block_count; i++)
    e->blocks[i].numbers = numbers + (size_t)e->blocks[i].first * e->member_numbers;
  memset(e->status, 0, (size_t)e->members * sizeof *e->status);
  e->started = 1;
  return DVI_OK;
}

dvi_status dvi_ensemble_start(dvi_ensemble *e, double t, const double *q, const double *p)
{
  return ensemble_start_members(e, t, q, p, 0);
}

dvi_status dvi_ensemble_start_velocity(dvi_ensemble *e, double t, const double *q, const double *v)
{
  return ensemble_start_members(e, t, q, v, 1);
}

/* ---- queries ---- */

static void copy_rows(const dvi_ensemble *e, size_t first_row, size_t rows, double *out)
{
  for (int b = 0; b < e->block_count && out != NULL; b++) {
    const dvi__block *block = &e->blocks[b];
    for (size_t i = 0; i < rows; i++)
      memcpy(out + i * (size_t)e->members + block->first, dvi__row(block, first_row + i),
             (size_t)block->count * sizeof(double));
  }
}

dvi_status dvi_ensemble_state(const dvi_ensemble *e, double *t, double *q, double *p)
{
  if (e == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: it is NULL");
  if (!e->started)
    return dvi__fail(DVI_BAD_STATE,
                     "ensemble: its members have no state yet; call dvi_ensemble_start first");
  const size_t n = (size_t)e->n;
  copy_rows(e, DVI__MEMBER_T, 1, t);
  copy_rows(e, DVI__MEMBER_Q, n, q);
  copy_rows(e, DVI__MEMBER_Q + n, (size_t)e->blocks[0].system->nv, p);
  return DVI_OK;
}

static int has_member(const dvi_ensemble *e, int member)
{
  return e != NULL && member >= 0 && member < e->members;
}

dvi_status dvi_ensemble_status(const dvi_ensemble *e, int member)
{
  return has_member(e, member) ? e->status[member] : DVI_BAD_ARGUMENT;
}

long dvi_ensemble_steps(const dvi_ensemble *e, int member)
{
  if (!has_member(e, member)) return 0;
  const dvi__block *block = block_of(e, member);
  return (long)dvi__driver_row(e, block, DVI__MEMBER_STEPS)[member - block->first];
}

/* Load a member of which `what` is asked into the first worker's integrator. */
static dvi_status load_asked(dvi_ensemble *e, int member, const double *value, const char *what)
{
  if (e == NULL || value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: %s: an argument is NULL", what);
  if (!has_member(e, member))
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: there is no member %d, the last one is %d",
                     member, e->members - 1);
  if (!e->started)
    return dvi__fail(DVI_BAD_STATE,
                     "ensemble: its members have no state yet; call dvi_ensemble_start first");
  const dvi__block *block = block_of(e, member);
  dvi__worker_bind(&e->workers[0], block);
  dvi__member_load(e, &e->workers[0], block, member - block->first);
  return DVI_OK;
}

dvi_status dvi_ensemble_invariants(dvi_ensemble *e, int member, double *value)
{
  DVI_TRY(load_asked(e, member, value, "invariants"));
  const dvi_status status = dvi_integrator_invariants(e->workers[0].integrator, value);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "ensemble: member %d", member);
}

dvi_status dvi_ensemble_temperature(dvi_ensemble *e, int member, double *temperature)
{
  DVI_TRY(load_asked(e, member, temperature, "temperature"));
  const dvi_status status = dvi_integrator_temperature(e->workers[0].integrator, temperature);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "ensemble: member %d", member);
}

int dvi_ensemble_members(const dvi_ensemble *e)
{
  return e != NULL ? e->members : 0;
}

const char *dvi_ensemble_method(const dvi_ensemble *e)
{
  return e != NULL ? dvi_integrator_method(e->integrators[0]) : NULL;
}

static void add_counters(const dvi_counters *some, dvi_counters *sum)
{
  sum->failed_steps += some->failed_steps;
  sum->values += some->values;
  sum->gradients += some->gradients;
  sum->hessians += some->hessians;
  sum->residuals += some->residuals;
  sum->jacobians += some->jacobians;
  sum->factorizations += some->factorizations;
  sum->symbolic += some->symbolic;
  sum->solves += some->solves;
  sum->fixed_points += some->fixed_points;
  sum->newtons += some->newtons;
  sum->kinsols += some->kinsols;
  sum->followed += some->followed;
  sum->jump_alarms += some->jump_alarms;
  sum->allocations += some->allocations;
  sum->simplified += some->simplified;
  sum->certified += some->certified;
  sum->energy_fallbacks += some->energy_fallbacks;
  sum->products += some->products;
  sum->preparations += some->preparations;
}

void dvi_ensemble_counters(const dvi_ensemble *e, dvi_counters *counters)
{
  if (counters == NULL) return;
  *counters = (dvi_counters){0};
  if (e == NULL) return;
  for (int i = 0; i < e->integrator_count; i++)
    add_counters(&e->integrators[i]->counters, counters);
  for (int i = 0; i < e->threads; i++) counters->steps += e->workers[i].steps;
  counters->allocations += e->allocations;
}

size_t dvi_ensemble_explain(const dvi_ensemble *e, char *text, size_t size)
{
  dvi__text out = {text, size, 0};
  if (size > 0) text[0] = 0;
  if (e == NULL) return 0;
  const int lanes = e->integrators[0]->stepper.lanes != NULL && e->block_count < e->members;
  dvi__text_add(&out, "ensemble: %d members in %d blocks%s, %s, %d thread%s\n", e->members,
                e->block_count, e->bound ? " with integrators of their own" : "",
                lanes ? "side by side as lanes" : "one after the other", e->threads,
                e->threads == 1 ? "" : "s");
  const size_t room = out.length < size ? size - out.length : 0;
  return out.length +
         dvi_integrator_explain(e->integrators[0], room > 0 ? text + out.length : NULL, room);
}
