#include "action/members.h"

#include <string.h>

#include "action/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/members.h"

static int allocate(dvi__action_members *m, size_t capacity)
{
  const size_t n = (size_t)m->action->n, r = (size_t)m->action->r, s = (size_t)m->action->s;
  m->member = DVI_NEW(int, capacity);
  m->going = DVI_NEW(int, capacity);
  m->change = DVI_NEW(double, capacity);
  m->largest = DVI_NEW(double, capacity);
  m->t = DVI_NEW(double, r *capacity);
  m->Z = DVI_NEW(double, n *r *capacity);
  m->Q = DVI_NEW(double, n *r *capacity);
  m->force = DVI_NEW(double, n *r *capacity);
  m->packed_start = DVI_NEW(double, n *capacity);
  m->packed_origin = DVI_NEW(double, n *capacity);
  m->all_start = DVI_NEW(double, n *capacity);
  m->kept = DVI_NEW(double, n *r *capacity);
  m->Y = DVI_NEW(double, n *s *capacity);
  m->dq = DVI_NEW(double, n *capacity);
  m->dp = DVI_NEW(double, n *capacity);
  m->ones = DVI_NEW(double, r);
  return m->member && m->going && m->change && m->largest && m->t && m->Z && m->Q && m->force && m->packed_start &&
         m->packed_origin && m->all_start && m->kept && m->Y && m->dq && m->dp && m->ones;
}

dvi_status dvi__action_members_create(dvi__action *action, int capacity, dvi__action_members *members)
{
  *members = (dvi__action_members){.action = action};
  /* Counted by who knows what a member took. */
  DVI_TRY(dvi__evaluator_create(action->system, capacity * action->r, DVI__GRADIENTS, NULL, &members->evaluator));
  if (!allocate(members, (size_t)capacity)) return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d members", capacity);
  for (int j = 0; j < action->r; j++) members->ones[j] = 1;
  return DVI_OK;
}

void dvi__action_members_clear(dvi__action_members *m)
{
  double *const owned[] = {m->change,        m->largest,   m->t,    m->Z, m->Q,  m->force, m->packed_start,
                           m->packed_origin, m->all_start, m->kept, m->Y, m->dq, m->dp,    m->ones};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__release(m->member);
  dvi__release(m->going);
  dvi__evaluator_destroy(&m->evaluator);
  *m = (dvi__action_members){0};
}

static size_t row(const dvi__action_members *m, size_t number)
{
  return number * (size_t)m->width;
}

/* As dvi__action_sweep_from, with the path in Y. */
static void put_nodes(dvi__action_members *m, const double *p)
{
  const dvi__action *a = m->action;
  dvi__members_product(a->n, a->s, a->lanes, a->r, a->psi, m->width, m->Y, m->Z);
  for (size_t i = 0; i < (size_t)a->n; i++) {
    for (size_t k = row(m, i); k < row(m, i + 1); k++) m->all_start[k] = a->sweep_factor[i] * p[k];
    for (size_t j = 0; j < (size_t)a->r; j++) {
      const double *Z = m->Z + row(m, i * (size_t)a->r + j), *origin = m->origin + row(m, i);
      double *Q = m->Q + row(m, i * (size_t)a->r + j);
      for (int k = 0; k < m->width; k++) Q[k] = origin[k] + Z[k];
    }
  }
}

void dvi__action_members_place(dvi__action_members *m, int count, double h, double last_h, const double *t, const double *q,
                               const double *p, const double *last_Y)
{
  dvi__action *a = m->action;
  m->count = m->width = count;
  m->start = m->all_start;
  m->origin = q;
  for (int k = 0; k < count; k++) m->member[k] = k;
  for (size_t j = 0; j < (size_t)a->r; j++)
    for (size_t k = 0; k < (size_t)count; k++) m->t[row(m, j) + k] = t[k] + a->node[j] * h;
  a->h = h;
  dvi__action_set_step(a);
  dvi__members_product(a->n, a->s, a->path_lanes, a->s, dvi__action_shift(a, h / last_h), count, last_Y, m->Y);
  put_nodes(m, p);
}

void dvi__action_members_pack(const dvi__action_members *m, int rows, int before, const double *x, double *packed)
{
  for (size_t i = 0; i < (size_t)rows; i++) {
    const double *from = x + i * (size_t)before;
    double *to = packed + row(m, i);
    for (int k = 0; k < m->width; k++) to[k] = from[m->going[k]];
  }
}

void dvi__action_members_close_up(dvi__action_members *m, const char *marked)
{
  const int n = m->action->n, r = m->action->r, before = m->width;
  int lanes = 0;
  for (int k = 0; k < before; k++) {
    m->member[lanes] = m->member[k];
    m->going[lanes] = k;
    lanes += marked[k] != 0;
  }
  if (lanes == before) return;
  m->width = lanes;
  dvi__action_members_pack(m, r, before, m->t, m->t);
  dvi__action_members_pack(m, n * r, before, m->Z, m->Z);
  dvi__action_members_pack(m, n * r, before, m->Q, m->Q);
  dvi__action_members_pack(m, n, before, m->start, m->packed_start);
  dvi__action_members_pack(m, n, before, m->origin, m->packed_origin);
  m->start = m->packed_start;
  m->origin = m->packed_origin;
}

dvi_status dvi__action_members_sweep(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  DVI_TRY(dvi__potentials_gradient(m->evaluator, a->r * m->width, m->t, m->Q, m->force));
  dvi__members_sweep sweep = {.n = a->n,
                              .stages = a->r,
                              .width = m->width,
                              .lanes = a->lanes,
                              .matrix = a->sweep_matrix,
                              .node = a->sweep_node,
                              .weight = a->sweep_weight,
                              .factor = a->sweep_factor,
                              .start = m->start,
                              .origin = m->origin,
                              .force = m->force,
                              .Z = m->Z,
                              .Q = m->Q,
                              .change = m->change,
                              .largest = m->largest};
  dvi__members_sweep_once(&sweep);
  return DVI_OK;
}

void dvi__action_members_keep(dvi__action_members *m, int lane)
{
  const size_t rows = (size_t)m->action->n * (size_t)m->action->r, count = (size_t)m->count;
  double *kept = m->kept + m->member[lane];
  for (size_t i = 0; i < rows; i++) kept[i * count] = m->force[row(m, i) + (size_t)lane];
}

/* As dvi__action_sweep_to and dvi__action_ends. */
void dvi__action_members_ends(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  const size_t count = (size_t)m->count;
  dvi__members_product(a->n, a->r, a->path_lanes, a->s, a->sweep_path, m->count, m->kept, m->Y);
  dvi__members_product(a->n, a->r, 1, 1, a->sweep_rest, m->count, m->kept, m->dq);
  dvi__members_product(a->n, a->r, 1, 1, m->ones, m->count, m->kept, m->dp);
  for (size_t i = 0; i < (size_t)a->n; i++) {
    const double factor = a->sweep_factor[i], *start = m->all_start + i * count;
    for (size_t s = 0; s < (size_t)a->s; s++) {
      double *Y = m->Y + (i * (size_t)a->s + s) * count;
      for (size_t k = 0; k < count; k++) Y[k] = start[k] * a->straight[s] + factor * Y[k];
    }
    double *dq = m->dq + i * count;
    for (size_t k = 0; k < count; k++) dq[k] = start[k] + factor * dq[k];
  }
}
