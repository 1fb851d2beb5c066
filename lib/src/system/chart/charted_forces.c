/* Forces in the charts. With the stored velocity v = A(xi) xi' a force F on v is A^T F on xi', by
 * d'Alembert's principle. All forces of the system are one force of the charts. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/chart/charted_struct.h"

/* Compute A^T F of a slot. */
static void pull_force(const dvi__factor_slot *slot, const dvi__functions *functions,
                       const double *T, const double *xi, const double *rate, const double *F,
                       double *local)
{
  if (slot->kind == DVI__ROTATION) {
    double in_xi[3];
    dvi__chart_turning_gradient(functions, xi, rate, F, in_xi, local);
    return;
  }
  if (slot->kind != DVI__SPHERE) {
    *local = *F;
    return;
  }
  for (int j = 0; j < 2; j++) local[j] = T[j] * F[0] + T[2 + j] * F[1] + T[4 + j] * F[2];
}

/* Compute y and v of one point, and T. The functions of the charts stay at point 0 of a group. */
static dvi_status place_force(dvi__charted *x, const double *xi, const double *rate)
{
  double velocity[DVI__CHART_POINT], S[3 * DVI__CHART_POINT];
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    const double angle = dvi__chart_angle(slot->kind, xi + slot->x);
    if (!(angle < dvi__chart_bound(slot->kind))) return dvi__charted_too_large(angle);
    dvi__functions *functions = &x->functions[c];
    dvi__chart_functions(slot->kind, xi + slot->x, functions);
    dvi__chart_point(&x->chart[c], functions, xi + slot->x, rate + slot->x, x->y + slot->q,
                     velocity);
    dvi__chart_leave_velocity(&x->chart[c], functions, xi + slot->x, rate + slot->x,
                              x->force_v + slot->v);
    if (slot->kind == DVI__SPHERE)
      dvi__chart_tangents(&x->chart[c], functions, xi + slot->x, rate + slot->x,
                          x->T + 3 * (size_t)slot->q, S);
  }
  return DVI_OK;
}

static dvi_status force_in_charts(dvi__charted *x, double t, const double *xi, const double *rate,
                                  double *F)
{
  DVI_TRY(place_force(x, xi, rate));
  x->counters->gradients--; /* the force of the charts is counted */
  DVI_TRY(dvi__forces(x->evaluator, DVI__FORCES, 1, &t, x->y, x->force_v, x->force));
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    pull_force(slot, &x->functions[c], x->T + 3 * (size_t)slot->q, xi + slot->x, rate + slot->x,
               x->force + slot->v, F + slot->x);
  }
  return DVI_OK;
}

dvi_status dvi__charted_supply(dvi__charted *x, double t, const double *xi, const double *rate,
                               double weight, double *supply)
{
  double *one = x->L_y; /* room for numbers that are made anew at every point */
  if (x->base->symmetry_count >= x->base->n * DVI__GROUP)
    return dvi__fail(DVI_BAD_SIZE, "charts: %d symmetries", x->base->symmetry_count);
  DVI_TRY(place_force(x, xi, rate));
  DVI_TRY(dvi__forces(x->evaluator, DVI__FORCES, 1, &t, x->y, x->force_v, x->force));
  DVI_TRY(dvi__supply(x->evaluator, 1, &weight, x->force, x->y, x->force_v, one));
  for (int i = 0; i <= x->base->symmetry_count; i++) supply[i] += one[i];
  return DVI_OK;
}

static int charted_force(double t, const double *xi, const double *rate, double *F, void *user)
{
  dvi__charted *x = user;
  return dvi__charted_verdict(x, force_in_charts(x, t, xi, rate, F));
}

/* ---- patterns ---- */

/* Mark the slots that meet in a pattern of one force, whose columns are stored coordinates, or
 * velocities. A pattern that was not declared is full. */
static void mark_meetings(const dvi__charted *x, const dvi__pattern *part, const int *slot_of_v,
                          const int *slot_of_column, char *meets)
{
  const int slots = x->base->slot_count;
  if (part->start == NULL) memset(meets, 1, (size_t)slots * (size_t)slots);
  for (int j = 0; part->start != NULL && j < part->columns; j++)
    for (int e = part->start[j]; e < part->start[j + 1]; e++) {
      const int row = slot_of_v[part->row[e]], column = slot_of_column[j];
      meets[row * slots + column] = meets[column * slots + row] = 1;
    }
}

/* Make the pattern of full blocks of the marked slots, by one coordinate of each. */
static dvi_status expand_meetings(const dvi__charted *x, const char *meets, dvi__pattern *made)
{
  const dvi_system *base = x->base;
  const int slots = base->slot_count;
  int entries = 0, next = 0;
  for (int k = 0; k < slots * slots; k++) entries += meets[k];
  dvi__pattern few = {base->n, base->n, DVI_NEW(int, (size_t)base->n + 1), DVI_NEW(int, entries)};
  dvi_status status = few.start != NULL && few.row != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "charts: no memory for forces");
  entries = 0;
  for (int c = 0; c < slots && status == DVI_OK; c++) {
    while (next <= base->slots[c].q) few.start[next++] = entries;
    for (int row = 0; row < slots; row++)
      if (meets[row * slots + c]) few.row[entries++] = base->slots[row].q;
  }
  while (status == DVI_OK && next <= base->n) few.start[next++] = entries;
  if (status == DVI_OK) status = dvi__charted_slot_pattern(x, &few, NULL, 0, made);
  dvi__pattern_clear(&few);
  return status;
}

static dvi_status make_force_patterns(dvi__charted *x)
{
  const dvi_system *base = x->base;
  const size_t slots = (size_t)base->slot_count;
  char *meets = DVI_NEW(char, 2 * slots * slots);
  int *slot_of_v = DVI_NEW(int, base->nv);
  dvi_status status = meets != NULL && slot_of_v != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "charts: no memory for forces");
  for (int c = 0; c < base->slot_count && status == DVI_OK; c++)
    for (int i = 0; i < dvi__chart_velocities(base->slots[c].kind); i++)
      slot_of_v[base->slots[c].v + i] = c;
  for (int k = 0; k < base->force_count && status == DVI_OK; k++) {
    mark_meetings(x, &base->forces[k].by_q, slot_of_v, x->slot, meets);
    mark_meetings(x, &base->forces[k].by_v, slot_of_v, slot_of_v, meets + slots * slots);
  }
  if (status == DVI_OK) status = expand_meetings(x, meets, &x->force_q);
  if (status == DVI_OK) status = expand_meetings(x, meets + slots * slots, &x->force_rate);
  dvi__release(meets);
  dvi__release(slot_of_v);
  return status;
}

dvi_status dvi__charted_make_force(dvi__charted *x, dvi_force *force)
{
  if (x->base->force_count == 0) return DVI_OK;
  x->force_v = DVI_NEW(double, x->base->nv);
  x->force = DVI_NEW(double, x->base->nv);
  if (x->force_v == NULL || x->force == NULL)
    return dvi__fail(DVI_NO_MEMORY, "charts: no memory for forces");
  DVI_TRY(make_force_patterns(x));
  *force = (dvi_force){.name = "forces",
                       .value = charted_force,
                       .by_q = {x->force_q.start, x->force_q.row},
                       .by_v = {x->force_rate.start, x->force_rate.row},
                       .user = x};
  return DVI_OK;
}

void dvi__charted_clear_force(dvi__charted *x)
{
  dvi__pattern_clear(&x->force_q);
  dvi__pattern_clear(&x->force_rate);
  dvi__release(x->force_v);
  dvi__release(x->force);
}
