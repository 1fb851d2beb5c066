/* Consider a rigid motion with the centre of mass at R rho from x. Then p_x = m (dx + dR rho)/h
 * gives dx. The R0^T-part of (dR Jd + m dx rho^T)/h gives Pi. The rest Pi - rho x R0^T p_x belongs
 * to the free body with the second moments Jd - m rho rho^T about its centre. */
#include <math.h>
#include <string.h>

#include "step/lie/lie_drift_struct.h"
#include "step/lie/slot.h"
#include "core/memory.h"
#include "core/status.h"

dvi_status dvi__lie_drift_create(const dvi_system *system, dvi__moser_veselov_map by,
                                 dvi_counters *counters, dvi__lie_drift **drift)
{
  dvi__lie_drift *l = *drift = DVI_NEW(dvi__lie_drift, 1);
  if (l == NULL) return dvi__fail(DVI_NO_MEMORY, "drift: no memory");
  l->by = by;
  dvi_status status = dvi__mass_blocks_create(system, &l->blocks);
  if (status == DVI_OK && l->blocks.coupled > 0)
    status = dvi__coupled_drift_create(system, l->blocks.together, counters, &l->together);
  if (status == DVI_OK) status = dvi__lie_drift_find_runs(l);
  if (status != DVI_OK) dvi__lie_drift_destroy(drift);
  return status;
}

void dvi__lie_drift_destroy(dvi__lie_drift **drift)
{
  dvi__lie_drift *l = *drift;
  if (l == NULL) return;
  dvi__coupled_drift_destroy(&l->together);
  dvi__mass_blocks_clear(&l->blocks);
  dvi__release(l->run);
  dvi__release(l->rows);
  dvi__release(l);
  *drift = NULL;
}

void dvi__lie_drift_count(const dvi__lie_drift *l, int *alone, int *coupled)
{
  *alone = l->blocks.system->slot_count - l->blocks.coupled;
  *coupled = l->blocks.coupled;
}

/* ---- kicks ---- */

void dvi__lie_drift_kick(const dvi__lie_drift *l, double h, const double *V_q,
                         const dvi__phase *state)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    const double *V = V_q + slot->q, *y = state->q + slot->q;
    double *p = state->p + slot->v;
    if (slot->kind == DVI__LINE) dvi__add_compensated(p, state->p_compensation + slot->v, -h * *V);
    if (slot->kind == DVI__CIRCLE)
      dvi__slot_kick_circle(h, V, y, p, state->p_compensation + slot->v);
    if (slot->kind == DVI__SPHERE)
      dvi__slot_kick_direction(h, V, y, p, state->p_compensation + slot->v);
    if (slot->kind == DVI__ROTATION)
      dvi__slot_kick_body(h, V, y, p, state->p_compensation + slot->v);
  }
}

void dvi__lie_drift_push(const dvi__lie_drift *l, double h, const double *F,
                         const dvi__phase *state)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    double *p = state->p + slot->v, *compensation = state->p_compensation + slot->v;
    if (slot->kind == DVI__SPHERE)
      dvi__slot_kick_direction(-h, F + slot->v, state->q + slot->q, p, compensation);
    else
      for (int i = 0; i < dvi__chart_velocities(slot->kind); i++)
        dvi__add_compensated(p + i, compensation + i, h * F[slot->v + i]);
  }
}

/* ---- drifts of one slot ---- */

static dvi_status lie_drift_too_large(const dvi__mass_block *own, double impulse, double most)
{
  const dvi__factor_slot *slot = own->slot;
  const char *what = slot->kind == DVI__ROTATION ? "body"
                     : slot->kind == DVI__SPHERE ? "direction"
                                                 : "angle";
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "the %s at coordinates %d to %d turns too far: h |p| is %.6g, and a step can be "
      "solved up to the moment of inertia %s%.6g",
      what, slot->q, slot->q + dvi__chart_stored(slot->kind) - 1, impulse,
      slot->kind == DVI__ROTATION ? "about the axis that it turns about, at most " : "", most);
}

static void drift_line(const dvi__mass_block *own, double h, const dvi__phase *state,
                       double *displacement)
{
  const int q = own->slot->q, v = own->slot->v;
  displacement[v] = h * (state->p[v] / own->mass);
  dvi__add_compensated(state->q + q, state->q_compensation + q, displacement[v]);
}

FUSED static void turn_circle(double sine, double y[3], double y_low[3])
{
  dvi__slot_turn_circle(sine, y, y_low);
}

static dvi_status drift_circle(const dvi__mass_block *own, double h, const dvi__phase *state,
                               double *displacement)
{
  const int v = own->slot->v;
  double *q = state->q + own->slot->q, *low = state->q_compensation + own->slot->q;
  double y[] = {q[0], q[1], 0}, y_low[] = {low[0], low[1], 0};
  const double sine = h * (state->p[v] / own->mass);
  if (!(fabs(sine) < 1)) return lie_drift_too_large(own, fabs(h * state->p[v]), own->mass);
  displacement[v] = asin(sine);
  turn_circle(sine, y, y_low);
  memcpy(q, y, 2 * sizeof *q);
  memcpy(low, y_low, 2 * sizeof *low);
  return DVI_OK;
}

FUSED static double turn_direction(double h, double mass, double *y, double *y_low, double *p,
                                   double *p_low, double *moved)
{
  return dvi__slot_turn_direction(h, mass, y, y_low, p, p_low, moved);
}

static dvi_status drift_sphere(const dvi__mass_block *own, double h, const dvi__phase *state,
                               double *displacement)
{
  const int q = own->slot->q, v = own->slot->v;
  const double sine = turn_direction(h, own->mass, state->q + q, state->q_compensation + q,
                                     state->p + v, state->p_compensation + v, displacement + v),
               stretch = dvi__slot_stretch(sine);
  if (!(sine < 1)) return lie_drift_too_large(own, sine * own->mass, own->mass);
  for (int i = 0; i < 3; i++) displacement[v + i] *= stretch;
  return DVI_OK;
}

FUSED static void find_place(const dvi__mass_block *own, double h, const double *R,
                             const double *p_x, const double *w, double *dx)
{
  dvi__slot_place(own->mass, own->centre, h, R, p_x, w, dx);
}

static dvi_status drift_body(const dvi__mass_block *own, dvi__moser_veselov_map by, double h,
                             const dvi__phase *state, double *displacement)
{
  const int q = own->slot->q, v = own->slot->v;
  double *R = state->q + q, *x = R + 9, *p = state->p + v, *low = state->p_compensation + v,
         *w = displacement + v;
  if (own->rigid) dvi__slot_shift(-1, own->centre, R, p, low);
  const double impulse[] = {h * p[0], h * p[1], h * p[2]};
  if (!dvi__body_moser_veselov(own->body, by, impulse, w))
    return lie_drift_too_large(own, sqrt(dvi__dot(impulse, impulse)), own->body->largest);
  if (own->rigid) {
    find_place(own, h, R, p + 3, w, w + 3);
    dvi__add_compensated_all(3, x, state->q_compensation + q + 9, w + 3);
  }
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_rows(&turn, 9, R, state->q_compensation + q);
  dvi__turn_rows(&turn, 3, p, low);
  if (own->rigid) dvi__slot_shift(1, own->centre, R, p, low);
  return DVI_OK;
}

static dvi_status drift_alone(const dvi__mass_block *own, dvi__moser_veselov_map by, double h,
                              const dvi__phase *state, double *displacement)
{
  switch (own->slot->kind) {
  case DVI__CIRCLE: return drift_circle(own, h, state, displacement);
  case DVI__SPHERE: return drift_sphere(own, h, state, displacement);
  case DVI__ROTATION: return drift_body(own, by, h, state, displacement);
  default: drift_line(own, h, state, displacement); return DVI_OK;
  }
}

dvi_status dvi__lie_drift_drift(dvi__lie_drift *l, double h, const dvi__phase *state,
                                double *displacement)
{
  for (int i = 0, next; i < l->blocks.alone; i = next) {
    next = i + l->run[i];
    if (l->run[i] > 1 && dvi__lie_drift_run(l, i, h, state, displacement)) continue;
    for (; i < next; i++) DVI_TRY(drift_alone(&l->blocks.block[i], l->by, h, state, displacement));
  }
  return l->together == NULL ? DVI_OK
                             : dvi__coupled_drift_drift(l->together, h, state, displacement);
}

/* ---- path ---- */

/* Compute the chart's coordinates of a displacement. */
static void coordinates_of(const dvi__chart *chart, const double *displacement, double *xi)
{
  dvi__chart_enter(chart, displacement, xi);
  if (chart->kind != DVI__ROTATION) return;
  const double tangent = sqrt(dvi__dot(xi, xi)),
               stretch = tangent > 0 ? 2 * atan(tangent) / tangent : 2;
  for (int i = 0; i < 3; i++) xi[i] *= stretch;
}

void dvi__lie_drift_path(const dvi__lie_drift *l, const double *q0, const double *displacement,
                         double h, double tau, double *q, double *v)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    double xi[DVI__CHART_SIZE], rate[DVI__CHART_SIZE];
    dvi__chart chart;
    dvi__functions functions;
    dvi__chart_centre(slot->kind, q0 + slot->q, &chart);
    coordinates_of(&chart, displacement + slot->v, xi);
    for (int i = 0; i < dvi__chart_size(slot->kind); i++) {
      rate[i] = xi[i] / h;
      xi[i] *= tau;
    }
    if (q != NULL) dvi__chart_place(&chart, xi, q + slot->q);
    if (v == NULL) continue;
    dvi__chart_functions(slot->kind, xi, &functions);
    dvi__chart_leave_velocity(&chart, &functions, xi, rate, v + slot->v);
  }
}
