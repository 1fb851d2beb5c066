/* The Jacobian of the stationarity rows, with one s x s block for each entry of the Hessian's joint
 * pattern. */
#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/lanes.h"

const dvi__pattern *dvi__action_pattern(const dvi__action *action)
{
  return &action->pattern;
}

const dvi__pattern *dvi__action_coupling(const dvi__action *a)
{
  return &a->joint;
}

void dvi__action_clear_jacobian(dvi__action *a)
{
  dvi__pattern_clear(&a->joint);
  dvi__pattern_clear(&a->pattern);
  dvi__release(a->block);
  dvi__release(a->H_qq);
  dvi__release(a->H_qv);
  dvi__release(a->H_vv);
  dvi__release(a->F_q);
  dvi__release(a->F_v);
  a->block = NULL;
  a->H_qq = a->H_qv = a->H_vv = a->F_q = a->F_v = NULL;
}

static dvi_status allocate_hessians(dvi__action *a)
{
  const dvi_system *system = a->system;
  const size_t r = (size_t)a->r;
  dvi__pattern more = {0};
  dvi_status status = dvi__action_join_terms(a, &more);
  if (status == DVI_OK)
    status = dvi__joint_create(system, more.start != NULL ? &more : NULL, &a->joint, &a->block);
  dvi__pattern_clear(&more);
  DVI_TRY(status);
  a->H_qq = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->qq) * r);
  a->H_qv = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->qv) * r);
  a->H_vv = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->vv) * r);
  if (system->force_count > 0) {
    a->F_q = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->by_q) * r);
    a->F_v = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->by_v) * r);
  }
  if (a->H_qq && a->H_qv && a->H_vv && (system->force_count == 0 || (a->F_q && a->F_v)))
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for Hessians at %d nodes", a->r);
}

dvi_status dvi__action_prepare_hessians(dvi__action *a)
{
  if (a->block != NULL) return DVI_OK;
  DVI_TRY(dvi__evaluator_prepare_hessians(a->evaluator));
  const dvi_status status = allocate_hessians(a);
  if (status != DVI_OK) dvi__action_clear_jacobian(a);
  return status;
}

dvi_status dvi__action_prepare_jacobian(dvi__action *a)
{
  if (a->pattern.start != NULL) return DVI_OK;
  DVI_TRY(dvi__action_prepare_hessians(a));
  return dvi__action_wide_pattern(a, &a->pattern);
}

/* Add factor * H[j] * table[j] to x[j], where the Hessian has this entry. */
static void add_weighted_entry(int r, const double *H, int entry, double factor,
                               const double *table, double *x)
{
  if (entry < 0) return;
  H += (size_t)entry * (size_t)r;
  for (int j = 0; j < r; j++) x[j] += factor * H[j] * table[j];
}

void dvi__action_weigh_hessian(const dvi__action *a, const dvi__joint_entry *block, const double *f,
                               const double *df, double *in_q, double *in_v)
{
  const int r = a->r;
  for (int j = 0; j < r; j++) in_q[j] = in_v[j] = 0;
  add_weighted_entry(r, a->H_qq, block->qq, a->h, f, in_q);
  add_weighted_entry(r, a->H_qv, block->qv, 1.0, df, in_q);
  add_weighted_entry(r, a->F_q, block->by_q, a->h, f, in_q);
  add_weighted_entry(r, a->F_v, block->by_v, 1.0, df, in_q);
  add_weighted_entry(r, a->H_qv, block->vq, 1.0, f, in_v);
  add_weighted_entry(r, a->H_vv, block->vv, 1.0 / a->h, df, in_v);
  for (int j = 0; j < r; j++) in_q[j] *= a->weight[j], in_v[j] *= a->weight[j];
}

void dvi__action_block_column(const dvi__action *a, const dvi__joint_entry *block, int l, int rows,
                              double *column)
{
  const int r = a->r;
  double *in_q = a->line, *in_v = a->line + r;
  dvi__action_weigh_hessian(a, block, a->psi + l * a->lanes, a->dpsi + l * a->lanes, in_q, in_v);
  for (int k = 0; k < rows; k++) {
    const double *bar = a->bar + k * a->lanes, *slope = a->dpsi + k * a->lanes;
    double sum = 0;
    for (int j = 0; j < r; j++) sum += bar[j] * in_q[j] + slope[j] * in_v[j];
    column[k] = sum;
  }
}

dvi_status dvi__action_evaluate_hessians(dvi__action *a, int count, const double *t,
                                         const double *q, const double *v)
{
  DVI_TRY(dvi__lagrangian_hessian(a->evaluator, count, t, q, v, a->H_qq, a->H_qv, a->H_vv));
  return a->F_q != NULL ? dvi__forces_jacobian(a->evaluator, count, t, q, v, a->F_q, a->F_v)
                        : DVI_OK;
}

dvi_status dvi__action_hessians(dvi__action *a, const double *Y)
{
  dvi__action_stages(a, Y);
  dvi__action_place_terms(a, Y);
  return dvi__action_evaluate_hessians(a, a->r, a->t, a->Q, a->V);
}

dvi_status dvi__action_jacobian(dvi__action *a, const double *Y, double *values)
{
  const size_t s = (size_t)a->s;
  DVI_TRY(dvi__action_hessians(a, Y));
  if (a->terms.unknowns > 0)
    memset(values, 0, (size_t)dvi__pattern_entries(&a->pattern) * sizeof *values);
  for (int j = 0; j < a->n; j++) {
    const int first = a->joint.start[j], length = a->joint.start[j + 1] - first;
    for (int l = 0; l < a->s; l++) {
      double *column = values + a->pattern.start[j * a->s + l];
      for (int e = first; e < first + length; e++, column += s)
        dvi__action_block_column(a, &a->block[e], l, a->s, column);
    }
  }
  return dvi__action_add_term_derivatives(a, Y, values);
}

void dvi__action_move_ends(dvi__action *a, const double *dY, double *dp)
{
  const size_t r = (size_t)a->r;
  double *in_q = a->line, *in_v = a->line + r;
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->psi, dY, a->Q);
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->dpsi, dY, a->V);
  for (int k = 0; k < a->n; k++)
    for (int e = a->joint.start[k]; e < a->joint.start[k + 1]; e++) {
      dvi__action_weigh_hessian(a, &a->block[e], a->Q + (size_t)k * r, a->V + (size_t)k * r, in_q,
                                in_v);
      for (size_t j = 0; j < r; j++) dp[a->joint.row[e]] += in_q[j];
    }
}

dvi_status dvi__action_prepare_product(dvi__action *a)
{
  DVI_TRY(dvi__action_prepare_hessians(a));
  if (a->moved == NULL) a->moved = DVI_NEW(double, 4 * (size_t)a->n * (size_t)a->r);
  return a->moved != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r,
                         a->n);
}

/* Add factor H x to y over the nodes, where the Hessian has this entry. */
static void add_moved(int r, const double *H, int entry, double factor, const double *x, double *y)
{
  if (entry < 0) return;
  H += (size_t)entry * (size_t)r;
  for (int j = 0; j < r; j++) y[j] += factor * H[j] * x[j];
}

/* The rows are linear in the changes of h L_q and L_v at the nodes, and these in h times those of Q
 * and in those of V. */
void dvi__action_times_jacobian(dvi__action *a, const double *x, double *y)
{
  const size_t r = (size_t)a->r, batch = (size_t)a->n * r;
  double *hQ = a->moved, *V = hQ + batch, *hL_q = V + batch, *L_v = hL_q + batch;
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->psi, x, hQ);
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->dpsi, x, V);
  for (size_t k = 0; k < batch; k++) hQ[k] *= a->h, V[k] /= a->h;
  memset(hL_q, 0, 2 * batch * sizeof(double));
  for (size_t j = 0; j < (size_t)a->n; j++)
    for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++) {
      const dvi__joint_entry *block = &a->block[e];
      const size_t to = (size_t)a->joint.row[e] * r;
      add_moved(a->r, a->H_qq, block->qq, 1, hQ + j * r, hL_q + to);
      add_moved(a->r, a->H_qv, block->qv, a->h, V + j * r, hL_q + to);
      add_moved(a->r, a->H_qv, block->vq, 1 / a->h, hQ + j * r, L_v + to);
      add_moved(a->r, a->H_vv, block->vv, 1, V + j * r, L_v + to);
      add_moved(a->r, a->F_q, block->by_q, 1, hQ + j * r, hL_q + to);
      add_moved(a->r, a->F_v, block->by_v, a->h, V + j * r, hL_q + to);
    }
  dvi__lanes_weigh(a->n, a->r, a->weight, hL_q);
  dvi__lanes_weigh(a->n, a->r, a->weight, L_v);
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, a->bar_row, hL_q, y);
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, a->slope_row, L_v, a->rows);
  for (size_t i = 0; i < (size_t)a->n * (size_t)a->s; i++) y[i] += a->rows[i];
}
