/* States from positions, values and waves. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

/* Slopes at both sides of a node that are nearer than this are one slope. */
static const double straight = 1e-7;

dvi_status dvi__moving_refuse(dvi_status status, int returned)
{
  char reason[DVI__SENTENCE_SIZE];
  dvi__take_reason(reason);
  if (reason[0] != '\0') return dvi__fail(status, "moving: %s", reason);
  return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "moving: a callback returned %d", returned);
}

int dvi__moving_admit(const dvi_moving *m, const dvi__moving_state *state)
{
  double y[2 * DVI__CELL_NODES * DVI__NODE_NUMBERS];
  int returned = 0;
  for (int k = 0; k < m->cells && returned == 0; k++)
    returned = dvi__moving_gather(m, state, m->cell.corner + (size_t)k * (size_t)m->cell.nodes,
                                  m->cell.nodes, y);
  return returned;
}

dvi_status dvi__moving_check(const dvi_moving *m, const dvi__moving_state *state)
{
  const int returned = dvi__moving_admit(m, state);
  return returned == 0 ? DVI_OK : dvi__moving_refuse(DVI_BAD_ARGUMENT, returned);
}

static dvi_status check_finite(const dvi_moving *m, const double *q, const double *v)
{
  for (int i = 0; i < m->nodes * m->numbers; i++) {
    const int at = m->unknown[i], node = i / m->numbers, number = i % m->numbers;
    if (at < 0 || (isfinite(q[at]) && isfinite(v[at]))) continue;
    return dvi__fail(DVI_NOT_FINITE, "moving: at node %d %s is %g and its rate %g", node,
                     number < m->dimension ? "the position" : "u", q[at], v[at]);
  }
  return DVI_OK;
}

/* ---- momenta ---- */

/* Without a mass of their own, nodes have that of the corners of u. */
static dvi_status check_mass(const dvi_moving *m, const dvi__moving_state *state)
{
  double y[6 * DVI__NODE_NUMBERS];
  if (m->mu > 0 || !dvi__moving_is_free(m)) return DVI_OK;
  if (m->dimension > 1)
    return dvi__fail(DVI_SINGULAR, "moving: free nodes of a mesh have no mass where u is straight "
                                   "along any line: give mu > 0, or prescribe the nodes");
  for (int k = 0; k < m->nodes; k++) {
    double corner = 0, size = 0;
    if (m->unknown[k * m->numbers] < 0) continue;
    const dvi__corner near[3] = {dvi__moving_corner(m, k - 1), dvi__moving_corner(m, k),
                                 dvi__moving_corner(m, k + 1)};
    const int returned = dvi__moving_gather(m, state, near, 3, y);
    if (returned != 0) return dvi__moving_refuse(DVI_BAD_ARGUMENT, returned);
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
  if (returned != 0) return dvi__moving_refuse(DVI_BAD_ARGUMENT, returned);
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
    const double *from = number < m->dimension ? x : u;
    const int k = number < m->dimension ? number : number - m->dimension;
    q[at] = from != NULL ? from[k * m->listed + node] : 0;
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

/* Put nodes where the path is at time 0, with its rate as velocity. */
static int follow(const dvi_moving *m, dvi__wave_values *w)
{
  int returned = 0;
  for (int k = 0; k < m->listed && returned == 0; k++) {
    double X[DVI_MOVING_AXES_MAX], x[DVI_MOVING_AXES_MAX] = {0}, rate[DVI_MOVING_AXES_MAX] = {0};
    for (int i = 0; i < m->dimension; i++) X[i] = w->x[i * m->listed + k];
    returned = dvi__moving_follow(m, 0, X, x, rate);
    for (int i = 0; i < m->dimension; i++) {
      w->x[i * m->listed + k] = x[i];
      w->velocity[i * m->listed + k] = rate[i];
    }
  }
  return returned;
}

/* Let nodes rest along the axes along which they cannot move. */
static void hold(const dvi_moving *m, dvi__wave_values *w)
{
  for (int k = 0; k < m->nodes * m->dimension; k++) {
    const int node = k / m->dimension, i = k % m->dimension;
    if (m->unknown[node * m->numbers + i] < 0) w->velocity[i * m->listed + node] = 0;
  }
}

/* Turn rates at places into those along the paths of nodes. */
static void ride(const dvi_moving *m, dvi__wave_values *w)
{
  for (int c = 0; c < m->components; c++)
    for (int k = 0; k < m->dimension * m->listed; k++)
      w->u_t[c * m->listed + k % m->listed] += w->u_x[c * m->dimension * m->listed + k] *
                                               w->velocity[k];
}

static dvi_status evaluate(const dvi_moving *m, dvi_moving_wave *wave, void *user,
                           dvi__wave_values *w, double *unread)
{
  memcpy(w->x, m->node, (size_t)(m->dimension * m->listed) * sizeof *w->x);
  int returned = m->path != NULL ? follow(m, w) : 0;
  if (returned != 0) return dvi__moving_refuse(DVI_CALLBACK_FAILED, returned);
  double *velocity = dvi__moving_is_free(m) ? w->velocity : unread;
  returned = wave(m->listed, w->x, w->u, w->u_x, w->u_t, velocity, user);
  if (returned != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "moving: the wave returned %d", returned);
  if (dvi__moving_is_free(m)) hold(m, w);
  if (m->motion == DVI_MOVING_EQUAL) DVI_TRY(dvi__moving_even_out(m, wave, user, w));
  ride(m, w);
  return DVI_OK;
}

dvi_status dvi_moving_start(const dvi_moving *moving, dvi_moving_wave *wave, void *user, double *q,
                            double *v, double *p)
{
  if (moving == NULL || wave == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and a wave are needed");
  const size_t places = (size_t)moving->listed * (size_t)moving->dimension,
               values = (size_t)moving->listed * (size_t)moving->components,
               slopes = values * (size_t)moving->dimension;
  double *work = DVI_NEW(double, 3 * places + 2 * values + slopes);
  if (work == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for a wave");
  dvi__wave_values w = {.x = work, .velocity = work + places, .u = work + 3 * places};
  w.u_t = w.u + values;
  w.u_x = w.u_t + values;
  dvi_status status = evaluate(moving, wave, user, &w, work + 2 * places);
  if (status == DVI_OK)
    status = dvi_moving_project(moving, 0, w.x, w.u, w.velocity, w.u_t, q, v, p);
  dvi__release(work);
  return status;
}
