/* Second derivatives of the Lagrangian in the charts, in the notation of charted_lagrangian.c,
 *
 *     L_xi'xi' = T^T M T,     L_xixi' = S^T M T + w.d2y,
 *     L_xixi = S^T M S + T^T L_yy T + (w.d3y) xi' + L_y.d2y */
#include "system/chart/charted_struct.h"

#include <string.h>

#include "core/status.h"

/* Compute T, S and the curvatures at point k of a group. */
static void bend_charts(dvi__charted *x, int count, int first, int group, int k, const double *xi,
                        const double *rate)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    double at[3], u[3], a[DVI__CHART_POINT], b[DVI__CHART_POINT];
    dvi__charted_gather(slot, count, first + k, xi, at);
    dvi__charted_gather(slot, count, first + k, rate, u);
    dvi__charted_pair(slot, group, k, x->L_y, x->w, a, b);
    const dvi__functions *functions = dvi__charted_functions(x, c, k);
    dvi__chart_tangents(&x->chart[c], functions, at, u, x->T + 3 * (size_t)slot->q,
                        x->S + 3 * (size_t)slot->q);
    dvi__chart_curvature(&x->chart[c], functions, at, u, a, b, x->curved + 9 * (size_t)c,
                         x->mixed + 9 * (size_t)c);
  }
}

void dvi__charted_add_entry(const dvi__place *at, int rows, int columns, double entry,
                            const double *left, const double *right, size_t count, size_t k,
                            double *values)
{
  for (int b = 0; b < columns; b++)
    for (int a = 0; a < rows; a++)
      values[(size_t)(at->first + b * at->column + a) * count + k] += left[a] * entry * right[b];
}

/* Add left^T M right to the blocks of `in`. A slot's own block, nearly all of M, is summed up
 * before it is added. */
static void add_slot_product(const dvi__charted *x, const dvi__factor_slot *slot,
                             const dvi__place *in, const double *left, const double *right,
                             size_t count, size_t k, double *values)
{
  const dvi__pattern *vv = &x->base->vv;
  const int size = dvi__chart_size(slot->kind);
  const dvi__place *own = NULL;
  double block[DVI__CHART_SIZE * DVI__CHART_SIZE] = {0};
  for (int j = slot->q; j < slot->q + dvi__chart_stored(slot->kind); j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++) {
      const int i = vv->row[e];
      if (x->base->mass_values[e] == 0) continue;
      const dvi__factor_slot *row = &x->base->slots[x->slot[i]];
      const double *from = dvi__charted_tangents_of(row, left, i),
                   *to = dvi__charted_tangents_of(slot, right, j);
      if (row != slot) {
        dvi__charted_add_entry(&in[e], dvi__chart_size(row->kind), size, x->base->mass_values[e],
                               from, to, count, k, values);
        continue;
      }
      own = &in[e];
      for (int a = 0; a < size; a++)
        for (int b = 0; b < size; b++)
          block[a * size + b] += from[a] * x->base->mass_values[e] * to[b];
    }
  if (own != NULL) dvi__charted_add_block(own, size, size, block, count, k, values);
}

void dvi__charted_add_mass_product(const dvi__charted *x, const dvi__place *in, const double *left,
                                   const double *right, size_t count, size_t k, double *values)
{
  for (int c = 0; c < x->base->slot_count; c++)
    add_slot_product(x, &x->base->slots[c], in, left, right, count, k, values);
}

/* Add left^T L_yy T to the blocks of qq. A user's Hessian without a pattern is nearly all zeros. */
void dvi__charted_add_potentials(const dvi__charted *x, int group, int in_group, const double *left,
                                 size_t count, size_t k, double *L_qq)
{
  const dvi__pattern *qq = &x->base->qq;
  for (int j = 0; j < x->base->n; j++)
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++) {
      const double entry = x->L_yy[e * group + in_group];
      if (entry == 0) continue;
      const dvi__factor_slot *row = &x->base->slots[x->slot[qq->row[e]]],
                             *column = &x->base->slots[x->slot[j]];
      dvi__charted_add_entry(&x->in_qq[e], dvi__chart_size(row->kind),
                             dvi__chart_size(column->kind), entry,
                             dvi__charted_tangents_of(row, left, qq->row[e]),
                             dvi__charted_tangents_of(column, x->T, j), count, k, L_qq);
    }
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

static void add_chart_curvature(const dvi__charted *x, size_t count, size_t k, double *L_qq,
                                double *L_qv)
{
  for (int c = 0; c < x->base->slot_count; c++)
    if (x->base->slots[c].kind != DVI__LINE)
      dvi__charted_add_own_blocks(x, c, x->curved + 9 * c, x->mixed + 9 * c, count, k, L_qq, L_qv);
}

static dvi_status hessian_group(dvi__charted *x, int count, int first, int group, const double *t,
                                const double *xi, const double *rate, double *L_qq, double *L_qv,
                                double *L_vv)
{
  const int on_path = dvi__charted_on_path(x, count);
  DVI_TRY(dvi__charted_forces(x, count, first, group, t, xi, rate));
  DVI_TRY(dvi__lagrangian_hessian(x->evaluator, group, x->t, x->y, x->rate, x->L_yy, NULL, NULL));
  for (int k = 0; k < group; k++) {
    const size_t points = (size_t)count, to = (size_t)first + (size_t)k;
    bend_charts(x, count, first, group, k, xi, rate);
    dvi__charted_add_mass_product(x, x->mass_in_qq, x->S, x->S, points, to, L_qq);
    dvi__charted_add_mass_product(x, x->mass_in_qv, x->S, x->T, points, to, L_qv);
    dvi__charted_add_mass_product(x, x->mass_in_vv, x->T, x->T, points, to, L_vv);
    dvi__charted_add_potentials(x, group, k, x->T, points, to, L_qq);
    add_chart_curvature(x, points, to, L_qq, L_qv);
    if (on_path) dvi__charted_add_moment_changes(x, count, first, group, k);
  }
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
    const size_t row = 3 * (size_t)x->base->slots[c].q;
    dvi__functions functions;
    dvi__chart_functions(x->chart[c].kind, rest, &functions);
    dvi__chart_tangents(&x->chart[c], &functions, rest, rest, x->T + row, x->S + row);
  }
  dvi__charted_add_mass_product(x, x->mass_in_vv, x->T, x->T, 1, 0, mass);
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
                           L_qq, L_qv, L_vv);
  if (on_path && status == DVI_OK) dvi__charted_finish_changes(x, count, L_qq, L_qv);
  return dvi__charted_verdict(x, status);
}
