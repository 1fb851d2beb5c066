/* Consider a rigid motion with the centre of mass at R rho from x. Then p_x = m (dx + dR rho)/h
 * gives dx. The R0^T-part of (dR Jd + m dx rho^T)/h gives Pi. The rest Pi - rho x R0^T p_x belongs
 * to the free body with the second moments Jd - m rho rho^T about its centre. */
#include "step/lie/lie_drift.h"

#include <math.h>

#include "step/lie/coupled_drift.h"
#include "step/lie/mass_blocks.h"
#include "core/memory.h"
#include "core/status.h"
#include "group/turn.h"
#include "group/vector.h"
#include "num/compensated.h"

struct dvi__lie_drift {
  dvi__mass_blocks blocks;
  dvi__moser_veselov_map by;
  dvi__coupled_drift *together; /* NULL without coupled slots */
};

dvi_status dvi__lie_drift_create(const dvi_system *system, dvi__moser_veselov_map by,
                                 dvi_counters *counters, dvi__lie_drift **drift)
{
  dvi__lie_drift *l = *drift = DVI_NEW(dvi__lie_drift, 1);
  if (l == NULL) return dvi__fail(DVI_NO_MEMORY, "drift: no memory");
  l->by = by;
  dvi_status status = dvi__mass_blocks_create(system, &l->blocks);
  if (status == DVI_OK && l->blocks.coupled > 0)
    status = dvi__coupled_drift_create(system, l->blocks.together, counters, &l->together);
  if (status != DVI_OK) dvi__lie_drift_destroy(drift);
  return status;
}

void dvi__lie_drift_destroy(dvi__lie_drift **drift)
{
  dvi__lie_drift *l = *drift;
  if (l == NULL) return;
  dvi__coupled_drift_destroy(&l->together);
  dvi__mass_blocks_clear(&l->blocks);
  dvi__release(l);
  *drift = NULL;
}

void dvi__lie_drift_count(const dvi__lie_drift *l, int *alone, int *coupled)
{
  *alone = l->blocks.system->slot_count - l->blocks.coupled;
  *coupled = l->blocks.coupled;
}

/* ---- kicks ---- */

static void kick_body(double h, const double *V_q, const double *R, double *p, double *compensation)
{
  double moment[3] = {0};
  dvi__chart_add_moment(DVI__ROTATION, R, V_q, moment);
  for (int i = 0; i < 3; i++)
    dvi__add_compensated(p + i, compensation + i,
                         -h * (R[i] * moment[0] + R[3 + i] * moment[1] + R[6 + i] * moment[2]));
}

static void kick_direction(double h, const double *V_q, const double *y, double *p,
                           double *compensation)
{
  const double radial = dvi__dot(y, V_q) / dvi__dot(y, y);
  for (int i = 0; i < 3; i++)
    dvi__add_compensated(p + i, compensation + i, -h * (V_q[i] - radial * y[i]));
}

void dvi__lie_drift_kick(const dvi__lie_drift *l, double h, const double *V_q,
                         const dvi__phase *state)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    const double *V = V_q + slot->q, *y = state->q + slot->q;
    double *p = state->p + slot->v;
    if (slot->kind == DVI__LINE) dvi__add_compensated(p, state->p_compensation + slot->v, -h * *V);
    if (slot->kind == DVI__CIRCLE)
      dvi__add_compensated(p, state->p_compensation + slot->v, -h * (y[0] * V[1] - y[1] * V[0]));
    if (slot->kind == DVI__SPHERE) kick_direction(h, V, y, p, state->p_compensation + slot->v);
    if (slot->kind == DVI__ROTATION) kick_body(h, V, y, p, state->p_compensation + slot->v);
  }
}

void dvi__lie_drift_push(const dvi__lie_drift *l, double h, const double *F,
                         const dvi__phase *state)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    double *p = state->p + slot->v, *compensation = state->p_compensation + slot->v;
    if (slot->kind == DVI__SPHERE)
      kick_direction(-h, F + slot->v, state->q + slot->q, p, compensation);
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
  return dvi__fail(DVI_STEP_TOO_LARGE,
                   "the %s at coordinates %d to %d turns too far: h |p| is %.6g, and a step can be "
                   "solved up to %.6g, its %smoment of inertia%s",
                   what, slot->q, slot->q + dvi__chart_stored(slot->kind) - 1, impulse, most,
                   slot->kind == DVI__ROTATION ? "largest " : "",
                   slot->kind == DVI__ROTATION ? ", about another axis only up to that of this axis"
                                               : "");
}

static void drift_line(const dvi__mass_block *own, double h, const dvi__phase *state,
                       double *displacement)
{
  const int q = own->slot->q, v = own->slot->v;
  displacement[v] = h * (state->p[v] / own->mass);
  dvi__add_compensated(state->q + q, state->q_compensation + q, displacement[v]);
}

/* Return sin(a)/tan(a/2), for angles up to a quarter turn. */
static double one_and_cosine(double sine)
{
  return 1 + sqrt((1 - sine) * (1 + sine));
}

static dvi_status drift_circle(const dvi__mass_block *own, double h, const dvi__phase *state,
                               double *displacement)
{
  const int q = own->slot->q, v = own->slot->v;
  const double sine = h * (state->p[v] / own->mass);
  if (!(fabs(sine) < 1)) return lie_drift_too_large(own, fabs(h * state->p[v]), own->mass);
  displacement[v] = asin(sine);
  const dvi__turn turn = dvi__turn_of((const double[]){0, 0, -sine / one_and_cosine(sine)});
  dvi__turn_rows(&turn, 2, state->q + q, state->q_compensation + q);
  return DVI_OK;
}

/* Rotate by a about mu, with sin(a) = |h mu/m|. The rotation keeps mu. */
static dvi_status drift_sphere(const dvi__mass_block *own, double h, const dvi__phase *state,
                               double *displacement)
{
  const int q = own->slot->q, v = own->slot->v;
  double *y = state->q + q, *y_compensation = state->q_compensation + q, *p = state->p + v,
         *p_compensation = state->p_compensation + v, w[3];
  dvi__twofold mu[3];
  dvi__turn_angular(y, y_compensation, p, p_compensation, mu);
  for (int i = 0; i < 3; i++) w[i] = h * (mu[i].head / own->mass);
  const double sine = sqrt(dvi__dot(w, w)), stretch = sine > 0 ? asin(sine) / sine : 1;
  if (!(sine < 1)) return lie_drift_too_large(own, sine * own->mass, own->mass);
  dvi__cross(w, y, displacement + v);
  for (int i = 0; i < 3; i++) displacement[v + i] *= stretch;
  for (int i = 0; i < 3; i++) w[i] /= -one_and_cosine(sine);
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_rows(&turn, 3, y, y_compensation);
  dvi__turn_momentum(mu, DVI__TURN_ANY, y, y_compensation, p, p_compensation);
  return DVI_OK;
}

/* Set dx = h p_x/m - R0 (F - I) rho. */
static void drift_place(const dvi__mass_block *own, double h, const dvi__phase *state,
                        double *displacement)
{
  const int x = own->slot->q + 9, v = own->slot->v;
  const double *R = state->q + own->slot->q;
  const dvi__turn back = dvi__turn_of(
      (const double[]){-displacement[v], -displacement[v + 1], -displacement[v + 2]});
  double moved[3];
  dvi__turn_change(&back, own->centre, moved);
  for (int i = 0; i < 3; i++)
    displacement[v + 3 + i] = h * (state->p[v + 3 + i] / own->mass) - dvi__dot(R + 3 * i, moved);
  dvi__add_compensated_all(3, state->q + x, state->q_compensation + x, displacement + v + 3);
}

/* Add sign rho x R^T p_x to Pi of a rigid motion. A sign of -1 gives the momentum about the centre
 * of mass. */
static void lie_drift_shift_momentum(const dvi__mass_block *own, double sign,
                                     const dvi__phase *state)
{
  const int v = own->slot->v;
  double moment[3];
  dvi__mass_block_moment(own, state->q, state->p, moment);
  for (int i = 0; i < 3; i++)
    dvi__add_compensated(state->p + v + i, state->p_compensation + v + i, sign * moment[i]);
}

static dvi_status drift_body(const dvi__mass_block *own, dvi__moser_veselov_map by, double h,
                             const dvi__phase *state, double *displacement)
{
  double *p = state->p + own->slot->v, *p_compensation = state->p_compensation + own->slot->v,
         *w = displacement + own->slot->v;
  if (own->rigid) lie_drift_shift_momentum(own, -1, state);
  const double impulse[] = {h * p[0], h * p[1], h * p[2]};
  if (!dvi__body_moser_veselov(own->body, by, impulse, w))
    return lie_drift_too_large(own, sqrt(dvi__dot(impulse, impulse)), own->body->largest);
  if (own->rigid) drift_place(own, h, state, displacement);
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_rows(&turn, 9, state->q + own->slot->q, state->q_compensation + own->slot->q);
  dvi__turn_rows(&turn, 3, p, p_compensation);
  if (own->rigid) lie_drift_shift_momentum(own, 1, state);
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
  for (int i = 0; i < l->blocks.alone; i++)
    DVI_TRY(drift_alone(&l->blocks.block[i], l->by, h, state, displacement));
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
