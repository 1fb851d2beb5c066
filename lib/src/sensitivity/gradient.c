/* The gradient of an objective by the adjoint. The run goes forward once and saves its state at the
 * beginning of each of about sqrt(N) parts. From the last part on each part is run once more, with
 * the paths of its steps kept, and the derivatives go backward over these (Griewank and Walther
 * 2000, of which this is the case of two sweeps). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "sensitivity/sensitivity_struct.h"

typedef struct backward {
  dvi_sensitivity *of;
  const dvi_run_plan *plan;
  const dvi_objective *objective;
  long part;            /* steps of a part */
  size_t bytes;         /* of a saved state */
  char *saved;          /* [parts * bytes] */
  double *numbers;      /* [part * (n + n s)] the paths of a part */
  dvi__step_path *path; /* [part] */
  double value;
  double *by_q, *by_p, *by_theta;   /* [n], [n], [count] */
  double *point, *by_point;         /* [2 n], [2 n] work */
  double *C_q, *C_v, *rows, *theta; /* [n r], [n r], [(s+1) n], [count] work */
} backward;

static dvi_status check_plan(const dvi_sensitivity *own, const dvi_run_plan *plan,
                             const dvi_objective *objective, const dvi_gradient *gradient)
{
  if (own == NULL || plan == NULL || objective == NULL || gradient == NULL || plan->q == NULL ||
      plan->p == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "gradient: a pointer is NULL");
  if (plan->steps < 1 || !isfinite(plan->h) || !(fabs(plan->h) > 0))
    return dvi__fail(DVI_BAD_ARGUMENT, "gradient: %ld steps of %g are no run", plan->steps,
                     plan->h);
  return DVI_OK;
}

static dvi_status allocate(backward *b)
{
  const dvi_sensitivity *own = b->of;
  const size_t n = (size_t)own->n, s = (size_t)own->s, r = (size_t)own->r, part = (size_t)b->part,
               count = (size_t)own->parameters, parts = ((size_t)b->plan->steps + part - 1) / part;
  DVI_TRY(dvi_integrator_start(own->integrator, b->plan->t, b->plan->q, b->plan->p));
  const dvi_status sized = dvi_integrator_save_memory(own->integrator, NULL, 0, &b->bytes);
  if (sized != DVI_OK && sized != DVI_BAD_SIZE) return sized;
  b->saved = dvi__allocate(parts, b->bytes);
  b->path = DVI_NEW(dvi__step_path, part);
  b->numbers = DVI_NEW(double, part *(n + n * s) + 6 * n + 2 * n * r + (s + 1) * n + 2 * count);
  if (b->saved == NULL || b->path == NULL || b->numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "gradient: no memory for %ld steps", b->plan->steps);
  b->by_q = b->numbers + part * (n + n * s);
  b->by_p = b->by_q + n;
  b->point = b->by_p + n;
  b->by_point = b->point + 2 * n;
  b->C_q = b->by_point + 2 * n;
  b->C_v = b->C_q + n * r;
  b->rows = b->C_v + n * r;
  b->by_theta = b->rows + (s + 1) * n;
  b->theta = b->by_theta + count;
  return DVI_OK;
}

static dvi_status check_returned(int returned, double t)
{
  if (returned == 0) return DVI_OK;
  return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "the objective failed (%d) at t = %g", returned, t);
}

/* Evaluate the rate at the nodes of a step, and add to the value, or backwards to the derivatives
 * by the parameters. rows become the derivatives by X_a. */
static dvi_status add_rate(backward *b, const dvi__step_path *path, int backwards)
{
  const size_t n = (size_t)b->of->n, r = (size_t)b->of->r, count = (size_t)b->of->parameters;
  dvi__linear_step_place(b->of->linear, path);
  dvi__action *action = dvi__linear_step_action(b->of->linear);
  const dvi__path_points points = dvi__action_two_point_points(action, path->Y);
  for (size_t j = 0; j < r; j++) {
    double value = 0, *q = b->point, *v = q + n;
    for (size_t i = 0; i < n; i++) {
      q[i] = points.Q[i * r + j];
      v[i] = points.V[i * r + j];
    }
    memset(b->by_point, 0, 2 * n * sizeof(double));
    memset(b->theta, 0, count * sizeof(double));
    DVI_TRY(check_returned(b->objective->rate(points.t[j], q, v, &value, b->by_point,
                                              b->by_point + n, b->theta, b->objective->user),
                           points.t[j]));
    const double weight = path->h * points.weight[j];
    if (!backwards) b->value += weight * value;
    for (size_t k = 0; backwards && k < count; k++) b->by_theta[k] += weight * b->theta[k];
    for (size_t i = 0; i < n; i++) {
      b->C_q[i * r + j] = b->by_point[i];
      b->C_v[i * r + j] = b->by_point[n + i];
    }
  }
  dvi__action_two_point_rows(action, b->C_q, b->C_v, b->rows);
  return DVI_OK;
}

/* ---- forward ---- */

static dvi_status go_forward(backward *b)
{
  for (long k = 0; k < b->plan->steps; k++) {
    size_t size;
    if (k % b->part == 0)
      DVI_TRY(dvi_integrator_save_memory(
          b->of->integrator, b->saved + (size_t)(k / b->part) * b->bytes, b->bytes, &size));
    DVI_TRY(dvi__sensitivity_advance(b->of, b->plan->h, b->numbers, &b->path[0]));
    if (b->objective->rate != NULL) DVI_TRY(add_rate(b, &b->path[0], 0));
  }
  if (b->objective->end == NULL) return DVI_OK;
  double value = 0;
  const double t = dvi_integrator_time(b->of->integrator);
  DVI_TRY(check_returned(b->objective->end(t, dvi_integrator_q(b->of->integrator),
                                           dvi_integrator_p(b->of->integrator), &value, b->by_q,
                                           b->by_p, b->by_theta, b->objective->user),
                         t));
  b->value += value;
  return DVI_OK;
}

/* ---- backward ---- */

static dvi_status run_part_again(backward *b, long part, int count)
{
  const size_t numbers = (size_t)b->of->n * (size_t)(b->of->s + 1);
  DVI_TRY(dvi_integrator_restore_memory(b->of->integrator, b->saved + (size_t)part * b->bytes,
                                        b->bytes));
  for (int k = 0; k < count; k++)
    DVI_TRY(
        dvi__sensitivity_advance(b->of, b->plan->h, b->numbers + (size_t)k * numbers, &b->path[k]));
  return DVI_OK;
}

static dvi_status pull_step(backward *b, const dvi__step_path *path)
{
  const int has_rate = b->objective->rate != NULL;
  if (has_rate) DVI_TRY(add_rate(b, path, 1));
  DVI_TRY(dvi__linear_step_at(b->of->linear, path, 1));
  return dvi__linear_step_pull(b->of->linear, has_rate ? b->rows : NULL, b->by_q, b->by_p,
                               b->by_theta);
}

static dvi_status go_backward(backward *b)
{
  for (long part = (b->plan->steps - 1) / b->part; part >= 0; part--) {
    const long first = part * b->part, left = b->plan->steps - first;
    const int count = (int)(left < b->part ? left : b->part);
    DVI_TRY(run_part_again(b, part, count));
    for (int k = count - 1; k >= 0; k--) DVI_TRY(pull_step(b, &b->path[k]));
  }
  return DVI_OK;
}

static dvi_status compute(backward *b)
{
  DVI_TRY(allocate(b));
  DVI_TRY(go_forward(b));
  DVI_TRY(go_backward(b));
  const int finite = isfinite(b->value) &&
                     dvi__first_not_finite(2 * (size_t)b->of->n, b->by_q) < 0 &&
                     dvi__first_not_finite((size_t)b->of->parameters, b->by_theta) < 0;
  return finite ? DVI_OK : dvi__fail(DVI_NOT_FINITE, "the objective or a derivative is not finite");
}

static void give(size_t count, const double *from, double *to)
{
  if (to != NULL) memcpy(to, from, count * sizeof(double));
}

dvi_status dvi_sensitivity_gradient(dvi_sensitivity *own, const dvi_run_plan *plan,
                                    const dvi_objective *objective, dvi_gradient *gradient)
{
  DVI_TRY(check_plan(own, plan, objective, gradient));
  backward b = {.of = own,
                .plan = plan,
                .objective = objective,
                .part = (long)ceil(sqrt((double)plan->steps))};
  own->has_tangents = 0;
  const dvi_status status = compute(&b);
  if (status == DVI_OK) {
    gradient->value = b.value;
    give((size_t)own->n, b.by_q, gradient->by_q);
    give((size_t)own->n, b.by_p, gradient->by_p);
    give((size_t)own->parameters, b.by_theta, gradient->by_theta);
  }
  dvi__release(b.saved);
  dvi__release(b.path);
  dvi__release(b.numbers);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "gradient");
}
