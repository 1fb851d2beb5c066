/* Let L = y'.M y'/2 - V. The Lagrangian exerts the moment N = y' x M y' - y x V_y on a slot, in
 * space. The angular momentum of a direction has the rate N, and that of a body in the body's frame
 * R^T N + Pi x Omega. An angle has the same rates in the plane. y' x M y' vanishes for mass blocks
 * other than rigid motions. */
#include "step/lie/flow.h"

#include <dvi/group.h>
#include <string.h>

#include "step/lie/coupled_drift.h"
#include "step/lie/mass_blocks.h"
#include "core/memory.h"
#include "core/status.h"
#include "group/turn.h"
#include "group/vector.h"
#include "num/compensated.h"

struct dvi__flow {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi__mass_blocks blocks;
  dvi__coupled_drift *together; /* NULL without coupled slots */
  /* not 0 if y' x M y' counts, because slots are coupled or rotations have places */
  int mixed;
  double *force;           /* [nq] V_y */
  double *rate, *covector; /* [nq] y' and M y' */
  double *v;               /* [nv] */
};

/* ---- create ---- */

static dvi_status flow_initialise(dvi__flow *f, dvi_counters *counters)
{
  const size_t n = (size_t)f->system->n;
  DVI_TRY(dvi__mass_blocks_create(f->system, &f->blocks));
  f->mixed = f->blocks.coupled > 0;
  for (int i = 0; i < f->blocks.alone; i++) f->mixed |= f->blocks.block[i].rigid;
  f->force = DVI_NEW(double, 4 * n);
  if (f->force == NULL) return dvi__fail(DVI_NO_MEMORY, "flow: no memory");
  f->rate = f->force + n;
  f->covector = f->rate + n;
  f->v = f->covector + n;
  if (f->blocks.coupled > 0)
    DVI_TRY(dvi__coupled_drift_create(f->system, f->blocks.together, counters, &f->together));
  return dvi__evaluator_create(f->system, 1, DVI__GRADIENTS, counters, &f->evaluator);
}

dvi_status dvi__flow_create(const dvi_system *system, dvi_counters *counters, dvi__flow **flow)
{
  dvi__flow *f = *flow = DVI_NEW(dvi__flow, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "flow: no memory");
  f->system = system;
  const dvi_status status = flow_initialise(f, counters);
  if (status != DVI_OK) dvi__flow_destroy(flow);
  return status;
}

void dvi__flow_destroy(dvi__flow **flow)
{
  dvi__flow *f = *flow;
  if (f == NULL) return;
  dvi__evaluator_destroy(&f->evaluator);
  dvi__coupled_drift_destroy(&f->together);
  dvi__mass_blocks_clear(&f->blocks);
  dvi__release(f->force);
  dvi__release(f);
  *flow = NULL;
}

/* ---- momenta ---- */

/* Replace p of a direction by mu = y x p. The function below goes back. */
static void enter_direction(const double *y, const double *y_compensation, double *p,
                            double *p_compensation)
{
  dvi__twofold mu[3];
  dvi__turn_angular(y, y_compensation, p, p_compensation, mu);
  dvi__twofold_put(3, mu, p, p_compensation);
}

static void leave_direction(double *y, double *y_compensation, double *m, double *m_compensation)
{
  dvi__twofold mu[3];
  dvi__twofold_get(3, m, m_compensation, mu);
  dvi__turn_momentum(mu, DVI__TURN_ROUNDINGS, y, y_compensation, m, m_compensation);
}

void dvi__flow_enter(const dvi__flow *f, const dvi__phase *state)
{
  for (int c = 0; c < f->system->slot_count; c++) {
    const dvi__factor_slot *slot = &f->system->slots[c];
    const int q = slot->q, v = slot->v;
    if (slot->kind == DVI__SPHERE)
      enter_direction(state->q + q, state->q_compensation + q, state->p + v,
                      state->p_compensation + v);
  }
}

void dvi__flow_leave(const dvi__flow *f, const dvi__phase *state)
{
  for (int c = 0; c < f->system->slot_count; c++) {
    const dvi__factor_slot *slot = &f->system->slots[c];
    const int q = slot->q, v = slot->v;
    if (slot->kind == DVI__SPHERE)
      leave_direction(state->q + q, state->q_compensation + q, state->p + v,
                      state->p_compensation + v);
  }
}

/* ---- rates ---- */

/* Compute y' of a slot with the velocity omega. */
static void move_rate(dvi__chart_kind kind, const double *y, const double *omega, double *rate)
{
  switch (kind) {
  case DVI__LINE: *rate = *omega; return;
  case DVI__CIRCLE:
    rate[0] = -*omega * y[1];
    rate[1] = *omega * y[0];
    return;
  case DVI__SPHERE: dvi__cross(omega, y, rate); return;
  default:
    for (int i = 0; i < 3; i++) dvi__cross(y + 3 * i, omega, rate + 3 * i);
  }
}

static dvi_status flow_velocities(dvi__flow *f, const double *q, const double *p)
{
  for (int i = 0; i < f->blocks.alone; i++)
    dvi__mass_block_velocity(&f->blocks.block[i], q, p, f->v);
  return f->together == NULL ? DVI_OK : dvi__coupled_drift_velocity(f->together, q, p, f->v);
}

/* Set covector = M y'. */
static void flow_multiply(dvi__flow *f)
{
  const dvi__pattern *vv = &f->system->vv;
  memset(f->covector, 0, (size_t)f->system->n * sizeof *f->covector);
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++)
      f->covector[vv->row[e]] += f->system->mass_values[e] * f->rate[j];
}

/* Compute N of a slot. N of an angle is one number. */
static void flow_moment_of(const dvi__flow *f, const dvi__factor_slot *slot, const double *y,
                           double *moment)
{
  const double *V = f->force + slot->q, *rate = f->rate + slot->q,
               *covector = f->covector + slot->q;
  if (slot->kind == DVI__CIRCLE) {
    moment[0] = y[1] * V[0] - y[0] * V[1] +
                (f->mixed ? rate[0] * covector[1] - rate[1] * covector[0] : 0);
    return;
  }
  memset(moment, 0, 3 * sizeof *moment);
  dvi__chart_add_moment(slot->kind, y, V, moment);
  for (int i = 0; i < 3; i++) moment[i] = -moment[i];
  if (f->mixed) dvi__chart_add_moment(slot->kind, rate, covector, moment);
}

static void flow_momentum_rate(const dvi__flow *f, const dvi__factor_slot *slot, const double *q,
                               const double *p, const double *omega, double *m_rate)
{
  const double *y = q + slot->q;
  double moment[3], turned[3];
  if (slot->kind == DVI__LINE) {
    *m_rate = -f->force[slot->q];
    return;
  }
  flow_moment_of(f, slot, y, moment);
  if (slot->kind != DVI__ROTATION) {
    memcpy(m_rate, moment, (size_t)dvi__chart_velocities(slot->kind) * sizeof *m_rate);
    return;
  }
  dvi__cross(p, omega, turned);
  for (int i = 0; i < 3; i++)
    m_rate[i] = turned[i] + y[i] * moment[0] + y[3 + i] * moment[1] + y[6 + i] * moment[2];
}

dvi_status dvi__flow_rates(dvi__flow *f, double t, const double *q, const double *p, double *omega,
                           double *m_rate)
{
  const dvi_system *s = f->system;
  DVI_TRY(flow_velocities(f, q, p));
  DVI_TRY(dvi__potentials_gradient(f->evaluator, 1, &t, q, f->force));
  for (int c = 0; c < s->slot_count; c++) {
    const dvi__factor_slot *slot = &s->slots[c];
    const double *v = f->v + slot->v;
    if (slot->kind == DVI__SPHERE)
      dvi__cross(q + slot->q, v, omega + slot->v);
    else
      memcpy(omega + slot->v, v, (size_t)dvi__chart_velocities(slot->kind) * sizeof *v);
    if (f->mixed) move_rate(slot->kind, q + slot->q, omega + slot->v, f->rate + slot->q);
  }
  if (f->mixed) flow_multiply(f);
  for (int c = 0; c < s->slot_count; c++) {
    const int v = s->slots[c].v;
    flow_momentum_rate(f, &s->slots[c], q, p + v, omega + v, m_rate + v);
  }
  return DVI_OK;
}

void dvi__flow_plain(const dvi__flow *f, const double *q, const double *p, const double *omega,
                     const double *m_rate, double *q_rate, double *p_rate)
{
  memcpy(p_rate, m_rate, (size_t)f->system->nv * sizeof *p_rate);
  for (int c = 0; c < f->system->slot_count; c++) {
    const dvi__factor_slot *slot = &f->system->slots[c];
    const double *y = q + slot->q;
    double given[3], turned[3];
    move_rate(slot->kind, y, omega + slot->v, q_rate + slot->q);
    if (slot->kind != DVI__SPHERE) continue;
    dvi__cross(m_rate + slot->v, y, given);
    dvi__cross(omega + slot->v, p + slot->v, turned);
    for (int i = 0; i < 3; i++) p_rate[slot->v + i] = given[i] + turned[i];
  }
}

/* ---- points ---- */

/* Find the rotation of a slot's rows. Directions and angles rotate from the left. */
static dvi__turn flow_turn(dvi__chart_kind kind, const double *theta)
{
  double w[3] = {0};
  for (int i = 0; i < 3 && kind != DVI__CIRCLE; i++)
    w[i] = kind == DVI__SPHERE ? -theta[i] : theta[i];
  if (kind == DVI__CIRCLE) w[2] = -*theta;
  dvi__turn_tangent(w, w);
  return dvi__turn_of(w);
}

void dvi__flow_move(const dvi__flow *f, const double *theta, const dvi__phase *state)
{
  for (int c = 0; c < f->system->slot_count; c++) {
    const dvi__factor_slot *slot = &f->system->slots[c];
    double *y = state->q + slot->q, *compensation = state->q_compensation + slot->q;
    if (slot->kind == DVI__LINE) {
      dvi__add_compensated(y, compensation, theta[slot->v]);
      continue;
    }
    const dvi__turn turn = flow_turn(slot->kind, theta + slot->v);
    dvi__turn_rows(&turn, dvi__chart_stored(slot->kind), y, compensation);
  }
}

/* Compute y of a slot from y0. */
static void place_slot(dvi__chart_kind kind, const double *theta, const double *y0, double *y)
{
  const int stored = dvi__chart_stored(kind);
  if (kind == DVI__LINE) {
    *y = *y0 + *theta;
    return;
  }
  const dvi__turn turn = flow_turn(kind, theta);
  for (int i = 0; i < stored; i += 3) {
    double row[3] = {0}, change[3];
    for (int j = 0; j < 3 && i + j < stored; j++) row[j] = y0[i + j];
    dvi__turn_change(&turn, row, change);
    for (int j = 0; j < 3 && i + j < stored; j++) y[i + j] = row[j] + change[j];
  }
}

void dvi__flow_place(const dvi__flow *f, const double *theta, double h, const double *m_rate,
                     const dvi__phase *start, double *q, double *p)
{
  for (int i = 0; i < f->system->nv; i++) p[i] = start->p[i] + h * m_rate[i];
  for (int c = 0; c < f->system->slot_count; c++) {
    const dvi__factor_slot *slot = &f->system->slots[c];
    double *m = p + slot->v, momentum[3];
    place_slot(slot->kind, theta + slot->v, start->q + slot->q, q + slot->q);
    if (slot->kind != DVI__SPHERE) continue;
    dvi__cross(m, q + slot->q, momentum);
    memcpy(m, momentum, sizeof momentum);
  }
}

void dvi__flow_theta_rate(const dvi__flow *f, const double *theta, const double *omega,
                          double *theta_rate)
{
  memmove(theta_rate, omega, (size_t)f->system->nv * sizeof *omega);
  for (int c = 0; c < f->system->slot_count; c++) {
    const dvi__factor_slot *slot = &f->system->slots[c];
    /* rotate from the left (1) or from the right (-1) */
    const double sign = slot->kind == DVI__SPHERE ? 1 : -1, *at = theta + slot->v;
    if (slot->kind != DVI__SPHERE && slot->kind != DVI__ROTATION) continue;
    const double from[] = {sign * at[0], sign * at[1], sign * at[2]};
    dvi_so3_dexp_inverse(from, theta_rate + slot->v, theta_rate + slot->v);
  }
}
