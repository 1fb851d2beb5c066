#include "step/element/members.h"

#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/fixed_point.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/members.h"
#include "system/evaluate/untested.h"

int dvi__action_has_members(const dvi__action *a)
{
  return (dvi__action_has_fixed_point(a) && dvi__action_has_offsets(a)) ||
         dvi__action_has_chord_members(a);
}

/* Allocate the numbers of fixed_point.h. */
static int members_allocate_stages(dvi__action_members *m, size_t capacity)
{
  const size_t n = (size_t)m->action->n, r = (size_t)m->action->r,
               stages = (size_t)m->action->fixed_point.stages;
  double **const rows[] = {&m->packed_start, &m->packed_low, &m->packed_origin, &m->all_start,
                           &m->all_low};
  int complete = 1;
  m->Z = DVI_NEW(double, n *stages *capacity);
  m->Q = DVI_NEW(double, n *stages *capacity);
  m->force = DVI_NEW(double, n *stages *capacity);
  if (stages > r) {
    m->kinetic = DVI_NEW(double, n *capacity);
    for (int k = 0; k < 4; k++) {
      m->batch[k] = DVI_NEW(double, n *r *capacity);
      complete = complete && m->batch[k] != NULL;
    }
    complete = complete && m->kinetic != NULL;
  }
  if (m->action->preconditioner != NULL) {
    m->rest = DVI_NEW(double, n *r *capacity);
    m->moved = DVI_NEW(double, n *r *capacity);
    m->kept_Q = DVI_NEW(double, n *r *capacity);
    complete = complete && m->rest && m->moved && m->kept_Q;
  }
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    *rows[i] = DVI_NEW(double, n *capacity);
    complete = complete && *rows[i] != NULL;
  }
  return complete && m->Z && m->Q && m->force;
}

static int members_allocate(dvi__action_members *m, size_t capacity)
{
  const size_t n = (size_t)m->action->n, r = (size_t)m->action->r;
  m->member = DVI_NEW(int, capacity);
  m->going = DVI_NEW(int, capacity);
  m->change = DVI_NEW(double, capacity);
  m->largest = DVI_NEW(double, capacity);
  m->t = DVI_NEW(double, r *capacity);
  m->dq = DVI_NEW(double, n *capacity);
  m->dq_low = DVI_NEW(double, n *capacity);
  m->dp = DVI_NEW(double, n *capacity);
  return m->member && m->going && m->change && m->largest && m->t && m->dq && m->dq_low && m->dp;
}

dvi_status dvi__action_members_create(dvi__action *action, int capacity,
                                      dvi__action_members *members)
{
  *members = (dvi__action_members){.action = action};
  /* Without counters, because the caller knows the cost of a member. The chord solves for s
   * functions. */
  const int points = action->r > action->s ? action->r : action->s;
  DVI_TRY(dvi__evaluator_create(action->system, capacity * points, DVI__GRADIENTS, NULL,
                                &members->evaluator));
  if (!members_allocate(members, (size_t)capacity))
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d members", capacity);
  if (!dvi__action_has_offsets(action)) return dvi__chord_members_create(members, (size_t)capacity);
  if (dvi__action_lags(action))
    DVI_TRY(dvi__lagged_create(action->system, action->r, capacity, &members->lagged));
  if (members_allocate_stages(members, (size_t)capacity)) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d members", capacity);
}

void dvi__action_members_clear(dvi__action_members *m)
{
  double *const owned[] = {m->change,
                           m->largest,
                           m->t,
                           m->Z,
                           m->Q,
                           m->force,
                           m->packed_start,
                           m->packed_low,
                           m->packed_origin,
                           m->all_start,
                           m->all_low,
                           m->dq,
                           m->dq_low,
                           m->dp,
                           m->kinetic,
                           m->rest,
                           m->moved,
                           m->kept_Q,
                           m->batch[0],
                           m->batch[1],
                           m->batch[2],
                           m->batch[3]};
  dvi__chord_members_clear(m);
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__release(m->member);
  dvi__release(m->going);
  dvi__lagged_destroy(&m->lagged);
  dvi__evaluator_destroy(&m->evaluator);
  *m = (dvi__action_members){0};
}

static size_t members_row(const dvi__action_members *m, size_t number)
{
  return number * (size_t)m->width;
}

static dvi__members_fixed_point members_fixed_point(const dvi__action_members *m)
{
  const dvi__action *a = m->action;
  return (dvi__members_fixed_point){.n = a->n,
                                    .stages = a->fixed_point.stages,
                                    .width = m->width,
                                    .lanes = a->fixed_point.lanes,
                                    .matrix = a->fixed_point.matrix,
                                    .node = a->fixed_point.node,
                                    .weight = a->fixed_point.weight,
                                    .factor = a->fixed_point.factor,
                                    .start = m->start,
                                    .low = m->low,
                                    .origin = m->origin,
                                    .force = m->force,
                                    .Z = m->Z,
                                    .Q = m->Q,
                                    .change = m->change,
                                    .largest = m->largest};
}

/* Put the nodes as dvi__action_fixed_point_continue. */
static void members_put_nodes(dvi__action_members *m, double ratio)
{
  dvi__action *a = m->action;
  dvi__action_set_step(a);
  dvi__members_split(a->n, m->width, a->fixed_point.factor, m->p, m->all_start, m->all_low);
  dvi__members_product(a->n, a->fixed_point.stages, a->fixed_point.lanes, a->fixed_point.stages,
                       dvi__action_fixed_point_shift(a, ratio), m->width, m->forces, m->Z);
  if (m->lagged != NULL)
    dvi__lagged_begin(m->lagged, m->width, ratio,
                      m->forces + members_row(m, (size_t)a->n * (size_t)a->r));
  const dvi__members_fixed_point iteration = members_fixed_point(m);
  if (a->preconditioner != NULL)
    dvi__preconditioner_begin_members(m);
  else
    dvi__members_begin(&iteration);
}

void dvi__action_members_place(dvi__action_members *m, int count, double h, double last_h,
                               const double *t, const double *q, const double *p, double *last)
{
  dvi__action *a = m->action;
  m->count = m->width = count;
  m->start = m->all_start;
  m->low = m->all_low;
  m->origin = q;
  m->t0 = t;
  m->p = p;
  m->forces = last;
  for (int k = 0; k < count; k++) m->member[k] = k;
  for (size_t j = 0; j < (size_t)a->r; j++)
    for (size_t k = 0; k < (size_t)count; k++) m->t[members_row(m, j) + k] = t[k] + a->node[j] * h;
  a->h = h;
  dvi__action_damp(a, h);
  if (m->chord != NULL)
    dvi__chord_members_place(m, h / last_h);
  else
    members_put_nodes(m, h / last_h);
}

void dvi__action_members_pack(const dvi__action_members *m, int rows, int before, const double *x,
                              double *packed)
{
  for (size_t i = 0; i < (size_t)rows; i++) {
    const double *from = x + i * (size_t)before;
    double *to = packed + members_row(m, i);
    for (int k = 0; k < m->width; k++) to[k] = from[m->going[k]];
  }
}

void dvi__action_members_close_up(dvi__action_members *m, const char *marked)
{
  const int n = m->action->n, r = m->action->r, stages = m->action->fixed_point.stages,
            before = m->width;
  int lanes = 0;
  for (int k = 0; k < before; k++) {
    m->member[lanes] = m->member[k];
    m->going[lanes] = k;
    lanes += marked[k] != 0;
  }
  if (lanes == before) return;
  m->width = lanes;
  dvi__action_members_pack(m, r, before, m->t, m->t);
  if (m->chord != NULL) {
    dvi__chord_members_pack(m, before);
    return;
  }
  dvi__action_members_pack(m, n * stages, before, m->Z, m->Z);
  dvi__action_members_pack(m, n * stages, before, m->Q, m->Q);
  dvi__action_members_pack(m, n, before, m->start, m->packed_start);
  dvi__action_members_pack(m, n, before, m->low, m->packed_low);
  dvi__action_members_pack(m, n, before, m->origin, m->packed_origin);
  m->start = m->packed_start;
  m->low = m->packed_low;
  m->origin = m->packed_origin;
  if (m->lagged != NULL) dvi__lagged_close_up(m->lagged, lanes, m->going);
}

/* Evaluate forces and A as evaluate_stages of fixed_point.c. */
static dvi_status members_evaluate_stages(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  const size_t rows = members_row(m, (size_t)a->r),
               of_stages = members_row(m, (size_t)a->fixed_point.stages);
  const double inverse_h = 1.0 / a->h;
  double *const Q = m->batch[0], *const V = m->batch[1], *const V_q = m->batch[2],
                *const A = m->batch[3];
  for (size_t i = 0; i < (size_t)a->n; i++) {
    memcpy(Q + i * rows, m->Q + i * of_stages, rows * sizeof(double));
    for (size_t k = 0; k < rows; k++) V[i * rows + k] = inverse_h * m->Z[i * of_stages + rows + k];
  }
  DVI_TRY(dvi__magnetic_gradient(m->evaluator, a->r * m->width, m->t, Q, V, V_q, A));
  for (size_t i = 0; i < (size_t)a->n; i++) {
    memcpy(m->force + i * of_stages, V_q + i * rows, rows * sizeof(double));
    memcpy(m->force + i * of_stages + rows, A + i * rows, rows * sizeof(double));
  }
  return DVI_OK;
}

/* Iterate with slow forces that may lag. */
static dvi_status members_iterate_lagged(dvi__action_members *m)
{
  const dvi__place_table table = dvi__action_place_table(m->action);
  DVI_TRY(dvi__lagged_gradient(m->lagged, m->evaluator, m->t, m->Q, &table, m->force));
  const dvi__members_fixed_point iteration = members_fixed_point(m);
  dvi__members_iterate(&iteration);
  dvi__lagged_change(m->lagged, m->largest, m->change);
  return DVI_OK;
}

dvi_status dvi__action_members_iterate(dvi__action_members *m)
{
  if (m->chord != NULL) return dvi__chord_members_iterate(m);
  if (m->lagged != NULL) return members_iterate_lagged(m);
  DVI_TRY(m->kinetic != NULL ? members_evaluate_stages(m)
                             : dvi__potentials_gradient_untested(
                                   m->evaluator, m->action->r * m->width, m->t, m->Q, m->force));
  const dvi__members_fixed_point iteration = members_fixed_point(m);
  if (m->action->preconditioner != NULL)
    dvi__preconditioner_iterate_members(m);
  else
    dvi__members_iterate(&iteration);
  return DVI_OK;
}

/* Keep rows of numbers of these lanes. All lanes are kept as a whole if they hold all members. */
static void keep_rows(const dvi__action_members *m, size_t rows, int lanes, const int *lane,
                      const double *x, double *kept)
{
  const size_t count = (size_t)m->count;
  if (lanes == m->count) {
    memcpy(kept, x, rows * count * sizeof(double));
    return;
  }
  for (size_t i = 0; i < rows; i++)
    for (int k = 0; k < lanes; k++)
      kept[i * count + (size_t)m->member[lane[k]]] = x[members_row(m, i) + (size_t)lane[k]];
}

void dvi__action_members_keep(dvi__action_members *m, int lanes, const int *lane)
{
  const size_t rows = (size_t)m->action->n * (size_t)m->action->fixed_point.stages;
  for (int k = 0; k < lanes && m->chord != NULL; k++) dvi__chord_members_keep(m, lane[k]);
  if (m->chord != NULL) return;
  keep_rows(m, rows, lanes, lane, m->force, m->forces);
  for (int k = 0; k < lanes && m->lagged != NULL; k++)
    dvi__lagged_factors(m->lagged, lane[k], (size_t)m->count,
                        m->forces + rows * (size_t)m->count + m->member[lane[k]]);
  if (m->kept_Q != NULL) keep_rows(m, rows, lanes, lane, m->Q, m->kept_Q);
}

/* Take g and a of all members apart, with p0 - sum_j a_j. */
static void members_part_stages(dvi__action_members *m)
{
  const size_t r = (size_t)m->action->r, stages = (size_t)m->action->fixed_point.stages,
               count = (size_t)m->count;
  for (size_t i = 0; i < (size_t)m->action->n; i++) {
    const double *row = m->forces + i * stages * count;
    double *sum = m->kinetic + i * count;
    memcpy(m->batch[0] + i * r * count, row, r * count * sizeof(double));
    memset(sum, 0, count * sizeof(double));
    for (size_t j = r; j < stages; j++)
      for (size_t k = 0; k < count; k++) sum[k] += row[j * count + k];
    for (size_t k = 0; k < count; k++) sum[k] = m->p[i * count + k] - sum[k];
  }
}

/* Find the path as dvi__action_fixed_point_path. */
static void members_path(const dvi__action_members *m, double *Y)
{
  const dvi__action *a = m->action;
  const size_t n = (size_t)a->n, s = (size_t)a->s, count = (size_t)m->count;
  dvi__members_product(a->n, a->fixed_point.stages, a->path_lanes, a->s, a->fixed_point.path,
                       m->count, m->forces, Y);
  for (size_t i = 0; i < n * s; i++) {
    const double *start = m->all_start + i / s * count;
    for (size_t k = 0; k < count; k++)
      Y[i * count + k] = start[k] * a->straight[i % s] +
                         a->fixed_point.factor[i / s] * Y[i * count + k];
  }
}

/* Find the path and the ends as dvi__action_fixed_point_ends. */
void dvi__action_members_ends(dvi__action_members *m, double *Y)
{
  const dvi__action *a = m->action;
  const int has_velocities = m->kinetic != NULL;
  if (m->chord != NULL) return;
  if (Y != NULL) members_path(m, Y);
  if (has_velocities) members_part_stages(m);
  dvi__members_ends_of(&(dvi__members_ends){.n = a->n,
                                            .stages = a->r,
                                            .width = m->count,
                                            .g = has_velocities ? m->batch[0] : m->forces,
                                            .slant = a->fixed_point.slant,
                                            .factor = a->fixed_point.factor,
                                            .p0 = has_velocities ? m->kinetic : m->p,
                                            .moved = m->dq,
                                            .low = m->dq_low,
                                            .sum = m->dp});
  if (a->preconditioner != NULL) dvi__preconditioner_other_forces_of_members(m);
}
