/* Both forms at one time, between steps.
 *
 * After n steps the state has B^n and E^{n+1/2}. At the time t of the next step, t = t_n + part dt,
 *     B(t) = B^n - part dt d E^{n+1/2},
 *     E(t) = E^{n+1/2} + (part - 1/2) dt M_1^-1 (d^T M_2 B(t) - J(t) - S E^{n+1/2}),
 * with S of conductors and absorbing ends. This is continuous in t. At t_0 it is the start, and
 * without losses it is at t_n the mean of E^{n-1/2} and E^{n+1/2}. Errors have the order 2. */
#include "core/status.h"
#include "field/yee/ranks.h"

typedef dvi__yee_value value;

static value plus(value a, double factor, value b)
{
  return (value){a.re + factor * b.re, a.im + factor * b.im};
}

/* ---- places ---- */

/* Move a place into the grid along axes that repeat themselves. Give the phase that the value there
 * is multiplied by, which what came of other processes has already. Return 0 if the place is
 * outside. */
static int move_inside(const dvi__yee *y, int component, int *place, value *phase)
{
  *phase = (value){1, 0};
  for (int l = 0; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    const int places = dvi__yee_places(y, component, l);
    if (place[l] >= 0 && place[l] < places) continue;
    if (!a->wraps) return 0;
    const double sine = place[l] < 0 ? -a->sine : a->sine;
    place[l] += place[l] < 0 ? a->cells : -a->cells;
    if (!dvi__yee_owns_along(y, l, place[l])) continue;
    *phase = (value){phase->re * a->cosine - phase->im * sine,
                     phase->im * a->cosine + phase->re * sine};
  }
  return 1;
}

static value times(value a, value b)
{
  return (value){a.re * b.re - a.im * b.im, a.im * b.re + a.re * b.im};
}

static value stored_inside(const dvi__yee *y, int component, const int *place)
{
  const size_t at = dvi__yee_at(y, component, place[1], place[2]) + (size_t)place[0];
  return (value){y->state[0][at], y->copies > 1 ? y->state[1][at] : 0};
}

value dvi__yee_stored(const dvi__yee *y, int component, const int *place)
{
  int inside[3] = {place[0], place[1], place[2]};
  value phase;
  if (y->slot[component] < 0 || !move_inside(y, component, inside, &phase)) return (value){0, 0};
  return times(phase, stored_inside(y, component, inside));
}

/* ---- absorbing layers ---- */

/* Add what the layers of an axis add to a difference D: r D and psi, whose step is done in part. */
static value stretched(const dvi__yee *y, int component, int which, int axis, const int *place,
                       value D, double part)
{
  const int i = place[axis], form = component >= DVI__YEE_B;
  for (int e = 0; e < 2; e++) {
    const dvi__yee_layers *l = &y->axis[axis].layers[e];
    if (i < l->first || i >= l->first + l->count) continue;
    const int layer = i - l->first, at = i - l->start;
    value psi = {0, 0};
    for (int copy = 0; copy < y->copies; copy++) {
      const size_t first = dvi__yee_psi_at(y, axis, e, copy, which, layer, place[1], place[2]);
      *(copy == 0 ? &psi.re : &psi.im) = l->psi[first + (size_t)(axis == 0 ? at : place[0])];
    }
    D = plus(D, l->r[form][at], D);
    const value old = plus(D, 1 + part * (l->b[form][at] - 1), psi);
    D = plus(old, part * l->a[form][at] / (1 + l->r[form][at]), D);
  }
  return D;
}

/* ---- B ---- */

static value forward(const dvi__yee *y, int c, int axis, const int *place)
{
  int next[3] = {place[0], place[1], place[2]};
  next[axis]++;
  return plus(dvi__yee_stored(y, c, next), -1, dvi__yee_stored(y, c, place));
}

/* Give what the next step adds to B. */
static value change_of_face(const dvi__yee_moment *m, int c, const int *place)
{
  const dvi__yee *y = m->yee;
  value sum = {0, 0};
  for (int side = 0; side < 2; side++) {
    const int axis = (c + 1 + side) % 3, other = (c + 2 - side) % 3;
    if (y->axis[axis].is_trivial || y->slot[other] < 0) continue;
    value D = forward(y, other, axis, place);
    D = (value){y->dt * D.re, y->dt * D.im};
    D = stretched(y, DVI__YEE_B + c, side == 0, axis, place, D, 1);
    sum = plus(sum, side == 0 ? -1 : 1, D);
  }
  sum.re += dvi__yee_acted(y, &y->on_faces, DVI__YEE_B + c, place, m->on_faces);
  return sum;
}

/* Give what another process found before the own planes of an axis. */
static value B_below(const dvi__yee_moment *m, int c, const int *place)
{
  const dvi__yee *y = m->yee;
  const int axis = dvi__yee_owns_along(y, 1, place[1]) ? 2 : 1;
  const double *below = m->below[axis];
  return (value){below[dvi__yee_at_plane(y, axis, c, 0, place)],
                 y->copies > 1 ? below[dvi__yee_at_plane(y, axis, c, 1, place)] : 0};
}

value dvi__yee_B_at(const dvi__yee_moment *m, int c, const int *place)
{
  const dvi__yee *y = m->yee;
  int inside[3] = {place[0], place[1], place[2]};
  value phase;
  if (y->slot[DVI__YEE_B + c] < 0 || !move_inside(y, DVI__YEE_B + c, inside, &phase))
    return (value){0, 0};
  value B = stored_inside(y, DVI__YEE_B + c, inside);
  if (m->part != 0 && !dvi__yee_owns(y, inside)) return times(phase, B_below(m, c, inside));
  if (m->part != 0) B = plus(B, m->part, change_of_face(m, c, inside));
  return times(phase, B);
}

/* Put B of the last own boxes of an axis to where planes are sent from. */
static void put_last_faces(const dvi__yee_moment *m, int axis, int c, double *sent)
{
  const dvi__yee *y = m->yee;
  const int across = 3 - axis, end = dvi__yee_end(y, DVI__YEE_B + c, across);
  int place[3] = {0, 0, 0};
  place[axis] = dvi__yee_last_boxes(y, axis);
  for (place[across] = dvi__yee_begin(y, across); place[across] < end; place[across]++)
    for (place[0] = 0; place[0] < dvi__yee_places(y, DVI__YEE_B + c, 0); place[0]++) {
      const value B = dvi__yee_B_at(m, c, place);
      sent[dvi__yee_at_plane(y, axis, c, 0, place)] = B.re;
      if (y->copies > 1) sent[dvi__yee_at_plane(y, axis, c, 1, place)] = B.im;
    }
}

/* Without a part of a step B is what is stored, and other processes have it. */
void dvi__yee_pass_moment(dvi__yee_moment *m)
{
  const dvi__yee *y = m->yee;
  for (int axis = 1; axis < 3 && m->part != 0; axis++) {
    if (!dvi__yee_is_divided(y, axis)) continue;
    for (int c = 0; c < 3; c++)
      if (y->slot[DVI__YEE_B + c] >= 0 && c != axis)
        put_last_faces(m, axis, c, dvi__yee_plane_sent(y));
    m->below[axis] = dvi__yee_pass_plane(y, axis, 1);
  }
}

/* ---- E ---- */

/* Give M_2 B beside that of vacuum. */
static value field_at(const dvi__yee_moment *m, int c, const int *place)
{
  const dvi__yee *y = m->yee;
  int inside[3] = {place[0], place[1], place[2]};
  value unused;
  const value B = dvi__yee_B_at(m, c, place);
  if (y->mi == NULL || !move_inside(y, DVI__YEE_B + c, inside, &unused)) return B;
  const double mi = dvi__yee_over_mu(y, c, inside);
  return (value){mi * B.re, mi * B.im};
}

/* Give what the curl of H adds to E in vacuum in a whole step. */
static value change_of_edge(const dvi__yee_moment *m, int c, const int *place)
{
  const dvi__yee *y = m->yee;
  value sum = {0, 0};
  for (int side = 0; side < 2; side++) {
    const int axis = (c + 1 + side) % 3, other = (c + 2 - side) % 3;
    const dvi__yee_axis *a = &y->axis[axis];
    if (a->is_trivial || y->slot[DVI__YEE_B + other] < 0) continue;
    int before[3] = {place[0], place[1], place[2]};
    before[axis]--;
    const value one = field_at(m, other, place);
    value D = {a->up[place[axis]] * one.re, a->up[place[axis]] * one.im};
    D = plus(D, -a->down[place[axis]], field_at(m, other, before));
    D = stretched(y, c, 2 + (side == 0), axis, place, D, m->part);
    sum = plus(sum, side == 0 ? 1 : -1, D);
  }
  return sum;
}

static value E_inside(const dvi__yee_moment *m, int c, const int *place)
{
  const dvi__yee *y = m->yee;
  const double part = m->part - 0.5;
  if (!dvi__yee_is_unknown(y, c, place)) return (value){0, 0};
  const double s = dvi__yee_loss(y, c, place), eps = 1 / dvi__yee_over_eps(y, c, place);
  const value stored = stored_inside(y, c, place);
  value E = plus(stored, part / eps, change_of_edge(m, c, place));
  E = plus(E, -2 * part * s, stored);
  E.re += (1 + s) * dvi__yee_acted(y, &y->on_edges, c, place, m->on_edges);
  return E;
}

value dvi__yee_E_at(const dvi__yee_moment *m, int c, const int *place)
{
  int inside[3] = {place[0], place[1], place[2]};
  value phase;
  if (!move_inside(m->yee, c, inside, &phase)) return (value){0, 0};
  return times(phase, E_inside(m, c, inside));
}

void dvi__yee_start_edge(const dvi__yee_moment *m, int c, const int *place, int has_B)
{
  const dvi__yee *y = m->yee;
  if (!dvi__yee_is_unknown(y, c, place)) return;
  const size_t here = dvi__yee_at(y, c, place[1], place[2]) + (size_t)place[0];
  const double s = dvi__yee_loss(y, c, place), eps = 1 / dvi__yee_over_eps(y, c, place);
  const value change = has_B ? change_of_edge(m, c, place) : (value){0, 0};
  y->state[0][here] = (y->state[0][here] + 0.5 / eps * change.re) / (1 + s) +
                      dvi__yee_acted(y, &y->on_edges, c, place, m->on_edges);
  if (y->copies > 1) y->state[1][here] = (y->state[1][here] + 0.5 / eps * change.im) / (1 + s);
  if (y->worn != NULL)
    y->worn[dvi__yee_beside(y, c, place)] = dvi__yee_conduction(y, c, place) * y->state[0][here];
}

/* ---- samples ---- */

dvi_status dvi__yee_sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                           double *values)
{
  const dvi__yee *y = self;
  const int64_t size = dvi__yee_form_size(y, form);
  dvi__yee_fill_ghosts(y, 1);
  DVI_TRY(dvi__yee_set_moment(y));
  for (int64_t i = 0; i < count; i++) {
    const int64_t number = cell != NULL ? cell[i] : i;
    int component, place[3];
    dvi__yee_place_of(y, form, number % size, &component, place);
    const value v = component < DVI__YEE_B
                        ? dvi__yee_E_at(y->moment, component, place)
                        : dvi__yee_B_at(y->moment, component - DVI__YEE_B, place);
    values[i] = number < size ? v.re : v.im;
  }
  return DVI_OK;
}
