/* The Jacobian of the stationarity rows: one s x s block for each entry of the Hessian's joint pattern. */
#include "action/action_struct.h"
#include "core/memory.h"
#include "core/status.h"

const dvi__pattern *dvi__action_pattern(const dvi__action *action)
{
  return &action->pattern;
}

static dvi_status join(dvi__action *a)
{
  const dvi_system *system = a->system;
  dvi__pattern vq = {0}, mixed = {0}, diagonal = {0};
  dvi_status status = dvi__pattern_transpose(&system->qv, &vq);
  if (status == DVI_OK) status = dvi__pattern_union(&system->qv, &vq, &mixed);
  if (status == DVI_OK) status = dvi__pattern_union(&system->qq, &system->vv, &diagonal);
  if (status == DVI_OK) status = dvi__pattern_union(&mixed, &diagonal, &a->joint);
  dvi__pattern_clear(&vq);
  dvi__pattern_clear(&mixed);
  dvi__pattern_clear(&diagonal);
  return status;
}

static dvi_status locate_blocks(dvi__action *a)
{
  const dvi_system *system = a->system;
  a->block = DVI_NEW(dvi__block, dvi__pattern_entries(&a->joint));
  if (a->block == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for the Jacobian");
  for (int j = 0; j < a->n; j++)
    for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++) {
      const int i = a->joint.row[e];
      a->block[e] = (dvi__block){dvi__pattern_find(&system->qq, i, j), dvi__pattern_find(&system->qv, i, j),
                                 dvi__pattern_find(&system->qv, j, i), dvi__pattern_find(&system->vv, i, j)};
    }
  return DVI_OK;
}

/* Every entry of the joint pattern becomes a full s x s block: column (j,l) holds rows (i,k). */
static dvi_status expand_pattern(dvi__action *a)
{
  const int s = a->s, columns = a->n * s;
  const size_t entries = (size_t)dvi__pattern_entries(&a->joint) * (size_t)s * (size_t)s;
  if (entries > 0x7fffffff)
    return dvi__fail(DVI_BAD_SIZE, "action: the Jacobian would have %zu entries; declare sparse Hessians", entries);
  a->pattern = (dvi__pattern){columns, columns, DVI_NEW(int, columns + 1), DVI_NEW(int, entries)};
  if (a->pattern.start == NULL || a->pattern.row == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for a Jacobian of %zu entries", entries);
  int at = 0;
  for (int j = 0; j < a->n; j++)
    for (int l = 0; l < s; l++) {
      for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++)
        for (int k = 0; k < s; k++) a->pattern.row[at++] = a->joint.row[e] * s + k;
      a->pattern.start[j * s + l + 1] = at;
    }
  return DVI_OK;
}

dvi_status dvi__action_prepare_jacobian(dvi__action *a)
{
  const dvi_system *system = a->system;
  const size_t r = (size_t)a->r;
  DVI_TRY(join(a));
  DVI_TRY(locate_blocks(a));
  DVI_TRY(expand_pattern(a));
  a->H_qq = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->qq) * r);
  a->H_qv = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->qv) * r);
  a->H_vv = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->vv) * r);
  if (a->H_qq && a->H_qv && a->H_vv) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for Hessians at %d nodes", a->r);
}

/* x[j] += factor * H[j] * table[j], where the Hessian has this entry. */
static void accumulate(int r, const double *H, int entry, double factor, const double *table, double *x)
{
  if (entry < 0) return;
  H += (size_t)entry * (size_t)r;
  for (int j = 0; j < r; j++) x[j] += factor * H[j] * table[j];
}

void dvi__action_weigh_hessian(const dvi__action *a, const dvi__block *block, const double *f, const double *df, double *in_q,
                               double *in_v)
{
  const int r = a->r;
  for (int j = 0; j < r; j++) in_q[j] = in_v[j] = 0;
  accumulate(r, a->H_qq, block->qq, a->h, f, in_q);
  accumulate(r, a->H_qv, block->qv, 1.0, df, in_q);
  accumulate(r, a->H_qv, block->vq, 1.0, f, in_v);
  accumulate(r, a->H_vv, block->vv, 1.0 / a->h, df, in_v);
  for (int j = 0; j < r; j++) in_q[j] *= a->weight[j], in_v[j] *= a->weight[j];
}

/* Column l of a block: sum_j b_j [ (psi_k - psi_k(1)) (h L_qq psi_l + L_qv psi_l') + psi_k' (L_vq psi_l + L_vv psi_l'/h) ]. */
static void block_column(const dvi__action *a, const dvi__block *block, int l, double *column)
{
  const int r = a->r;
  double *in_q = a->line, *in_v = a->line + r;
  dvi__action_weigh_hessian(a, block, a->psi + l * a->lanes, a->dpsi + l * a->lanes, in_q, in_v);
  for (int k = 0; k < a->s; k++) {
    const double *bar = a->bar + k * a->lanes, *slope = a->dpsi + k * a->lanes;
    double sum = 0;
    for (int j = 0; j < r; j++) sum += bar[j] * in_q[j] + slope[j] * in_v[j];
    column[k] = sum;
  }
}

dvi_status dvi__action_jacobian(dvi__action *a, const double *Y, double *values)
{
  const size_t s = (size_t)a->s;
  dvi__action_stages(a, Y);
  DVI_TRY(dvi__lagrangian_hessian(a->evaluator, a->r, a->t, a->Q, a->V, a->H_qq, a->H_qv, a->H_vv));
  for (int j = 0; j < a->n; j++) {
    const int first = a->joint.start[j], length = a->joint.start[j + 1] - first;
    double *column = values + s * s * (size_t)first;
    for (int l = 0; l < a->s; l++)
      for (int e = first; e < first + length; e++, column += s) block_column(a, &a->block[e], l, column);
  }
  return DVI_OK;
}
