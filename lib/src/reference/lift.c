#include "reference/lift.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

static double lift_dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int lifted_size(dvi__chart_kind kind)
{
  return kind == DVI__ROTATION ? 4 : kind == DVI__SPHERE ? 3 : kind == DVI__CIRCLE ? 2 : 1;
}

/* ---- rotations ---- */

/* Compute R of a quaternion of any length. */
static void rotation_of(const double *k, double *R)
{
  const double a = k[0], b = k[1], c = k[2], d = k[3], scale = 2 / (a * a + b * b + c * c + d * d);
  const double square[3] = {scale * (c * c + d * d), scale * (b * b + d * d),
                            scale * (b * b + c * c)};
  R[0] = 1 - square[0], R[4] = 1 - square[1], R[8] = 1 - square[2];
  R[1] = scale * (b * c - a * d), R[3] = scale * (b * c + a * d);
  R[2] = scale * (b * d + a * c), R[6] = scale * (b * d - a * c);
  R[5] = scale * (c * d - a * b), R[7] = scale * (c * d + a * b);
}

/* Compute the quaternion of R from the largest of its four squares, the trace with signs (Shepperd
 * 1978). */
static void quaternion_of(const double *R, double *k)
{
  const double square[4] = {1 + R[0] + R[4] + R[8], 1 + R[0] - R[4] - R[8], 1 - R[0] + R[4] - R[8],
                            1 - R[0] - R[4] + R[8]};
  int most = 0;
  for (int i = 1; i < 4; i++)
    if (square[i] > square[most]) most = i;
  const double table[4][4] = {{square[0], R[7] - R[5], R[2] - R[6], R[3] - R[1]},
                              {R[7] - R[5], square[1], R[3] + R[1], R[2] + R[6]},
                              {R[2] - R[6], R[3] + R[1], square[2], R[7] + R[5]},
                              {R[3] - R[1], R[2] + R[6], R[7] + R[5], square[3]}};
  for (int i = 0; i < 4; i++) k[i] = table[most][i] / (2 * sqrt(square[most]));
}

static void quaternion_rate(const double *k, const double *Omega, double *rate)
{
  rate[0] = -0.5 * lift_dot(k + 1, Omega);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    rate[1 + i] = 0.5 * (k[0] * Omega[i] + k[1 + j] * Omega[l] - k[1 + l] * Omega[j]);
  }
}

/* Compute R Omega^, in which each row is (row of R) x Omega. */
static void rotation_rate(const double *R, const double *Omega, double *rate)
{
  for (int row = 0; row < 9; row += 3)
    for (int i = 0; i < 3; i++)
      rate[row + i] = R[row + (i + 1) % 3] * Omega[(i + 2) % 3] -
                      R[row + (i + 2) % 3] * Omega[(i + 1) % 3];
}

/* Add the covector A applied to the rotations R eta^, by the components of eta. It is the sum over
 * rows of A x R. */
static void add_turns(const double *R, const double *A, double *sum)
{
  for (int row = 0; row < 9; row += 3)
    for (int i = 0; i < 3; i++)
      sum[i] += A[row + (i + 1) % 3] * R[row + (i + 2) % 3] -
                A[row + (i + 2) % 3] * R[row + (i + 1) % 3];
}

/* ---- all kinds ---- */

static void unit_vector_of(int count, const double *kappa, double *y)
{
  const double length = count == 3 ? sqrt(lift_dot(kappa, kappa)) : hypot(kappa[0], kappa[1]);
  for (int i = 0; i < count; i++) y[i] = kappa[i] / length;
}

static void point_of(dvi__chart_kind kind, const double *kappa, double *y)
{
  if (kind == DVI__ROTATION)
    rotation_of(kappa, y);
  else if (kind == DVI__LINE)
    *y = *kappa;
  else
    unit_vector_of(lifted_size(kind), kappa, y);
}

static void lifted_rate(dvi__chart_kind kind, const double *kappa, const double *v, double *rate)
{
  const double length = kind == DVI__SPHERE ? sqrt(lift_dot(kappa, kappa)) : 1;
  if (kind == DVI__ROTATION) {
    quaternion_rate(kappa, v, rate);
  } else if (kind == DVI__CIRCLE) {
    rate[0] = -v[0] * kappa[1];
    rate[1] = v[0] * kappa[0];
  } else {
    for (int i = 0; i < lifted_size(kind); i++) rate[i] = length * v[i];
  }
}

/* Compute y' = T(y) v. */
static void stored_rate(dvi__chart_kind kind, const double *y, const double *v, double *rate)
{
  if (kind == DVI__ROTATION) {
    rotation_rate(y, v, rate);
  } else if (kind == DVI__CIRCLE) {
    rate[0] = -v[0] * y[1];
    rate[1] = v[0] * y[0];
  } else {
    memcpy(rate, v, (size_t)(kind == DVI__SPHERE ? 3 : 1) * sizeof *rate);
  }
}

/* Compute p = T^t C. For a direction q (q.v), which must vanish, is added. */
static void momentum_of(dvi__chart_kind kind, const double *y, const double *v, const double *C,
                        double *p)
{
  if (kind == DVI__LINE) {
    *p = *C;
  } else if (kind == DVI__CIRCLE) {
    *p = y[0] * C[1] - y[1] * C[0];
  } else if (kind == DVI__SPHERE) {
    const double along = lift_dot(y, v) - lift_dot(y, C);
    for (int i = 0; i < 3; i++) p[i] = C[i] + along * y[i];
  } else {
    memset(p, 0, 3 * sizeof *p);
    add_turns(y, C, p);
  }
}

/* Compute p' = T^t L_y + (dT/dt)^t C. */
static void lifted_momentum_rate(dvi__chart_kind kind, const double *y, const double *rate,
                                 const double *L_y, const double *C, double *p_rate)
{
  if (kind == DVI__LINE) {
    *p_rate = *L_y;
  } else if (kind == DVI__CIRCLE) {
    *p_rate = y[0] * L_y[1] - y[1] * L_y[0] + rate[0] * C[1] - rate[1] * C[0];
  } else if (kind == DVI__SPHERE) {
    const double along = lift_dot(y, L_y) + lift_dot(rate, C), turned = lift_dot(y, C);
    for (int i = 0; i < 3; i++) p_rate[i] = L_y[i] - along * y[i] - turned * rate[i];
  } else {
    memset(p_rate, 0, 3 * sizeof *p_rate);
    add_turns(y, L_y, p_rate);
    add_turns(rate, C, p_rate);
  }
}

/* ---- a system ---- */

dvi_status dvi__lift_create(dvi__reference_run *run, dvi__lift *lift)
{
  const size_t nq = (size_t)run->system->n;
  *lift = (dvi__lift){
      .system = run->system, .evaluator = run->evaluator, .y = DVI_NEW(double, 4 * nq)};
  if (lift->y == NULL) return dvi__reference_no_setup(run);
  lift->rate = lift->y + nq;
  lift->L_y = lift->y + 2 * nq;
  lift->C = lift->y + 3 * nq;
  for (int c = 0; c < run->system->slot_count; c++)
    lift->size += lifted_size(run->system->slots[c].kind);
  return DVI_OK;
}

void dvi__lift_clear(dvi__lift *lift)
{
  dvi__release(lift->y);
}

void dvi__lift_up(const dvi__lift *lift, const double *q, double *kappa)
{
  for (int c = 0; c < lift->system->slot_count; c++) {
    const dvi__factor_slot *slot = &lift->system->slots[c];
    const int size = lifted_size(slot->kind);
    if (slot->kind == DVI__ROTATION)
      quaternion_of(q + slot->q, kappa);
    else
      memcpy(kappa, q + slot->q, (size_t)size * sizeof *kappa);
    kappa += size;
  }
}

void dvi__lift_down(const dvi__lift *lift, const double *kappa, double *q)
{
  for (int c = 0; c < lift->system->slot_count; c++) {
    const dvi__factor_slot *slot = &lift->system->slots[c];
    point_of(slot->kind, kappa, q + slot->q);
    kappa += lifted_size(slot->kind);
  }
}

/* Add the forces, tangential to directions. */
static dvi_status add_lifted_forces(const dvi__lift *lift, double t, const double *v,
                                    double *p_rate)
{
  double *F = lift->L_y; /* not needed any more */
  DVI_TRY(dvi__forces(lift->evaluator, DVI__FORCES, 1, &t, lift->y, v, F));
  dvi__lift_tangent(lift, lift->y, F);
  for (int i = 0; i < lift->system->nv; i++) p_rate[i] += F[i];
  return DVI_OK;
}

dvi_status dvi__lift_equations(dvi__lift *lift, double t, const double *kappa, const double *v,
                               double *kappa_rate, double *p_rate, double *p_of_v)
{
  const dvi_system *system = lift->system;
  dvi__lift_down(lift, kappa, lift->y);
  for (int c = 0; c < system->slot_count; c++) {
    const dvi__factor_slot *slot = &system->slots[c];
    lifted_rate(slot->kind, kappa, v + slot->v, kappa_rate);
    stored_rate(slot->kind, lift->y + slot->q, v + slot->v, lift->rate + slot->q);
    kappa += lifted_size(slot->kind);
    kappa_rate += lifted_size(slot->kind);
  }
  DVI_TRY(
      dvi__lagrangian_gradient(lift->evaluator, 1, &t, lift->y, lift->rate, lift->L_y, lift->C));
  for (int c = 0; c < system->slot_count; c++) {
    const dvi__factor_slot *slot = &system->slots[c];
    const double *y = lift->y + slot->q, *C = lift->C + slot->q;
    momentum_of(slot->kind, y, v + slot->v, C, p_of_v + slot->v);
    lifted_momentum_rate(slot->kind, y, lift->rate + slot->q, lift->L_y + slot->q, C,
                         p_rate + slot->v);
  }
  for (int i = 0; i < system->nv; i++) p_rate[i] -= system->damping * p_of_v[i];
  return system->force_count > 0 ? add_lifted_forces(lift, t, v, p_rate) : DVI_OK;
}

void dvi__lift_pull(const dvi__lift *lift, const double *a, double *w)
{
  static const double rest[3] = {0};
  for (int c = 0; c < lift->system->slot_count; c++) {
    const dvi__factor_slot *slot = &lift->system->slots[c];
    momentum_of(slot->kind, lift->y + slot->q, rest, a + slot->q, w + slot->v);
  }
}

void dvi__lift_slow(const dvi__lift *lift, const double *kappa, const double *w, double *kappa_rate)
{
  for (int c = 0; c < lift->system->slot_count; c++) {
    const dvi__factor_slot *slot = &lift->system->slots[c];
    double rate[4];
    lifted_rate(slot->kind, kappa, w + slot->v, rate);
    for (int i = 0; i < lifted_size(slot->kind); i++) kappa_rate[i] -= rate[i];
    kappa += lifted_size(slot->kind);
    kappa_rate += lifted_size(slot->kind);
  }
}

void dvi__lift_tangent(const dvi__lift *lift, const double *q, double *p)
{
  for (int c = 0; c < lift->system->slot_count; c++) {
    const dvi__factor_slot *slot = &lift->system->slots[c];
    if (slot->kind != DVI__SPHERE) continue;
    const double along = lift_dot(q + slot->q, p + slot->v);
    for (int i = 0; i < 3; i++) p[slot->v + i] -= along * q[slot->q + i];
  }
}
