/* The step in charts for members of an ensemble side by side. It is the cheapest way of
 * charted_step.c alone, simplified Newton's method by kept blocks of the Jacobian from the last
 * path continued. A member's new blocks are made alone. Members for which that would not be tried,
 * or does not converge, are left to dvi__charted_step. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_struct.h"
#include "method/lie/charted_step.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "solve/progress.h"
#include "step/element/fixed_point.h"
#include "step/element/members.h"
#include "system/chart/charted_members.h"

/* Members are taken together in groups of this size, so that their numbers stay in the nearest
 * cache, and few wait for the slowest of them. */
enum { GROUP = 32 };

/* Numbers of a group have rows of `width`, which is their number. */
typedef struct lanes {
  dvi__charted_members *charted;
  dvi__members_chord loops;
  dvi__criteria criteria;
  dvi__histories histories; /* [width] */
  int width, member[GROUP];
  char going[GROUP], solved[GROUP], renewed[GROUP];
  int iterations[GROUP];
  int64_t verdict[GROUP];
  double first[GROUP];                /* first corrections */
  double *t;                          /* rows at the nodes */
  double *p0, *p0_low, *end, *dp, *C; /* rows [nx] */
  double *kicks;                      /* rows [nx], the momenta added to each solution */
  double *guess, *solution;           /* rows [nx*s] */
  double *inverses;                   /* rows of the blocks' inverses */
  const double *inverse;              /* those in use, whose rows are `stride` apart */
  int stride;
  double *state, *memory; /* one member's q, p and compensations [4 n], and memory */
  double *numbers;        /* the memory of all these arrays */
} lanes;

static dvi__charted_step_of *step_of(const dvi__stepper *self)
{
  return self->own;
}

static dvi__element *element_of(const dvi__stepper *self)
{
  return step_of(self)->inner.own;
}

static size_t inverses_of(const dvi__element *element)
{
  return dvi__blocks_numbers(element->blocks) - dvi__blocks_inverses(element->blocks);
}

/* ---- create ---- */

/* Fewer members do not fill a vector. The inverses of larger blocks leave the caches, and making
 * them takes most of the time. */
enum { FEWEST = 4, MOST_INVERSES = 2048 };

static int has_lanes(const dvi__stepper *self, int capacity)
{
  const dvi__element *element = element_of(self);
  return capacity >= FEWEST && element->choice == DVI__SOLVER_AUTO && element->blocks != NULL &&
         inverses_of(element) <= MOST_INVERSES && self->system->damping == 0 &&
         dvi__action_forces_count(element->action) == 0 &&
         dvi__charted_has_members(step_of(self)->charted);
}

/* Share out the memory of all arrays, or give its size if there is none yet. */
static size_t share_out(const dvi__stepper *self, lanes *own)
{
  const dvi__element *element = element_of(self);
  dvi__members_chord *loops = &own->loops;
  const size_t width = GROUP, nx = (size_t)self->system->nx * width,
               nodes = (size_t)dvi__action_nodes(element->action),
               path = (size_t)dvi__action_unknowns(element->action) * width;
  double *q0 = NULL;
  struct {
    double **array;
    size_t size;
  } const parts[] = {{&q0, nx},
                     {&own->histories.last, width},
                     {&own->histories.ratio, width},
                     {&own->histories.contraction, width},
                     {&own->histories.own, width},
                     {&own->histories.size, width},
                     {&loops->change, width},
                     {&loops->largest, width},
                     {&own->t, nodes * width},
                     {&own->p0, nx},
                     {&own->p0_low, nx},
                     {&own->end, nx},
                     {&own->dp, nx},
                     {&own->C, nx},
                     {&own->kicks, nx},
                     {&own->guess, path},
                     {&own->solution, path},
                     {&loops->Y, path},
                     {&loops->R, path},
                     {&loops->rows, path},
                     {&loops->Q, nodes * nx},
                     {&loops->V, nodes * nx},
                     {&loops->L_q, nodes * nx},
                     {&loops->L_v, nodes * nx},
                     {&own->inverses, inverses_of(element) * width},
                     {&own->state, 4 * (size_t)self->system->n},
                     {&own->memory, self->memory_count}};
  size_t sum = 0;
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    if (own->numbers != NULL) *parts[i].array = own->numbers + sum;
    sum += parts[i].size;
  }
  loops->q0 = q0;
  loops->p0 = own->p0;
  return sum;
}

dvi_status dvi__charted_step_prepare_lanes(dvi__stepper *self, int capacity)
{
  if (!has_lanes(self, capacity)) return DVI_OK;
  lanes *own = self->lanes = DVI_NEW(lanes, 1);
  if (own != NULL) own->numbers = DVI_NEW(double, share_out(self, own));
  if (own == NULL || own->numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  (void)share_out(self, own);
  own->criteria = dvi__simplified_criteria();
  return dvi__charted_members_create(
      step_of(self)->charted, dvi__action_nodes(element_of(self)->action), GROUP, &own->charted);
}

void dvi__charted_step_clear_lanes(dvi__stepper *self)
{
  lanes *own = self->lanes;
  dvi__charted_members_destroy(&own->charted);
  dvi__release(own->numbers);
  dvi__release(own);
}

/* ---- numbers of members ---- */

static double *memory_row(const dvi__members *m, size_t number)
{
  return m->memory + number * (size_t)m->count;
}

/* Read rows of the block's numbers for the group. */
static void read_rows(const lanes *own, const dvi__members *m, size_t rows, const double *from,
                      double *to)
{
  for (size_t i = 0; i < rows; i++, from += m->count)
    for (int k = 0; k < own->width; k++) *to++ = from[own->member[k]];
}

/* Read numbers of one member from rows of `width`, and write them. */
static void read_one(size_t rows, int width, const double *from, double *one)
{
  for (size_t i = 0; i < rows; i++) one[i] = from[i * (size_t)width];
}

static void write_one(size_t rows, int width, const double *one, double *to)
{
  for (size_t i = 0; i < rows; i++) to[i * (size_t)width] = one[i];
}

/* ---- begin ---- */

/* Centre the charts of member k, and enter them. */
static void enter_charts(const dvi__stepper *self, const dvi__members *m, int k)
{
  const lanes *own = self->lanes;
  const dvi__charted_step_of *step = step_of(self);
  const size_t n = (size_t)self->system->n, count = (size_t)m->count, nx = (size_t)self->system->nx;
  const int member = own->member[k];
  read_one(n, m->count, m->q + member, own->state);
  dvi__charted_centre(step->charted, own->state);
  dvi__charted_members_take(own->charted, k);
  const double *const momenta[] = {m->p, m->p_compensation};
  double *const rows[] = {own->p0, own->p0_low};
  for (int i = 0; i < 2; i++) {
    read_one(n, (int)count, momenta[i] + member, own->state);
    dvi__charted_enter(step->charted, own->state, step->local);
    write_one(nx, own->width, step->local, rows[i] + k);
  }
}

static void find_times(const dvi__element *element, const lanes *own, const dvi__members *m,
                       double h)
{
  for (int j = 0; j < dvi__action_nodes(element->action); j++) {
    double node, weight;
    dvi__action_node(element->action, j, &node, &weight);
    for (int k = 0; k < own->width; k++)
      own->t[j * own->width + k] = m->t[own->member[k]] + node * h;
  }
}

/* Guess as dvi__element_guess. */
static void guess_paths(const dvi__stepper *self, const dvi__members *m)
{
  const lanes *own = self->lanes;
  const dvi__stepper *inner = &step_of(self)->inner;
  dvi__action *action = element_of(self)->action;
  const size_t unknowns = (size_t)dvi__action_unknowns(action),
               numbers = unknowns * (size_t)own->width;
  read_rows(own, m, unknowns, memory_row(m, DVI__LAST_Y), own->loops.R);
  dvi__action_continue_members(action, 1, own->width, own->loops.R, own->loops.Y);
  read_rows(own, m, unknowns, memory_row(m, inner->memory_count - unknowns), own->loops.R);
  for (size_t i = 0; i < numbers; i++) own->loops.Y[i] += own->loops.R[i];
  memcpy(own->guess, own->loops.Y, numbers * sizeof(double));
}

/* Count what new blocks of a member have taken, whose step may still be left. */
static void take_over_counts(dvi_counters *counters, const dvi_counters *before, dvi__members *m,
                             int member)
{
  m->gradients[member] += counters->gradients - before->gradients;
  m->hessians[member] += counters->hessians - before->hessians;
  m->jacobians[member] += counters->jacobians - before->jacobians;
  counters->gradients = before->gradients;
  counters->hessians = before->hessians;
  counters->jacobians = before->jacobians;
}

/* Put the element at the start of member k in its charts. */
static void place_element(const dvi__stepper *self, const dvi__members *m, double h, int k)
{
  const lanes *own = self->lanes;
  const dvi__charted_step_of *step = step_of(self);
  const size_t nx = (size_t)self->system->nx;
  memset(step->local, 0, nx * sizeof(double));
  read_one(nx, own->width, own->p0 + k, step->local + nx);
  dvi__element_put(element_of(self),
                   &(dvi__element_place){
                       .t = m->t[own->member[k]], .h = h, .q = step->local, .p = step->local + nx},
                   h);
}

/* Make new blocks of member k at its guess. A failure is left to the step alone. */
static void renew_blocks(dvi__stepper *self, dvi__members *m, double h, int k)
{
  lanes *own = self->lanes;
  const dvi__charted_step_of *step = step_of(self);
  dvi__element *element = element_of(self);
  const size_t count = dvi__blocks_numbers(element->blocks),
               part = dvi__element_blocks_part(&step->inner),
               unknowns = (size_t)dvi__action_unknowns(element->action);
  double *numbers = own->memory + part + DVI__FROZEN_POINT;
  const dvi_counters before = *self->counters;
  place_element(self, m, h, k);
  read_one(unknowns, own->width, own->guess + k, element->Y);
  dvi__charted_members_give(own->charted, k);
  own->going[k] = dvi__element_invert_blocks(element, element->Y, numbers) == DVI_OK;
  own->renewed[k] = 1;
  take_over_counts(self->counters, &before, m, own->member[k]);
  write_one(count, m->count, numbers, memory_row(m, part + DVI__FROZEN_POINT) + own->member[k]);
}

static void begin_iteration(lanes *own)
{
  dvi__histories *h = &own->histories;
  double *const rows[] = {h->last, h->ratio, h->contraction, h->own, h->size};
  for (int i = 0; i < 5; i++) memset(rows[i], 0, (size_t)own->width * sizeof(double));
  memset(own->going, 1, sizeof own->going);
  memset(own->solved, 0, sizeof own->solved);
  memset(own->renewed, 0, sizeof own->renewed);
}

/* Neighbours have their inverses in the block's numbers. */
static void find_inverses(const dvi__stepper *self, const dvi__members *m)
{
  lanes *own = self->lanes;
  const dvi__blocks *blocks = element_of(self)->blocks;
  const int first = own->member[0];
  const double *from = memory_row(m, dvi__element_blocks_part(&step_of(self)->inner) +
                                         DVI__FROZEN_POINT + dvi__blocks_inverses(blocks));
  if (own->member[own->width - 1] == first + own->width - 1) {
    own->inverse = from + first;
    own->stride = m->count;
    return;
  }
  read_rows(own, m, inverses_of(element_of(self)), from, own->inverses);
  own->inverse = own->inverses;
  own->stride = own->width;
}

static void begin_group(dvi__stepper *self, dvi__members *m, double h)
{
  lanes *own = self->lanes;
  const dvi__charted_step_of *step = step_of(self);
  dvi__element *element = element_of(self);
  const size_t part = dvi__element_blocks_part(&step->inner);
  begin_iteration(own);
  dvi__charted_members_begin(own->charted, own->width);
  for (int k = 0; k < own->width; k++) enter_charts(self, m, k);
  place_element(self, m, h, 0);
  dvi__action_members_tables(element->action, &own->loops);
  own->loops.width = own->width;
  find_times(element, own, m, h);
  guess_paths(self, m);
  for (int k = 0; k < own->width; k++)
    if (memory_row(m, part + DVI__FROZEN_H)[own->member[k]] != h) renew_blocks(self, m, h, k);
  find_inverses(self, m);
}

/* ---- iterations ---- */

/* Find ends of paths as dvi__action_place_terms, and h sum_j b_j L_q as
 * dvi__action_add_term_rows. */
WIDE static void find_ends(const dvi__members_chord *c, double *restrict end, double *restrict dp)
{
  const size_t width = (size_t)c->width;
  memset(end, 0, (size_t)c->n * width * sizeof *end);
  memset(dp, 0, (size_t)c->n * width * sizeof *dp);
  for (size_t i = 0; i < (size_t)c->n; i++, end += width, dp += width) {
    for (size_t l = 0; l < (size_t)c->s; l++)
      for (size_t k = 0; k < width; k++)
        end[k] += c->end[l] * c->Y[(i * (size_t)c->s + l) * width + k];
    for (size_t j = 0; j < (size_t)c->r; j++)
      for (size_t k = 0; k < width; k++) dp[k] += c->h * c->L_q[(i * (size_t)c->r + j) * width + k];
  }
}

WIDE static void subtract_corrections(const dvi__members_chord *c, const double *restrict C)
{
  const size_t width = (size_t)c->width;
  for (size_t i = 0; i < (size_t)c->n; i++, C += width)
    for (size_t l = 0; l < (size_t)c->s; l++) {
      double *restrict R = c->R + (i * (size_t)c->s + l) * width;
      for (size_t k = 0; k < width; k++) R[k] -= c->end[l] * C[k];
    }
}

static dvi_status iterate_group(const dvi__stepper *self)
{
  const lanes *own = self->lanes;
  const dvi__members_chord *loops = &own->loops;
  dvi__members_chord_stages(loops);
  DVI_TRY(dvi__charted_members_gradient(own->charted, own->t, loops->Q, loops->V, loops->L_q,
                                        loops->L_v));
  dvi__members_chord_residual(loops);
  find_ends(loops, own->end, own->dp);
  dvi__charted_members_correct(own->charted, loops->h, loops->weight, own->end, own->p0, own->dp,
                               own->C);
  subtract_corrections(loops, own->C);
  dvi__blocks_solve_members(element_of(self)->blocks, own->width, own->stride, own->inverse,
                            loops->R, loops->rows);
  dvi__members_chord_subtract(loops);
  return DVI_OK;
}

/* Keep the path of member k, and the momentum that it adds as dvi__action_ends. */
static void keep_solution(const lanes *own, int k)
{
  const dvi__members_chord *c = &own->loops;
  const size_t width = (size_t)own->width, s = (size_t)c->s, r = (size_t)c->r;
  for (size_t row = 0; row < (size_t)c->n * s; row++)
    own->solution[row * width + (size_t)k] = c->Y[row * width + (size_t)k];
  for (size_t i = 0; i < (size_t)c->n; i++) {
    double force = 0;
    for (size_t j = 0; j < r; j++) force += c->L_q[(i * r + j) * width + (size_t)k];
    own->kicks[i * width + (size_t)k] = c->h * force + own->C[i * width + (size_t)k];
  }
  dvi__charted_members_keep(own->charted, k);
}

/* Tell whether the iteration of member k ends without a solution, as that of the step alone, or
 * where that one looks at the roundings of its rows. */
static int is_lost(const lanes *own, int k, int iteration)
{
  const dvi__history history = {.last = own->loops.change[k], .before = own->first[k]};
  return own->verdict[k] == DVI__STALLED ||
         (iteration == 2 && dvi__misleading(&history, own->loops.largest[k]));
}

/* Test every member's iteration. Returns the number of members that go on. */
static int test_group(lanes *own, int iteration)
{
  int going = 0;
  const dvi__members_chord *loops = &own->loops;
  if (iteration == 1) memcpy(own->first, loops->change, (size_t)own->width * sizeof(double));
  dvi__test_corrections(own->width, loops->change, loops->largest, &own->criteria, &own->histories,
                        own->verdict);
  for (int k = 0; k < own->width; k++) {
    if (!own->going[k]) continue;
    own->solved[k] = own->verdict[k] == DVI__CONVERGED;
    own->going[k] = !own->solved[k] && !is_lost(own, k, iteration);
    own->iterations[k] = iteration;
    if (own->solved[k]) keep_solution(own, k);
    going += own->going[k];
  }
  return going;
}

/* Members that go on after a failure are left. */
static void solve_group(const dvi__stepper *self)
{
  for (int i = 1; i <= dvi__simplified_most(); i++)
    if (iterate_group(self) != DVI_OK || test_group(self->lanes, i) == 0) return;
}

/* ---- ends ---- */

/* Read what the step changes in a member's memory, and the sign of its blocks. */
static void read_memory(const dvi__stepper *self, const dvi__members *m, int member)
{
  const lanes *own = self->lanes;
  const dvi__stepper *inner = &step_of(self)->inner;
  const size_t unknowns = (size_t)dvi__action_unknowns(element_of(self)->action),
               first[] = {0, dvi__element_blocks_part(inner), inner->memory_count - unknowns},
               count[] = {DVI__LAST_Y + unknowns, DVI__FROZEN_POINT + 1, unknowns};
  for (int i = 0; i < 3; i++)
    read_one(count[i], m->count, memory_row(m, first[i]) + member, own->memory + first[i]);
}

static void write_memory(const dvi__stepper *self, const dvi__members *m, int member)
{
  const lanes *own = self->lanes;
  const dvi__stepper *inner = &step_of(self)->inner;
  const size_t unknowns = (size_t)dvi__action_unknowns(element_of(self)->action),
               first[] = {0, dvi__element_blocks_part(inner), inner->memory_count - unknowns},
               count[] = {DVI__LAST_Y + unknowns, DVI__FROZEN_POINT, 2 * unknowns};
  for (int i = 0; i < 3; i++)
    write_one(count[i], m->count, own->memory + first[i], memory_row(m, first[i]) + member);
}

/* Give the element the solution of member k. Returns 0 if it is not sure to be that of the
 * branch. */
static int give_solution(const dvi__stepper *self, double h, int k)
{
  const lanes *own = self->lanes;
  dvi__element *element = element_of(self);
  const dvi__element_place at = {.h = h};
  const size_t unknowns = (size_t)dvi__action_unknowns(element->action);
  read_one(unknowns, own->width, own->solution + k, element->Y);
  read_one(unknowns, own->width, own->guess + k, element->guess);
  element->frozen = own->memory + dvi__element_blocks_part(&step_of(self)->inner);
  element->rung = DVI__SIMPLIFIED;
  element->by_blocks = 1;
  return !dvi__element_strays(&step_of(self)->inner, &at);
}

/* Advance member k's state in the charts, as dvi__element_step. */
static void advance_in_charts(const dvi__stepper *self, double h, int k, dvi__state *local)
{
  const lanes *own = self->lanes;
  dvi__charted_step_of *step = step_of(self);
  dvi__element *element = step->inner.own;
  const size_t nx = (size_t)self->system->nx;
  double *frozen = element->frozen;
  for (size_t i = 0; i < nx; i++) {
    element->dq[i] = element->dq_low[i] = 0;
    for (size_t l = 0; l < (size_t)own->loops.s; l++)
      element->dq[i] += own->loops.end[l] * element->Y[i * (size_t)own->loops.s + l];
  }
  read_one(nx, own->width, own->kicks + k, element->dp);
  element->duration = h;
  frozen[DVI__FROZEN_H] = own->renewed[k] || dvi__element_keeps(frozen[DVI__FROZEN_ITERATIONS],
                                                                own->iterations[k])
                              ? h
                              : 0;
  if (own->renewed[k]) frozen[DVI__FROZEN_ITERATIONS] = own->iterations[k];
  own->memory[DVI__NEWTON_WAIT] = 0;
  step->inner.memory = own->memory;
  dvi__element_advance(&step->inner, local, h);
}

/* Give the state of member k in its charts. */
static dvi__state local_state(const dvi__stepper *self, const dvi__members *m, int k)
{
  const lanes *own = self->lanes;
  const dvi__charted_step_of *step = step_of(self);
  const size_t nx = (size_t)self->system->nx;
  memset(step->local, 0, 4 * nx * sizeof(double));
  read_one(nx, own->width, own->p0 + k, step->local + nx);
  read_one(nx, own->width, own->p0_low + k, step->local + 3 * nx);
  return (dvi__state){.t = m->t[own->member[k]],
                      .t_compensation = m->t_compensation[own->member[k]],
                      .q = step->local,
                      .p = step->local + nx,
                      .q_compensation = step->local + 2 * nx,
                      .p_compensation = step->local + 3 * nx};
}

/* Move member k from its charts' centre to the end. */
static void arrive(const dvi__stepper *self, const dvi__members *m, const dvi__state *local, int k)
{
  const lanes *own = self->lanes;
  const size_t n = (size_t)self->system->n;
  const int member = own->member[k];
  double *const rows[] = {m->q, m->p, m->q_compensation, m->p_compensation};
  dvi__state state = {.q = own->state,
                      .p = own->state + n,
                      .q_compensation = own->state + 2 * n,
                      .p_compensation = own->state + 3 * n};
  for (size_t i = 0; i < 4; i++) read_one(n, m->count, rows[i] + member, own->state + i * n);
  dvi__charted_step_arrive(step_of(self), own->memory, local, &state);
  for (size_t i = 0; i < 4; i++) write_one(n, m->count, own->state + i * n, rows[i] + member);
  m->t[member] = state.t;
  m->t_compensation[member] = state.t_compensation;
}

static void end_member(const dvi__stepper *self, dvi__members *m, double h, int k)
{
  const lanes *own = self->lanes;
  const dvi__charted_step_of *step = step_of(self);
  const int member = own->member[k];
  m->left[member] = 1;
  if (!own->solved[k]) return;
  dvi__state local = local_state(self, m, k);
  dvi__charted_members_give(own->charted, k);
  read_memory(self, m, member);
  if (!give_solution(self, h, k)) return;
  advance_in_charts(self, h, k, &local);
  if (dvi__charted_check(step->charted, local.q) != DVI_OK) return;
  arrive(self, m, &local, k);
  write_memory(self, m, member);
  m->residuals[member] += own->iterations[k];
  m->gradients[member] += (long)own->iterations[k] * own->loops.r;
  m->simplified[member]++;
  m->left[member] = 0;
}

/* ---- step ---- */

/* Give the size of groups of about the same size, in whole vectors. */
static int group_size(int count)
{
  const int groups = (count - 1) / GROUP + 1, vectors = (count - 1) / groups / FEWEST + 1;
  return vectors * FEWEST;
}

/* Fill the group from member `next` on. Leaves those without a last step of this length, and those
 * that wait for the blocks to be tried again. Returns the first member behind the group. */
static int choose_group(lanes *own, dvi__members *m, double h, int next)
{
  const double *last_h = memory_row(m, DVI__LAST_H), *steps = memory_row(m, DVI__NEWTON_STEPS);
  own->width = 0;
  for (const int most = group_size(m->count); next < m->count && own->width < most; next++) {
    if (last_h[next] != h || steps[next] != 0) m->left[next] = 1;
    if (!m->left[next]) own->member[own->width++] = next;
  }
  return next;
}

void dvi__charted_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  lanes *own = self->lanes;
  for (int next = 0; next < m->count;) {
    next = choose_group(own, m, h, next);
    if (own->width < FEWEST) {
      for (int k = 0; k < own->width; k++) m->left[own->member[k]] = 1;
      continue;
    }
    begin_group(self, m, h);
    solve_group(self);
    for (int k = 0; k < own->width; k++) end_member(self, m, h, k);
  }
}
