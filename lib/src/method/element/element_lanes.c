/* The element's step for members of an ensemble side by side. It is the cheapest way of
 * element_step.c alone, fixed point iteration from the continued last forces, or on the continued
 * last path. Members for which that would not be tried, or does not converge, are left to
 * dvi__element_step. */
#include <math.h>
#include <string.h>

#include "step/element/members.h"
#include "step/element/fixed_point.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_struct.h"
#include "num/compensated.h"
#include "num/simd/lanes.h"
#include "solve/progress.h"

typedef struct lanes {
  dvi__action_members members;
  dvi__criteria criteria;
  int patient;
  /* histories of the lanes, whose size is that of q at the step's start */
  dvi__histories histories;
  char *going;      /* [width] the lane iterates on */
  int64_t *verdict; /* [width] verdict on the last iteration */
  int *ended;       /* [width] lanes that ended with it */
} lanes;

/* More than four nodes fill most of the vectors of a single element. Members as lanes then gain
 * only as long as they stay in the caches. */
enum { FEW_NODES = 4, POINTS_IN_CACHE = 160 };

static int lanes_pay(const dvi__action *action, int n)
{
  const int nodes = dvi__action_nodes(action);
  return (nodes <= FEW_NODES && dvi__action_has_offsets(action)) || n <= POINTS_IN_CACHE / nodes;
}

/* Tell whether the ladder begins with fixed point iteration by members' functions. */
static int has_lanes(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return (own->choice == DVI__SOLVER_FIXED_POINT || own->choice == DVI__SOLVER_AUTO) &&
         !own->keeps_whole && dvi__action_has_members(own->action) &&
         dvi__system_has_gradients(self->system) && lanes_pay(own->action, self->system->n);
}

dvi_status dvi__element_prepare_lanes(dvi__stepper *self, int capacity)
{
  const dvi__element *element = self->own;
  if (!has_lanes(self)) return DVI_OK;
  lanes *own = self->lanes = DVI_NEW(lanes, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  own->patient = element->choice == DVI__SOLVER_FIXED_POINT || element->without_hessian != NULL;
  own->criteria = dvi__fixed_point_criteria(own->patient, dvi__action_has_offsets(element->action));
  own->histories.last = DVI_NEW(double, capacity);
  own->histories.ratio = DVI_NEW(double, capacity);
  own->histories.contraction = DVI_NEW(double, capacity);
  own->histories.own = DVI_NEW(double, capacity);
  own->histories.size = DVI_NEW(double, capacity);
  own->going = DVI_NEW(char, capacity);
  own->verdict = DVI_NEW(int64_t, capacity);
  own->ended = DVI_NEW(int, capacity);
  if (!own->histories.last || !own->histories.ratio || !own->histories.contraction ||
      !own->histories.own || !own->histories.size || !own->going || !own->verdict || !own->ended)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  return dvi__action_members_create(element->action, capacity, &own->members);
}

void dvi__element_clear_lanes(dvi__stepper *self)
{
  lanes *own = self->lanes;
  dvi__action_members_clear(&own->members);
  dvi__release(own->histories.last);
  dvi__release(own->histories.ratio);
  dvi__release(own->histories.contraction);
  dvi__release(own->histories.own);
  dvi__release(own->histories.size);
  dvi__release(own->going);
  dvi__release(own->verdict);
  dvi__release(own->ended);
  dvi__release(own);
}

static double *memory_row(const dvi__members *m, size_t number)
{
  return m->memory + number * (size_t)m->count;
}

/* Leave the members that would not try fixed point iteration, or whose last step had another length
 * than the others'. Gives that length, or 0 if no member remains. */
static double lanes_choose(const lanes *own, dvi__members *m)
{
  const double *last_h = memory_row(m, DVI__LAST_H),
               *newton_steps = memory_row(m, DVI__NEWTON_STEPS);
  double common = 0;
  for (int k = 0; k < m->count; k++) {
    if (common == 0 && !m->left[k]) common = last_h[k];
    if (last_h[k] == 0 || last_h[k] != common || (newton_steps[k] != 0 && !own->patient))
      m->left[k] = 1;
  }
  return memchr(m->left, 0, (size_t)m->count) != NULL ? common : 0;
}

/* Remove the lanes that have ended. */
static void lanes_close_up(lanes *own)
{
  dvi__action_members *at = &own->members;
  double *const rows[] = {own->histories.last, own->histories.ratio, own->histories.contraction,
                          own->histories.own, own->histories.size};
  const int before = at->width;
  dvi__action_members_close_up(at, own->going);
  for (int i = 0; i < (int)(sizeof rows / sizeof *rows) && at->width < before; i++)
    dvi__action_members_pack(at, 1, before, rows[i], rows[i]);
  memset(own->going, 1, (size_t)at->width);
}

/* Begin from numbers of the last step, which stand in the memory from `last` on. */
static void lanes_begin(lanes *own, int n, size_t last, const dvi__members *m, double h,
                        double last_h)
{
  const size_t count = (size_t)m->count;
  double *size = own->histories.size;
  memset(own->histories.last, 0, count * sizeof(double));
  memset(own->histories.ratio, 0, count * sizeof(double));
  memset(own->histories.contraction, 0, count * sizeof(double));
  memset(own->histories.own, 0, count * sizeof(double));
  memset(size, 0, count * sizeof(double));
  for (size_t i = 0; i < (size_t)n; i++)
    for (size_t k = 0; k < count; k++) {
      const double q = fabs(m->q[i * count + k]);
      size[k] = q > size[k] ? q : size[k];
    }
  for (size_t k = 0; k < count; k++) own->going[k] = !m->left[k];
  dvi__action_members_place(&own->members, m->count, h, last_h, m->t, m->q, m->p,
                            memory_row(m, last));
  lanes_close_up(own);
}

/* Count a lane's iterations, which end with this one. */
static void lanes_count_one(const lanes *own, dvi__members *m, int lane, int iteration)
{
  const dvi__action_members *at = &own->members;
  const int k = at->member[lane];
  m->residuals[k] += iteration;
  m->gradients[k] += (long)iteration * dvi__action_nodes(at->action);
  m->fixed[k]++;
}

/* Test every lane's iteration. Gives how many ended with it. *stalled tells that some of them must
 * not be iterated any more. */
static int lanes_test(lanes *own, dvi__members *m, int iteration, int *stalled)
{
  dvi__action_members *at = &own->members;
  int done = 0, lost = 0;
  dvi__test_corrections(at->width, at->change, at->largest, &own->criteria, &own->histories,
                        own->verdict);
  for (int lane = 0; lane < at->width; lane++) {
    own->ended[done] = lane;
    done += own->going[lane] & (own->verdict[lane] == DVI__CONVERGED);
  }
  for (int lane = 0; lane < at->width; lane++) {
    const int stalls = own->going[lane] & (own->verdict[lane] == DVI__STALLED);
    if (stalls) m->left[at->member[lane]] = 1;
    lost += stalls;
    own->going[lane] &= own->verdict[lane] == DVI__GO_ON;
  }
  dvi__action_members_keep(at, done, own->ended);
  for (int i = 0; i < done; i++) lanes_count_one(own, m, own->ended[i], iteration);
  *stalled = lost > 0;
  return done + lost;
}

/* Leave the members whose iteration is cut short. */
static void lanes_leave(const lanes *own, dvi__members *m)
{
  for (int lane = 0; lane < own->members.width; lane++)
    if (own->going[lane]) m->left[own->members.member[lane]] = 1;
}

/* Iterate. Lanes that have ended stay until they are half of all, because closing up costs about as
 * much as an iteration. */
static void lanes_iterate(lanes *own, dvi__members *m)
{
  dvi__action_members *at = &own->members;
  const int most = dvi__fixed_point_most(own->patient);
  int going = at->width;
  for (int iteration = 1; iteration <= most; iteration++) {
    int stalled = 0;
    if (dvi__action_members_iterate(at) != DVI_OK) break;
    going -= lanes_test(own, m, iteration, &stalled);
    if (going == 0) return;
    if (stalled || 2 * going <= at->width) lanes_close_up(own);
  }
  lanes_leave(own, m);
}

/* Keep the unknowns, or what they are made of, and find the ends. */
static void lanes_end(lanes *own, size_t n, int late, dvi__members *m)
{
  const size_t count = (size_t)m->count;
  double *last = memory_row(m, DVI__LAST_Y), *is_late = memory_row(m, DVI__LATE);
  if (late) memcpy(last, m->p, n * count * sizeof(double));
  dvi__action_members_ends(&own->members, late ? NULL : last);
  for (size_t k = 0; k < count; k++) is_late[k] = late;
}

/* Advance the state and the memory by a step that fixed point iteration has solved. */
static void lanes_advance(const lanes *own, size_t n, dvi__members *m, double h)
{
  static const size_t cleared[] = {DVI__NEWTON_STEPS, DVI__NEWTON_WAIT};
  const dvi__action_members *at = &own->members;
  const size_t count = (size_t)m->count;
  double *last_h = memory_row(m, DVI__LAST_H);
  dvi__lanes_add_scaled(n * count, 1.0, at->dq, m->q, m->q_compensation);
  dvi__lanes_add_scaled(n * count, 1.0, at->dq_low, m->q, m->q_compensation);
  dvi__lanes_add_scaled(n * count, 1.0, at->dp, m->p, m->p_compensation);
  for (size_t k = 0; k < count; k++) dvi__add_compensated(m->t + k, m->t_compensation + k, h);
  for (size_t k = 0; k < count; k++) last_h[k] = h;
  for (int i = 0; i < 2; i++) memset(memory_row(m, cleared[i]), 0, count * sizeof(double));
}

void dvi__element_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  lanes *own = self->lanes;
  const double last_h = lanes_choose(own, m);
  if (last_h == 0) return;
  const size_t last = own->members.chord != NULL ? DVI__LAST_Y : dvi__element_forces(self);
  lanes_begin(own, self->system->n, last, m, h, last_h);
  lanes_iterate(own, m);
  lanes_end(own, (size_t)self->system->n, ((const dvi__element *)self->own)->late_paths, m);
  lanes_advance(own, (size_t)self->system->n, m, h);
}
