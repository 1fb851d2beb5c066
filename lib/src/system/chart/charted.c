/* Charts at one point of a configuration space, and maps between the charts and the space. */
#include "system/chart/charted_struct.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* ---- create, destroy ---- */

static dvi_status make_charted_system(dvi__charted *x, dvi_holonomic *rows)
{
  const int reduced = x->reduced.bodies != NULL;
  const dvi_lagrangian lagrangian = {
      .value_batch = reduced ? dvi__reduced_value : dvi__charted_value,
      .gradient_batch = reduced ? dvi__reduced_gradient : dvi__charted_gradient,
      .hessian_batch = reduced ? dvi__reduced_hessian : dvi__charted_hessian,
      .qq = {x->qq.start, x->qq.row},
      .qv = {x->qv.start, x->qv.row},
      .vv = {x->vv.start, x->vv.row},
      .user = x};
  dvi_force force = {0};
  DVI_TRY(dvi__charted_make_rows(x, rows));
  DVI_TRY(dvi__charted_make_force(x, &force));
  return dvi_system_create(&(dvi_system_terms){.dimension = x->base->nx,
                                               .lagrangian = &lagrangian,
                                               .forces = x->base->force_count > 0 ? &force : NULL,
                                               .force_count = x->base->force_count > 0,
                                               .damping = x->base->damping,
                                               .holonomics = rows,
                                               .holonomic_count = x->base->holonomic_count},
                           &x->system);
}

/* Constraints in the charts are declared by a list that is not kept. */
static dvi_status declare_charted_system(dvi__charted *x)
{
  const int count = x->base->holonomic_count;
  dvi_holonomic *rows = count > 0 ? DVI_NEW(dvi_holonomic, count) : NULL;
  if (count > 0 && rows == NULL)
    return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %d constraints", count);
  const dvi_status status = make_charted_system(x, rows);
  dvi__release(rows);
  return status;
}

static dvi_status charted_allocate(dvi__charted *x)
{
  const size_t group = (size_t)x->base->n * DVI__GROUP, slots = (size_t)x->base->slot_count;
  x->chart = DVI_NEW(dvi__chart, slots);
  x->functions = DVI_NEW(dvi__functions, slots);
  x->stumpff = DVI_NEW(double, DVI__NODE_FUNCTIONS *DVI__GROUP *slots);
  x->t = DVI_NEW(double, DVI__GROUP);
  x->y = DVI_NEW(double, group);
  x->rate = DVI_NEW(double, group);
  x->L_y = DVI_NEW(double, group);
  x->w = DVI_NEW(double, group);
  x->L_yy = DVI_NEW(double, (size_t)dvi__pattern_entries(&x->base->qq) * DVI__GROUP);
  x->T = DVI_NEW(double, 3 * group);
  x->S = DVI_NEW(double, 3 * group);
  x->slot_blocks = DVI_NEW(double, 4 * 9 * DVI__GROUP);
  if (x->chart && x->functions && x->stumpff && x->t && x->y && x->rate && x->L_y && x->w &&
      x->L_yy && x->T && x->S && x->slot_blocks)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %zu factors", slots);
}

static dvi_status charted_fill(dvi__charted *x, const dvi_system *system, int reduced,
                               dvi_counters *counters)
{
  x->base = system;
  x->counters = counters;
  DVI_TRY(dvi__system_prepare_hessian(system));
  DVI_TRY(charted_allocate(x));
  DVI_TRY(dvi__evaluator_create(system, DVI__GROUP, DVI__HESSIANS, counters, &x->evaluator));
  if (reduced) DVI_TRY(dvi__reduced_create(system, &x->reduced));
  if (!reduced) DVI_TRY(dvi__charted_read_masses(x));
  DVI_TRY(dvi__charted_make_patterns(x));
  if (reduced) DVI_TRY(dvi__reduced_place(x));
  return declare_charted_system(x);
}

dvi_status dvi__charted_create(const dvi_system *system, int reduced, dvi_counters *counters,
                               dvi__charted **charted)
{
  dvi__charted *x = *charted = DVI_NEW(dvi__charted, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  const dvi_status status = charted_fill(x, system, reduced, counters);
  if (status != DVI_OK) dvi__charted_destroy(charted);
  return status;
}

void dvi__charted_destroy(dvi__charted **charted)
{
  dvi__charted *x = *charted;
  if (x == NULL) return;
  dvi_system_destroy(&x->system);
  dvi__evaluator_destroy(&x->evaluator);
  dvi__pattern_clear(&x->qq);
  dvi__pattern_clear(&x->qv);
  dvi__pattern_clear(&x->vv);
  dvi__reduced_clear(&x->reduced);
  dvi__charted_clear_rows(x);
  dvi__charted_clear_force(x);
  dvi__charted_clear_blocks(x);
  void *const own[] = {x->functions,   x->chart,    x->slot,      x->slot_of_x, x->t,
                       x->y,           x->rate,     x->L_y,       x->w,         x->L_yy,
                       x->T,           x->S,        x->own_in_qq, x->own_in_qv, x->own_in_vv,
                       x->coupled_in,  x->W,        x->end,       x->moment,    x->impulse,
                       x->turned_T,    x->turned_S, x->C_q1,      x->C_qq,      x->C_qv,
                       x->kick,        x->first,    x->width,     x->inertia,   x->own_mass,
                       x->slot_blocks, x->stumpff};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) dvi__release(own[i]);
  dvi__release(x);
  *charted = NULL;
}

const dvi_system *dvi__charted_system(const dvi__charted *x)
{
  return x->system;
}

/* ---- maps between the charts and the space ---- */

void dvi__charted_centre(dvi__charted *x, const double *q)
{
  for (int c = 0; c < x->base->slot_count; c++)
    dvi__chart_centre(x->base->slots[c].kind, q + x->base->slots[c].q, &x->chart[c]);
  x->failure = DVI_OK;
}

void dvi__charted_enter(const dvi__charted *x, const double *stored, double *local)
{
  for (int c = 0; c < x->base->slot_count; c++)
    dvi__chart_enter(&x->chart[c], stored + x->base->slots[c].v, local + x->base->slots[c].x);
}

void dvi__charted_store(const dvi__charted *x, const double *local, double *stored)
{
  for (int c = 0; c < x->base->slot_count; c++)
    dvi__chart_store(&x->chart[c], local + x->base->slots[c].x, stored + x->base->slots[c].v);
}

void dvi__charted_arrive(const dvi__charted *x, const dvi__phase *local, const dvi__phase *state)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *at = &x->base->slots[c];
    double *y = state->q + at->q, *y_compensation = state->q_compensation + at->q,
           *p = state->p + at->v, *p_compensation = state->p_compensation + at->v;
    if (dvi__turns(at)) {
      double added[3];
      for (int i = 0; i < 3; i++) added[i] = x->impulse[3 * c + i] + x->kick[3 * c + i];
      dvi__chart_transport(&x->chart[c], local->q + at->x, added, y, y_compensation, p,
                           p_compensation);
    } else {
      dvi__chart_move(&x->chart[c], local->q + at->x, y, y_compensation);
      *p = local->p[at->x];
      *p_compensation = local->p_compensation[at->x];
    }
  }
}

void dvi__charted_point(const dvi__charted *x, const double *xi, const double *rate, double *q,
                        double *v)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *at = &x->base->slots[c];
    if (q != NULL) dvi__chart_place(&x->chart[c], xi + at->x, q + at->q);
    if (v == NULL) continue;
    dvi__functions functions;
    dvi__chart_functions(at->kind, xi + at->x, &functions);
    dvi__chart_leave_velocity(&x->chart[c], &functions, xi + at->x, rate + at->x, v + at->v);
  }
}

/* Do so for one slot, whose points begin at its first coordinate. */
static void follow_slot(const dvi__chart *chart, const dvi__chart *next, const double *end, int s,
                        double *points)
{
  const int size = dvi__chart_size(chart->kind);
  double start[DVI__CHART_SIZE];
  dvi__chart_back(chart, next, end, start);
  for (int m = 0; m < s; m++) {
    double xi[DVI__CHART_SIZE], eta[DVI__CHART_SIZE] = {0};
    for (int i = 0; i < size; i++) xi[i] = points[i * s + m];
    if (m < s - 1) dvi__chart_follow(chart, next, end, xi, eta);
    for (int i = 0; i < size; i++) points[i * s + m] = eta[i] - start[i];
  }
}

void dvi__charted_follow(dvi__charted *x, const double *q, const double *end, int s, double *points)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    dvi__chart next;
    dvi__chart_centre(slot->kind, q + slot->q, &next);
    follow_slot(&x->chart[c], &next, end + slot->x, s, points + (size_t)slot->x * (size_t)s);
    x->chart[c] = next;
  }
  x->failure = DVI_OK;
}

dvi_status dvi__charted_too_large(double turned)
{
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "a step too large: a rotation by %.3g is beyond the chart, whose bound is half a turn, %.3g",
      turned, dvi__chart_bound(DVI__ROTATION));
}

dvi_status dvi__charted_check(const dvi__charted *x, const double *xi)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    const double angle = dvi__chart_angle(slot->kind, xi + slot->x);
    if (!(angle < dvi__chart_bound(slot->kind))) return dvi__charted_too_large(angle);
  }
  return DVI_OK;
}

/* If every number of `system` was finite, numbers of the charts are too large. */
dvi_status dvi__charted_explain(const dvi__charted *x, dvi_status status)
{
  const int by_callback = status == DVI_CALLBACK_RETRY || status == DVI_CALLBACK_FAILED;
  const int behind = status == DVI_STEP_TOO_LARGE && x->failure != DVI_STEP_TOO_LARGE;
  if (x->failure != DVI_OK && (by_callback || behind))
    return dvi__fail(x->failure, "%s", x->sentence);
  if (x->failure == DVI_OK && status == DVI_NOT_FINITE)
    return dvi__fail(DVI_NOT_FINITE, "the derivatives of the Lagrangian overflow at this state: "
                                     "its velocities or forces are too large; other units "
                                     "make them smaller");
  return status;
}
