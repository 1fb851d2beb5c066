/* The Lagrangian as a sum over stencils. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/moving/moving.h"

/* Part of a step by which a time may be off the multiple that is meant. */
static const double same_time = 1e-6;

/* ---- from coordinates to stencils ---- */

int dvi__moving_follow(const dvi_moving *m, double t, const double *X, double *x, double *rate)
{
  if (m->path_step == 0) return m->path(1, t, X, x, rate, m->user);
  double next[DVI_MOVING_AXES_MAX] = {0}, unused[DVI_MOVING_AXES_MAX];
  const double count = floor(t / m->path_step + same_time), from = count * m->path_step;
  int returned = m->path(1, from, X, x, unused, m->user);
  if (returned == 0) returned = m->path(1, (count + 1) * m->path_step, X, next, unused, m->user);
  for (int i = 0; i < m->dimension && returned == 0; i++) {
    rate[i] = (next[i] - x[i]) / m->path_step;
    x[i] += (t - from) * rate[i];
  }
  return returned;
}

/* Give the position of a node and its rate by a path. */
static int follow(const dvi_moving *m, const dvi__moving_state *state, int node, double *x,
                  double *rate)
{
  double X[DVI_MOVING_AXES_MAX];
  dvi__moving_reference(m, &(dvi__corner){.node = node}, X);
  const int returned = dvi__moving_follow(m, state->t, X, x, rate);
  for (int i = 0; i < m->dimension && state->v == NULL; i++) rate[i] = 0;
  return returned;
}

static int gather_corner(const dvi_moving *m, const dvi__moving_state *state,
                         const dvi__corner *corner, double *y, double *rate)
{
  const int first = corner->node * m->numbers;
  for (int k = 0; k < m->numbers; k++) {
    const int at = m->unknown[first + k];
    y[k] = at >= 0 ? state->q[at] : m->known[first + k];
    rate[k] = at >= 0 && state->v != NULL ? state->v[at] : 0;
  }
  const int returned = m->path != NULL ? follow(m, state, corner->node, y, rate) : 0;
  for (int i = 0; i < m->dimension; i++) {
    y[i] += corner->turn[i] * m->period[i];
    for (int c = 0; c < m->components; c++)
      y[m->dimension + c] += corner->turn[i] * m->jump[i * m->components + c];
  }
  return returned;
}

/* Return 1, and explain that the cell with the corner is turned over. */
static int refuse(const dvi_moving *m, const dvi__corner *corner, const double *y)
{
  static const char remedy[] =
      "take a smaller step or a larger kappa, or let the nodes move more slowly";
  if (m->dimension == 1)
    return dvi__return_because(
        1, "the mesh is tangled, cell %d of %d reaches from x = %.6g to %.6g: %s", corner->node,
        m->cells, y[0], y[m->numbers], remedy);
  return dvi__return_because(
      1, "the mesh is tangled, cell %d of %d at (%.6g, %.6g) has the area %.6g: %s",
      (int)((corner - m->cell.corner) / m->cell.nodes), m->cells, y[0], y[1],
      dvi__moving_volume(m, y), remedy);
}

int dvi__moving_gather(const dvi_moving *m, const dvi__moving_state *state,
                       const dvi__corner *corner, int count, double *y)
{
  double *rate = y + count * m->numbers;
  for (int i = 0; i < count; i++) {
    const int returned = gather_corner(m, state, corner + i, y + i * m->numbers,
                                       rate + i * m->numbers);
    if (returned != 0) return returned;
  }
  for (int i = 0; i + m->dimension < count; i++) {
    const double volume = dvi__moving_volume(m, y + i * m->numbers);
    if (!(volume > 0 && isfinite(volume))) return refuse(m, corner + i, y + i * m->numbers);
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
    const dvi__corner *corner = of->corner + (size_t)k * (size_t)of->nodes + i / m->numbers;
    const int at = m->unknown[corner->node * m->numbers + i % m->numbers];
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

/* Add mu sum |x'|^2/2. */
static void add_masses(const dvi_moving *m, const dvi__moving_state *state,
                       const dvi__moving_sums *sums)
{
  for (int k = 0; k < m->nodes * m->numbers; k++) {
    const int at = m->unknown[k];
    if (at < 0 || k % m->numbers >= m->dimension) continue;
    const double rate = state->v != NULL ? state->v[at] : 0;
    add(sums->L, 0, 0.5 * m->mu * rate * rate);
    add(sums->L_v, at, m->mu * rate);
    if (sums->L_vv != NULL) sums->L_vv[dvi__pattern_find(&m->pattern, at, at)] += m->mu;
  }
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
  if (m->mu > 0) add_masses(m, state, sums);
  const int returned = dvi__moving_add_cells(m, state, sums);
  return returned != 0 || m->dispersion == 0 ? returned : dvi__moving_add_bends(m, state, sums);
}
