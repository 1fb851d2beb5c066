/* Optimal control as a path of the doubled Lagrangian (doubled.h). At the start q is given, and w
 * is free with the momentum p_0. At the end q is given, or free with the momentum 0. w is free with
 * the momentum p_N where that is given, else w is 0. These are the rows of the two end nodes. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "boundary/doubled.h"
#include "boundary/path_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_step.h"
#include "num/finite.h"
#include "system/term_name.h"

struct dvi_control {
  dvi__doubled *doubled;
  dvi_path *path;
  dvi__evaluator *states; /* for velocities at nodes */
  dvi_counters counters;
  int n, m, solved, free_span;
  double *point, *v; /* [8 n], [n] work */
};

/* Factors of the log barrier, over the size of the cost: the first one, the ratio from each to the
 * next, and the last one. */
static const double first_barrier = 0.1, next_barrier = 0.2, last_barrier = 1e-10;

/* The search of a free span: the first change, the change below which roundings may end it, and the
 * largest ratio to the guess, as parts of the span. */
static const double first_change = 0.01, last_change = 1e-6, largest_span = 1e3;
enum { MOST_SPANS = 60 };

/* ---- create ---- */

static dvi_status check_arguments(const dvi_system *system, const char *method,
                                  const dvi_controls *controls, const dvi_control_options *o)
{
  if (system == NULL || method == NULL || controls == NULL || o == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "control: a pointer is NULL");
  if (controls->count < 1 || controls->count > DVI__CONTROLS_MOST)
    return dvi__fail(DVI_BAD_SIZE, "control: %d controls; 1 to %d are possible", controls->count,
                     DVI__CONTROLS_MOST);
  if (controls->cost == NULL || controls->force == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "control: the controls have no %s",
                     controls->cost == NULL ? "cost" : "force");
  const unsigned taken = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__FORCES |
                         DVI__FAST | DVI__VECTOR_POTENTIAL;
  if ((system->terms & ~taken) != 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "control: control is of constant masses and general Lagrangians in R^n with "
                     "potentials and forces; the system declares %s",
                     dvi__term_name(system->terms & ~taken));
  if (o->free_span && !system->autonomous)
    return dvi__fail(DVI_UNSUPPORTED,
                     "control: a free span needs a system that is declared autonomous");
  if (o->dimension != system->n)
    return dvi__fail(DVI_BAD_SIZE, "control: the ends have %d coordinates, the system %d",
                     o->dimension, system->n);
  const double *const ends[] = {o->q0, o->p0, o->q1, o->p1};
  static const char *const names[] = {"q0", "p0", "q1", "p1"};
  for (int k = 0; k < 4; k++) {
    if (ends[k] == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "control: %s is missing", names[k]);
    const ptrdiff_t bad = dvi__first_not_finite((size_t)o->dimension, ends[k]);
    if (bad >= 0)
      return dvi__fail(DVI_BAD_ARGUMENT, "control: number %td of %s is %g", bad, names[k],
                       ends[k][bad]);
  }
  return DVI_OK;
}

/* Refuse a method by its own system, which the user knows, and not by the doubled one. */
static dvi_status check_method(const dvi_system *system, const char *method)
{
  dvi__action_space space;
  char spelled[DVI__PATH_METHOD_SIZE] = "";
  return dvi__element_space(system, method, "control", &space,
                            &(dvi__text){spelled, sizeof spelled, 0});
}

/* Fill the ends of the path on (q,w). */
static dvi_status make_path(dvi_control *own, const char *method, const dvi_control_options *o)
{
  const size_t n = (size_t)own->n;
  double *numbers = DVI_NEW(double, 8 * n);
  char *free0 = DVI_NEW(char, 4 * n), *free1 = free0 + 2 * n;
  dvi_status status = numbers != NULL && free0 != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "no memory for the ends");
  for (size_t i = 0; status == DVI_OK && i < n; i++) {
    numbers[i] = o->q0[i];
    numbers[2 * n + i] = o->q1[i];
    numbers[5 * n + i] = o->p0[i];
    numbers[7 * n + i] = o->p1[i];
    free0[n + i] = 1;
    free1[i] = o->free_q1 != NULL && o->free_q1[i];
    free1[n + i] = o->free_p1 == NULL || !o->free_p1[i];
  }
  const dvi_path_options options = {.ends = DVI_ENDS_MIXED,
                                    .steps = o->steps,
                                    .start = o->start,
                                    .span = o->span,
                                    .dimension = 2 * own->n,
                                    .q0 = numbers,
                                    .q1 = numbers + 2 * n,
                                    .p0 = numbers + 4 * n,
                                    .p1 = numbers + 6 * n,
                                    .free0 = free0,
                                    .free1 = free1};
  if (status == DVI_OK)
    status = dvi_path_create(own->doubled->system, method, &options, &own->path);
  dvi__release(numbers);
  dvi__release(free0);
  return status;
}

static dvi_status assemble(dvi_control *own, const dvi_system *system, const char *method,
                           const dvi_controls *controls, const dvi_control_options *o)
{
  DVI_TRY(dvi__doubled_create(system, controls, &own->doubled));
  DVI_TRY(make_path(own, method, o));
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__STATES, &own->counters, &own->states));
  own->point = DVI_NEW(double, 9 * own->n);
  if (own->point == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  own->v = own->point + 8 * own->n;
  return DVI_OK;
}

dvi_status dvi_control_create(const dvi_system *system, const char *method,
                              const dvi_controls *controls, const dvi_control_options *options,
                              dvi_control **control)
{
  if (control == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "control: no place for the result");
  *control = NULL;
  DVI_TRY(check_arguments(system, method, controls, options));
  DVI_TRY(check_method(system, method));
  dvi_control *made = DVI_NEW(dvi_control, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "control: no memory");
  made->n = system->n;
  made->m = controls->count;
  made->free_span = options->free_span != 0;
  const dvi_status status = assemble(made, system, method, controls, options);
  if (status != DVI_OK) dvi_control_destroy(&made);
  *control = made;
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "control");
}

void dvi_control_destroy(dvi_control **control)
{
  if (control == NULL || *control == NULL) return;
  dvi_control *own = *control;
  dvi_path_destroy(&own->path);
  dvi__doubled_destroy(&own->doubled);
  dvi__evaluator_destroy(&own->states);
  dvi__release(own->point);
  dvi__release(own);
  *control = NULL;
}

dvi_status dvi_control_guess(dvi_control *own, int points, int dimension, const double *t,
                             const double *q)
{
  if (own == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "control: no problem to guess");
  if (points < 2 || dimension != own->n || q == NULL)
    return dvi__fail(DVI_BAD_SIZE, "control: a guess of %d points in %d coordinates", points,
                     dimension);
  const size_t n = (size_t)own->n;
  double *both = DVI_NEW(double, 2 * n * (size_t)points);
  if (both == NULL) return dvi__fail(DVI_NO_MEMORY, "control: no memory for %d points", points);
  for (size_t k = 0; k < (size_t)points; k++)
    memcpy(both + 2 * n * k, q + n * k, n * sizeof(double));
  const dvi_status status = dvi_path_guess(own->path, points, 2 * own->n, t, both);
  dvi__release(both);
  own->solved = own->solved && status != DVI_OK;
  return status;
}

/* ---- solve ---- */

/* Evaluate u at quadrature point j of step k, and q and v there in `point`. */
static dvi_status point_controls(dvi_control *own, int k, int j, double *t, double *u)
{
  dvi__path_place(own->path, own->path->x, k);
  const dvi__path_points points = dvi__action_two_point_points(own->path->action, own->path->Y);
  const size_t n2 = 2 * (size_t)own->n, r = (size_t)points.count;
  *t = points.t[j];
  for (size_t i = 0; i < n2; i++) {
    own->point[i] = points.Q[i * r + (size_t)j];
    own->point[n2 + i] = points.V[i * r + (size_t)j];
  }
  return dvi__doubled_minimise(own->doubled, *t, own->point, own->point + n2, own->point + own->n,
                               u);
}

static dvi_status measure_cost(dvi_control *own, double *cost)
{
  const double h = dvi__path_span(own->path, own->path->x) / own->path->steps;
  const int r = dvi__action_nodes(own->path->action);
  *cost = 0;
  for (int k = 0; k < own->path->steps; k++)
    for (int j = 0; j < r; j++) {
      double t, C, u[DVI__CONTROLS_MOST];
      DVI_TRY(point_controls(own, k, j, &t, u));
      const double weight = dvi__action_two_point_points(own->path->action, own->path->Y).weight[j];
      DVI_TRY(dvi__doubled_cost(own->doubled, t, own->point, own->point + 2 * own->n, u, &C));
      *cost += h * weight * C;
    }
  return DVI_OK;
}

/* Solve for one barrier. A failure in the controls has its own sentence. */
static dvi_status solve_once(dvi_control *own, dvi_path_report *found, int *iterations)
{
  const dvi_status status = dvi_path_solve(own->path, found);
  *iterations += found->iterations;
  if (status == DVI_OK) return DVI_OK;
  if (own->doubled->trouble[0] != '\0' &&
      (status == DVI_CALLBACK_RETRY || status == DVI_NOT_CONVERGED))
    return dvi__fail(DVI_NOT_CONVERGED, "%s", own->doubled->trouble);
  return status;
}

/* Solve for a falling sequence of barriers, each from the solution for the one before. */
static dvi_status solve_all(dvi_control *own, dvi_path_report *found, dvi_control_report *report)
{
  double size;
  dvi__doubled *d = own->doubled;
  DVI_TRY(dvi__doubled_choose_unit(d, own->path->start, own->path->span, own->path->q0, &size));
  if (!dvi__doubled_is_bounded(d)) return solve_once(own, found, &report->iterations);
  for (d->mu = first_barrier * size;; d->mu = fmax(next_barrier * d->mu, last_barrier * size)) {
    DVI_TRY(solve_once(own, found, &report->iterations));
    if (d->mu <= last_barrier * size) break;
  }
  report->barrier = d->mu * d->unit;
  return DVI_OK;
}

/* ---- a free span ---- */

/* Compute the derivative of the cost by the span, in the cost's unit. With the path's numbers fixed
 * the action h sum_j b_j G(Q_j, V_j) changes by its h and by V = X'/h, by
 *
 *     sum_j b_j (G - V.G_v)_j / N     over all steps. */
static dvi_status slope_by_span(dvi_control *own, double *slope)
{
  dvi_path *path = own->path;
  dvi__evaluator *e = dvi__action_evaluator(path->action);
  const size_t n2 = 2 * (size_t)own->n;
  *slope = 0;
  for (int k = 0; k < path->steps; k++) {
    dvi__path_place(path, path->x, k);
    const dvi__path_points points = dvi__action_two_point_points(path->action, path->Y);
    const size_t r = (size_t)points.count;
    for (size_t j = 0; j < r; j++) {
      double G, *q = own->point, *v = q + n2, *G_q = v + n2, *G_v = G_q + n2;
      for (size_t i = 0; i < n2; i++) q[i] = points.Q[i * r + j], v[i] = points.V[i * r + j];
      DVI_TRY(dvi__lagrangian_value(e, 1, &points.t[j], q, v, &G));
      DVI_TRY(dvi__lagrangian_gradient(e, 1, &points.t[j], q, v, G_q, G_v));
      for (size_t i = 0; i < n2; i++) G -= v[i] * G_v[i];
      *slope += points.weight[j] * G / path->steps;
    }
  }
  return DVI_OK;
}

static dvi_status solve_over(dvi_control *own, double span, dvi_path_report *found, int *iterations,
                             double *slope)
{
  own->path->span = span;
  DVI_TRY(solve_once(own, found, iterations));
  return slope_by_span(own, slope);
}

/* Find the span at which the slope is 0, by the secant method with steps of at most half the span,
 * to the rounding of the slope. */
static dvi_status search_span(dvi_control *own, dvi_path_report *found, int *iterations)
{
  const double guess = own->path->span;
  double before = guess, span = guess * (1 + first_change), slope_before, slope;
  DVI_TRY(slope_by_span(own, &slope_before));
  for (int k = 0; k < MOST_SPANS; k++) {
    DVI_TRY(solve_over(own, span, found, iterations, &slope));
    double change = -slope * (span - before) / (slope - slope_before);
    if (!isfinite(change)) change = 0;
    if (fabs(change) <= 4 * DBL_EPSILON * span ||
        (fabs(span - before) < last_change * span && fabs(slope) >= 0.5 * fabs(slope_before)))
      return DVI_OK;
    before = span;
    slope_before = slope;
    span += fmax(fmin(change, 0.5 * span), -0.5 * span);
    if (!(span < largest_span * guess) || !(span * largest_span > guess)) break;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "no span near %g has the least cost: at %g the cost changes by %.2g per unit of "
                   "time; where slower is always cheaper the cost must count the time, as in u^2/2 "
                   "+ 1",
                   guess, before, slope_before * own->doubled->unit);
}

static int count_multipliers(const dvi_control *own)
{
  int given = 0;
  for (int i = own->n; i < 2 * own->n; i++) given += dvi__path_given(own->path, 1, i) >= 0;
  return own->n * (own->path->steps * own->path->s + 1) - given;
}

static dvi_status solve_and_measure(dvi_control *own, dvi_control_report *report)
{
  dvi_path_report found = {0};
  DVI_TRY(solve_all(own, &found, report));
  if (own->free_span) DVI_TRY(search_span(own, &found, &report->iterations));
  report->span = own->path->span;
  DVI_TRY(measure_cost(own, &report->cost));
  report->gradient = found.gradient;
  report->negative = found.negative;
  report->zero = found.zero;
  report->multipliers = count_multipliers(own);
  report->is_minimum = found.negative < 0
                           ? -1
                           : found.negative == report->multipliers && found.zero == 0;
  return DVI_OK;
}

dvi_status dvi_control_solve(dvi_control *own, dvi_control_report *report)
{
  if (own == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "control: no problem to solve");
  dvi_control_report found = {0};
  const double span = own->path->span;
  const dvi_status status = solve_and_measure(own, &found);
  if (status != DVI_OK) own->path->span = span;
  own->solved = status == DVI_OK;
  if (status != DVI_OK) return dvi__fail_in(status, "control");
  if (report != NULL) *report = found;
  return DVI_OK;
}

/* ---- queries ---- */

int dvi_control_steps(const dvi_control *own)
{
  return own != NULL ? dvi_path_steps(own->path) : 0;
}

double dvi_control_time(const dvi_control *own, int k)
{
  return own != NULL ? dvi_path_time(own->path, k) : (double)NAN;
}

static int has_node(const dvi_control *own, int k)
{
  return own != NULL && own->solved && k >= 0 && k <= own->path->steps;
}

const double *dvi_control_q(const dvi_control *own, int k)
{
  return has_node(own, k) ? dvi_path_q(own->path, k) : NULL;
}

const double *dvi_control_p(const dvi_control *own, int k)
{
  return has_node(own, k) ? dvi_path_p(own->path, k) + own->n : NULL;
}

dvi_status dvi_control_costate(const dvi_control *own, int k, double *by_q, double *by_p)
{
  if (!has_node(own, k))
    return dvi__fail(DVI_BAD_STATE, "control: no costate of node %d before a solve", k);
  const double unit = own->doubled->unit;
  for (int i = 0; i < own->n; i++) {
    by_q[i] = -unit * dvi_path_p(own->path, k)[i];
    by_p[i] = unit * dvi_path_q(own->path, k)[own->n + i];
  }
  return DVI_OK;
}

/* The velocity is that of the momentum. Its guess is the mean of a step beside the node. */
dvi_status dvi_control_u(dvi_control *own, int k, double *u)
{
  if (!has_node(own, k))
    return dvi__fail(DVI_BAD_STATE, "control: no control of node %d before a solve", k);
  const int from = k > 0 ? k - 1 : 0, n = own->n;
  const double t = dvi_path_time(own->path, k), *q = dvi_path_q(own->path, k),
               h = dvi__path_span(own->path, own->path->x) / own->path->steps;
  for (int i = 0; i < n; i++)
    own->v[i] = (dvi_path_q(own->path, from + 1)[i] - dvi_path_q(own->path, from)[i]) / h;
  DVI_TRY(dvi__legendre_inverse(own->states, t, q, dvi_path_p(own->path, k) + n, own->v));
  return dvi__doubled_minimise(own->doubled, t, q, own->v, q + n, u);
}

dvi_status dvi_control_point(dvi_control *own, int k, int j, double *t, double *u)
{
  if (!has_node(own, k) || k == own->path->steps || j < 0 || j >= dvi_control_points(own))
    return dvi__fail(DVI_BAD_STATE, "control: no point %d of step %d before a solve", j, k);
  return point_controls(own, k, j, t, u);
}

int dvi_control_points(const dvi_control *own)
{
  return own != NULL ? dvi__action_nodes(own->path->action) : 0;
}

const char *dvi_control_method(const dvi_control *own)
{
  return own != NULL ? dvi_path_method(own->path) : NULL;
}
