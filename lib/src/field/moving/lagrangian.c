/* The Lagrangian as a sum over stencils. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/moving/moving.h"

/* Part of a step by which a time may be off the multiple that is meant. */
static const double same_time = 1e-6;

/* ---- from coordinates to stencils ---- */

int dvi__moving_follow(const dvi_moving *m, double t, double X, double *x, double *rate)
{
  if (m->path_step == 0) return m->path(1, t, &X, x, rate, m->user);
  double next = 0, unused;
  const double count = floor(t / m->path_step + same_time), from = count * m->path_step;
  int returned = m->path(1, from, &X, x, &unused, m->user);
  if (returned == 0) returned = m->path(1, (count + 1) * m->path_step, &X, &next, &unused, m->user);
  if (returned != 0) return returned;
  *rate = (next - *x) / m->path_step;
  *x += (t - from) * *rate;
  return 0;
}

/* Give the position of node k of reference and its rate. */
static int place(const dvi_moving *m, const dvi__moving_state *state, int k, double *x,
                 double *rate)
{
  const int at = m->unknown[k * m->numbers];
  *x = at >= 0 ? state->q[at] : m->node[k];
  *rate = at >= 0 && state->v != NULL ? state->v[at] : 0;
  if (m->path == NULL) return 0;
  const int returned = dvi__moving_follow(m, state->t, m->node[k], x, rate);
  if (state->v == NULL) *rate = 0;
  return returned;
}

static int gather_node(const dvi_moving *m, const dvi__moving_state *state, int node, double *y,
                       double *rate)
{
  const int turn = m->periodic ? (node + m->nodes) / m->nodes - 1 : 0, k = node - turn * m->nodes;
  const int *at = m->unknown + k * m->numbers;
  const int returned = place(m, state, k, y, rate);
  if (returned != 0) return returned;
  y[0] += turn * m->length;
  for (int c = 0; c < m->components; c++) {
    const int free = at[1 + c] >= 0;
    y[1 + c] = (free ? state->q[at[1 + c]] : m->end[k > 0][c]) + turn * m->jump[c];
    rate[1 + c] = free && state->v != NULL ? state->v[at[1 + c]] : 0;
  }
  return 0;
}

int dvi__moving_gather(const dvi_moving *m, const dvi__moving_state *state, int node, int count,
                       double *y)
{
  double *rate = y + count * m->numbers;
  for (int i = 0; i < count; i++) {
    const int returned = gather_node(m, state, node + i, y + i * m->numbers, rate + i * m->numbers);
    if (returned != 0) return returned;
  }
  for (int i = 0; i + 1 < count; i++) {
    const double left = y[i * m->numbers], right = y[(i + 1) * m->numbers];
    if (right > left && isfinite(right - left)) continue;
    return dvi__return_because(
        1,
        "the mesh is tangled, cell %d of %d reaches from x = %.6g to %.6g: take a smaller step or "
        "a larger kappa, or let the nodes move more slowly",
        (node + i + m->cells) % m->cells, m->cells, left, right);
  }
  return 0;
}

/* ---- from stencils to sums ---- */

void dvi__stencil_clear(const dvi_moving *m, int nodes, dvi__stencil *s)
{
  s->half = nodes * m->numbers;
  s->size = 2 * s->half;
  s->value = 0;
  memset(s->first, 0, (size_t)s->size * sizeof *s->first);
  memset(s->second, 0, (size_t)(s->size * s->size) * sizeof *s->second);
}

/* Return the coordinate of number i of a stencil, or -1. */
static int coordinate(const dvi_moving *m, const dvi__stencils *of, int k, int i)
{
  const int node = (of->first + k + i / m->numbers + m->nodes) % m->nodes;
  return m->unknown[node * m->numbers + i % m->numbers];
}

static void add(double *sum, int at, double value)
{
  if (sum != NULL) sum[at] += value;
}

void dvi__stencil_scatter(const dvi_moving *m, const dvi__stencils *of, int k,
                          const dvi__stencil *s, const dvi__moving_sums *sums)
{
  const int n = s->half, *entry = of->entry + (size_t)k * (size_t)n * (size_t)n;
  if (sums->L != NULL) *sums->L += s->value;
  for (int i = 0; i < n && (sums->L_q != NULL || sums->L_v != NULL); i++) {
    const int at = coordinate(m, of, k, i);
    if (at < 0) continue;
    add(sums->L_q, at, s->first[i]);
    add(sums->L_v, at, s->first[n + i]);
  }
  if (sums->L_qq == NULL && sums->L_qv == NULL && sums->L_vv == NULL) return;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const int at = entry[i * n + j];
      if (at < 0) continue;
      add(sums->L_qq, at, s->second[i * s->size + j]);
      add(sums->L_qv, at, s->second[i * s->size + n + j]);
      add(sums->L_vv, at, s->second[(n + i) * s->size + n + j]);
    }
}

static void zero(double *sum, int count)
{
  if (sum != NULL) memset(sum, 0, (size_t)count * sizeof *sum);
}

int dvi__moving_sum(const dvi_moving *m, const dvi__moving_state *state,
                    const dvi__moving_sums *sums)
{
  const int entries = dvi__pattern_entries(&m->pattern);
  zero(sums->L, 1);
  zero(sums->L_q, m->unknowns);
  zero(sums->L_v, m->unknowns);
  zero(sums->L_qq, entries);
  zero(sums->L_qv, entries);
  zero(sums->L_vv, entries);
  const int returned = dvi__moving_add_cells(m, state, sums);
  return returned != 0 || m->dispersion == 0 ? returned : dvi__moving_add_bends(m, state, sums);
}
