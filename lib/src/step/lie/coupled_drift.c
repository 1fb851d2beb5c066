/* The unknowns are the chart coordinates xi of q1 at q0.
 *
 *     h p - T0^T M (y(xi) - y0) = 0,     with the derivative  -T0^T M T(xi)
 *
 * From xi = 0 the first correction is h v. As long as each correction is much shorter than the one
 * before, the same holds for all shorter steps, and the solution lies on their branch
 * (Kantorovich's theorem; Deuflhard 2004, sec. 2.1). At the end of the branch corrections shrink by
 * one half only. The length of a correction is that of T0 xi with the weights sum_j |M_ij|. It is
 * at least the length by the kinetic energy, and remains a length for an indefinite mass, for which
 * the kinetic energy gives none.
 *
 * With a = M (y1 - y0)/h the angular momentum y x a of a slot changes by (y1 - y0) x a, the moment
 * that the other slots exert. The sum of all moments is 0 if the mass has the symmetry. */
#include "step/lie/coupled_drift.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "group/turn.h"
#include "group/vector.h"
#include "num/compensated.h"

enum { MOST_ITERATIONS = 60 };

typedef struct unit {
  const dvi__factor_slot *slot;
  int x; /* index of its first unknown */
  dvi__chart chart;
} unit;

struct dvi__coupled_drift {
  const dvi_system *system;
  dvi_counters *counters;
  int count, unknowns;
  unit *unit;           /* [count] */
  int *owner;           /* [n] the unit of a stored coordinate, or -1 */
  dvi__pattern pattern; /* pattern of the derivative */
  int *first;           /* [entries of the mass] first entry of the block in the derivative */
  dvi__linear *linear;
  double *T0, *T;                /* [3 n] as dvi__chart_tangents has them */
  double *moved, *force;         /* [n] y(xi) - y0, and M times that */
  double *weight;                /* [n] weights of coordinates in the length of a correction */
  double *unwanted;              /* [3 n] */
  double *values;                /* [entries] */
  double *xi, *impulse, *change; /* [unknowns] */
};

/* ---- create ---- */

static void find_units(dvi__coupled_drift *l, const int *together)
{
  const dvi_system *s = l->system;
  for (int i = 0; i < s->n; i++) l->owner[i] = -1;
  for (int c = 0; c < s->slot_count; c++) {
    const dvi__factor_slot *slot = &s->slots[c];
    if (!together[c]) continue;
    for (int i = 0; i < dvi__chart_stored(slot->kind); i++) l->owner[slot->q + i] = l->count;
    l->unit[l->count++] = (unit){.slot = slot, .x = l->unknowns};
    l->unknowns += dvi__chart_size(slot->kind);
  }
}

/* List the rows of the block column of unit `column`, which are those of all units that the mass
 * couples to this unit. Returns their number. Without `row` the rows are counted only. */
static size_t list_rows(const dvi__coupled_drift *l, int column, int *seen, int stamp, int *row)
{
  const dvi__factor_slot *slot = l->unit[column].slot;
  const dvi__pattern *vv = &l->system->vv;
  size_t rows = 0;
  seen[column] = stamp;
  for (int j = slot->q; j < slot->q + dvi__chart_stored(slot->kind); j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++)
      if (l->owner[vv->row[e]] >= 0) seen[l->owner[vv->row[e]]] = stamp;
  for (int u = 0; u < l->count; u++)
    for (int i = 0; seen[u] == stamp && i < dvi__chart_size(l->unit[u].slot->kind); i++, rows++)
      if (row != NULL) row[rows] = l->unit[u].x + i;
  return rows;
}

static dvi_status coupled_drift_make_pattern(dvi__coupled_drift *l)
{
  int *seen = DVI_NEW(int, l->count);
  size_t entries = 0;
  for (int u = 0; u < l->count && seen != NULL; u++)
    entries += list_rows(l, u, seen, u + 1, NULL) * (size_t)dvi__chart_size(l->unit[u].slot->kind);
  l->pattern = (dvi__pattern){.rows = l->unknowns,
                              .columns = l->unknowns,
                              .start = DVI_NEW(int, (size_t)l->unknowns + 1),
                              .row = DVI_NEW(int, entries)};
  const int possible = seen != NULL && l->pattern.start != NULL && l->pattern.row != NULL &&
                       entries <= 0x7fffffff;
  for (int u = 0, at = 0; u < l->count && possible; u++)
    for (int j = 0; j < dvi__chart_size(l->unit[u].slot->kind); j++) {
      at += (int)list_rows(l, u, seen, l->count + u + 1, l->pattern.row + at);
      l->pattern.start[l->unit[u].x + j + 1] = at;
    }
  dvi__release(seen);
  return possible ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "drift: no memory for the mass in charts");
}

static void coupled_drift_find_blocks(dvi__coupled_drift *l)
{
  const dvi__pattern *vv = &l->system->vv;
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1] && l->owner[j] >= 0; e++)
      if (l->owner[vv->row[e]] >= 0)
        l->first[e] = dvi__pattern_find(&l->pattern, l->unit[l->owner[vv->row[e]]].x,
                                        l->unit[l->owner[j]].x);
}

static dvi_status coupled_drift_allocate(dvi__coupled_drift *l)
{
  const size_t n = (size_t)l->system->n, unknowns = (size_t)l->unknowns;
  l->first = DVI_NEW(int, dvi__pattern_entries(&l->system->vv));
  l->values = DVI_NEW(double, dvi__pattern_entries(&l->pattern));
  l->T0 = DVI_NEW(double, 12 * n + 3 * unknowns);
  if (l->first == NULL || l->values == NULL || l->T0 == NULL)
    return dvi__fail(DVI_NO_MEMORY, "drift: no memory");
  l->T = l->T0 + 3 * n;
  l->unwanted = l->T + 3 * n;
  l->moved = l->unwanted + 3 * n;
  l->force = l->moved + n;
  l->weight = l->force + n;
  l->xi = l->weight + n;
  l->impulse = l->xi + unknowns;
  l->change = l->impulse + unknowns;
  return DVI_OK;
}

static void find_weights(dvi__coupled_drift *l)
{
  const dvi__pattern *vv = &l->system->vv;
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++)
      l->weight[j] += fabs(l->system->mass_values[e]);
}

static dvi_status coupled_drift_initialise(dvi__coupled_drift *l, const int *together)
{
  l->unit = DVI_NEW(unit, l->system->slot_count);
  l->owner = DVI_NEW(int, l->system->n);
  if (l->unit == NULL || l->owner == NULL) return dvi__fail(DVI_NO_MEMORY, "drift: no memory");
  find_units(l, together);
  DVI_TRY(coupled_drift_make_pattern(l));
  DVI_TRY(coupled_drift_allocate(l));
  coupled_drift_find_blocks(l);
  find_weights(l);
  return dvi__linear_create(&l->pattern, DVI__LINEAR_AUTO, l->counters, &l->linear);
}

dvi_status dvi__coupled_drift_create(const dvi_system *system, const int *together,
                                     dvi_counters *counters, dvi__coupled_drift **drift)
{
  dvi__coupled_drift *l = *drift = DVI_NEW(dvi__coupled_drift, 1);
  if (l == NULL) return dvi__fail(DVI_NO_MEMORY, "drift: no memory");
  l->system = system;
  l->counters = counters;
  const dvi_status status = coupled_drift_initialise(l, together);
  if (status != DVI_OK) dvi__coupled_drift_destroy(drift);
  return status;
}

void dvi__coupled_drift_destroy(dvi__coupled_drift **drift)
{
  dvi__coupled_drift *l = *drift;
  if (l == NULL) return;
  dvi__linear_destroy(&l->linear);
  dvi__pattern_clear(&l->pattern);
  dvi__release(l->unit);
  dvi__release(l->owner);
  dvi__release(l->first);
  dvi__release(l->values);
  dvi__release(l->T0);
  dvi__release(l);
  *drift = NULL;
}

/* ---- points ---- */

/* Set force = M moved. */
static void coupled_drift_multiply(dvi__coupled_drift *l)
{
  const dvi__pattern *vv = &l->system->vv;
  memset(l->force, 0, (size_t)l->system->n * sizeof *l->force);
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1] && l->owner[j] >= 0; e++)
      l->force[vv->row[e]] += l->system->mass_values[e] * l->moved[j];
}

/* Return the length of a change of xi at q0. */
static double coupled_drift_length_of(const dvi__coupled_drift *l, const double *change)
{
  double sum = 0;
  for (int u = 0; u < l->count; u++) {
    const dvi__factor_slot *slot = l->unit[u].slot;
    const int size = dvi__chart_size(slot->kind);
    for (int i = 0; i < dvi__chart_stored(slot->kind); i++) {
      double moved = 0;
      for (int a = 0; a < size; a++)
        moved += l->T0[3 * slot->q + i * size + a] * change[l->unit[u].x + a];
      sum += l->weight[slot->q + i] * moved * moved;
    }
  }
  return sqrt(sum);
}

/* ---- Newton's method ---- */

/* Compute T of a unit at xi. */
static void find_tangents(const dvi__coupled_drift *l, const unit *of, const double *xi, double *T)
{
  const double rest[DVI__CHART_SIZE] = {0};
  dvi__functions c;
  dvi__chart_functions(of->chart.kind, xi, &c);
  dvi__chart_tangents(&of->chart, &c, xi, rest, T + 3 * (size_t)of->slot->q, l->unwanted);
}

static void coupled_drift_begin(dvi__coupled_drift *l, double h, const double *q, const double *p)
{
  const double rest[DVI__CHART_SIZE] = {0};
  memset(l->xi, 0, (size_t)l->unknowns * sizeof *l->xi);
  for (int u = 0; u < l->count; u++) {
    unit *of = &l->unit[u];
    double *impulse = l->impulse + of->x;
    dvi__chart_centre(of->slot->kind, q + of->slot->q, &of->chart);
    find_tangents(l, of, rest, l->T0);
    dvi__chart_enter(&of->chart, p + of->slot->v, impulse);
    for (int a = 0; a < dvi__chart_size(of->slot->kind); a++) impulse[a] *= h;
  }
}

/* Set change = h p - T0^T M (y(xi) - y0). */
static void coupled_drift_find_residual(dvi__coupled_drift *l)
{
  for (int u = 0; u < l->count; u++)
    dvi__chart_displacement(&l->unit[u].chart, l->xi + l->unit[u].x, l->moved + l->unit[u].slot->q);
  coupled_drift_multiply(l);
  memcpy(l->change, l->impulse, (size_t)l->unknowns * sizeof *l->change);
  for (int u = 0; u < l->count; u++) {
    const dvi__factor_slot *slot = l->unit[u].slot;
    const int size = dvi__chart_size(slot->kind);
    for (int i = 0; i < dvi__chart_stored(slot->kind); i++)
      for (int a = 0; a < size; a++)
        l->change[l->unit[u].x + a] -= l->T0[3 * slot->q + i * size + a] * l->force[slot->q + i];
  }
}

/* Add T0^T (entry e, in column j) T to values. */
static void coupled_drift_add_block(dvi__coupled_drift *l, int e, int j)
{
  const int i = l->system->vv.row[e];
  const unit *row = &l->unit[l->owner[i]], *column = &l->unit[l->owner[j]];
  const int rows = dvi__chart_size(row->slot->kind), columns = dvi__chart_size(column->slot->kind),
            length = l->pattern.start[column->x + 1] - l->pattern.start[column->x];
  const double *left = l->T0 + 3 * row->slot->q + (i - row->slot->q) * rows,
               *right = l->T + 3 * column->slot->q + (j - column->slot->q) * columns;
  for (int b = 0; b < columns; b++)
    for (int a = 0; a < rows; a++)
      l->values[l->first[e] + b * length + a] += left[a] * l->system->mass_values[e] * right[b];
}

static dvi_status coupled_drift_correct(dvi__coupled_drift *l)
{
  const dvi__pattern *vv = &l->system->vv;
  for (int u = 0; u < l->count; u++) find_tangents(l, &l->unit[u], l->xi + l->unit[u].x, l->T);
  memset(l->values, 0, (size_t)dvi__pattern_entries(&l->pattern) * sizeof *l->values);
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1] && l->owner[j] >= 0; e++)
      if (l->owner[vv->row[e]] >= 0) coupled_drift_add_block(l, e, j);
  l->counters->jacobians++;
  coupled_drift_find_residual(l);
  l->counters->residuals++;
  DVI_TRY(dvi__linear_factor(l->linear, l->values));
  dvi__linear_solve(l->linear, l->change);
  return DVI_OK;
}

static dvi_status coupled_drift_too_large(double ratio)
{
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "coupled slots turn too far: the corrections of their drift shrink by %.3g, not by 1/2 as on "
      "the branch of short steps; for a single one that means h |p| near its moment of inertia",
      ratio);
}

static dvi_status coupled_drift_newton(dvi__coupled_drift *l)
{
  double first = 0, last = HUGE_VAL;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const dvi_status status = coupled_drift_correct(l);
    if (status == DVI_SINGULAR && iteration > 0) return coupled_drift_too_large(1);
    DVI_TRY(status);
    const double length = coupled_drift_length_of(l, l->change);
    if (!(length <= 0.6 * last)) return coupled_drift_too_large(length / last);
    for (int i = 0; i < l->unknowns; i++) l->xi[i] += l->change[i];
    if (iteration == 0) first = length;
    if (length <= 1e-9 * first) return DVI_OK;
    last = length;
  }
  return coupled_drift_too_large(1);
}

/* ---- the end ---- */

/* Compute the moment (y1 - y0) x a in space. */
static void coupled_drift_moment_of(const dvi__coupled_drift *l, const unit *of, double h,
                                    double *moment)
{
  const int q = of->slot->q;
  memset(moment, 0, 3 * sizeof *moment);
  if (of->slot->kind == DVI__CIRCLE)
    moment[0] = l->moved[q] * l->force[q + 1] - l->moved[q + 1] * l->force[q];
  else if (of->slot->kind != DVI__LINE)
    dvi__chart_add_moment(of->slot->kind, l->moved + q, l->force + q, moment);
  for (int i = 0; i < 3; i++) moment[i] /= h;
}

static void coupled_drift_arrive(const dvi__coupled_drift *l, const unit *of, double h,
                                 const dvi__phase *state, double *displacement)
{
  const int q = of->slot->q, v = of->slot->v;
  const double *xi = l->xi + of->x;
  double *y = state->q + q, *y_compensation = state->q_compensation + q, *p = state->p + v,
         *p_compensation = state->p_compensation + v, moment[3], added[3] = {0};
  coupled_drift_moment_of(l, of, h, moment);
  dvi__chart_store(&of->chart, xi, displacement + v);
  if (of->slot->kind == DVI__LINE || of->slot->kind == DVI__CIRCLE) {
    dvi__chart_move(&of->chart, xi, y, y_compensation);
    if (of->slot->kind == DVI__CIRCLE) dvi__add_compensated(p, p_compensation, moment[0]);
    return;
  }
  dvi__chart_add_impulse(&of->chart, moment, added);
  dvi__chart_transport(&of->chart, xi, added, y, y_compensation, p, p_compensation);
  if (of->slot->kind == DVI__ROTATION) dvi__turn_tangent(xi, displacement + v);
}

static dvi_status coupled_drift_check_turns(const dvi__coupled_drift *l)
{
  for (int u = 0; u < l->count; u++) {
    const unit *of = &l->unit[u];
    double square = 0;
    for (int a = 0; a < dvi__chart_size(of->slot->kind); a++)
      square += l->xi[of->x + a] * l->xi[of->x + a];
    if (!(sqrt(square) < dvi__chart_bound(of->slot->kind)))
      return dvi__fail(DVI_STEP_TOO_LARGE,
                       "the slot at coordinate %d turns by %.3g in one step, half a turn or more",
                       of->slot->q, sqrt(square));
  }
  return DVI_OK;
}

dvi_status dvi__coupled_drift_drift(dvi__coupled_drift *l, double h, const dvi__phase *state,
                                    double *displacement)
{
  coupled_drift_begin(l, h, state->q, state->p);
  DVI_TRY(coupled_drift_newton(l));
  DVI_TRY(coupled_drift_check_turns(l));
  coupled_drift_find_residual(l);
  for (int u = 0; u < l->count; u++) coupled_drift_arrive(l, &l->unit[u], h, state, displacement);
  return DVI_OK;
}

dvi_status dvi__coupled_drift_velocity(dvi__coupled_drift *l, const double *q, const double *p,
                                       double *v)
{
  coupled_drift_begin(l, 1, q, p);
  DVI_TRY(coupled_drift_correct(l));
  for (int u = 0; u < l->count; u++)
    dvi__chart_store(&l->unit[u].chart, l->change + l->unit[u].x, v + l->unit[u].slot->v);
  return DVI_OK;
}
