#include "step/onestep/stacked_shot.h"

#include <math.h>
#include <string.h>

#include "step/onestep/stacked_struct.h"
#include "step/joint.h"
#include "core/memory.h"
#include "core/status.h"
#include "system/rescale/transformed.h"

/* ---- create ---- */

static double **stacked_owned_array(dvi__stacked_shot *s, int i)
{
  double **const all[] = {&s->unit, &s->x, &s->rate, &s->kappa, &s->slope, &s->point, &s->turned};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status stacked_allocate(dvi__stacked_shot *s)
{
  const size_t z = 2 * (size_t)s->n, pieces = (size_t)s->course.pieces,
               stages = pieces * (size_t)s->method.stages;
  const size_t size[] = {z, z * (size_t)s->blocks, z * stages, z * stages, z * (pieces + 1), z, z};
  for (int i = 0; stacked_owned_array(s, i) != NULL; i++) {
    *stacked_owned_array(s, i) = DVI_NEW(double, size[i]);
    if (*stacked_owned_array(s, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", s->method.stages,
                       s->n);
  }
  return DVI_OK;
}

static dvi_status stacked_initialise(dvi__stacked_shot *s, const dvi_system *system,
                                     dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(system, 2, 2 * s->blocks));
  DVI_TRY(dvi__vector_field_create(system, dvi__stack_node_point(s, s->course.pieces) + 1, counters,
                                   &s->field));
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__GRADIENTS, counters, &s->evaluator));
  DVI_TRY(dvi__stacked_shot_lay_out(s, system));
  return stacked_allocate(s);
}

dvi_status dvi__stacked_shot_create(const dvi_system *system, const dvi__runge_kutta *method,
                                    const dvi__course *course, dvi_counters *counters,
                                    dvi__stacked_shot **step)
{
  *step = NULL;
  dvi__stacked_shot *s = DVI_NEW(dvi__stacked_shot, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  s->system = system;
  s->method = *method;
  s->course = *course;
  s->n = system->n;
  s->blocks = dvi__stack_start(s) + 1;
  const dvi_status status = stacked_initialise(s, system, counters);
  if (status != DVI_OK) dvi__stacked_shot_destroy(&s);
  *step = s;
  return status;
}

void dvi__stacked_shot_destroy(dvi__stacked_shot **step)
{
  dvi__stacked_shot *s = *step;
  if (s == NULL) return;
  for (int i = 0; stacked_owned_array(s, i) != NULL; i++) dvi__release(*stacked_owned_array(s, i));
  dvi__stacked_shot_clear_layout(s);
  dvi__vector_field_destroy(&s->field);
  dvi__evaluator_destroy(&s->evaluator);
  dvi__release(s);
  *step = NULL;
}

const dvi__pattern *dvi__stacked_shot_pattern(const dvi__stacked_shot *s)
{
  return &s->pattern;
}

/* ---- units ---- */

/* Return the size of component i of a block, in units of q. States have (q,p), costates (p,q), and
 * the start (p,p). */
static double stacked_unit_of(const dvi__stacked_shot *s, int block, int i)
{
  const int half = s->course.pieces * (s->method.stages + 1);
  const int is_momentum = block == 2 * half || (block < half ? i >= s->n : i < s->n);
  return is_momentum ? s->unit[i % s->n] : 1;
}

/* Return the size of a row. The rows of the start are costates. */
static double unit_of_row(const dvi__stacked_shot *s, int block, int i)
{
  return block == dvi__stack_start(s) ? (i < s->n ? s->unit[i] : 1) : stacked_unit_of(s, block, i);
}

static double *stacked_at(const dvi__stacked_shot *s, double *numbers, int index)
{
  return numbers + (size_t)index * 2 * (size_t)s->n;
}

/* Take the unknowns. If all numbers are those of the last call, all results remain valid. */
static void stacked_take_unknowns(dvi__stacked_shot *s, const double *x)
{
  for (int b = 0; b < s->blocks; b++)
    for (int i = 0; i < 2 * s->n; i++) {
      const double number = x[b * 2 * s->n + i] * stacked_unit_of(s, b, i);
      if (number != stacked_at(s, s->x, b)[i]) s->known = 0;
      stacked_at(s, s->x, b)[i] = number;
    }
}

static void stacked_give(dvi__stacked_shot *s, double *x)
{
  for (int b = 0; b < s->blocks; b++)
    for (int i = 0; i < 2 * s->n; i++)
      x[b * 2 * s->n + i] = stacked_at(s, s->x, b)[i] / stacked_unit_of(s, b, i);
}

/* ---- points ---- */

static double stacked_length_of(const dvi__stacked_shot *s, int piece)
{
  return s->h * (s->course.c[piece + 1] - s->course.c[piece]);
}

/* Add factor x to y, both [2n]. */
static void stacked_add(const dvi__stacked_shot *s, double factor, const double *x, double *y)
{
  if (factor == 0) return;
  for (int i = 0; i < 2 * s->n; i++) y[i] += factor * x[i];
}

/* Write the motion from the start to node m. */
static void go_to_node(dvi__stacked_shot *s, int m)
{
  memset(s->point, 0, 2 * (size_t)s->n * sizeof *s->point);
  if (m > 0) stacked_add(s, 1, stacked_at(s, s->x, dvi__stack_node(s, m)), s->point);
}

static dvi_status stacked_place(dvi__stacked_shot *s, int point, double t, double *rate)
{
  const double *p = stacked_at(s, s->x, dvi__stack_start(s)) + s->n;
  for (int i = 0; i < s->n; i++) {
    s->point[i] += s->q0[i];
    s->point[s->n + i] += p[i];
  }
  return dvi__vector_field_place(s->field, point, t, s->point, s->point + s->n, rate);
}

static dvi_status place_stage(dvi__stacked_shot *s, int m, int j)
{
  const dvi__runge_kutta *rk = &s->method;
  const int point = dvi__stack_stage_point(s, m, j);
  const double h = stacked_length_of(s, m);
  double *rate = stacked_at(s, s->rate, point);
  go_to_node(s, m);
  for (int k = 0; k < rk->stages; k++)
    stacked_add(s, rk->a[j][k], stacked_at(s, s->x, dvi__stack_W(s, m, k)), s->point);
  const dvi_status status = stacked_place(s, point, s->t0 + s->course.c[m] * s->h + rk->c[j] * h,
                                          rate);
  if (status != DVI_OK)
    return dvi__fail_in(status, "stage %d of the one-step method from node %d on", j + 1, m + 1);
  for (int i = 0; i < 2 * s->n; i++) rate[i] *= h;
  return DVI_OK;
}

/* Place all points. The solver asks for the Jacobian and for the residual at the same point. */
static dvi_status place_all(dvi__stacked_shot *s)
{
  if (s->known) return DVI_OK;
  for (int m = 0; m < s->course.pieces; m++)
    for (int j = 0; j < s->method.stages; j++) DVI_TRY(place_stage(s, m, j));
  DVI_TRY(dvi__vector_field_differentiate(s->field, 0, s->course.pieces * s->method.stages));
  for (int m = 0; m <= s->course.pieces; m++) {
    if (s->course.b[m] == 0) continue;
    go_to_node(s, m);
    DVI_TRY(
        stacked_place(s, dvi__stack_node_point(s, m), s->t0 + s->course.c[m] * s->h, s->turned));
    DVI_TRY(dvi__vector_field_differentiate(s->field, dvi__stack_node_point(s, m), 1));
  }
  s->known = 1;
  return DVI_OK;
}

/* ---- residual ---- */

/* Compute kappa at the stages, and h b L_z at the nodes. */
static dvi_status stacked_pull_costates(dvi__stacked_shot *s)
{
  const int n = s->n;
  for (int m = 0; m < s->course.pieces; m++)
    for (int j = 0; j < s->method.stages; j++) {
      const double *Gamma = stacked_at(s, s->x, dvi__stack_Gamma(s, m, j));
      const int point = dvi__stack_stage_point(s, m, j);
      DVI_TRY(dvi__vector_field_select(s->field, point));
      dvi__vector_field_pull(s->field, stacked_length_of(s, m), Gamma,
                             stacked_at(s, s->kappa, point));
    }
  memset(s->slope, 0, 2 * (size_t)n * ((size_t)s->course.pieces + 1) * sizeof *s->slope);
  for (int m = 0; m <= s->course.pieces; m++) {
    if (s->course.b[m] == 0) continue;
    DVI_TRY(dvi__vector_field_select(s->field, dvi__stack_node_point(s, m)));
    dvi__vector_field_lagrangian(s->field, s->point);
    stacked_add(s, s->h * s->course.b[m], s->point, stacked_at(s, s->slope, m));
  }
  return DVI_OK;
}

/* Return lambda_m without -p1. */
static const double *stacked_lambda(dvi__stacked_shot *s, int m)
{
  return m < s->course.pieces ? stacked_at(s, s->x, dvi__stack_lambda(s, m))
                              : stacked_at(s, s->slope, m);
}

static void piece_rows(dvi__stacked_shot *s, int m, double *R)
{
  const dvi__runge_kutta *rk = &s->method;
  double *node = stacked_at(s, R, dvi__stack_node(s, m + 1)),
         *costate = stacked_at(s, R, dvi__stack_lambda(s, m));
  const double *p1 = stacked_at(s, s->x, dvi__stack_start(s));
  stacked_add(s, 1, stacked_at(s, s->x, dvi__stack_node(s, m + 1)), node);
  if (m > 0) stacked_add(s, -1, stacked_at(s, s->x, dvi__stack_node(s, m)), node);
  stacked_add(s, 1, stacked_lambda(s, m), costate);
  stacked_add(s, -1, stacked_lambda(s, m + 1), costate);
  stacked_add(s, -1, stacked_at(s, s->slope, m), costate);
  for (int j = 0; j < rk->stages; j++) {
    const int point = dvi__stack_stage_point(s, m, j);
    double *W = stacked_at(s, R, dvi__stack_W(s, m, j)),
           *Gamma = stacked_at(s, R, dvi__stack_Gamma(s, m, j));
    stacked_add(s, 1, stacked_at(s, s->x, dvi__stack_W(s, m, j)), W);
    stacked_add(s, -1, stacked_at(s, s->rate, point), W);
    stacked_add(s, -rk->b[j], stacked_at(s, s->x, dvi__stack_W(s, m, j)), node);
    stacked_add(s, -1, stacked_at(s, s->kappa, point), costate);
    stacked_add(s, 1, stacked_at(s, s->x, dvi__stack_Gamma(s, m, j)), Gamma);
    stacked_add(s, -rk->b[j], stacked_lambda(s, m + 1), Gamma);
    for (int i = 0; i < s->n; i++) Gamma[i] += rk->b[j] * p1[i];
    for (int k = 0; k < rk->stages; k++)
      stacked_add(s, -rk->a[k][j], stacked_at(s, s->kappa, dvi__stack_stage_point(s, m, k)), Gamma);
  }
}

/* Exchange two rows, as row_of in stacked_pattern.c does. */
static void stacked_exchange_rows(dvi__stacked_shot *s, double *R)
{
  double *lambda_row = stacked_at(s, R, dvi__stack_lambda(s, 0)),
         *start_row = stacked_at(s, R, dvi__stack_start(s));
  for (int i = s->n; i < 2 * s->n; i++) {
    const double kept = lambda_row[i];
    lambda_row[i] = start_row[i];
    start_row[i] = kept;
  }
}

dvi_status dvi__stacked_shot_residual(void *step, const double *x, double *R)
{
  dvi__stacked_shot *s = step;
  const int z = 2 * s->n, start = dvi__stack_start(s);
  stacked_take_unknowns(s, x);
  DVI_TRY(place_all(s));
  DVI_TRY(stacked_pull_costates(s));
  memset(R, 0, (size_t)s->blocks * (size_t)z * sizeof *R);
  for (int m = 0; m < s->course.pieces; m++) piece_rows(s, m, R);
  stacked_add(s, 1, stacked_lambda(s, 0), stacked_at(s, R, start));
  for (int i = 0; i < s->n; i++)
    stacked_at(s, R, start)[i] += s->p0[i] - stacked_at(s, s->x, start)[i];
  for (int b = 0; b < s->blocks; b++)
    for (int i = 0; i < z; i++) stacked_at(s, R, b)[i] /= unit_of_row(s, b, i);
  stacked_exchange_rows(s, R);
  return DVI_OK;
}

/* Compute the ends from sums of the last residual's evaluations. They differ from the solution by
 * less than its unknowns do. */
void dvi__stacked_shot_ends(const dvi__stacked_shot *s, double *dq, double *dp)
{
  const int n = s->n;
  memset(dq, 0, (size_t)n * sizeof *dq);
  memset(dp, 0, (size_t)n * sizeof *dp);
  for (int m = 0; m < s->course.pieces; m++)
    for (int j = 0; j < s->method.stages; j++) {
      const int point = dvi__stack_stage_point(s, m, j);
      for (int i = 0; i < n; i++) {
        dq[i] += s->method.b[j] * stacked_at(s, s->rate, point)[i];
        dp[i] += stacked_at(s, s->kappa, point)[i];
      }
    }
  for (int m = 0; m <= s->course.pieces; m++)
    for (int i = 0; i < n; i++) dp[i] += stacked_at(s, s->slope, m)[i];
}

dvi_status dvi__stacked_shot_duration(dvi__stacked_shot *s, double *duration)
{
  dvi__monitor *monitor = dvi__transformed_monitor(dvi__transformed_of(s->system));
  double g;
  *duration = 0;
  for (int m = 0; m <= s->course.pieces; m++) {
    if (s->course.b[m] == 0) continue;
    go_to_node(s, m);
    for (int i = 0; i < s->n; i++) s->point[i] += s->q0[i];
    DVI_TRY(dvi__monitor_value(monitor, 1, s->point, &g));
    *duration += s->h * s->course.b[m] * g;
  }
  return DVI_OK;
}

/* ---- Jacobian ---- */

/* Compute H_zz at the selected point. */
static void stacked_hessian(dvi__stacked_shot *s)
{
  memset(s->point, 0, 2 * (size_t)s->n * sizeof *s->point);
  for (int c = 0; c < 2 * s->n; c++) {
    s->point[c] = 1;
    dvi__vector_field_product(s->field, s->point, s->turned);
    s->point[c] = 0;
    for (int e = s->joint.start[c]; e < s->joint.start[c + 1]; e++)
      s->H_zz[e] = s->turned[s->joint.row[e]];
  }
}

/* Return an entry of f_z = (H_pz, -H_qz), or of L_zz = (-H_qq, H_pp) without third derivatives. */
static double stacked_value_of(const dvi__stacked_shot *s, dvi__stack_content content, int row,
                               int column, int e)
{
  switch (content) {
  case DVI__FLOW: return (row < s->n ? 1 : -1) * s->H_zz[s->flow[e]];
  case DVI__FLOW_TRANSPOSED: return (column < s->n ? 1 : -1) * s->H_zz[s->transposed[e]];
  case DVI__LAGRANGIAN_ZZ:
    return (row < s->n) != (column < s->n) ? 0 : (row < s->n ? -1 : 1) * s->H_zz[e];
  case DVI__ONE: break;
  }
  return 0;
}

/* Add the entries of a block at the indices `where`. Returns their number. */
static int fill_block(dvi__stacked_shot *s, const dvi__stack_block *b, const int *where,
                      double *values)
{
  const int z = 2 * s->n, from = b->columns == DVI__SECOND ? s->n : 0,
            to = b->columns == DVI__FIRST ? s->n : z;
  int count = 0;
  for (int c = from; c < to; c++) {
    const double column = stacked_unit_of(s, b->column, c);
    if (b->content == DVI__ONE) {
      values[where[count++]] += b->factor * column / unit_of_row(s, b->row, c);
      continue;
    }
    for (int e = s->joint.start[c]; e < s->joint.start[c + 1]; e++) {
      const int i = s->joint.row[e];
      values[where[count++]] += s->h * b->factor * stacked_value_of(s, b->content, i, c, e) *
                                column / unit_of_row(s, b->row, i);
    }
  }
  return count;
}

dvi_status dvi__stacked_shot_jacobian(void *step, const double *x, double *values)
{
  dvi__stacked_shot *s = step;
  int at_entry = 0, selected = -1;
  stacked_take_unknowns(s, x);
  DVI_TRY(place_all(s));
  memset(values, 0, (size_t)dvi__pattern_entries(&s->pattern) * sizeof *values);
  for (int b = 0; b < s->block_count; b++) {
    const dvi__stack_block *block = &s->block[b];
    if (block->content != DVI__ONE && block->point != selected) {
      selected = block->point;
      DVI_TRY(dvi__vector_field_select(s->field, selected));
      stacked_hessian(s);
    }
    at_entry += fill_block(s, block, s->where + at_entry, values);
  }
  return DVI_OK;
}

/* ---- the step ---- */

/* Compute stages one after the other, starting from stages that all move as the start does. For an
 * explicit method the result is the shot. */
static dvi_status stacked_predict_stages(dvi__stacked_shot *s)
{
  const dvi__runge_kutta *rk = &s->method;
  const size_t bytes = 2 * (size_t)s->n * sizeof(double);
  for (int m = 0; m < s->course.pieces; m++) {
    double *next = stacked_at(s, s->x, dvi__stack_node(s, m + 1));
    go_to_node(s, m);
    memcpy(next, s->point, bytes);
    for (int j = 0; j < rk->stages; j++) {
      DVI_TRY(place_stage(s, m, j));
      for (int k = j; k < (j == 0 ? rk->stages : j + 1); k++)
        memcpy(stacked_at(s, s->x, dvi__stack_W(s, m, k)),
               stacked_at(s, s->rate, dvi__stack_stage_point(s, m, j)), bytes);
    }
    for (int j = 0; j < rk->stages; j++)
      stacked_add(s, rk->b[j], stacked_at(s, s->x, dvi__stack_W(s, m, j)), next);
  }
  return DVI_OK;
}

dvi_status dvi__stacked_shot_place(dvi__stacked_shot *s, double t0, double h, double whole,
                                   const double *q0, const double *p0, double *v, double *x)
{
  const int n = s->n;
  double *start = stacked_at(s, s->x, dvi__stack_start(s));
  s->t0 = t0;
  s->h = h;
  s->q0 = q0;
  s->p0 = p0;
  s->known = 0;
  DVI_TRY(dvi__legendre_inverse(s->evaluator, t0, q0, p0, v));
  DVI_TRY(dvi__vector_field_mass(s->field, t0, q0, v, s->unit));
  for (int i = 0; i < n; i++) s->unit[i] /= fabs(whole);
  dvi__vector_field_guess(s->field, v);
  memset(s->x, 0, 2 * (size_t)n * (size_t)s->blocks * sizeof *s->x);
  memcpy(start + n, p0, (size_t)n * sizeof *p0);
  DVI_TRY(stacked_predict_stages(s));
  for (int i = 0; i < n; i++)
    start[i] = p0[i] + stacked_at(s, s->x, dvi__stack_node(s, s->course.pieces))[n + i];
  for (int m = 0; m < s->course.pieces; m++)
    for (int j = 0; j < s->method.stages; j++)
      for (int i = 0; i < n; i++)
        stacked_at(s, s->x, dvi__stack_Gamma(s, m, j))[i] = -s->method.b[j] * start[i];
  stacked_give(s, x);
  return DVI_OK;
}
