#include "step/element/user_element.h"

#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"

struct dvi__user_element {
  /* element in which every coordinate has all functions; those that a coordinate lacks stay 0 */
  dvi__action *action;
  dvi__shapes shapes;
  int *first;           /* [n+1] first unknown of a coordinate */
  dvi__pattern pattern; /* pattern of the Jacobian */
  double h;             /* step of the tables, 0 if none */
  double *psi, *dpsi;   /* [functions] work */
  double *rest;         /* [n] zeros, the velocity at which rows are scaled */
  double *dq_low;       /* [n] */
  double *at;           /* [n*functions] point of the last residual */
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

/* ---- create ---- */

static int user_element_allocate(dvi__user_element *s, const char *has_all, int fewest)
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

static dvi_status user_element_fill(dvi__user_element *s, const dvi_system *system,
                                    const char *has_all, int fewest, dvi_counters *counters)
{
  const int functions = s->shapes.functions, points = s->shapes.points;
  DVI_TRY(dvi__joint_check(system, fewest, functions > points ? functions : points));
  DVI_TRY(dvi__system_has_hessians(system));
  DVI_TRY(dvi__action_create_by_user(system, s->shapes.functions, s->shapes.points, counters,
                                     &s->action));
  if (!user_element_allocate(s, has_all, fewest))
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d shapes", s->shapes.functions);
  DVI_TRY(dvi__action_prepare_hessians(s->action));
  return dvi__pattern_uneven_blocks(&s->action->joint, s->first, &s->pattern);
}

dvi_status dvi__user_element_create(const dvi_system *system, const dvi__shapes *shapes,
                                    const char *has_all, int fewest, dvi_counters *counters,
                                    dvi__user_element **element)
{
  dvi__user_element *s = *element = DVI_NEW(dvi__user_element, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  s->shapes = *shapes;
  const dvi_status status = user_element_fill(s, system, has_all, fewest, counters);
  if (status != DVI_OK) dvi__user_element_destroy(element);
  return status;
}

void dvi__user_element_destroy(dvi__user_element **element)
{
  dvi__user_element *s = *element;
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
  *element = NULL;
}

const dvi__pattern *dvi__user_element_pattern(const dvi__user_element *element)
{
  return &element->pattern;
}

dvi__evaluator *dvi__user_element_evaluator(const dvi__user_element *element)
{
  return dvi__action_evaluator(element->action);
}

/* ---- tables of a length ---- */

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

void dvi__user_element_renew(dvi__user_element *element)
{
  element->h = 0;
}

void dvi__user_element_place(dvi__user_element *element, double t0, double h, const double *q0,
                             const double *p0)
{
  set_length(element, h);
  dvi__action_place(element->action, t0, h, q0, p0);
}

/* ---- step ---- */

/* Expand the unknowns to all coordinates' coefficients [n*functions]. */
static void user_element_expand(const dvi__user_element *s, const double *Y, double *whole)
{
  const size_t count = (size_t)s->shapes.functions;
  memset(whole, 0, (size_t)s->action->n * count * sizeof *whole);
  for (int i = 0; i < s->action->n; i++)
    memcpy(whole + (size_t)i * count, Y + s->first[i], (size_t)functions_of(s, i) * sizeof *Y);
}

dvi_status dvi__user_element_residual(dvi__user_element *element, const double *Y, double *R)
{
  const dvi__action *a = element->action;
  user_element_expand(element, Y, element->at);
  DVI_TRY(dvi__action_residual(element->action, element->at, element->whole));
  for (int i = 0; i < a->n; i++)
    for (int k = 0, row = element->first[i]; row < element->first[i + 1]; k++, row++)
      R[row] = is_present(element, k) ? element->whole[i * a->s + k] : Y[row];
  return DVI_OK;
}

/* Make rows and columns of functions that are not present those of the identity. */
static void mask_block(const dvi__user_element *s, int i, int j, int l, double *column)
{
  for (int k = 0; k < functions_of(s, i); k++)
    if (!is_present(s, k) || !is_present(s, l)) column[k] = i == j && k == l;
}

dvi_status dvi__user_element_jacobian(dvi__user_element *element, const double *Y, double *values)
{
  const dvi__action *a = element->action;
  user_element_expand(element, Y, element->whole);
  DVI_TRY(dvi__action_hessians(element->action, element->whole));
  for (int j = 0; j < a->n; j++)
    for (int l = 0; l < functions_of(element, j); l++)
      for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++) {
        const int i = a->joint.row[e];
        dvi__action_block_column(a, &a->block[e], l, functions_of(element, i), values);
        mask_block(element, i, j, l, values);
        values += functions_of(element, i);
      }
  return DVI_OK;
}

dvi_status dvi__user_element_scale(dvi__user_element *element, double *scale)
{
  const dvi__action *a = element->action;
  const double *L_vv = NULL;
  if (a->system->lagrangian != NULL)
    DVI_TRY(dvi__velocity_hessian(a->evaluator, a->t0, a->q0, element->rest, &L_vv));
  dvi__action_scale_by(a, L_vv, element->whole);
  for (int i = 0; i < a->n; i++)
    for (int k = 0, row = element->first[i]; row < element->first[i + 1]; k++, row++)
      scale[row] = is_present(element, k) ? element->whole[i * a->s] : 1;
  return DVI_OK;
}

void dvi__user_element_straight(const dvi__user_element *element, const double *v, double *Y)
{
  const dvi__action *a = element->action;
  memset(Y, 0, (size_t)element->pattern.columns * sizeof *Y);
  for (int i = 0; i < a->n; i++) Y[element->first[i]] = a->h * v[i];
}

/* After a step of another length only the mean velocity is taken over. */
void dvi__user_element_continue(dvi__user_element *element, double ratio, const double *last,
                                double *Y)
{
  const dvi__action *a = element->action;
  const size_t count = (size_t)a->s;
  memset(Y, 0, (size_t)element->pattern.columns * sizeof *Y);
  user_element_expand(element, last, element->whole);
  for (int i = 0; i < a->n; i++) {
    const double *from = element->whole + (size_t)i * count;
    double *to = Y + element->first[i];
    if (ratio == 1)
      element->shapes.next(element->shapes.of, from, element->psi);
    else
      to[0] = ratio * from[0];
    for (int k = 0; ratio == 1 && k < functions_of(element, i); k++)
      to[k] = is_present(element, k) ? element->psi[k] : 0;
  }
}

void dvi__user_element_ends(dvi__user_element *element, const double *Y, double *dq, double *dp)
{
  const size_t count = (size_t)element->action->n * (size_t)element->action->s;
  user_element_expand(element, Y, element->whole);
  /* 0 without fixed-point iteration */
  dvi__action_ends(element->action, element->whole, dq, element->dq_low, dp);
  for (size_t k = 0; k < count; k++) element->at[k] = element->whole[k] - element->at[k];
  dvi__action_move_ends(element->action, element->at, dp);
}

dvi_status dvi__user_element_duration(dvi__user_element *element, const double *Y, double *duration)
{
  user_element_expand(element, Y, element->whole);
  return dvi__action_duration(element->action, element->whole, duration);
}

void dvi__user_element_path(dvi__user_element *element, const double *Y, double h, double tau,
                            double *offset, double *v)
{
  const dvi__action *a = element->action;
  set_length(element, h);
  element->shapes.path(element->shapes.of, tau, element->psi, element->dpsi);
  for (int i = 0; i < a->n; i++) {
    const double *own = Y + element->first[i];
    double sum[2] = {0, 0};
    for (int k = 0; k < functions_of(element, i); k++) {
      sum[0] += element->psi[k] * own[k];
      sum[1] += element->dpsi[k] * own[k];
    }
    if (offset != NULL) offset[i] = sum[0];
    if (v != NULL) v[i] = sum[1] / h;
  }
}
