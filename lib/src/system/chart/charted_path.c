/* Paths from the centre. Moving the centre turns a path in space. Let N = y x L_y + y' x w be the
 * moment that the Lagrangian exerts on a rotation or a direction, and mu its angular momentum. Then
 * mu1 = mu0 + h sum_j b_j N_j, and the chart's momentum at the end is p1 = W(xi1) mu1
 * (group/chart.h). So
 *
 *     C = W(xi1) mu1 - p0 - h sum_j b_j L_xi_j.
 *
 * Without C steps have the same order, but keep neither momenta nor the symplectic form. They would
 * have a discrete Lagrangian of their own in every step. */
#include "system/chart/charted_struct.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

void dvi__charted_find_turns(dvi__charted *x)
{
  for (int c = 0; c < x->base->slot_count; c++)
    if (dvi__turns(&x->base->slots[c]))
      dvi__chart_moments(&x->chart[c], x->end + x->base->slots[c].x, x->W + 9 * c);
}

int dvi__charted_on_path(const dvi__charted *x, int count)
{
  return x->from_centre && count <= x->capacity;
}

void dvi__charted_clear_changes(dvi__charted *x, int count)
{
  const size_t points = (size_t)count * sizeof(double);
  memset(x->C_qq, 0, (size_t)dvi__pattern_entries(&x->qq) * points);
  memset(x->C_qv, 0, (size_t)dvi__pattern_entries(&x->qv) * points);
}

/* Subtract H from C in the rows of slots that turn. */
static void subtract_rows(const dvi__charted *x, const dvi__pattern *pattern, size_t count,
                          const double *H, double *C)
{
  for (int e = 0; e < dvi__pattern_entries(pattern); e++)
    if (dvi__turns(&x->base->slots[x->slot_of_x[pattern->row[e]]]))
      for (size_t k = (size_t)e * count; k < ((size_t)e + 1) * count; k++) C[k] -= H[k];
}

void dvi__charted_finish_changes(const dvi__charted *x, int count, const double *L_qq,
                                 const double *L_qv)
{
  subtract_rows(x, &x->qq, (size_t)count, L_qq, x->C_qq);
  subtract_rows(x, &x->qv, (size_t)count, L_qv, x->C_qv);
}

static void place_path(void *of, const double *q0, const double *q1)
{
  dvi__charted *x = of;
  x->from_centre = 1;
  for (int i = 0; i < x->base->nx; i++) x->from_centre &= q0[i] == 0;
  memcpy(x->end, q1, (size_t)x->base->nx * sizeof *q1);
  memset(x->kick, 0, 3 * (size_t)x->base->slot_count * sizeof *x->kick);
}

/* Compute mu1 - mu0 = h sum_j b_j N_j of slot c. */
static void impulse_of(const dvi__charted *x, int c, int nodes, double h, const double *weight,
                       double *impulse)
{
  double in_space[3] = {0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < nodes; j++)
      in_space[i] += h * weight[j] * x->moment[(3 * c + i) * x->capacity + j];
  memset(impulse, 0, 3 * sizeof *impulse);
  dvi__chart_add_impulse(&x->chart[c], in_space, impulse);
}

/* Compute mu1 of slot c. */
static void angular_momentum(const dvi__charted *x, int c, const double *p0, const double *impulse,
                             double *mu)
{
  dvi__chart_angular_momentum(&x->chart[c], p0 + x->base->slots[c].x, mu);
  for (int i = 0; i < 3; i++) mu[i] += impulse[i];
}

/* Compute C of slot c, whose impulse is known. */
static void correct_slot(const dvi__charted *x, int c, const double *p0, const double *dp,
                         double *C)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  double mu[3], p1[DVI__CHART_SIZE];
  angular_momentum(x, c, p0, x->impulse + 3 * c, mu);
  dvi__chart_momentum(&x->chart[c], x->end + slot->x, mu, p1);
  for (int i = 0; i < dvi__chart_size(slot->kind); i++)
    C[slot->x + i] = p1[i] - p0[slot->x + i] - dp[slot->x + i];
}

static void correct_path(void *of, int nodes, double h, const double *weight, const double *p0,
                         const double *dp, double *C)
{
  dvi__charted *x = of;
  memset(C, 0, (size_t)x->base->nx * sizeof *C);
  for (int c = 0; c < x->base->slot_count && x->from_centre; c++)
    if (dvi__turns(&x->base->slots[c])) {
      impulse_of(x, c, nodes, h, weight, x->impulse + 3 * c);
      correct_slot(x, c, p0, dp, C);
    }
}

/* Compute C where nothing but the group's own motion changes momenta. */
static void correct_reduced(void *of, int nodes, double h, const double *weight, const double *p0,
                            const double *dp, double *C)
{
  dvi__charted *x = of;
  (void)nodes, (void)h, (void)weight;
  memset(C, 0, (size_t)x->base->nx * sizeof *C);
  for (int b = 0; b < x->reduced.count && x->from_centre; b++) {
    const int c = x->reduced.bodies[b].slot;
    dvi__reduced_impulse(x, &x->reduced.bodies[b], p0, x->impulse + 3 * c);
    correct_slot(x, c, p0, dp, C);
  }
}

/* In every frame of the sum, one component of a turn's momentum is rounded as the largest component
 * is. */
static void mix_turn_magnitudes(void *of, int s, double *magnitude)
{
  const dvi__charted *x = of;
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    double *rows = magnitude + slot->x * s;
    for (int k = 0; k < s && dvi__turns(slot); k++) {
      double largest = 0;
      for (int i = 0; i < dvi__chart_size(slot->kind); i++)
        largest = fmax(largest, rows[i * s + k]);
      for (int i = 0; i < dvi__chart_size(slot->kind); i++) rows[i * s + k] = largest;
    }
  }
}

static double largest_turn(void *of, int s, const double *points, const double *others)
{
  const dvi__charted *x = of;
  double largest = 0;
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    for (int k = slot->x * s; k < (slot->x + 1) * s && slot->kind != DVI__LINE; k++) {
      double turn[DVI__CHART_SIZE];
      for (int i = 0; i < dvi__chart_size(slot->kind); i++)
        turn[i] = points[k + i * s] - (others != NULL ? others[k + i * s] : 0);
      largest = fmax(largest, dvi__chart_angle(slot->kind, turn));
    }
  }
  return largest;
}

/* Add the derivative of C to the diagonal block of C_q1. */
static void derive_slot(const dvi__charted *x, int c, const double *p0, const double *impulse)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  const int size = dvi__chart_size(slot->kind);
  double mu[3], derivative[9];
  angular_momentum(x, c, p0, impulse, mu);
  dvi__chart_momentum_derivative(&x->chart[c], x->end + slot->x, mu, derivative);
  dvi__charted_add_block(&x->own_in_qq[c], size, size, derivative, 1, 0, x->C_q1);
}

static void name_changes(const dvi__charted *x, const double **C_q1, const double **C_qq,
                         const double **C_qv)
{
  memset(x->C_q1, 0, (size_t)dvi__pattern_entries(&x->qq) * sizeof(double));
  *C_q1 = x->C_q1;
  *C_qq = x->C_qq;
  *C_qv = x->C_qv;
}

static void derive_path(void *of, int nodes, double h, const double *weight, const double *p0,
                        const double **C_q1, const double **C_qq, const double **C_qv)
{
  dvi__charted *x = of;
  double impulse[3];
  name_changes(x, C_q1, C_qq, C_qv);
  for (int c = 0; c < x->base->slot_count && x->from_centre; c++)
    if (dvi__turns(&x->base->slots[c])) {
      impulse_of(x, c, nodes, h, weight, impulse);
      derive_slot(x, c, p0, impulse);
    }
}

static void derive_reduced(void *of, int nodes, double h, const double *weight, const double *p0,
                           const double **C_q1, const double **C_qq, const double **C_qv)
{
  dvi__charted *x = of;
  double impulse[3];
  (void)nodes, (void)h, (void)weight;
  name_changes(x, C_q1, C_qq, C_qv);
  for (int b = 0; b < x->reduced.count && x->from_centre; b++) {
    dvi__reduced_impulse(x, &x->reduced.bodies[b], p0, impulse);
    derive_slot(x, x->reduced.bodies[b].slot, p0, impulse);
    dvi__reduced_derive(x, &x->reduced.bodies[b], &x->coupled_in[b], p0, x->C_q1);
  }
}

/* ---- momenta that other forces add on the way ---- */

static void carry_on_path(void *of, const double *xi, const double *f, double *more)
{
  dvi__charted *x = of;
  memset(more, 0, (size_t)x->base->nx * sizeof *more);
  for (int c = 0; c < x->base->slot_count && x->from_centre; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    double mu[3], carried[DVI__CHART_SIZE];
    if (!dvi__turns(slot)) continue;
    dvi__chart_angular_momentum_at(&x->chart[c], xi + slot->x, f + slot->x, mu);
    dvi__chart_momentum(&x->chart[c], x->end + slot->x, mu, carried);
    for (int i = 0; i < 3; i++) x->kick[3 * c + i] += mu[i];
    for (int i = 0; i < dvi__chart_size(slot->kind); i++)
      more[slot->x + i] = carried[i] - f[slot->x + i];
  }
}

/* Copy a matrix [size*size] into the rows of a slot. */
static void put_rows(const dvi__factor_slot *slot, const double *matrix, double *rows)
{
  const int size = dvi__chart_size(slot->kind);
  for (int i = 0; i < size; i++)
    memcpy(rows + 3 * (slot->x + i), matrix + size * i, (size_t)size * sizeof *rows);
}

static void derive_carried(void *of, const double *xi, const double *f, double *by_f, double *by_xi,
                           double *by_end)
{
  const dvi__charted *x = of;
  const size_t bytes = 3 * (size_t)x->base->nx * sizeof(double);
  memset(by_f, 0, bytes);
  memset(by_xi, 0, bytes);
  memset(by_end, 0, bytes);
  for (int c = 0; c < x->base->slot_count && x->from_centre; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    double in_f[9], in_xi[9], in_end[9];
    if (!dvi__turns(slot)) continue;
    dvi__chart_carry_derivatives(&x->chart[c], xi + slot->x, x->end + slot->x, f + slot->x, in_f,
                                 in_xi, in_end);
    for (int i = 0; i < dvi__chart_size(slot->kind); i++)
      in_f[i * (dvi__chart_size(slot->kind) + 1)] -= 1;
    put_rows(slot, in_f, by_f);
    put_rows(slot, in_xi, by_xi);
    put_rows(slot, in_end, by_end);
  }
}

static void list_blocks(dvi__charted *x)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    for (int i = 0; i < dvi__chart_size(slot->kind); i++) {
      x->first[slot->x + i] = slot->x;
      x->width[slot->x + i] = dvi__turns(slot) ? dvi__chart_size(slot->kind) : 0;
    }
  }
}

static dvi_status charted_reserve(dvi__charted *x, int nodes)
{
  const size_t slots = (size_t)x->base->slot_count, n = (size_t)x->base->n,
               qq = (size_t)dvi__pattern_entries(&x->qq);
  x->capacity = nodes;
  x->W = DVI_NEW(double, 9 * slots);
  x->end = DVI_NEW(double, x->base->nx);
  x->impulse = DVI_NEW(double, 3 * slots);
  x->kick = DVI_NEW(double, 3 * slots);
  x->first = DVI_NEW(int, x->base->nx);
  x->width = DVI_NEW(int, x->base->nx);
  x->moment = DVI_NEW(double, 3 * slots * (size_t)nodes);
  x->turned_T = DVI_NEW(double, 3 * n * DVI__GROUP);
  x->turned_S = DVI_NEW(double, 3 * n * DVI__GROUP);
  x->C_q1 = DVI_NEW(double, qq);
  x->C_qq = DVI_NEW(double, qq *(size_t)nodes);
  x->C_qv = DVI_NEW(double, (size_t)dvi__pattern_entries(&x->qv) * (size_t)nodes);
  if (x->W && x->end && x->impulse && x->kick && x->first && x->width && x->moment && x->turned_T &&
      x->turned_S && x->C_q1 && x->C_qq && x->C_qv)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %d nodes", nodes);
}

dvi_status dvi__charted_centring(dvi__charted *x, int nodes, dvi__centring *centring)
{
  const int reduced = x->reduced.bodies != NULL;
  int signs = 1;
  for (int c = 0; c < x->base->slot_count; c++) signs &= x->base->slots[c].kind != DVI__SPHERE;
  *centring = (dvi__centring){.of = x,
                              .signs = signs,
                              .place = place_path,
                              .correct = reduced ? correct_reduced : correct_path,
                              .mix = mix_turn_magnitudes,
                              .turn = largest_turn,
                              .derive = reduced ? derive_reduced : derive_path,
                              .carry = carry_on_path,
                              .carry_derivatives = derive_carried};
  DVI_TRY(charted_reserve(x, nodes));
  list_blocks(x);
  centring->first = x->first;
  centring->width = x->width;
  return DVI_OK;
}
