/* A rigid motion whose centre of mass is at R rho from x:  p_x = m (dx + dR rho)/h gives dx, and what is left of
 * Pi = R0^T-part of (dR Jd + m dx rho^T)/h  is  Pi - rho x R0^T p_x, of the free body with the second moments Jd - m rho rho^T about its centre. */
#include "action/leaps.h"

#include <math.h>
#include <string.h>

#include "action/coupled_leaps.h"
#include "core/memory.h"
#include "core/status.h"
#include "group/turn.h"
#include "group/vector.h"
#include "num/compensated.h"

/* A cell that leaps alone; a rigid motion is a rotation with the three lines that follow. */
typedef struct piece {
  const dvi__cell *cell;
  double mass; /* of a line, a circle, a sphere, a rigid motion */
  int rigid;
  double centre[3];
  const dvi__body *body; /* of a rotation */
} piece;

struct dvi__leaps {
  const dvi_system *system;
  dvi__leap_by by;
  piece *piece; /* [alone] */
  dvi__body *body;
  int alone, bodies, coupled;
  dvi__coupled_leaps *together; /* NULL: nothing is coupled */
};

/* ---- which cells are alone ---- */

static double entry(const dvi_system *s, int row, int column)
{
  const int e = dvi__pattern_find(&s->vv, row, column);
  return e >= 0 ? s->mass_values[e] : 0;
}

static int root_of(int *root, int c)
{
  while (root[c] != c) c = root[c] = root[root[c]];
  return c;
}

/* root [cells]: the first cell of those that the mass couples to c, by any way; NULL if there is no memory. */
static int *components(const dvi_system *s)
{
  int *root = DVI_NEW(int, s->cell_count), *cell = DVI_NEW(int, s->n);
  for (int c = 0; c < s->cell_count && root != NULL && cell != NULL; c++) {
    root[c] = c;
    for (int i = 0; i < dvi__chart_stored(s->cells[c].kind); i++) cell[s->cells[c].q + i] = c;
  }
  for (int j = 0; j < s->n && root != NULL && cell != NULL; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++) {
      const int a = root_of(root, cell[j]), b = root_of(root, cell[s->vv.row[e]]);
      if (s->mass_values[e] != 0) root[a > b ? a : b] = a > b ? b : a;
    }
  for (int c = 0; c < s->cell_count && root != NULL; c++) root[c] = root_of(root, c);
  if (cell == NULL) dvi__release(root);
  dvi__release(cell);
  return cell != NULL ? root : NULL;
}

/* Whether the block of the mass from a cell's first coordinate on is that of a point, m I, or of a body: I x Jd with x' beside it. */
static int is_point(const dvi_system *s, const dvi__cell *cell)
{
  const int stored = dvi__chart_stored(cell->kind);
  const double mass = entry(s, cell->q, cell->q);
  int same = mass > 0;
  for (int i = 0; i < stored; i++)
    for (int j = 0; j < stored; j++) same &= entry(s, cell->q + i, cell->q + j) == (i == j ? mass : 0);
  return same;
}

static int is_body(const dvi_system *s, const dvi__cell *cell, int rigid)
{
  const int q = cell->q, x = q + 9;
  const double mass = rigid ? entry(s, x, x) : 0;
  int same = !rigid || mass > 0;
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 9; j++) same &= entry(s, q + i, q + j) == (i / 3 == j / 3 ? entry(s, q + i % 3, q + j % 3) : 0);
  for (int i = 0; i < 3 && rigid; i++) {
    for (int j = 0; j < 3; j++) same &= entry(s, x + i, x + j) == (i == j ? mass : 0);
    for (int j = 0; j < 9; j++) same &= entry(s, x + i, q + j) == (i == j / 3 ? entry(s, x, q + j % 3) : 0);
  }
  return same;
}

static int make_body(const dvi_system *s, piece *made, dvi__body *body)
{
  const int q = made->cell->q, x = q + 9;
  double Jd[9];
  if (!is_body(s, made->cell, made->rigid)) return 0;
  made->mass = made->rigid ? entry(s, x, x) : 0;
  for (int i = 0; i < 3; i++) made->centre[i] = made->rigid ? entry(s, x, q + i) / made->mass : 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) Jd[3 * i + j] = entry(s, q + i, q + j) - made->mass * made->centre[i] * made->centre[j];
  made->body = body;
  return dvi__body_of(Jd, body);
}

/* The cells of a component that begins with c: 1, or 4 if it is a rigid motion; 0 if they have to leap together. */
static int make_piece(dvi__leaps *l, const int *root, const int *size, int c)
{
  const dvi_system *s = l->system;
  piece made = {.cell = &s->cells[c]};
  made.rigid = made.cell->kind == DVI__ROTATION && size[c] == 4 && c + 3 < s->cell_count;
  for (int i = 1; i < 4 && made.rigid; i++) made.rigid = root[c + i] == c && s->cells[c + i].kind == DVI__LINE;
  if (size[c] != 1 && !made.rigid) return 0;
  if (made.cell->kind != DVI__ROTATION) {
    if (!is_point(s, made.cell)) return 0;
    made.mass = entry(s, made.cell->q, made.cell->q);
  } else if (!make_body(s, &made, &l->body[l->bodies])) {
    return 0;
  }
  l->bodies += made.cell->kind == DVI__ROTATION;
  l->piece[l->alone++] = made;
  return size[c];
}

/* together [cells]: not 0 for those that leap together. */
static void find_pieces(dvi__leaps *l, const int *root, int *size, int *together)
{
  const int cells = l->system->cell_count;
  for (int c = 0; c < cells; c++) size[root[c]]++;
  for (int c = 0; c < cells; c++) {
    if (root[c] == c) together[c] = make_piece(l, root, size, c) == 0;
    together[c] = together[root[c]];
    l->coupled += together[c];
  }
}

dvi_status dvi__leaps_create(const dvi_system *system, dvi__leap_by by, dvi_counters *counters, dvi__leaps **leaps)
{
  const size_t cells = (size_t)system->cell_count;
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "leaps: no memory");
  dvi__leaps *l = *leaps = DVI_NEW(dvi__leaps, 1);
  int *root = components(system), *size = DVI_NEW(int, cells), *together = DVI_NEW(int, cells);
  if (l != NULL && root != NULL && size != NULL && together != NULL) {
    *l = (dvi__leaps){.system = system, .by = by, .piece = DVI_NEW(piece, cells), .body = DVI_NEW(dvi__body, cells)};
    if (l->piece != NULL && l->body != NULL) {
      find_pieces(l, root, size, together);
      status = l->coupled == 0 ? DVI_OK : dvi__coupled_leaps_create(system, together, counters, &l->together);
    }
  }
  dvi__release(root);
  dvi__release(size);
  dvi__release(together);
  if (status != DVI_OK) dvi__leaps_destroy(leaps);
  return status;
}

void dvi__leaps_destroy(dvi__leaps **leaps)
{
  dvi__leaps *l = *leaps;
  if (l == NULL) return;
  dvi__coupled_leaps_destroy(&l->together);
  dvi__release(l->piece);
  dvi__release(l->body);
  dvi__release(l);
  *leaps = NULL;
}

void dvi__leaps_count(const dvi__leaps *l, int *alone, int *coupled)
{
  *alone = l->system->cell_count - l->coupled;
  *coupled = l->coupled;
}

/* ---- kicks ---- */

static void kick_body(double h, const double *V_q, const double *R, double *p)
{
  double moment[3] = {0};
  dvi__chart_add_moment(DVI__ROTATION, R, V_q, moment);
  for (int i = 0; i < 3; i++) p[i] -= h * (R[i] * moment[0] + R[3 + i] * moment[1] + R[6 + i] * moment[2]);
}

static void kick_direction(double h, const double *V_q, const double *y, double *p)
{
  const double radial = dvi__dot(y, V_q) / dvi__dot(y, y);
  for (int i = 0; i < 3; i++) p[i] -= h * (V_q[i] - radial * y[i]);
}

void dvi__leaps_kick(const dvi__leaps *l, double h, const double *V_q, const dvi__phase *state)
{
  for (int c = 0; c < l->system->cell_count; c++) {
    const dvi__cell *cell = &l->system->cells[c];
    const double *V = V_q + cell->q, *y = state->q + cell->q;
    double *p = state->p + cell->v;
    if (cell->kind == DVI__LINE) dvi__add_compensated(p, state->p_carry + cell->v, -h * *V);
    if (cell->kind == DVI__CIRCLE) *p -= h * (y[0] * V[1] - y[1] * V[0]);
    if (cell->kind == DVI__SPHERE) kick_direction(h, V, y, p);
    if (cell->kind == DVI__ROTATION) kick_body(h, V, y, p);
  }
}

/* ---- leaps of one cell ---- */

static dvi_status too_large(const dvi__cell *cell, double impulse, double most)
{
  const char *what = cell->kind == DVI__ROTATION ? "body" : cell->kind == DVI__SPHERE ? "direction" : "angle";
  return dvi__fail(DVI_STEP_TOO_LARGE, "the %s at coordinates %d to %d turns too far: h |p| is %.6g; %s solvable up to %.6g%s",
                   what, cell->q, cell->q + dvi__chart_stored(cell->kind) - 1, impulse, "its equation is", most,
                   cell->kind == DVI__ROTATION ? ", its largest moment of inertia, at most" : ", its moment of inertia");
}

static void leap_line(const piece *own, double h, const dvi__phase *state, double *leap)
{
  const int q = own->cell->q, v = own->cell->v;
  leap[v] = h * (state->p[v] / own->mass);
  dvi__add_compensated(state->q + q, state->q_carry + q, leap[v]);
}

static dvi_status leap_circle(const piece *own, double h, const dvi__phase *state, double *leap)
{
  const int q = own->cell->q, v = own->cell->v;
  const double sine = h * (state->p[v] / own->mass), *y = state->q + q;
  double u[] = {-sine * y[1], sine * y[0]};
  if (!(fabs(sine) < 1)) return too_large(own->cell, fabs(h * state->p[v]), own->mass);
  leap[v] = asin(sine);
  dvi__swing(2, dvi__swing_cosine(2, u), u, state->q + q, state->q_carry + q, u);
  return DVI_OK;
}

static dvi_status leap_sphere(const piece *own, double h, const dvi__phase *state, double *leap)
{
  double *y = state->q + own->cell->q, *p = state->p + own->cell->v, mu[3], u[3];
  dvi__cross(y, p, mu);
  dvi__cross(mu, y, u);
  for (int i = 0; i < 3; i++) u[i] *= h / own->mass;
  const double sine = sqrt(dvi__dot(u, u)), stretch = sine > 0 ? asin(sine) / sine : 1;
  if (!(sine < 1)) return too_large(own->cell, sine * own->mass, own->mass);
  for (int i = 0; i < 3; i++) leap[own->cell->v + i] = stretch * u[i];
  dvi__swing(3, dvi__swing_cosine(3, u), u, y, state->q_carry + own->cell->q, u);
  dvi__swing_momentum(mu, u, y, p);
  return DVI_OK;
}

/* p +- rho x R^T p_x */
static void shift_momentum(const piece *own, double sign, const dvi__phase *state)
{
  const double *R = state->q + own->cell->q, *force = state->p + own->cell->v + 3;
  double *p = state->p + own->cell->v, turned[3], moment[3];
  for (int i = 0; i < 3; i++) turned[i] = R[i] * force[0] + R[3 + i] * force[1] + R[6 + i] * force[2];
  dvi__cross(own->centre, turned, moment);
  for (int i = 0; i < 3; i++) p[i] += sign * moment[i];
}

/* dx = h p_x/m - R0 (F - I) rho */
static void leap_place(const piece *own, double h, const dvi__phase *state, double *leap)
{
  const int x = own->cell->q + 9, v = own->cell->v;
  const double *R = state->q + own->cell->q;
  const dvi__turn back = dvi__turn_of((const double[]){-leap[v], -leap[v + 1], -leap[v + 2]});
  double moved[3];
  dvi__turn_change(&back, own->centre, moved);
  for (int i = 0; i < 3; i++) leap[v + 3 + i] = h * (state->p[v + 3 + i] / own->mass) - dvi__dot(R + 3 * i, moved);
  dvi__add_compensated_all(3, state->q + x, state->q_carry + x, leap + v + 3);
}

static dvi_status leap_body(const piece *own, dvi__leap_by by, double h, const dvi__phase *state, double *leap)
{
  double *p = state->p + own->cell->v, *w = leap + own->cell->v, change[3];
  if (own->rigid) shift_momentum(own, -1, state);
  const double impulse[] = {h * p[0], h * p[1], h * p[2]};
  if (!dvi__body_leap(own->body, by, impulse, w)) return too_large(own->cell, sqrt(dvi__dot(impulse, impulse)), own->body->largest);
  if (own->rigid) leap_place(own, h, state, leap);
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_frame(&turn, state->q + own->cell->q, state->q_carry + own->cell->q);
  dvi__turn_change(&turn, p, change);
  for (int i = 0; i < 3; i++) p[i] += change[i];
  if (own->rigid) shift_momentum(own, 1, state);
  return DVI_OK;
}

static dvi_status leap_alone(const piece *own, dvi__leap_by by, double h, const dvi__phase *state, double *leap)
{
  switch (own->cell->kind) {
  case DVI__CIRCLE: return leap_circle(own, h, state, leap);
  case DVI__SPHERE: return leap_sphere(own, h, state, leap);
  case DVI__ROTATION: return leap_body(own, by, h, state, leap);
  default: leap_line(own, h, state, leap); return DVI_OK;
  }
}

dvi_status dvi__leaps_drift(dvi__leaps *l, double h, const dvi__phase *state, double *leap)
{
  for (int i = 0; i < l->alone; i++) DVI_TRY(leap_alone(&l->piece[i], l->by, h, state, leap));
  return l->together == NULL ? DVI_OK : dvi__coupled_leaps_drift(l->together, h, state, leap);
}

/* ---- between the ends ---- */

/* The chart's coordinates of a leap. */
static void coordinates_of(const dvi__chart *chart, const double *leap, double *xi)
{
  dvi__chart_enter(chart, leap, xi);
  if (chart->kind != DVI__ROTATION) return;
  const double tangent = sqrt(dvi__dot(xi, xi)), stretch = tangent > 0 ? 2 * atan(tangent) / tangent : 2;
  for (int i = 0; i < 3; i++) xi[i] *= stretch;
}

void dvi__leaps_path(const dvi__leaps *l, const double *q0, const double *leap, double h, double tau, double *q, double *v)
{
  for (int c = 0; c < l->system->cell_count; c++) {
    const dvi__cell *cell = &l->system->cells[c];
    double xi[DVI__CHART_SIZE], rate[DVI__CHART_SIZE];
    dvi__chart chart;
    dvi__chart_centre(cell->kind, q0 + cell->q, &chart);
    coordinates_of(&chart, leap + cell->v, xi);
    for (int i = 0; i < dvi__chart_size(cell->kind); i++) {
      rate[i] = xi[i] / h;
      xi[i] *= tau;
    }
    if (q != NULL) dvi__chart_point(&chart, xi, NULL, q + cell->q, NULL);
    if (v != NULL) dvi__chart_leave_velocity(&chart, xi, rate, v + cell->v);
  }
}
