#include "step/element/user_element.h"

#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"

struct dvi__user_element {
  /* in which every coordinate has all functions: those that it has not got stay 0 */
  dvi__action *action;
  dvi__shapes shapes;
  int *first;           /* [n+1] of a coordinate's unknowns */
  dvi__pattern pattern; /* of the Jacobian */
  double h;             /* that the tables are for; 0: none */
  double *psi, *dpsi;   /* [functions] work */
  double *rest;         /* [n] zeros: the velocity at which rows are scaled */
  double *dq_low;       /* [n] */
  double *at;           /* [n*functions] of the last residual */
  double *whole;        /* [n*functions] work */
};

static int functions_of(const dvi__user_element *s, int i)
{
  return s->first[i + 1] - s->first[i];
}

static int is_present(const dvi__user_element *s, int k)
{
  return s->shapes.present(s->shapes.of, k);
}

/* ---- making it ---- */

static int allocate(dvi__user_element *s, const char *has_all, int fewest)
{
  const size_t n = (size_t)s->action->n, count = (size_t)s->shapes.functions;
  s->first = DVI_NEW(int, n + 1);
  s->psi = DVI_NEW(double, count);
  s->dpsi = DVI_NEW(double, count);
  s->rest = DVI_NEW(double, n);
  s->dq_low = DVI_NEW(double, n);
  s->at = DVI_NEW(double, n *count);
  s->whole = DVI_NEW(double, n *count);
  if (!s->first || !s->psi || !s->dpsi || !s->rest || !s->dq_low || !s->at || !s->whole) return 0;
  for (size_t i = 0; i < n; i++)
    s->first[i + 1] = s->first[i] + (has_all[i] ? s->shapes.functions : fewest);
  return 1;
}

static dvi_status fill(dvi__user_element *s, const dvi_system *system, const char *has_all,
                       int fewest, dvi_counters *counters)
{
  const int functions = s->shapes.functions, points = s->shapes.points;
  DVI_TRY(dvi__joint_check(system, fewest, functions > points ? functions : points));
  DVI_TRY(dvi__action_create_by_user(system, s->shapes.functions, s->shapes.points, counters,
                                     &s->action));
  if (!allocate(s, has_all, fewest))
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d shapes", s->shapes.functions);
  DVI_TRY(dvi__action_prepare_hessians(s->action));
  return dvi__pattern_uneven_blocks(&s->action->joint, s->first, &s->pattern);
}

dvi_status dvi__user_element_create(const dvi_system *system, const dvi__shapes *shapes,
                                    const char *has_all, int fewest, dvi_counters *counters,
                                    dvi__user_element **shaped)
{
  dvi__user_element *s = *shaped = DVI_NEW(dvi__user_element, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  s->shapes = *shapes;
  const dvi_status status = fill(s, system, has_all, fewest, counters);
  if (status != DVI_OK) dvi__user_element_destroy(shaped);
  return status;
}

void dvi__user_element_destroy(dvi__user_element **shaped)
{
  dvi__user_element *s = *shaped;
  if (s == NULL) return;
  dvi__action_destroy(&s->action);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->first);
  dvi__release(s->psi);
  dvi__release(s->dpsi);
  dvi__release(s->rest);
  dvi__release(s->dq_low);
  dvi__release(s->at);
  dvi__release(s->whole);
  dvi__release(s);
  *shaped = NULL;
}

const dvi__pattern *dvi__user_element_pattern(const dvi__user_element *shaped)
{
  return &shaped->pattern;
}

dvi__evaluator *dvi__user_element_evaluator(const dvi__user_element *shaped)
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

static void set_length(dvi__user_element *s, double h)
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

void dvi__user_element_renew(dvi__user_element *shaped)
{
  shaped->h = 0;
}

void dvi__user_element_place(dvi__user_element *shaped, double t0, double h, const double *q0,
                             const double *p0)
{
  set_length(shaped, h);
  dvi__action_place(shaped->action, t0, h, q0, p0);
}

/* ---- the step ---- */

/* All coordinates' coefficients [n*functions] from the unknowns. */
static void widen(const dvi__user_element *s, const double *Y, double *whole)
{
  const size_t count = (size_t)s->shapes.functions;
  memset(whole, 0, (size_t)s->action->n * count * sizeof *whole);
  for (int i = 0; i < s->action->n; i++)
    memcpy(whole + (size_t)i * count, Y + s->first[i], (size_t)functions_of(s, i) * sizeof *Y);
}

dvi_status dvi__user_element_residual(dvi__user_element *shaped, const double *Y, double *R)
{
  const dvi__action *a = shaped->action;
  widen(shaped, Y, shaped->at);
  DVI_TRY(dvi__action_residual(shaped->action, shaped->at, shaped->whole));
  for (int i = 0; i < a->n; i++)
    for (int k = 0, row = shaped->first[i]; row < shaped->first[i + 1]; k++, row++)
      R[row] = is_present(shaped, k) ? shaped->whole[i * a->s + k] : Y[row];
  return DVI_OK;
}

/* Rows and columns of functions that are not present become those of the identity. */
static void mask_block(const dvi__user_element *s, int i, int j, int l, double *column)
{
  for (int k = 0; k < functions_of(s, i); k++)
    if (!is_present(s, k) || !is_present(s, l)) column[k] = i == j && k == l;
}

dvi_status dvi__user_element_jacobian(dvi__user_element *shaped, const double *Y, double *values)
{
  const dvi__action *a = shaped->action;
  widen(shaped, Y, shaped->whole);
  DVI_TRY(dvi__action_hessians(shaped->action, shaped->whole));
  for (int j = 0; j < a->n; j++)
    for (int l = 0; l < functions_of(shaped, j); l++)
      for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++) {
        const int i = a->joint.row[e];
        dvi__action_block_column(a, &a->block[e], l, functions_of(shaped, i), values);
        mask_block(shaped, i, j, l, values);
        values += functions_of(shaped, i);
      }
  return DVI_OK;
}

dvi_status dvi__user_element_scale(dvi__user_element *shaped, double *scale)
{
  const dvi__action *a = shaped->action;
  const double *L_vv = NULL;
  if (a->system->lagrangian != NULL)
    DVI_TRY(dvi__velocity_hessian(a->evaluator, a->t0, a->q0, shaped->rest, &L_vv));
  dvi__action_scale_by(a, L_vv, shaped->whole);
  for (int i = 0; i < a->n; i++)
    for (int k = 0, row = shaped->first[i]; row < shaped->first[i + 1]; k++, row++)
      scale[row] = is_present(shaped, k) ? shaped->whole[i * a->s] : 1;
  return DVI_OK;
}

void dvi__user_element_straight(const dvi__user_element *shaped, const double *v, double *Y)
{
  const dvi__action *a = shaped->action;
  memset(Y, 0, (size_t)shaped->pattern.columns * sizeof *Y);
  for (int i = 0; i < a->n; i++) Y[shaped->first[i]] = a->h * v[i];
}

/* After a step of another length its mean velocity is all that is taken over. */
void dvi__user_element_continue(dvi__user_element *shaped, double ratio, const double *last,
                                double *Y)
{
  const dvi__action *a = shaped->action;
  const size_t count = (size_t)a->s;
  memset(Y, 0, (size_t)shaped->pattern.columns * sizeof *Y);
  widen(shaped, last, shaped->whole);
  for (int i = 0; i < a->n; i++) {
    const double *from = shaped->whole + (size_t)i * count;
    double *to = Y + shaped->first[i];
    if (ratio == 1)
      shaped->shapes.next(shaped->shapes.of, from, shaped->psi);
    else
      to[0] = ratio * from[0];
    for (int k = 0; ratio == 1 && k < functions_of(shaped, i); k++)
      to[k] = is_present(shaped, k) ? shaped->psi[k] : 0;
  }
}

void dvi__user_element_ends(dvi__user_element *shaped, const double *Y, double *dq, double *dp)
{
  const size_t count = (size_t)shaped->action->n * (size_t)shaped->action->s;
  widen(shaped, Y, shaped->whole);
  dvi__action_ends(shaped->action, shaped->whole, dq, shaped->dq_low, dp); /* 0 without sweeps */
  for (size_t k = 0; k < count; k++) shaped->at[k] = shaped->whole[k] - shaped->at[k];
  dvi__action_move_ends(shaped->action, shaped->at, dp);
}

dvi_status dvi__user_element_duration(dvi__user_element *shaped, const double *Y, double *duration)
{
  widen(shaped, Y, shaped->whole);
  return dvi__action_duration(shaped->action, shaped->whole, duration);
}

void dvi__user_element_path(dvi__user_element *shaped, const double *Y, double h, double tau,
                            double *offset, double *v)
{
  const dvi__action *a = shaped->action;
  set_length(shaped, h);
  shaped->shapes.path(shaped->shapes.of, tau, shaped->psi, shaped->dpsi);
  for (int i = 0; i < a->n; i++) {
    const double *own = Y + shaped->first[i];
    double sum[2] = {0, 0};
    for (int k = 0; k < functions_of(shaped, i); k++) {
      sum[0] += shaped->psi[k] * own[k];
      sum[1] += shaped->dpsi[k] * own[k];
    }
    if (offset != NULL) offset[i] = sum[0];
    if (v != NULL) v[i] = sum[1] / h;
  }
}
