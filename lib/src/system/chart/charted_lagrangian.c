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

dvi__chart_nodes dvi__charted_nodes(const dvi__charted *x, int c, int count, int first, int group,
                                    const double *xi, const double *rate)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  const size_t local = (size_t)slot->x * (size_t)count + (size_t)first,
               stored = (size_t)slot->q * (size_t)group;
  return (dvi__chart_nodes){.count = group,
                            .local = (size_t)count,
                            .xi = xi != NULL ? xi + local : NULL,
                            .rate = rate != NULL ? rate + local : NULL,
                            .functions = x->stumpff + DVI__NODE_FUNCTIONS * DVI__GROUP * c,
                            .y = x->y + stored,
                            .v = x->rate + stored,
                            .a = x->L_y + stored,
                            .b = x->w + stored};
}

/* Compute t, y and rate of the group that begins at point `first`. */
static dvi_status find_points(dvi__charted *x, int count, int first, int group, const double *t,
                              const double *xi, const double *rate)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__chart_nodes nodes = dvi__charted_nodes(x, c, count, first, group, xi, rate);
    const double beyond = dvi__chart_place_nodes(&x->chart[c], &nodes);
    if (beyond != 0) return dvi__charted_too_large(beyond);
  }
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

/* Compute N at the nodes of a group. Masses that couple no factors have no moment. */
void dvi__charted_find_moments(dvi__charted *x, int first, int group)
{
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__chart_nodes nodes = dvi__charted_nodes(x, c, 0, 0, group, NULL, NULL);
    if (dvi__turns(&x->base->slots[c]))
      dvi__chart_moments_of_nodes(&x->chart[c], x->inertia != NULL ? NULL : x->own_mass + 3 * c,
                                  &nodes, (size_t)x->capacity,
                                  x->moment + 3 * c * x->capacity + first);
  }
}

static dvi_status gradient_of_group(dvi__charted *x, int count, int first, int group,
                                    const double *t, const double *xi, const double *rate,
                                    double *L_xi, double *L_rate)
{
  const int apart = x->inertia != NULL;
  DVI_TRY(find_points(x, count, first, group, t, xi, rate));
  DVI_TRY(dvi__lagrangian_gradient(x->evaluator, group, x->t, x->y, apart ? NULL : x->rate, x->L_y,
                                   apart ? NULL : x->w));
  for (int c = 0; c < x->base->slot_count; c++) {
    const size_t to = (size_t)x->base->slots[c].x * (size_t)count + (size_t)first;
    dvi__chart_nodes nodes = dvi__charted_nodes(x, c, count, first, group, xi, rate);
    nodes.in_xi = L_xi + to;
    nodes.in_rate = L_rate + to;
    if (apart)
      dvi__chart_move_nodes(&x->chart[c], x->inertia + 9 * c, &nodes);
    else
      dvi__chart_differentiate_nodes(&x->chart[c], &nodes);
  }
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
    status = gradient_of_group(x, count, first, smaller_batch(DVI__GROUP, count - first), t, xi,
                               rate, L_xi, L_rate);
  return dvi__charted_verdict(x, status);
}
