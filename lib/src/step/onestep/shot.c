#include "step/onestep/shot.h"

#include <string.h>

#include "step/onestep/end_terms.h"
#include "step/onestep/stages.h"
#include "step/onestep/taylor.h"
#include "core/memory.h"
#include "core/status.h"
#include "system/rescale/transformed.h"

struct dvi__shot {
  const dvi_system *system;
  dvi__runge_kutta method;
  dvi__course course;
  dvi__vector_field *field;
  dvi__stages *coupled; /* NULL for an explicit method */
  dvi__taylor *series;  /* NULL for a method with a tableau */
  dvi__end_terms *ends; /* NULL for a quadrature by values of L alone */
  int n, first_is_node; /* first_is_node is not 0 if a node is the first stage of the next piece */
  double t0, h;
  const double *q0;
  double *p0;             /* [n] */
  double *node;           /* [2n*(pieces+1)] z_m - z_0 */
  double *W;              /* [2n*stages*pieces] */
  double *point, *turned; /* [2n] */
  double *lambda;         /* [2n] without `end` */
  double *Gamma;          /* [2n*stages] */
  double *kappa;          /* [2n*stages] h f_z^T Gamma, and work for 2n motions of the stages */
};

/* ---- create ---- */

static double **shot_owned_array(dvi__shot *s, int i)
{
  double **const all[] = {&s->p0,     &s->node,   &s->W,     &s->point,
                          &s->turned, &s->lambda, &s->Gamma, &s->kappa};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status shot_allocate(dvi__shot *s)
{
  const size_t z = 2 * (size_t)s->n, stages = (size_t)s->method.stages,
               pieces = (size_t)s->course.pieces;
  const size_t size[] = {z, z * (pieces + 1), z * stages * pieces, z, z,
                         z, z * stages,       z * stages * z};
  for (int i = 0; shot_owned_array(s, i) != NULL; i++) {
    *shot_owned_array(s, i) = DVI_NEW(double, size[i]);
    if (*shot_owned_array(s, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", s->method.stages,
                       s->n);
  }
  return DVI_OK;
}

/* Points of the vector field are the stages, piece by piece, followed by the last node or by all
 * nodes. */
static int stage_point(const dvi__shot *s, int piece, int stage)
{
  return piece * s->method.stages + stage;
}

static int node_point(const dvi__shot *s, int m)
{
  const int stages = s->course.pieces * s->method.stages;
  if (!s->first_is_node) return stages + m;
  return m == s->course.pieces ? stages : stage_point(s, m, 0);
}

static int first_stage_is_node(const dvi__runge_kutta *m)
{
  int is = m->c[0] == 0;
  for (int j = 0; j < m->stages; j++) is &= m->a[0][j] == 0;
  return is;
}

static dvi_status shot_initialise(dvi__shot *s, const dvi_system *system, dvi_counters *counters)
{
  DVI_TRY(shot_allocate(s));
  DVI_TRY(
      dvi__vector_field_create(system, node_point(s, s->course.pieces) + 1, counters, &s->field));
  if (s->method.series > 0)
    DVI_TRY(dvi__taylor_create(system, s->field, s->method.series, s->course.pieces, counters,
                               &s->series));
  if (s->course.count > 0)
    DVI_TRY(dvi__end_terms_create(system, s->course.count, s->course.weight, counters, &s->ends));
  return s->method.is_explicit
             ? DVI_OK
             : dvi__stages_create(s->field, s->n, &s->method, counters, &s->coupled);
}

dvi_status dvi__shot_create(const dvi_system *system, const dvi__runge_kutta *method,
                            const dvi__course *course, dvi_counters *counters, dvi__shot **shot)
{
  *shot = NULL;
  dvi__shot *s = DVI_NEW(dvi__shot, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  s->system = system;
  s->method = *method;
  s->course = *course;
  s->n = system->n;
  s->first_is_node = first_stage_is_node(method);
  const dvi_status status = shot_initialise(s, system, counters);
  if (status != DVI_OK) dvi__shot_destroy(&s);
  *shot = s;
  return status;
}

void dvi__shot_destroy(dvi__shot **shot)
{
  dvi__shot *s = *shot;
  if (s == NULL) return;
  for (int i = 0; shot_owned_array(s, i) != NULL; i++) dvi__release(*shot_owned_array(s, i));
  dvi__stages_destroy(&s->coupled);
  dvi__taylor_destroy(&s->series);
  dvi__end_terms_destroy(&s->ends);
  dvi__vector_field_destroy(&s->field);
  dvi__release(s);
  *shot = NULL;
}

dvi__vector_field *dvi__shot_vector_field(dvi__shot *s)
{
  return s->field;
}

void dvi__shot_aim(dvi__shot *s, double t0, double h, const double *q, const double *unit)
{
  s->t0 = t0;
  s->h = h;
  s->q0 = q;
  if (s->coupled != NULL) dvi__stages_unit(s->coupled, unit);
}

/* ---- forward ---- */

static double *shot_at(const dvi__shot *s, double *numbers, int index)
{
  return numbers + (size_t)index * 2 * (size_t)s->n;
}

static double shot_length_of(const dvi__shot *s, int piece)
{
  return s->h * (s->course.c[piece + 1] - s->course.c[piece]);
}

/* Add factor x to y, both [2n]. */
static void shot_add(const dvi__shot *s, double factor, const double *x, double *y)
{
  if (factor == 0) return;
  for (int i = 0; i < 2 * s->n; i++) y[i] += factor * x[i];
}

/* Place a point. The start, which is the large number, is added last. */
static dvi_status shot_place(dvi__shot *s, int point, double t, const double *moved, double *rate)
{
  for (int i = 0; i < s->n; i++) {
    s->point[i] = s->q0[i] + moved[i];
    s->point[s->n + i] = s->p0[i] + moved[s->n + i];
  }
  return dvi__vector_field_place(s->field, point, t, s->point, s->point + s->n, rate);
}

static dvi_status explicit_stages(dvi__shot *s, int piece, double t, double h)
{
  const dvi__runge_kutta *m = &s->method;
  double *W = shot_at(s, s->W, piece * m->stages), *moved = s->turned;
  for (int j = 0; j < m->stages; j++) {
    memcpy(moved, shot_at(s, s->node, piece), 2 * (size_t)s->n * sizeof *moved);
    for (int k = 0; k < j; k++) shot_add(s, m->a[j][k], shot_at(s, W, k), moved);
    const dvi_status status = shot_place(s, stage_point(s, piece, j), t + m->c[j] * h, moved,
                                         shot_at(s, W, j));
    if (status != DVI_OK)
      return dvi__fail_in(status, "stage %d of the one-step method from node %d on", j + 1,
                          piece + 1);
    for (int i = 0; i < 2 * s->n; i++) shot_at(s, W, j)[i] *= h;
  }
  return DVI_OK;
}

/* Advance by the Taylor series. Its one stage is the start of the piece. */
static dvi_status series_stage(dvi__shot *s, int piece, double t, double h)
{
  const int point = stage_point(s, piece, 0);
  dvi_status status = shot_place(s, point, t, shot_at(s, s->node, piece), s->turned);
  if (status == DVI_OK) status = dvi__taylor_advance(s->series, point, h, shot_at(s, s->W, piece));
  return status == DVI_OK
             ? DVI_OK
             : dvi__fail_in(status, "the Taylor series of the motion at node %d", piece + 1);
}

static dvi_status coupled_stages(dvi__shot *s, int piece, double t, double h)
{
  const double *node = shot_at(s, s->node, piece);
  for (int i = 0; i < s->n; i++) {
    s->point[i] = s->q0[i] + node[i];
    s->point[s->n + i] = s->p0[i] + node[s->n + i];
  }
  const dvi_status status = dvi__stages_solve(s->coupled, stage_point(s, piece, 0), t, h, s->point,
                                              shot_at(s, s->W, piece * s->method.stages));
  return status == DVI_OK
             ? DVI_OK
             : dvi__fail_in(status, "the stages of the one-step method from node %d on", piece + 1);
}

static dvi_status shot_stages(dvi__shot *s, int piece)
{
  const double t = s->t0 + s->course.c[piece] * s->h, h = shot_length_of(s, piece);
  if (s->series != NULL) return series_stage(s, piece, t, h);
  return s->coupled != NULL ? coupled_stages(s, piece, t, h) : explicit_stages(s, piece, t, h);
}

/* Return 1 for a node of the quadrature that no stage coincides with. */
static int stands_alone(const dvi__shot *s, int m)
{
  return s->course.b[m] != 0 && node_point(s, m) >= s->course.pieces * s->method.stages;
}

static dvi_status shot_place_nodes(dvi__shot *s)
{
  for (int m = 0; m <= s->course.pieces; m++)
    if (stands_alone(s, m))
      DVI_TRY(shot_place(s, node_point(s, m), s->t0 + s->course.c[m] * s->h, shot_at(s, s->node, m),
                         s->turned));
  return DVI_OK;
}

dvi_status dvi__shot_fire(dvi__shot *s, const double *p, double *reach)
{
  const dvi__runge_kutta *m = &s->method;
  const size_t z = 2 * (size_t)s->n;
  memcpy(s->p0, p, (size_t)s->n * sizeof *p);
  memset(s->node, 0, z * sizeof *s->node);
  for (int piece = 0; piece < s->course.pieces; piece++) {
    DVI_TRY(shot_stages(s, piece));
    double *next = shot_at(s, s->node, piece + 1);
    memcpy(next, shot_at(s, s->node, piece), z * sizeof *next);
    for (int j = 0; j < m->stages; j++)
      shot_add(s, m->b[j], shot_at(s, s->W, piece * m->stages + j), next);
  }
  memcpy(reach, shot_at(s, s->node, s->course.pieces), z * sizeof *reach);
  return shot_place_nodes(s);
}

dvi_status dvi__shot_duration(dvi__shot *s, double *duration)
{
  dvi__monitor *monitor = dvi__transformed_monitor(dvi__transformed_of(s->system));
  double g;
  *duration = 0;
  for (int m = 0; m <= s->course.pieces; m++) {
    if (s->course.b[m] == 0) continue;
    for (int i = 0; i < s->n; i++) s->point[i] = s->q0[i] + shot_at(s, s->node, m)[i];
    DVI_TRY(dvi__monitor_value(monitor, 1, s->point, &g));
    *duration += s->h * s->course.b[m] * g;
  }
  return DVI_OK;
}

/* ---- backward ---- */

dvi_status dvi__shot_trace(dvi__shot *s)
{
  DVI_TRY(dvi__vector_field_differentiate(s->field, 0, s->course.pieces * s->method.stages));
  for (int m = 0; m <= s->course.pieces; m++)
    if (stands_alone(s, m)) DVI_TRY(dvi__vector_field_differentiate(s->field, node_point(s, m), 1));
  for (int piece = 0; s->series != NULL && piece < s->course.pieces; piece++)
    DVI_TRY(dvi__taylor_trace(s->series, piece, shot_length_of(s, piece)));
  return DVI_OK;
}

static dvi_status explicit_costates(dvi__shot *s, int piece, double h, const double *end)
{
  const dvi__runge_kutta *m = &s->method;
  for (int j = m->stages - 1; j >= 0; j--) {
    double *Gamma = shot_at(s, s->Gamma, j);
    memset(Gamma, 0, 2 * (size_t)s->n * sizeof *Gamma);
    shot_add(s, m->b[j], end, Gamma);
    for (int k = j + 1; k < m->stages; k++) shot_add(s, m->a[k][j], shot_at(s, s->kappa, k), Gamma);
    DVI_TRY(dvi__vector_field_select(s->field, stage_point(s, piece, j)));
    dvi__vector_field_pull(s->field, h, Gamma, shot_at(s, s->kappa, j));
  }
  return DVI_OK;
}

static dvi_status coupled_costates(dvi__shot *s, int piece, double h, const double *end)
{
  for (int j = 0; j < s->method.stages; j++) {
    memset(shot_at(s, s->Gamma, j), 0, 2 * (size_t)s->n * sizeof(double));
    shot_add(s, s->method.b[j], end, shot_at(s, s->Gamma, j));
  }
  DVI_TRY(dvi__stages_solve_transposed(s->coupled, stage_point(s, piece, 0), h, s->Gamma));
  for (int j = 0; j < s->method.stages; j++) {
    DVI_TRY(dvi__vector_field_select(s->field, stage_point(s, piece, j)));
    dvi__vector_field_pull(s->field, h, shot_at(s, s->Gamma, j), shot_at(s, s->kappa, j));
  }
  return DVI_OK;
}

/* Compute kappa of all stages from the costate `end` behind them. */
static dvi_status shot_costates(dvi__shot *s, int piece, const double *end)
{
  const double h = shot_length_of(s, piece);
  if (s->series != NULL) return dvi__taylor_pull(s->series, piece, end, s->kappa);
  return s->coupled != NULL ? coupled_costates(s, piece, h, end)
                            : explicit_costates(s, piece, h, end);
}

static dvi_status add_lagrangian(dvi__shot *s, int m)
{
  if (s->course.b[m] == 0) return DVI_OK;
  DVI_TRY(dvi__vector_field_select(s->field, node_point(s, m)));
  dvi__vector_field_lagrangian(s->field, s->point);
  shot_add(s, s->h * s->course.b[m], s->point, s->lambda);
  if (s->ends == NULL || (m > 0 && m < s->course.pieces)) return DVI_OK;
  DVI_TRY(dvi__end_terms_gradient(s->ends, s->field, m == 0 ? s->h : -s->h, s->point));
  shot_add(s, s->h, s->point, s->lambda);
  return DVI_OK;
}

dvi_status dvi__shot_costate(dvi__shot *s, const double *end, double *gain)
{
  const int z = 2 * s->n;
  memset(s->lambda, 0, (size_t)z * sizeof *s->lambda);
  DVI_TRY(add_lagrangian(s, s->course.pieces));
  for (int piece = s->course.pieces - 1; piece >= 0; piece--) {
    for (int i = 0; i < z; i++) s->point[i] = end[i] + s->lambda[i];
    DVI_TRY(shot_costates(s, piece, s->point));
    for (int j = 0; j < s->method.stages; j++) shot_add(s, 1, shot_at(s, s->kappa, j), s->lambda);
    DVI_TRY(add_lagrangian(s, piece));
  }
  memcpy(gain, s->lambda, (size_t)z * sizeof *gain);
  return DVI_OK;
}

/* ---- motions of the start ---- */

/* Return kappa of a column, which holds the increments of its stages. */
static double *shot_column_of(const dvi__shot *s, int column)
{
  return shot_at(s, s->kappa, column * s->method.stages);
}

/* Move the stages of all columns. Each stage's point is selected once for all columns. */
static dvi_status move_stages(dvi__shot *s, int piece, double h, int columns, double *motion)
{
  const dvi__runge_kutta *m = &s->method;
  for (int j = 0; j < m->stages; j++) {
    DVI_TRY(dvi__vector_field_select(s->field, stage_point(s, piece, j)));
    for (int i = 0; i < columns; i++) {
      memcpy(s->point, shot_at(s, motion, i), 2 * (size_t)s->n * sizeof *s->point);
      for (int k = 0; k < j && m->is_explicit; k++)
        shot_add(s, m->a[j][k], shot_at(s, shot_column_of(s, i), k), s->point);
      dvi__vector_field_push(s->field, h, s->point, shot_at(s, shot_column_of(s, i), j));
    }
  }
  return DVI_OK;
}

static dvi_status move_series(dvi__shot *s, int piece, int columns, const double *motion)
{
  for (int i = 0; i < columns; i++)
    DVI_TRY(dvi__taylor_push(s->series, piece, motion + (size_t)i * 2 * (size_t)s->n,
                             shot_column_of(s, i)));
  return DVI_OK;
}

static dvi_status shot_couple(dvi__shot *s, int piece, double h, int columns)
{
  if (s->coupled == NULL) return DVI_OK;
  DVI_TRY(dvi__stages_factor(s->coupled, stage_point(s, piece, 0), h));
  for (int i = 0; i < columns; i++) dvi__stages_apply(s->coupled, shot_column_of(s, i));
  return DVI_OK;
}

dvi_status dvi__shot_move(dvi__shot *s, double *motion)
{
  const int columns = 2 * s->n;
  for (int piece = 0; piece < s->course.pieces; piece++) {
    const double h = shot_length_of(s, piece);
    DVI_TRY(s->series != NULL ? move_series(s, piece, columns, motion)
                              : move_stages(s, piece, h, columns, motion));
    DVI_TRY(shot_couple(s, piece, h, columns));
    for (int i = 0; i < columns; i++)
      for (int j = 0; j < s->method.stages; j++)
        shot_add(s, s->method.b[j], shot_at(s, shot_column_of(s, i), j), shot_at(s, motion, i));
  }
  return DVI_OK;
}
