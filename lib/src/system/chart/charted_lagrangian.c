/* Values and first derivatives of the Lagrangian in the charts. With T = dy/dxi and S = dy'/dxi
 * (group/chart.h), the constant mass M, w = M y' and L_y = -V_y of the potentials' sum V,
 *
 *     L_xi = S^T w + T^T L_y,     L_xi' = T^T w */
#include "system/chart/charted_struct.h"

#include <string.h>

#include "core/status.h"

/* A callback of the new system can only return a number. The status itself is kept, with its
 * sentence. */
int dvi__charted_verdict(dvi__charted *x, dvi_status status)
{
  x->failure = status;
  if (status != DVI_OK) memcpy(x->sentence, dvi_last_error(), sizeof x->sentence);
  return status == DVI_OK ? 0 : status > 0 ? 1 : -1;
}

/* Copy xi or rate of point k of a batch of `count`, for a slot. */
void dvi__charted_gather(const dvi__factor_slot *slot, int count, int k, const double *batch,
                         double *one)
{
  for (int i = 0; i < dvi__chart_size(slot->kind); i++)
    one[i] = batch[(size_t)(slot->x + i) * (size_t)count + (size_t)k];
}

/* Compute y and rate of a slot, and its chart's functions, at point k of a group. This is point
 * `from` of a batch. */
static dvi_status find_point(dvi__charted *x, int c, int count, int from, int group, int k,
                             const double *xi, const double *rate)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  double at[DVI__CHART_SIZE], u[DVI__CHART_SIZE], y[DVI__CHART_POINT], v[DVI__CHART_POINT];
  dvi__charted_gather(slot, count, from, xi, at);
  dvi__charted_gather(slot, count, from, rate, u);
  const double angle = dvi__chart_angle(slot->kind, at);
  if (!(angle < dvi__chart_bound(slot->kind))) return dvi__charted_too_large(angle);
  dvi__functions *functions = dvi__charted_functions(x, c, k);
  dvi__chart_functions(slot->kind, at, functions);
  dvi__chart_point(&x->chart[c], functions, at, u, y, v);
  for (int i = 0; i < dvi__chart_stored(slot->kind); i++) {
    x->y[(slot->q + i) * group + k] = y[i];
    x->rate[(slot->q + i) * group + k] = v[i];
  }
  return DVI_OK;
}

/* Compute t, y and rate of the group that begins at point `first`. */
static dvi_status find_points(dvi__charted *x, int count, int first, int group, const double *t,
                              const double *xi, const double *rate)
{
  for (int c = 0; c < x->base->slot_count; c++)
    for (int k = 0; k < group; k++) DVI_TRY(find_point(x, c, count, first + k, group, k, xi, rate));
  memcpy(x->t, t + first, (size_t)group * sizeof *t);
  return DVI_OK;
}

static int smaller_batch(int a, int b)
{
  return a < b ? a : b;
}

int dvi__charted_value(int count, const double *t, const double *xi, const double *rate, double *L,
                       void *user)
{
  dvi__charted *x = user;
  dvi_status status = DVI_OK;
  x->counters->values -= count; /* the calling evaluator counts the same points */
  for (int first = 0; first < count && status == DVI_OK; first += DVI__GROUP) {
    const int group = smaller_batch(DVI__GROUP, count - first);
    status = find_points(x, count, first, group, t, xi, rate);
    if (status == DVI_OK)
      status = dvi__lagrangian_value(x->evaluator, group, x->t, x->y, x->rate, L + first);
  }
  return dvi__charted_verdict(x, status);
}

dvi_status dvi__charted_forces(dvi__charted *x, int count, int first, int group, const double *t,
                               const double *xi, const double *rate)
{
  DVI_TRY(find_points(x, count, first, group, t, xi, rate));
  return dvi__lagrangian_gradient(x->evaluator, group, x->t, x->y, x->rate, x->L_y, x->w);
}

void dvi__charted_pair(const dvi__factor_slot *slot, int group, int k, const double *first,
                       const double *second, double *a, double *b)
{
  for (int i = 0; i < dvi__chart_stored(slot->kind); i++) {
    a[i] = first[(slot->q + i) * group + k];
    b[i] = second[(slot->q + i) * group + k];
  }
}

static void pull_back_gradient(const dvi__charted *x, int count, int first, int group,
                               const double *xi, const double *rate, double *L_xi, double *L_rate)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    for (int k = 0; k < group; k++) {
      double at[3], u[3], a[DVI__CHART_POINT], b[DVI__CHART_POINT], in_xi[3], in_rate[3];
      dvi__charted_gather(slot, count, first + k, xi, at);
      dvi__charted_gather(slot, count, first + k, rate, u);
      dvi__charted_pair(slot, group, k, x->L_y, x->w, a, b);
      dvi__chart_gradient(&x->chart[c], dvi__charted_functions(x, c, k), at, u, a, b, in_xi,
                          in_rate);
      for (int i = 0; i < dvi__chart_size(slot->kind); i++) {
        const size_t to = (size_t)(slot->x + i) * (size_t)count + ((size_t)first + (size_t)k);
        L_xi[to] = in_xi[i];
        L_rate[to] = in_rate[i];
      }
    }
  }
}

/* Subtract m y' from w for each vector of a slot, m its own mass. v x m v is 0, but its rounded
 * value is not, and always errs to one side. */
static void take_own(const dvi__charted *x, const dvi__factor_slot *slot, const double *rate,
                     double *w)
{
  const int stored = dvi__chart_stored(slot->kind), vectors = stored / 3;
  for (int i = 0; i < stored; i++) {
    const int j = slot->q + i % vectors, e = dvi__pattern_find(&x->base->vv, j, j);
    if (e >= 0) w[i] -= x->base->mass_values[e] * rate[i];
  }
}

/* Compute N at the nodes of a group. */
void dvi__charted_find_moments(dvi__charted *x, int first, int group)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    for (int k = 0; k < group && dvi__turns(slot); k++) {
      double y[DVI__CHART_POINT], v[DVI__CHART_POINT], a[DVI__CHART_POINT], b[DVI__CHART_POINT],
          N[3] = {0};
      dvi__charted_pair(slot, group, k, x->y, x->rate, y, v);
      dvi__charted_pair(slot, group, k, x->L_y, x->w, a, b);
      dvi__chart_add_moment(slot->kind, y, a, N);
      take_own(x, slot, v, b);
      dvi__chart_add_moment(slot->kind, v, b, N);
      for (int i = 0; i < 3; i++) x->moment[(3 * c + i) * x->capacity + first + k] = N[i];
    }
  }
}

static dvi_status gradient_of_group(dvi__charted *x, int count, int first, int group,
                                    const double *t, const double *xi, const double *rate,
                                    double *L_xi, double *L_rate)
{
  DVI_TRY(dvi__charted_forces(x, count, first, group, t, xi, rate));
  pull_back_gradient(x, count, first, group, xi, rate, L_xi, L_rate);
  if (dvi__charted_on_path(x, count)) dvi__charted_find_moments(x, first, group);
  return DVI_OK;
}

int dvi__charted_gradient(int count, const double *t, const double *xi, const double *rate,
                          double *L_xi, double *L_rate, void *user)
{
  dvi__charted *x = user;
  dvi_status status = DVI_OK;
  x->counters->gradients -= count; /* the calling evaluator counts the same points */
  for (int first = 0; first < count && status == DVI_OK; first += DVI__GROUP)
    status = (x->inertia != NULL ? dvi__charted_gradient_apart : gradient_of_group)(
        x, count, first, smaller_batch(DVI__GROUP, count - first), t, xi, rate, L_xi, L_rate);
  return dvi__charted_verdict(x, status);
}
