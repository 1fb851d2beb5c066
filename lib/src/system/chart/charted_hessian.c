/* Second derivatives of the Lagrangian in the charts, in the notation of charted_lagrangian.c,
 *
 *     L_xi'xi' = T^T M T,     L_xixi' = S^T M T + w.d2y,
 *     L_xixi = S^T M S + T^T L_yy T + (w.d3y) xi' + L_y.d2y */
#include "system/chart/charted_struct.h"

#include <string.h>

#include "core/status.h"
#include "group/chart_bends.h"

/* Add a slot's matrix at a group of points, whose number i of point k is [i*group + k]. */
static void add_slot_block(const dvi__place *at, int size, int group, const double *matrix,
                           size_t count, size_t first, double *values)
{
  for (int a = 0; a < size; a++)
    for (int b = 0; b < size; b++, matrix += group) {
      double *to = values + (size_t)(at->first + b * at->column + a) * count + first;
      for (int k = 0; k < group; k++) to[k] += matrix[k];
    }
}

/* Compute T and S of slot c at a group of points, and add the curvature of the chart. On a path do
 * so for the change of its moments. */
static void bend_chart(dvi__charted *x, int c, const dvi__chart_nodes *nodes, int first,
                       int on_path, const dvi__hessian *to)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  const dvi__place *in_qq = &x->own_in_qq[c], *in_qv = &x->own_in_qv[c];
  const int size = dvi__chart_size(slot->kind), group = nodes->count,
            turns = on_path && dvi__turns(slot);
  const size_t row = 3 * (size_t)slot->q * DVI__GROUP, count = nodes->local, at = (size_t)first;
  const dvi__chart_bends bends = {.stride = DVI__GROUP,
                                  .even = x->inertia != NULL,
                                  .T = x->T + row,
                                  .S = x->S + row,
                                  .in_xi = x->slot_blocks,
                                  .mixed = x->slot_blocks + 9 * DVI__GROUP,
                                  .turned_T = turns ? x->turned_T + row : NULL,
                                  .turned_S = turns ? x->turned_S + row : NULL,
                                  .C_xi = x->slot_blocks + 18 * DVI__GROUP,
                                  .C_rate = x->slot_blocks + 27 * DVI__GROUP};
  dvi__chart_bend_nodes(&x->chart[c], nodes, turns ? x->W + 9 * c : NULL, &bends);
  if (slot->kind == DVI__LINE) return;
  add_slot_block(in_qq, size, group, bends.in_xi, count, at, to->qq);
  add_slot_block(in_qv, size, group, bends.mixed, count, at, to->qv);
  if (!turns) return;
  add_slot_block(in_qq, size, group, bends.C_xi, count, at, x->C_qq);
  if (!bends.even) add_slot_block(in_qv, size, group, bends.C_rate, count, at, x->C_qv);
}

void dvi__charted_add_entry(const dvi__place *at, int rows, int columns, double entry,
                            const double *left, const double *right, size_t count, size_t k,
                            double *values)
{
  for (int b = 0; b < columns; b++)
    for (int a = 0; a < rows; a++)
      values[(size_t)(at->first + b * at->column + a) * count + k] += left[a] * entry * right[b];
}

void dvi__charted_add_block(const dvi__place *at, int rows, int columns, const double *matrix,
                            size_t count, size_t k, double *values)
{
  for (int b = 0; b < columns; b++)
    for (int a = 0; a < rows; a++)
      values[(size_t)(at->first + b * at->column + a) * count + k] += matrix[a * columns + b];
}

void dvi__charted_add_own_blocks(const dvi__charted *x, int c, const double *in_qq,
                                 const double *in_qv, size_t count, size_t k, double *qq,
                                 double *qv)
{
  const int size = dvi__chart_size(x->base->slots[c].kind);
  dvi__charted_add_block(&x->own_in_qq[c], size, size, in_qq, count, k, qq);
  dvi__charted_add_block(&x->own_in_qv[c], size, size, in_qv, count, k, qv);
}

static dvi_status hessian_group(dvi__charted *x, int count, int first, int group, const double *t,
                                const double *xi, const double *rate, const dvi__hessian *to)
{
  const int on_path = dvi__charted_on_path(x, count);
  DVI_TRY(dvi__charted_forces(x, count, first, group, t, xi, rate));
  DVI_TRY(dvi__lagrangian_hessian(x->evaluator, group, x->t, x->y, x->rate, x->L_yy, NULL, NULL));
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__chart_nodes nodes = dvi__charted_nodes(x, c, count, first, group, xi, rate);
    bend_chart(x, c, &nodes, first, on_path, to);
  }
  dvi__charted_add_blocks(x, count, first, group, on_path, to);
  if (on_path) dvi__charted_find_moments(x, first, group);
  return DVI_OK;
}

static void clear_hessian(const dvi__pattern *pattern, int count, double *values)
{
  memset(values, 0, (size_t)dvi__pattern_entries(pattern) * (size_t)count * sizeof *values);
}

void dvi__charted_mass(dvi__charted *x, double *mass)
{
  static const double rest[DVI__CHART_SIZE] = {0};
  clear_hessian(&x->vv, 1, mass);
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    const int numbers = dvi__chart_stored(slot->kind) * dvi__chart_size(slot->kind);
    double T[3 * DVI__CHART_POINT], S[3 * DVI__CHART_POINT];
    dvi__functions functions;
    dvi__chart_functions(x->chart[c].kind, rest, &functions);
    dvi__chart_tangents(&x->chart[c], &functions, rest, rest, T, S);
    for (int i = 0; i < numbers; i++) x->T[(3 * (size_t)slot->q + (size_t)i) * DVI__GROUP] = T[i];
  }
  dvi__charted_add_mass(x, mass);
}

static int smaller_group(int a, int b)
{
  return a < b ? a : b;
}

int dvi__charted_hessian(int count, const double *t, const double *xi, const double *rate,
                         double *L_qq, double *L_qv, double *L_vv, void *user)
{
  dvi__charted *x = user;
  const int on_path = dvi__charted_on_path(x, count);
  dvi_status status = DVI_OK;
  x->counters->hessians -= count;
  clear_hessian(&x->qq, count, L_qq);
  clear_hessian(&x->qv, count, L_qv);
  clear_hessian(&x->vv, count, L_vv);
  if (on_path) {
    dvi__charted_find_turns(x);
    dvi__charted_clear_changes(x, count);
  }
  for (int first = 0; first < count && status == DVI_OK; first += DVI__GROUP)
    status = hessian_group(x, count, first, smaller_group(DVI__GROUP, count - first), t, xi, rate,
                           &(dvi__hessian){L_qq, L_qv, L_vv});
  if (on_path && status == DVI_OK) dvi__charted_finish_changes(x, count, L_qq, L_qv);
  return dvi__charted_verdict(x, status);
}
