#include "action/shaped.h"

#include <string.h>

#include "action/action_struct.h"
#include "core/memory.h"
#include "core/status.h"

struct dvi__shaped {
  dvi__action *action;
  dvi__shapes shapes;
  int *functions;     /* [n] */
  double h;           /* that the tables are for; 0: none */
  double *psi, *dpsi; /* [functions] work */
  double *rest;       /* [n] zeros: the velocity at which rows are scaled */
  double *dq_low;     /* [n] */
  double *at;         /* [unknowns] of the last residual */
};

static int is_there(const dvi__shaped *s, int i, int k)
{
  return k < s->functions[i] && s->shapes.present(s->shapes.of, k);
}

/* ---- making it ---- */

static int allocate(dvi__shaped *s, const int *functions)
{
  const size_t n = (size_t)s->action->n, count = (size_t)s->shapes.functions;
  s->functions = DVI_NEW(int, n);
  s->psi = DVI_NEW(double, count);
  s->dpsi = DVI_NEW(double, count);
  s->rest = DVI_NEW(double, n);
  s->dq_low = DVI_NEW(double, n);
  s->at = DVI_NEW(double, n *count);
  if (!s->functions || !s->psi || !s->dpsi || !s->rest || !s->dq_low || !s->at) return 0;
  memcpy(s->functions, functions, n * sizeof *functions);
  return 1;
}

static dvi_status fill(dvi__shaped *s, const dvi_system *system, const int *functions, dvi_counters *counters)
{
  DVI_TRY(dvi__action_create_shaped(system, s->shapes.functions, s->shapes.points, counters, &s->action));
  if (!allocate(s, functions)) return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d shapes", s->shapes.functions);
  return dvi__action_prepare_jacobian(s->action);
}

dvi_status dvi__shaped_create(const dvi_system *system, const dvi__shapes *shapes, const int *functions, dvi_counters *counters,
                              dvi__shaped **shaped)
{
  dvi__shaped *s = *shaped = DVI_NEW(dvi__shaped, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  s->shapes = *shapes;
  const dvi_status status = fill(s, system, functions, counters);
  if (status != DVI_OK) dvi__shaped_destroy(shaped);
  return status;
}

void dvi__shaped_destroy(dvi__shaped **shaped)
{
  dvi__shaped *s = *shaped;
  if (s == NULL) return;
  dvi__action_destroy(&s->action);
  dvi__release(s->functions);
  dvi__release(s->psi);
  dvi__release(s->dpsi);
  dvi__release(s->rest);
  dvi__release(s->dq_low);
  dvi__release(s->at);
  dvi__release(s);
  *shaped = NULL;
}

const dvi__pattern *dvi__shaped_pattern(const dvi__shaped *shaped)
{
  return dvi__action_pattern(shaped->action);
}

dvi__evaluator *dvi__shaped_evaluator(const dvi__shaped *shaped)
{
  return dvi__action_evaluator(shaped->action);
}

/* ---- the tables of a length ---- */

static void fill_point(dvi__action *a, int j, const double *psi, const double *dpsi)
{
  for (int k = 0; k < a->s; k++) {
    a->psi[k * a->lanes + j] = psi[k];
    a->bar[k * a->lanes + j] = a->bar_row[j * a->path_lanes + k] = psi[k] - a->end[k];
    a->dpsi[k * a->lanes + j] = a->slope_row[j * a->path_lanes + k] = dpsi[k];
  }
}

static void set_length(dvi__shaped *s, double h)
{
  dvi__action *a = s->action;
  if (s->h == h) return;
  s->h = h;
  s->shapes.set(s->shapes.of, h);
  s->shapes.path(s->shapes.of, 1, a->end, NULL);
  for (int j = 0; j < a->r; j++) {
    s->shapes.point(s->shapes.of, j, &a->node[j], &a->weight[j], s->psi, s->dpsi);
    fill_point(a, j, s->psi, s->dpsi);
  }
}

void dvi__shaped_place(dvi__shaped *shaped, double t0, double h, const double *q0, const double *p0)
{
  set_length(shaped, h);
  dvi__action_place(shaped->action, t0, h, q0, p0);
}

/* ---- the step ---- */

dvi_status dvi__shaped_residual(dvi__shaped *shaped, const double *Y, double *R)
{
  const dvi__action *a = shaped->action;
  memcpy(shaped->at, Y, (size_t)dvi__action_unknowns(a) * sizeof *Y);
  DVI_TRY(dvi__action_residual(shaped->action, Y, R));
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->s; k++)
      if (!is_there(shaped, i, k)) R[i * a->s + k] = Y[i * a->s + k];
  return DVI_OK;
}

dvi_status dvi__shaped_jacobian(dvi__shaped *shaped, const double *Y, double *values)
{
  const dvi__action *a = shaped->action;
  DVI_TRY(dvi__action_jacobian(shaped->action, Y, values));
  for (int column = 0; column < a->pattern.columns; column++)
    for (int e = a->pattern.start[column]; e < a->pattern.start[column + 1]; e++) {
      const int row = a->pattern.row[e];
      if (!is_there(shaped, column / a->s, column % a->s) || !is_there(shaped, row / a->s, row % a->s)) values[e] = row == column;
    }
  return DVI_OK;
}

dvi_status dvi__shaped_scale(dvi__shaped *shaped, double *scale)
{
  const dvi__action *a = shaped->action;
  const double *L_vv = NULL;
  if (a->system->lagrangian != NULL) DVI_TRY(dvi__velocity_hessian(a->evaluator, a->t0, a->q0, shaped->rest, &L_vv));
  dvi__action_scale_by(a, L_vv, scale);
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->s; k++)
      if (!is_there(shaped, i, k)) scale[i * a->s + k] = 1;
  return DVI_OK;
}

void dvi__shaped_straight(const dvi__shaped *shaped, const double *v, double *Y)
{
  const dvi__action *a = shaped->action;
  memset(Y, 0, (size_t)dvi__action_unknowns(a) * sizeof *Y);
  for (int i = 0; i < a->n; i++) Y[i * a->s] = a->h * v[i];
}

/* After a step of another length its mean velocity is all that is taken over. */
void dvi__shaped_continue(dvi__shaped *shaped, double ratio, const double *last, double *Y)
{
  const dvi__action *a = shaped->action;
  memset(Y, 0, (size_t)dvi__action_unknowns(a) * sizeof *Y);
  for (int i = 0; i < a->n; i++) {
    const double *from = last + i * a->s;
    double *to = Y + i * a->s;
    if (ratio == 1)
      shaped->shapes.next(shaped->shapes.of, from, to);
    else
      to[0] = ratio * from[0];
    for (int k = 0; k < a->s; k++)
      if (!is_there(shaped, i, k)) to[k] = 0;
  }
}

void dvi__shaped_ends(dvi__shaped *shaped, const double *Y, double *dq, double *dp)
{
  dvi__action_ends(shaped->action, Y, dq, shaped->dq_low, dp); /* 0 without sweeps */
  for (int k = 0; k < dvi__action_unknowns(shaped->action); k++) shaped->at[k] = Y[k] - shaped->at[k];
  dvi__action_move_ends(shaped->action, shaped->at, dp);
}

void dvi__shaped_path(dvi__shaped *shaped, const double *Y, double h, double tau, double *offset, double *v)
{
  const dvi__action *a = shaped->action;
  set_length(shaped, h);
  shaped->shapes.path(shaped->shapes.of, tau, shaped->psi, shaped->dpsi);
  for (int i = 0; i < a->n; i++) {
    double sum[2] = {0, 0};
    for (int k = 0; k < a->s; k++) {
      sum[0] += shaped->psi[k] * Y[i * a->s + k];
      sum[1] += shaped->dpsi[k] * Y[i * a->s + k];
    }
    if (offset != NULL) offset[i] = sum[0];
    if (v != NULL) v[i] = sum[1] / h;
  }
}
