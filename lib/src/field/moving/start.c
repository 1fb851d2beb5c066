/* States from positions, values and waves, and back. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

/* Slopes at both sides of a node that are nearer than this are one slope. */
static const double straight = 1e-7;

/* Fail with what a callback returned. */
static dvi_status refuse(dvi_status status, int returned)
{
  char reason[DVI__SENTENCE_SIZE];
  dvi__take_reason(reason);
  if (reason[0] != '\0') return dvi__fail(status, "moving: %s", reason);
  return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "moving: a callback returned %d", returned);
}

dvi_status dvi__moving_check(const dvi_moving *m, const dvi__moving_state *state)
{
  double y[4 * DVI__NODE_NUMBERS];
  for (int k = 0; k < m->cells; k++) {
    const int returned = dvi__moving_gather(m, state, k, 2, y);
    if (returned != 0) return refuse(DVI_BAD_ARGUMENT, returned);
  }
  return DVI_OK;
}

static dvi_status check_finite(const dvi_moving *m, const double *q, const double *v)
{
  for (int i = 0; i < m->nodes * m->numbers; i++) {
    const int at = m->unknown[i], node = i / m->numbers, number = i % m->numbers;
    if (at < 0 || (isfinite(q[at]) && isfinite(v[at]))) continue;
    return dvi__fail(DVI_NOT_FINITE, "moving: at node %d %s is %g and its rate %g", node,
                     number == 0 ? "the position" : "u", q[at], v[at]);
  }
  return DVI_OK;
}

/* ---- momenta ---- */

/* Without a mass of their own, nodes have that of the corners of u. */
static dvi_status check_mass(const dvi_moving *m, const dvi__moving_state *state)
{
  double y[6 * DVI__NODE_NUMBERS];
  if (m->mu > 0 || !dvi__moving_is_free(m)) return DVI_OK;
  for (int k = 0; k < m->nodes; k++) {
    double corner = 0, size = 0;
    if (m->unknown[k * m->numbers] < 0) continue;
    const int returned = dvi__moving_gather(m, state, k - 1, 3, y);
    if (returned != 0) return refuse(DVI_BAD_ARGUMENT, returned);
    const double *middle = y + m->numbers, *right = middle + m->numbers;
    for (int c = 1; c <= m->components; c++) {
      const double before = (middle[c] - y[c]) / (middle[0] - y[0]);
      const double after = (right[c] - middle[c]) / (right[0] - middle[0]);
      corner = fmax(corner, fabs(after - before));
      size = fmax(size, fmax(fabs(after), fabs(before)));
    }
    if (corner <= straight * size)
      return dvi__fail(DVI_SINGULAR,
                       "moving: u is straight at node %d, x = %.6g, so that the node has no mass: "
                       "give mu > 0, or prescribe the nodes",
                       k, middle[0]);
  }
  return DVI_OK;
}

static dvi_status find_momenta(const dvi_moving *m, const dvi__moving_state *state, double *p)
{
  double *L_q = DVI_NEW(double, m->unknowns);
  if (L_q == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for momenta");
  const int returned = dvi__moving_sum(m, state, &(dvi__moving_sums){.L_q = L_q, .L_v = p});
  dvi__release(L_q);
  if (returned != 0) return refuse(DVI_BAD_ARGUMENT, returned);
  for (int i = 0; i < m->unknowns; i++)
    if (!isfinite(p[i]))
      return dvi__fail(DVI_NOT_FINITE, "moving: momentum %d is %g: check the density", i, p[i]);
  return DVI_OK;
}

/* ---- project ---- */

static void take(const dvi_moving *m, const double *x, const double *u, double *q)
{
  for (int i = 0; i < m->nodes * m->numbers; i++) {
    const int at = m->unknown[i], node = i / m->numbers, number = i % m->numbers;
    if (at < 0) continue;
    if (number == 0)
      q[at] = x != NULL ? x[node] : 0;
    else
      q[at] = u != NULL ? u[(number - 1) * (m->cells + 1) + node] : 0;
  }
}

dvi_status dvi_moving_project(const dvi_moving *moving, double t, const double *x, const double *u,
                              const double *x_rate, const double *u_rate, double *q, double *v,
                              double *p)
{
  if (moving == NULL || u == NULL || (x == NULL && dvi__moving_is_free(moving)))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field, positions and values are needed");
  const size_t n = (size_t)moving->unknowns;
  double *made = DVI_NEW(double, 3 * n);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for a state");
  const dvi__moving_state state = {.t = t, .q = made, .v = made + n};
  take(moving, x, u, made);
  take(moving, x_rate, u_rate, made + n);
  dvi_status status = check_finite(moving, made, made + n);
  if (status == DVI_OK) status = dvi__moving_check(moving, &state);
  if (status == DVI_OK && (v != NULL || p != NULL)) status = check_mass(moving, &state);
  if (status == DVI_OK && p != NULL) status = find_momenta(moving, &state, made + 2 * n);
  double *wanted[3] = {q, v, p};
  for (size_t k = 0; k < 3 && status == DVI_OK; k++)
    if (wanted[k] != NULL) memcpy(wanted[k], made + k * n, n * sizeof *made);
  dvi__release(made);
  return status;
}

/* ---- start ---- */

static dvi_status evaluate(const dvi_moving *m, dvi_moving_wave *wave, void *user,
                           dvi__wave_values *w)
{
  const int nodes = m->cells + 1;
  memcpy(w->x, m->node, (size_t)nodes * sizeof *w->x);
  int returned = 0;
  for (int k = 0; k < nodes && m->path != NULL && returned == 0; k++)
    returned = dvi__moving_follow(m, 0, m->node[k], w->x + k, w->velocity + k);
  if (returned != 0) return refuse(DVI_CALLBACK_FAILED, returned);
  double *velocity = dvi__moving_is_free(m) ? w->velocity : w->u_t + nodes * m->components;
  returned = wave(nodes, w->x, w->u, w->u_x, w->u_t, velocity, user);
  if (returned != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "moving: the wave returned %d", returned);
  if (!m->periodic && dvi__moving_is_free(m)) w->velocity[0] = w->velocity[m->cells] = 0;
  if (m->motion == DVI_MOVING_EQUAL) DVI_TRY(dvi__moving_even_out(m, wave, user, w));
  for (int i = 0; i < nodes * m->components; i++) w->u_t[i] += w->u_x[i] * w->velocity[i % nodes];
  return DVI_OK;
}

dvi_status dvi_moving_start(const dvi_moving *moving, dvi_moving_wave *wave, void *user, double *q,
                            double *v, double *p)
{
  if (moving == NULL || wave == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and a wave are needed");
  const size_t nodes = (size_t)moving->cells + 1, values = nodes * (size_t)moving->components;
  double *work = DVI_NEW(double, 3 * (nodes + values));
  if (work == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for a wave");
  dvi__wave_values w = {.x = work, .velocity = work + nodes, .u = work + 2 * nodes};
  w.u_x = w.u + values;
  w.u_t = w.u_x + values;
  dvi_status status = evaluate(moving, wave, user, &w);
  if (status == DVI_OK)
    status = dvi_moving_project(moving, 0, w.x, w.u, w.velocity, w.u_t, q, v, p);
  dvi__release(work);
  return status;
}

/* ---- back ---- */

dvi_status dvi_moving_lift(const dvi_moving *moving, double t, const double *q, double *x,
                           double *u)
{
  if (moving == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and coordinates are needed");
  const dvi__moving_state state = {.t = t, .q = q};
  const int nodes = moving->cells + 1;
  for (int k = 0; k < nodes; k++) {
    double y[2 * DVI__NODE_NUMBERS];
    const int returned = dvi__moving_gather(moving, &state, k, 1, y);
    if (returned != 0) return refuse(DVI_CALLBACK_FAILED, returned);
    if (x != NULL) x[k] = y[0];
    for (int c = 0; c < moving->components && u != NULL; c++) u[c * nodes + k] = y[1 + c];
  }
  return DVI_OK;
}

/* Find the cell of a point among ascending nodes, or -1. */
static int find_cell(int cells, const double *node, double x)
{
  int first = 0, last = cells;
  if (!(x >= node[0] && x <= node[cells])) return -1;
  while (last - first > 1) {
    const int middle = first + (last - first) / 2;
    if (x < node[middle])
      last = middle;
    else
      first = middle;
  }
  return first;
}

static dvi_status evaluate_at(const dvi_moving *m, const double *node, int slope, int64_t count,
                              const double *x, double *u)
{
  const double *value = node + m->cells + 1;
  for (int64_t i = 0; i < count; i++) {
    const double turn = m->periodic ? floor((x[i] - node[0]) / m->length) : 0;
    const double shifted = x[i] - turn * m->length;
    const double inside = m->periodic && isfinite(shifted)
                              ? fmin(fmax(shifted, node[0]), node[m->cells])
                              : x[i];
    const int cell = find_cell(m->cells, node, inside);
    if (cell < 0)
      return dvi__fail(DVI_BAD_ARGUMENT, "moving: the point x = %.6g is outside of %.6g to %.6g",
                       x[i], node[0], node[m->cells]);
    const double h = node[cell + 1] - node[cell], a = (inside - node[cell]) / h;
    for (int c = 0; c < m->components; c++) {
      const double *ends = value + (int64_t)c * (m->cells + 1) + cell;
      u[c * count + i] = slope ? (ends[1] - ends[0]) / h
                               : (1 - a) * ends[0] + a * ends[1] + turn * m->jump[c];
    }
  }
  return DVI_OK;
}

dvi_status dvi_moving_evaluate(const dvi_moving *moving, double t, const double *q, int slope,
                               int64_t count, const double *x, double *u)
{
  if (moving == NULL || q == NULL || count < 0 || (count > 0 && (x == NULL || u == NULL)))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field, coordinates and points are needed");
  DVI_TRY(dvi__moving_check(moving, &(dvi__moving_state){.t = t, .q = q}));
  double *node = DVI_NEW(double, (moving->cells + 1) * moving->numbers);
  if (node == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  dvi_status status = dvi_moving_lift(moving, t, q, node, node + moving->cells + 1);
  if (status == DVI_OK) status = evaluate_at(moving, node, slope, count, x, u);
  dvi__release(node);
  return status;
}
