/* A rigid motion whose centre of mass is at R rho from x:  p_x = m (dx + dR rho)/h gives dx, and what is left of
 * Pi = R0^T-part of (dR Jd + m dx rho^T)/h  is  Pi - rho x R0^T p_x, of the free body with the second moments Jd - m rho rho^T about its centre. */
#include "step/lie/leaps.h"

#include <math.h>

#include "step/lie/coupled_leaps.h"
#include "step/lie/pieces.h"
#include "core/memory.h"
#include "core/status.h"
#include "group/turn.h"
#include "group/vector.h"
#include "num/compensated.h"

struct dvi__leaps {
  dvi__pieces pieces;
  dvi__leap_by by;
  dvi__coupled_leaps *together; /* NULL: nothing is coupled */
};

dvi_status dvi__leaps_create(const dvi_system *system, dvi__leap_by by, dvi_counters *counters, dvi__leaps **leaps)
{
  dvi__leaps *l = *leaps = DVI_NEW(dvi__leaps, 1);
  if (l == NULL) return dvi__fail(DVI_NO_MEMORY, "leaps: no memory");
  l->by = by;
  dvi_status status = dvi__pieces_create(system, &l->pieces);
  if (status == DVI_OK && l->pieces.coupled > 0)
    status = dvi__coupled_leaps_create(system, l->pieces.together, counters, &l->together);
  if (status != DVI_OK) dvi__leaps_destroy(leaps);
  return status;
}

void dvi__leaps_destroy(dvi__leaps **leaps)
{
  dvi__leaps *l = *leaps;
  if (l == NULL) return;
  dvi__coupled_leaps_destroy(&l->together);
  dvi__pieces_clear(&l->pieces);
  dvi__release(l);
  *leaps = NULL;
}

void dvi__leaps_count(const dvi__leaps *l, int *alone, int *coupled)
{
  *alone = l->pieces.system->cell_count - l->pieces.coupled;
  *coupled = l->pieces.coupled;
}

/* ---- kicks ---- */

static void kick_body(double h, const double *V_q, const double *R, double *p, double *carry)
{
  double moment[3] = {0};
  dvi__chart_add_moment(DVI__ROTATION, R, V_q, moment);
  for (int i = 0; i < 3; i++)
    dvi__add_compensated(p + i, carry + i, -h * (R[i] * moment[0] + R[3 + i] * moment[1] + R[6 + i] * moment[2]));
}

static void kick_direction(double h, const double *V_q, const double *y, double *p, double *carry)
{
  const double radial = dvi__dot(y, V_q) / dvi__dot(y, y);
  for (int i = 0; i < 3; i++) dvi__add_compensated(p + i, carry + i, -h * (V_q[i] - radial * y[i]));
}

void dvi__leaps_kick(const dvi__leaps *l, double h, const double *V_q, const dvi__phase *state)
{
  for (int c = 0; c < l->pieces.system->cell_count; c++) {
    const dvi__cell *cell = &l->pieces.system->cells[c];
    const double *V = V_q + cell->q, *y = state->q + cell->q;
    double *p = state->p + cell->v;
    if (cell->kind == DVI__LINE) dvi__add_compensated(p, state->p_carry + cell->v, -h * *V);
    if (cell->kind == DVI__CIRCLE) dvi__add_compensated(p, state->p_carry + cell->v, -h * (y[0] * V[1] - y[1] * V[0]));
    if (cell->kind == DVI__SPHERE) kick_direction(h, V, y, p, state->p_carry + cell->v);
    if (cell->kind == DVI__ROTATION) kick_body(h, V, y, p, state->p_carry + cell->v);
  }
}

/* ---- leaps of one cell ---- */

static dvi_status too_large(const dvi__piece *own, double impulse, double most)
{
  const dvi__cell *cell = own->cell;
  const char *what = cell->kind == DVI__ROTATION ? "body" : cell->kind == DVI__SPHERE ? "direction" : "angle";
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "the %s at coordinates %d to %d turns too far: h |p| is %.6g, and a step can be solved up to %.6g, its %smoment of inertia%s",
      what, cell->q, cell->q + dvi__chart_stored(cell->kind) - 1, impulse, most, cell->kind == DVI__ROTATION ? "largest " : "",
      cell->kind == DVI__ROTATION ? ", about another axis only up to that of this axis" : "");
}

static void leap_line(const dvi__piece *own, double h, const dvi__phase *state, double *leap)
{
  const int q = own->cell->q, v = own->cell->v;
  leap[v] = h * (state->p[v] / own->mass);
  dvi__add_compensated(state->q + q, state->q_carry + q, leap[v]);
}

/* sin(a)/tan(a/2), up to a quarter turn. */
static double one_and_cosine(double sine)
{
  return 1 + sqrt((1 - sine) * (1 + sine));
}

static dvi_status leap_circle(const dvi__piece *own, double h, const dvi__phase *state, double *leap)
{
  const int q = own->cell->q, v = own->cell->v;
  const double sine = h * (state->p[v] / own->mass);
  if (!(fabs(sine) < 1)) return too_large(own, fabs(h * state->p[v]), own->mass);
  leap[v] = asin(sine);
  const dvi__turn turn = dvi__turn_of((const double[]){0, 0, -sine / one_and_cosine(sine)});
  dvi__turn_rows(&turn, 2, state->q + q, state->q_carry + q);
  return DVI_OK;
}

/* By a, sin(a) = |h mu/m|, about mu, which it keeps. */
static dvi_status leap_sphere(const dvi__piece *own, double h, const dvi__phase *state, double *leap)
{
  const int q = own->cell->q, v = own->cell->v;
  double *y = state->q + q, *y_carry = state->q_carry + q, *p = state->p + v, *p_carry = state->p_carry + v, w[3];
  dvi__twofold mu[3];
  dvi__turn_angular(y, y_carry, p, p_carry, mu);
  for (int i = 0; i < 3; i++) w[i] = h * (mu[i].head / own->mass);
  const double sine = sqrt(dvi__dot(w, w)), stretch = sine > 0 ? asin(sine) / sine : 1;
  if (!(sine < 1)) return too_large(own, sine * own->mass, own->mass);
  dvi__cross(w, y, leap + v);
  for (int i = 0; i < 3; i++) leap[v + i] *= stretch;
  for (int i = 0; i < 3; i++) w[i] /= -one_and_cosine(sine);
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_rows(&turn, 3, y, y_carry);
  dvi__turn_momentum(mu, DVI__TURN_ANY, y, y_carry, p, p_carry);
  return DVI_OK;
}

/* dx = h p_x/m - R0 (F - I) rho */
static void leap_place(const dvi__piece *own, double h, const dvi__phase *state, double *leap)
{
  const int x = own->cell->q + 9, v = own->cell->v;
  const double *R = state->q + own->cell->q;
  const dvi__turn back = dvi__turn_of((const double[]){-leap[v], -leap[v + 1], -leap[v + 2]});
  double moved[3];
  dvi__turn_change(&back, own->centre, moved);
  for (int i = 0; i < 3; i++) leap[v + 3 + i] = h * (state->p[v + 3 + i] / own->mass) - dvi__dot(R + 3 * i, moved);
  dvi__add_compensated_all(3, state->q + x, state->q_carry + x, leap + v + 3);
}

/* Pi += sign rho x R^T p_x, of a rigid motion: -1 makes it that about the centre of mass. */
static void shift(const dvi__piece *own, double sign, const dvi__phase *state)
{
  const int v = own->cell->v;
  double moment[3];
  dvi__piece_moment(own, state->q, state->p, moment);
  for (int i = 0; i < 3; i++) dvi__add_compensated(state->p + v + i, state->p_carry + v + i, sign * moment[i]);
}

static dvi_status leap_body(const dvi__piece *own, dvi__leap_by by, double h, const dvi__phase *state, double *leap)
{
  double *p = state->p + own->cell->v, *p_carry = state->p_carry + own->cell->v, *w = leap + own->cell->v;
  if (own->rigid) shift(own, -1, state);
  const double impulse[] = {h * p[0], h * p[1], h * p[2]};
  if (!dvi__body_leap(own->body, by, impulse, w)) return too_large(own, sqrt(dvi__dot(impulse, impulse)), own->body->largest);
  if (own->rigid) leap_place(own, h, state, leap);
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_rows(&turn, 9, state->q + own->cell->q, state->q_carry + own->cell->q);
  dvi__turn_rows(&turn, 3, p, p_carry);
  if (own->rigid) shift(own, 1, state);
  return DVI_OK;
}

static dvi_status leap_alone(const dvi__piece *own, dvi__leap_by by, double h, const dvi__phase *state, double *leap)
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
  for (int i = 0; i < l->pieces.alone; i++) DVI_TRY(leap_alone(&l->pieces.piece[i], l->by, h, state, leap));
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
  for (int c = 0; c < l->pieces.system->cell_count; c++) {
    const dvi__cell *cell = &l->pieces.system->cells[c];
    double xi[DVI__CHART_SIZE], rate[DVI__CHART_SIZE];
    dvi__chart chart;
    dvi__functions functions;
    dvi__chart_centre(cell->kind, q0 + cell->q, &chart);
    coordinates_of(&chart, leap + cell->v, xi);
    for (int i = 0; i < dvi__chart_size(cell->kind); i++) {
      rate[i] = xi[i] / h;
      xi[i] *= tau;
    }
    if (q != NULL) dvi__chart_place(&chart, xi, q + cell->q);
    if (v == NULL) continue;
    dvi__chart_functions(cell->kind, xi, &functions);
    dvi__chart_leave_velocity(&chart, &functions, xi, rate, v + cell->v);
  }
}
