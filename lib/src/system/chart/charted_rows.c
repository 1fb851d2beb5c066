/* Holonomic constraints in the charts, phi(t, y(xi)) = 0. With T = dy/dxi
 *
 *     phi_xi = T^T phi_y,     (phi.w)_xixi = T^T (phi.w)_yy T + (w phi_y).d2y. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/chart/charted_struct.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/term/holonomic.h"

/* ---- create ---- */

static dvi_status refuse_memory_of_rows(void)
{
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for constraints");
}

/* Give the slot of entry e of a column, if the entry before it has another one, or -1. */
static int new_slot(const dvi__charted *x, const dvi__pattern *G, int column, int e)
{
  const int slot = x->slot[G->row[e]];
  return e == G->start[column] || x->slot[G->row[e - 1]] != slot ? slot : -1;
}

/* Make the pattern of the gradients, in which each slot of a column has its whole block. */
static dvi_status make_gradients(dvi__charted_rows *rows)
{
  const dvi__charted *x = rows->of;
  const dvi__pattern *G = &rows->term->gradients;
  const size_t most = 3 * (size_t)dvi__pattern_entries(G);
  int at = 0;
  rows->gradients = (dvi__pattern){x->base->nx, G->columns, DVI_NEW(int, (size_t)G->columns + 1),
                                   DVI_NEW(int, most)};
  rows->in_gradients = DVI_NEW(int, dvi__pattern_entries(G));
  if (!rows->gradients.start || !rows->gradients.row || !rows->in_gradients)
    return refuse_memory_of_rows();
  for (int a = 0; a < G->columns; a++) {
    rows->gradients.start[a] = at;
    for (int e = G->start[a], block = at; e < G->start[a + 1]; e++) {
      const int c = new_slot(x, G, a, e);
      if (c >= 0) {
        block = at;
        for (int i = 0; i < dvi__chart_size(x->base->slots[c].kind); i++)
          rows->gradients.row[at++] = x->base->slots[c].x + i;
      }
      rows->in_gradients[e] = block;
    }
  }
  rows->gradients.start[G->columns] = at;
  return DVI_OK;
}

/* List the slots in the patterns of a term. */
static dvi_status list_slots(dvi__charted_rows *rows)
{
  const dvi__charted *x = rows->of;
  const int slots = x->base->slot_count;
  int *touched = DVI_NEW(int, slots);
  rows->slot = DVI_NEW(int, slots);
  if (touched != NULL && rows->slot != NULL) {
    const dvi__pattern *part[] = {&rows->term->gradients, &rows->term->qq};
    for (int k = 0; k < 2; k++)
      for (int e = 0; e < dvi__pattern_entries(part[k]); e++) touched[x->slot[part[k]->row[e]]] = 1;
    for (int c = 0; c < slots; c++)
      if (touched[c]) rows->slot[rows->slot_count++] = c;
  }
  const int possible = touched != NULL && rows->slot != NULL;
  dvi__release(touched);
  return possible ? DVI_OK : refuse_memory_of_rows();
}

static dvi_status make_rows(dvi__charted *x, const dvi__holonomic_term *term,
                            dvi__charted_rows *rows)
{
  *rows = (dvi__charted_rows){.of = x, .term = term};
  DVI_TRY(list_slots(rows));
  DVI_TRY(make_gradients(rows));
  DVI_TRY(dvi__charted_slot_pattern(x, &term->qq, NULL, 0, &rows->qq));
  DVI_TRY(dvi__charted_place_entries(x, &term->qq, &rows->qq, &rows->in_qq));
  return dvi__charted_place_own(x, &rows->qq, &rows->own_in_qq);
}

static dvi_status reserve_rows(dvi__charted *x)
{
  const dvi_system *base = x->base;
  const size_t n = (size_t)base->n, gradients = (size_t)dvi__pattern_entries(&base->rows_q);
  x->rows = DVI_NEW(dvi__charted_rows, base->holonomic_count);
  x->rows_y = DVI_NEW(double, n);
  x->rows_T = DVI_NEW(double, 3 * n);
  x->rows_phi_y = DVI_NEW(double, 2 * gradients);
  x->rows_phi_yy = DVI_NEW(double, dvi__pattern_entries(&base->rows_qq));
  x->rows_covector = DVI_NEW(double, n);
  x->rows_moved = DVI_NEW(double, 2 * n);
  return x->rows && x->rows_y && x->rows_T && x->rows_phi_y && x->rows_phi_yy && x->rows_covector &&
                 x->rows_moved
             ? DVI_OK
             : refuse_memory_of_rows();
}

void dvi__charted_clear_rows(dvi__charted *x)
{
  for (int k = 0; x->rows != NULL && k < x->base->holonomic_count; k++) {
    dvi__charted_rows *rows = &x->rows[k];
    dvi__pattern_clear(&rows->gradients);
    dvi__pattern_clear(&rows->qq);
    dvi__release(rows->slot);
    dvi__release(rows->in_gradients);
    dvi__release(rows->in_qq);
    dvi__release(rows->own_in_qq);
  }
  void *const own[] = {x->rows,        x->rows_y,        x->rows_T,    x->rows_phi_y,
                       x->rows_phi_yy, x->rows_covector, x->rows_moved};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) dvi__release(own[i]);
}

/* ---- one point ---- */

/* Compute y of the slots that the rows touch, and T with the charts' functions if `tangents`. */
static dvi_status place_rows(const dvi__charted_rows *rows, const double *xi, int tangents)
{
  static const double rest[DVI__CHART_SIZE] = {0};
  const dvi__charted *x = rows->of;
  double rate[DVI__CHART_POINT], S[3 * DVI__CHART_POINT];
  for (int k = 0; k < rows->slot_count; k++) {
    const int c = rows->slot[k];
    const dvi__factor_slot *slot = &x->base->slots[c];
    const double angle = dvi__chart_angle(slot->kind, xi + slot->x);
    if (!(angle < dvi__chart_bound(slot->kind))) return dvi__charted_too_large(angle);
    dvi__functions *functions = &x->functions[c];
    dvi__chart_functions(slot->kind, xi + slot->x, functions);
    dvi__chart_point(&x->chart[c], functions, xi + slot->x, rest, x->rows_y + slot->q, rate);
    if (tangents)
      dvi__chart_tangents(&x->chart[c], functions, xi + slot->x, rest,
                          x->rows_T + 3 * (size_t)slot->q, S);
  }
  return DVI_OK;
}

static int rows_value(double t, const double *xi, double *phi, void *user)
{
  const dvi__charted_rows *rows = user;
  dvi_status status = place_rows(rows, xi, 0);
  if (status == DVI_OK) status = dvi__holonomic_value(rows->term, t, rows->of->rows_y, phi);
  return dvi__charted_verdict(rows->of, status);
}

static int rows_rate(double t, const double *xi, double *phi_t, void *user)
{
  const dvi__charted_rows *rows = user;
  dvi_status status = place_rows(rows, xi, 0);
  if (status == DVI_OK) status = dvi__holonomic_rate(rows->term, t, rows->of->rows_y, phi_t);
  return dvi__charted_verdict(rows->of, status);
}

static int rows_gradient(double t, const double *xi, double *phi_xi, void *user)
{
  const dvi__charted_rows *rows = user;
  const dvi__charted *x = rows->of;
  const dvi__pattern *G = &rows->term->gradients;
  dvi_status status = place_rows(rows, xi, 1);
  if (status == DVI_OK) status = dvi__holonomic_gradient(rows->term, t, x->rows_y, x->rows_phi_y);
  memset(phi_xi, 0, (size_t)dvi__pattern_entries(&rows->gradients) * sizeof *phi_xi);
  for (int e = 0; e < dvi__pattern_entries(G) && status == DVI_OK; e++) {
    const dvi__factor_slot *slot = &x->base->slots[x->slot[G->row[e]]];
    const double *T = dvi__charted_tangents_of(slot, x->rows_T, G->row[e]);
    for (int i = 0; i < dvi__chart_size(slot->kind); i++)
      phi_xi[rows->in_gradients[e] + i] += T[i] * x->rows_phi_y[e];
  }
  return dvi__charted_verdict(rows->of, status);
}

/* Add T^T (phi.w)_yy T. */
static void add_rows_hessian(const dvi__charted_rows *rows, double *phi_w)
{
  const dvi__charted *x = rows->of;
  const dvi__pattern *qq = &rows->term->qq;
  for (int j = 0; j < qq->columns; j++)
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++) {
      const dvi__factor_slot *row = &x->base->slots[x->slot[qq->row[e]]],
                             *column = &x->base->slots[x->slot[j]];
      dvi__charted_add_entry(&rows->in_qq[e], dvi__chart_size(row->kind),
                             dvi__chart_size(column->kind), x->rows_phi_yy[e],
                             dvi__charted_tangents_of(row, x->rows_T, qq->row[e]),
                             dvi__charted_tangents_of(column, x->rows_T, j), 1, 0, phi_w);
    }
}

/* Add the charts' curvature along w phi_y. */
static void add_rows_curvature(const dvi__charted_rows *rows, const double *xi, const double *w,
                               double *phi_w)
{
  static const double rest[DVI__CHART_SIZE] = {0}, none[DVI__CHART_POINT] = {0};
  const dvi__charted *x = rows->of;
  const dvi__pattern *G = &rows->term->gradients;
  for (int k = 0; k < rows->slot_count; k++) {
    const dvi__factor_slot *slot = &x->base->slots[rows->slot[k]];
    memset(x->rows_covector + slot->q, 0,
           (size_t)dvi__chart_stored(slot->kind) * sizeof *x->rows_covector);
  }
  for (int a = 0; a < G->columns; a++)
    for (int e = G->start[a]; e < G->start[a + 1]; e++)
      x->rows_covector[G->row[e]] += w[a] * x->rows_phi_y[e];
  for (int k = 0; k < rows->slot_count; k++) {
    const int c = rows->slot[k];
    const dvi__factor_slot *slot = &x->base->slots[c];
    double curved[9], mixed[9];
    if (slot->kind == DVI__LINE) continue;
    dvi__chart_curvature(&x->chart[c], &x->functions[c], xi + slot->x, rest,
                         x->rows_covector + slot->q, none, curved, mixed);
    dvi__charted_add_block(&rows->own_in_qq[c], dvi__chart_size(slot->kind),
                           dvi__chart_size(slot->kind), curved, 1, 0, phi_w);
  }
}

static int rows_hessian(double t, const double *xi, const double *w, double *phi_w, void *user)
{
  const dvi__charted_rows *rows = user;
  dvi__charted *x = rows->of;
  const dvi__holonomic_at at = {.term = rows->term,
                                .t = t,
                                .w = w,
                                .point = x->rows_moved,
                                .phi_q = x->rows_phi_y + dvi__pattern_entries(&x->base->rows_q),
                                .sum = x->rows_moved + x->base->n};
  dvi_status status = place_rows(rows, xi, 1);
  if (status == DVI_OK) status = dvi__holonomic_gradient(rows->term, t, x->rows_y, x->rows_phi_y);
  if (status == DVI_OK)
    status = dvi__holonomic_hessian(&at, &x->evaluator->scratch, x->rows_y, x->rows_phi_yy);
  memset(phi_w, 0, (size_t)dvi__pattern_entries(&rows->qq) * sizeof *phi_w);
  if (status == DVI_OK) {
    add_rows_hessian(rows, phi_w);
    add_rows_curvature(rows, xi, w, phi_w);
  }
  return dvi__charted_verdict(x, status);
}

/* ---- declaration ---- */

dvi_status dvi__charted_make_rows(dvi__charted *x, dvi_holonomic *list)
{
  const dvi_system *base = x->base;
  if (base->holonomic_count == 0) return DVI_OK;
  DVI_TRY(reserve_rows(x));
  for (int k = 0; k < base->holonomic_count; k++) {
    const dvi__holonomic_term *term = &base->holonomics[k];
    dvi__charted_rows *rows = &x->rows[k];
    DVI_TRY(make_rows(x, term, rows));
    list[k] = (dvi_holonomic){.name = term->name,
                              .count = term->callbacks.count,
                              .value = rows_value,
                              .gradient = rows_gradient,
                              .hessian = rows_hessian,
                              .rate = term->callbacks.rate != NULL ? rows_rate : NULL,
                              .gradients = {rows->gradients.start, rows->gradients.row},
                              .qq = {rows->qq.start, rows->qq.row},
                              .row_names = term->callbacks.row_names,
                              .user = rows};
  }
  return DVI_OK;
}
