#include "sensitivity/linear_step.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/linear.h"

struct dvi__linear_step {
  dvi_dependence dependence;
  dvi__action *action;
  int n, s, r;
  double *K;                      /* [entries of the coupling * (s+1)^2] */
  dvi__pattern pattern[2];        /* of B and of its transpose, [n s x n s] */
  int *place[2];                  /* [entries of pattern[0]] of each entry of B in both */
  double *values;                 /* [entries of pattern[0]] */
  dvi__linear *factor[2];         /* of B and of its transpose */
  int transposed;                 /* which of the two is factored */
  double *rest;                   /* [n] zeros, the p0 of the element */
  double *x, *y, *U;              /* [(s+1) n], [(s+1) n], [n s] work */
  double *at_point, *in_q, *in_v; /* [2 n + 2 n count], [n r count] each, of the dependence */
  double *by_theta;               /* [(s+1) n count] rho_theta */
};

/* ---- create ---- */

static dvi_status draw_patterns(dvi__linear_step *step)
{
  DVI_TRY(dvi__pattern_blocks(dvi__action_coupling(step->action), step->s, &step->pattern[0]));
  DVI_TRY(dvi__pattern_transpose(&step->pattern[0], &step->pattern[1]));
  const int entries = dvi__pattern_entries(&step->pattern[0]);
  for (int k = 0; k < 2; k++)
    if ((step->place[k] = DVI_NEW(int, entries)) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "sensitivity: no memory for %d entries", entries);
  for (int c = 0; c < step->pattern[0].columns; c++)
    for (int e = step->pattern[0].start[c]; e < step->pattern[0].start[c + 1]; e++) {
      step->place[0][e] = e;
      step->place[1][e] = dvi__pattern_find(&step->pattern[1], c, step->pattern[0].row[e]);
    }
  return DVI_OK;
}

static dvi_status allocate_numbers(dvi__linear_step *step)
{
  const size_t n = (size_t)step->n, s = (size_t)step->s, count = (size_t)step->dependence.count,
               entries = (size_t)dvi__pattern_entries(dvi__action_coupling(step->action));
  const struct {
    double **array;
    size_t count;
  } wanted[] = {{&step->K, entries * (s + 1) * (s + 1)},
                {&step->values, entries * s * s},
                {&step->rest, n},
                {&step->x, (s + 1) * n},
                {&step->y, (s + 1) * n},
                {&step->U, s * n},
                {&step->at_point, 2 * n + 2 * n * count},
                {&step->in_q, n * (size_t)step->r * count},
                {&step->in_v, n * (size_t)step->r * count},
                {&step->by_theta, (s + 1) * n * count}};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++)
    if ((*wanted[k].array = DVI_NEW(double, wanted[k].count)) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "sensitivity: no memory for %d coordinates", step->n);
  return DVI_OK;
}

static dvi_status assemble(dvi__linear_step *step, const dvi_system *system,
                           const dvi__action_space *space, dvi_counters *counters)
{
  DVI_TRY(dvi__action_create(system, space, counters, &step->action));
  DVI_TRY(dvi__action_prepare_jacobian(step->action));
  DVI_TRY(dvi__action_prepare_two_point(step->action));
  DVI_TRY(draw_patterns(step));
  for (int k = 0; k < 2; k++)
    DVI_TRY(dvi__linear_create(&step->pattern[k], DVI__LINEAR_AUTO, counters, &step->factor[k]));
  return allocate_numbers(step);
}

dvi_status dvi__linear_step_create(const dvi_system *system, const dvi__action_space *space,
                                   const dvi_dependence *dependence, dvi_counters *counters,
                                   dvi__linear_step **step)
{
  dvi__linear_step *made = *step = DVI_NEW(dvi__linear_step, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "sensitivity: no memory");
  if (dependence != NULL) made->dependence = *dependence;
  made->n = system->n;
  made->s = space->degree;
  made->r = space->nodes;
  const dvi_status status = assemble(made, system, space, counters);
  if (status != DVI_OK) dvi__linear_step_destroy(step);
  return status;
}

void dvi__linear_step_destroy(dvi__linear_step **step)
{
  dvi__linear_step *own = *step;
  if (own == NULL) return;
  double *const owned[] = {own->K, own->values,   own->rest, own->x,    own->y,
                           own->U, own->at_point, own->in_q, own->in_v, own->by_theta};
  for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) dvi__release(owned[k]);
  for (int k = 0; k < 2; k++) {
    dvi__linear_destroy(&own->factor[k]);
    dvi__pattern_clear(&own->pattern[k]);
    dvi__release(own->place[k]);
  }
  dvi__action_destroy(&own->action);
  dvi__release(own);
  *step = NULL;
}

dvi__action *dvi__linear_step_action(const dvi__linear_step *step)
{
  return step->action;
}

void dvi__linear_step_place(dvi__linear_step *step, const dvi__step_path *path)
{
  dvi__action_place(step->action, path->t, path->h, path->q, step->rest);
}

/* ---- derivatives on a path ---- */

/* Evaluate the derivatives by the parameters at node j, and move them into the batches. */
static dvi_status depend_at_node(dvi__linear_step *step, const dvi__path_points *points, int j)
{
  const size_t n = (size_t)step->n, r = (size_t)step->r, all = n * (size_t)step->dependence.count;
  double *q = step->at_point, *v = q + n, *in_q = v + n, *in_v = in_q + all;
  for (size_t i = 0; i < n; i++) {
    q[i] = points->Q[i * r + (size_t)j];
    v[i] = points->V[i * r + (size_t)j];
  }
  memset(in_q, 0, 2 * all * sizeof(double));
  const int returned = step->dependence.derivative(points->t[j], q, v, in_q, in_v,
                                                   step->dependence.user);
  if (returned != 0)
    return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                     "the derivatives by the parameters failed (%d) at t = %g", returned,
                     points->t[j]);
  if (dvi__first_not_finite(2 * all, in_q) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "a derivative by a parameter is not finite at t = %g",
                     points->t[j]);
  for (size_t c = 0; c < all; c++) {
    step->in_q[c * r + (size_t)j] = in_q[c];
    step->in_v[c * r + (size_t)j] = in_v[c];
  }
  return DVI_OK;
}

static dvi_status depend(dvi__linear_step *step, const double *Y)
{
  const size_t batch = (size_t)step->n * (size_t)step->r,
               rows = (size_t)(step->s + 1) * (size_t)step->n;
  const dvi__path_points points = dvi__action_two_point_points(step->action, Y);
  for (int j = 0; j < points.count; j++) DVI_TRY(depend_at_node(step, &points, j));
  for (size_t k = 0; k < (size_t)step->dependence.count; k++)
    dvi__action_two_point_rows(step->action, step->in_q + k * batch, step->in_v + k * batch,
                               step->by_theta + k * rows);
  return DVI_OK;
}

/* Move B out of K. Its rows leave out rho_1, its columns q0. */
static void extract(dvi__linear_step *step, const int *place)
{
  const dvi__pattern *coupling = dvi__action_coupling(step->action);
  const int s = step->s, size = s + 1;
  for (int j = 0; j < step->n; j++) {
    const int first = coupling->start[j];
    for (int e = first; e < coupling->start[j + 1]; e++)
      for (int l = 0; l < s; l++)
        for (int k = 0; k < s; k++) {
          const int a = k == 0 ? 0 : k + 1, b = l + 1;
          const int entry = step->pattern[0].start[j * s + l] + (e - first) * s + k;
          step->values[place[entry]] =
              step->K[((size_t)e * (size_t)size + (size_t)b) * (size_t)size + (size_t)a];
        }
  }
}

dvi_status dvi__linear_step_at(dvi__linear_step *step, const dvi__step_path *path, int transposed)
{
  dvi__linear_step_place(step, path);
  DVI_TRY(dvi__action_two_point_hessian(step->action, path->Y, step->K));
  if (step->dependence.count > 0) DVI_TRY(depend(step, path->Y));
  step->transposed = transposed;
  extract(step, step->place[transposed]);
  return dvi__linear_factor(step->factor[transposed], step->values);
}

/* ---- the map and its transpose ---- */

/* Compute y = K x, or with `transposed` K^T x. All are [(s+1)*n], X_a after X_a. */
static void multiply(const dvi__linear_step *step, const double *x, int transposed, double *y)
{
  const dvi__pattern *coupling = dvi__action_coupling(step->action);
  const size_t n = (size_t)step->n, size = (size_t)step->s + 1;
  memset(y, 0, size * n * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (int e = coupling->start[j]; e < coupling->start[j + 1]; e++) {
      const double *block = step->K + (size_t)e * size * size;
      const size_t i = (size_t)coupling->row[e];
      for (size_t b = 0; b < size; b++)
        for (size_t a = 0; a < size; a++) {
          if (transposed)
            y[b * n + j] += block[b * size + a] * x[a * n + i];
          else
            y[a * n + i] += block[b * size + a] * x[b * n + j];
        }
    }
}

/* Solve with the right hand sides -y of X_from and the bubbles, for x of X_to and the bubbles. */
static dvi_status solve(dvi__linear_step *step, size_t from, size_t to)
{
  const size_t n = (size_t)step->n, s = (size_t)step->s;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < s; k++) step->U[i * s + k] = -step->y[(k == 0 ? from : k + 1) * n + i];
  DVI_TRY(dvi__linear_solve(step->factor[step->transposed], step->U));
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < s; k++) step->x[(k == 0 ? to : k + 1) * n + i] = step->U[i * s + k];
  return DVI_OK;
}

static void add_parameter(dvi__linear_step *step, int k)
{
  const size_t rows = (size_t)(step->s + 1) * (size_t)step->n;
  for (size_t c = 0; k >= 0 && c < rows; c++) step->y[c] += step->by_theta[(size_t)k * rows + c];
}

dvi_status dvi__linear_step_push(dvi__linear_step *step, int k, double *dq, double *dp)
{
  const size_t n = (size_t)step->n;
  memset(step->x, 0, (size_t)(step->s + 1) * n * sizeof(double));
  memcpy(step->x, dq, n * sizeof(double));
  multiply(step, step->x, 0, step->y);
  add_parameter(step, k);
  for (size_t i = 0; i < n; i++) step->y[i] += dp[i];
  DVI_TRY(solve(step, 0, 1));
  multiply(step, step->x, 0, step->y);
  add_parameter(step, k);
  memcpy(dq, step->x + n, n * sizeof(double));
  memcpy(dp, step->y + n, n * sizeof(double));
  return DVI_OK;
}

dvi_status dvi__linear_step_pull(dvi__linear_step *step, const double *cost, double *by_q,
                                 double *by_p, double *by_theta)
{
  const size_t n = (size_t)step->n, rows = (size_t)(step->s + 1) * n;
  memset(step->x, 0, rows * sizeof(double));
  memcpy(step->x + n, by_p, n * sizeof(double));
  multiply(step, step->x, 1, step->y);
  for (size_t c = 0; cost != NULL && c < rows; c++) step->y[c] += cost[c];
  for (size_t i = 0; i < n; i++) step->y[n + i] += by_q[i];
  DVI_TRY(solve(step, 1, 0));
  multiply(step, step->x, 1, step->y);
  for (size_t i = 0; i < n; i++) by_q[i] = step->y[i] + (cost != NULL ? cost[i] : 0);
  memcpy(by_p, step->x, n * sizeof(double));
  for (size_t k = 0; k < (size_t)step->dependence.count; k++)
    for (size_t c = 0; c < rows; c++) by_theta[k] += step->x[c] * step->by_theta[k * rows + c];
  return DVI_OK;
}
