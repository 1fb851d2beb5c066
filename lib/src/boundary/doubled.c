#include "boundary/doubled.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

enum { ITERATIONS = 100, HALVINGS = 40 };

/* ---- callbacks of the controls ---- */

static dvi_status check_returned(const char *what, int returned, double t)
{
  if (returned == 0) return DVI_OK;
  return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "the controls' %s failed (%d) at t = %g", what, returned, t);
}

dvi_status dvi__doubled_cost(dvi__doubled *d, double t, const double *q, const double *v,
                             const double *u, double *C)
{
  const size_t n = (size_t)d->of->n;
  *C = 0;
  memset(d->C_q, 0, n * sizeof(double));
  memset(d->C_v, 0, n * sizeof(double));
  memset(d->C_u, 0, sizeof d->C_u);
  DVI_TRY(check_returned(
      "cost", d->controls.cost(t, q, v, u, C, d->C_q, d->C_v, d->C_u, d->controls.user), t));
  if (isfinite(*C) && dvi__first_not_finite(DVI__CONTROLS_MOST, d->C_u) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the cost is not finite at t = %g", t);
}

static dvi_status control_force(dvi__doubled *d, double t, const double *q, const double *v,
                                const double *u)
{
  const size_t n = (size_t)d->of->n, m = (size_t)d->controls.count;
  memset(d->F, 0, n * sizeof(double));
  memset(d->F_q, 0, n * n * sizeof(double));
  memset(d->F_v, 0, n * n * sizeof(double));
  memset(d->F_u, 0, n * m * sizeof(double));
  return check_returned(
      "force", d->controls.force(t, q, v, u, d->F, d->F_q, d->F_v, d->F_u, d->controls.user), t);
}

/* ---- the minimum over u ---- */

/* The function of u at one point. */
typedef struct choice {
  dvi__doubled *of;
  double t;
  const double *q, *v, *w;
} choice;

static double dot(size_t n, const double *x, const double *y)
{
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

static double barrier(const dvi__doubled *d, const double *u)
{
  double sum = 0;
  for (int a = 0; a < d->controls.count; a++) {
    if (isfinite(d->least[a])) sum -= d->mu * log(u[a] - d->least[a]);
    if (isfinite(d->most[a])) sum -= d->mu * log(d->most[a] - u[a]);
  }
  return sum;
}

/* Evaluate C/unit + w.F, and its derivatives by u without those of the barrier. */
static dvi_status choice_value(const choice *c, const double *u, double *value, double *slope)
{
  dvi__doubled *d = c->of;
  const size_t n = (size_t)d->of->n;
  double C;
  DVI_TRY(dvi__doubled_cost(d, c->t, c->q, c->v, u, &C));
  DVI_TRY(control_force(d, c->t, c->q, c->v, u));
  *value = C / d->unit + dot(n, c->w, d->F);
  for (size_t a = 0; a < (size_t)d->controls.count; a++)
    slope[a] = d->C_u[a] / d->unit + dot(n, c->w, d->F_u + a * n);
  return DVI_OK;
}

static double room_of(const dvi__doubled *d, const double *u, int a)
{
  return fmin(u[a] - d->least[a], d->most[a] - u[a]);
}

/* Difference the slopes, and add the second derivatives of the barrier. */
static dvi_status choice_hessian(const choice *c, double *u, double *H)
{
  const dvi__doubled *d = c->of;
  const int m = d->controls.count;
  double value, more[DVI__CONTROLS_MOST] = {0}, less[DVI__CONTROLS_MOST] = {0};
  for (int b = 0; b < m; b++) {
    const double at = u[b], delta = fmin(1e-4 * fmax(1, fabs(at)), 0.5 * room_of(d, u, b));
    u[b] = at + delta;
    DVI_TRY(choice_value(c, u, &value, more));
    u[b] = at - delta;
    DVI_TRY(choice_value(c, u, &value, less));
    u[b] = at;
    for (int a = 0; a < m; a++) H[b * m + a] = (more[a] - less[a]) / (2 * delta);
    if (isfinite(d->least[b])) H[b * m + b] += d->mu / pow(at - d->least[b], 2);
    if (isfinite(d->most[b])) H[b * m + b] += d->mu / pow(d->most[b] - at, 2);
  }
  return DVI_OK;
}

/* Solve H x = b in place by Cholesky's factors. Returns 0 if H is not positive definite. */
static int solve_positive(int m, double *H, double *b)
{
  for (int j = 0; j < m; j++) {
    for (int k = 0; k < j; k++)
      for (int i = j; i < m; i++) H[j * m + i] -= H[k * m + i] * H[k * m + j];
    if (!(H[j * m + j] > 0)) return 0;
    const double root = sqrt(H[j * m + j]);
    for (int i = j; i < m; i++) H[j * m + i] /= root;
  }
  for (int j = 0; j < m; j++) {
    b[j] /= H[j * m + j];
    for (int i = j + 1; i < m; i++) b[i] -= H[j * m + i] * b[j];
  }
  for (int j = m - 1; j >= 0; j--) {
    for (int i = j + 1; i < m; i++) b[j] -= H[j * m + i] * b[i];
    b[j] /= H[j * m + j];
  }
  return 1;
}

static dvi_status not_found(dvi__doubled *d, const char *why, double t)
{
  const dvi_status status = dvi__fail(DVI_NOT_CONVERGED, "%s at t = %g", why, t);
  strncpy(d->trouble, dvi_last_error(), sizeof d->trouble - 1);
  return status;
}

/* Compute Newton's correction du at u. */
static dvi_status choice_correction(const choice *c, double *u, double *value, double *du)
{
  dvi__doubled *d = c->of;
  const int m = d->controls.count;
  double H[DVI__CONTROLS_MOST * DVI__CONTROLS_MOST], slope[DVI__CONTROLS_MOST];
  DVI_TRY(choice_hessian(c, u, H));
  DVI_TRY(choice_value(c, u, value, slope));
  *value += barrier(d, u);
  for (int a = 0; a < m; a++) {
    du[a] = -slope[a];
    if (isfinite(d->least[a])) du[a] += d->mu / (u[a] - d->least[a]);
    if (isfinite(d->most[a])) du[a] -= d->mu / (d->most[a] - u[a]);
  }
  if (solve_positive(m, H, du)) return DVI_OK;
  return not_found(d, "the cost has no minimum in the controls, or is not strictly convex there,",
                   c->t);
}

/* Move u along du, within the bounds, to a value that is not larger. Returns the part of du. */
static dvi_status choice_move(const choice *c, double value, const double *du, double *u)
{
  const dvi__doubled *d = c->of;
  const int m = d->controls.count;
  double part = 1, from[DVI__CONTROLS_MOST], next, slope[DVI__CONTROLS_MOST], size = 0;
  memcpy(from, u, (size_t)m * sizeof(double));
  for (int a = 0; a < m; a++) {
    const double room = du[a] > 0 ? d->most[a] - u[a] : u[a] - d->least[a];
    if (part * fabs(du[a]) > 0.9 * room) part = 0.9 * room / fabs(du[a]);
    size = fmax(size, fabs(du[a]) / fmax(1e-3, fabs(u[a])));
  }
  for (int k = 0; k < HALVINGS; k++, part /= 2) {
    for (int a = 0; a < m; a++) u[a] = from[a] + part * du[a];
    DVI_TRY(choice_value(c, u, &next, slope));
    if (next + barrier(d, u) <= value + 64 * DBL_EPSILON * fabs(value) || size < 1e-6)
      return DVI_OK;
  }
  return DVI_OK;
}

static void start_choice(const dvi__doubled *d, double *u)
{
  for (int a = 0; a < d->controls.count; a++) {
    const double low = d->least[a], high = d->most[a];
    u[a] = 0;
    if (isfinite(low) && isfinite(high))
      u[a] = 0.5 * (low + high);
    else if (isfinite(low))
      u[a] = fmax(0, low + 1);
    else if (isfinite(high))
      u[a] = fmin(0, high - 1);
  }
}

dvi_status dvi__doubled_minimise(dvi__doubled *d, double t, const double *q, const double *v,
                                 const double *w, double *u)
{
  const choice c = {d, t, q, v, w};
  double value, du[DVI__CONTROLS_MOST] = {0}, last = HUGE_VAL;
  d->trouble[0] = '\0';
  start_choice(d, u);
  for (int k = 0; k < ITERATIONS; k++) {
    double size = 0, relative = 0;
    DVI_TRY(choice_correction(&c, u, &value, du));
    for (int a = 0; a < d->controls.count; a++) {
      size = fmax(size, fabs(du[a]) / fmax(1e-3, fabs(u[a])));
      relative = fmax(relative, fabs(du[a]) / fmax(DBL_MIN, fabs(u[a]) + fabs(du[a])));
    }
    DVI_TRY(choice_move(&c, value, du, u));
    if (relative <= DBL_EPSILON || (size < 1e-9 && size >= 0.5 * last)) return DVI_OK;
    last = size;
  }
  return not_found(d, "no minimum of the cost in the controls was found", t);
}

/* ---- the Lagrangian ---- */

/* Add factor H^T x to y, for a matrix on a pattern. */
static void add_transposed(const dvi__pattern *pattern, const double *H, const double *x, double *y)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      y[j] += H[e] * x[pattern->row[e]];
}

/* Add H x to y. */
static void add_product(const dvi__pattern *pattern, const double *H, const double *x, double *y)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      y[pattern->row[e]] += H[e] * x[j];
}

/* Tell a callback's caller about a failure: it may go on from another point, or not. */
static int as_returned(dvi_status status)
{
  return status == DVI_OK ? 0 : status > 0 ? 1 : -1;
}

static dvi_status evaluate(dvi__doubled *d, double t, const double *q, const double *v, double *G)
{
  const size_t n = (size_t)d->of->n;
  double u[DVI__CONTROLS_MOST], slope[DVI__CONTROLS_MOST];
  const choice c = {d, t, q, v, q + n};
  DVI_TRY(dvi__doubled_minimise(d, t, q, v, q + n, u));
  DVI_TRY(choice_value(&c, u, G, slope));
  DVI_TRY(dvi__lagrangian_gradient(d->evaluator, 1, &t, q, v, d->L_q, d->L_v));
  *G += barrier(d, u) + dot(n, q + n, d->L_q) + dot(n, v + n, d->L_v);
  return DVI_OK;
}

static int doubled_value(double t, const double *q, const double *v, double *G, void *user)
{
  return as_returned(evaluate(user, t, q, v, G));
}

static dvi_status evaluate_gradient(dvi__doubled *d, double t, const double *q, const double *v,
                                    double *G_q, double *G_v)
{
  const dvi_system *of = d->of;
  const size_t n = (size_t)of->n;
  const double *w = q + n, *w_rate = v + n;
  double G;
  DVI_TRY(evaluate(d, t, q, v, &G));
  DVI_TRY(dvi__lagrangian_hessian(d->evaluator, 1, &t, q, v, d->qq, d->qv, d->vv));
  for (size_t i = 0; i < n; i++) {
    G_q[i] = d->C_q[i] / d->unit + dot(n, w, d->F_q + i * n);
    G_v[i] = d->C_v[i] / d->unit + dot(n, w, d->F_v + i * n);
    G_q[n + i] = d->L_q[i] + d->F[i];
    G_v[n + i] = d->L_v[i];
  }
  add_transposed(&of->qq, d->qq, w, G_q);
  add_transposed(&of->qv, d->qv, w, G_v);
  add_product(&of->qv, d->qv, w_rate, G_q);
  add_product(&of->vv, d->vv, w_rate, G_v);
  if (of->force_count == 0) return DVI_OK;
  DVI_TRY(dvi__forces_jacobian(d->evaluator, 1, &t, q, v, d->by_q, d->by_v));
  add_transposed(&of->by_q, d->by_q, w, G_q);
  add_transposed(&of->by_v, d->by_v, w, G_v);
  return DVI_OK;
}

static int doubled_gradient(double t, const double *q, const double *v, double *G_q, double *G_v,
                            void *user)
{
  return as_returned(evaluate_gradient(user, t, q, v, G_q, G_v));
}

/* ---- create ---- */

static int allocate(dvi__doubled *d)
{
  const size_t n = (size_t)d->of->n, m = (size_t)d->controls.count,
               qq = (size_t)dvi__pattern_entries(&d->of->qq),
               qv = (size_t)dvi__pattern_entries(&d->of->qv),
               vv = (size_t)dvi__pattern_entries(&d->of->vv),
               forces = d->of->force_count > 0 ? 1 : 0,
               by_q = forces ? (size_t)dvi__pattern_entries(&d->of->by_q) : 0,
               by_v = forces ? (size_t)dvi__pattern_entries(&d->of->by_v) : 0;
  const struct {
    double **array;
    size_t count;
  } wanted[] = {{&d->L_q, n},     {&d->L_v, n},     {&d->F, n},       {&d->C_q, n}, {&d->C_v, n},
                {&d->F_q, n * n}, {&d->F_v, n * n}, {&d->F_u, n * m}, {&d->qq, qq}, {&d->qv, qv},
                {&d->vv, vv},     {&d->by_q, by_q}, {&d->by_v, by_v}};
  size_t all = 0;
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) all += wanted[k].count;
  double *at = d->numbers = DVI_NEW(double, all);
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted && d->numbers != NULL; k++) {
    *wanted[k].array = at;
    at += wanted[k].count;
  }
  return d->numbers != NULL;
}

static dvi_status copy_bounds(dvi__doubled *d, const dvi_controls *controls)
{
  for (int a = 0; a < controls->count; a++) {
    d->least[a] = controls->least != NULL ? controls->least[a] : -HUGE_VAL;
    d->most[a] = controls->most != NULL ? controls->most[a] : HUGE_VAL;
    if (!(d->least[a] < d->most[a]))
      return dvi__fail(DVI_BAD_ARGUMENT, "control %d is to lie between %g and %g", a, d->least[a],
                       d->most[a]);
  }
  return DVI_OK;
}

static dvi_status assemble(dvi__doubled *d)
{
  const dvi_lagrangian G = {.value = doubled_value, .gradient = doubled_gradient, .user = d};
  const dvi_system_terms terms = {.dimension = 2 * d->of->n, .lagrangian = &G};
  DVI_TRY(dvi__evaluator_create(d->of, 1, DVI__HESSIANS, &d->counters, &d->evaluator));
  if (!allocate(d)) return dvi__fail(DVI_NO_MEMORY, "no memory for %d coordinates", d->of->n);
  return dvi_system_create(&terms, &d->system);
}

dvi_status dvi__doubled_create(const dvi_system *system, const dvi_controls *controls,
                               dvi__doubled **doubled)
{
  dvi__doubled *made = *doubled = DVI_NEW(dvi__doubled, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  made->of = system;
  made->controls = *controls;
  made->unit = 1;
  dvi_status status = copy_bounds(made, controls);
  if (status == DVI_OK) status = assemble(made);
  if (status != DVI_OK) dvi__doubled_destroy(doubled);
  return status;
}

void dvi__doubled_destroy(dvi__doubled **doubled)
{
  dvi__doubled *own = *doubled;
  if (own == NULL) return;
  dvi_system_destroy(&own->system);
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own->numbers);
  dvi__release(own);
  *doubled = NULL;
}

int dvi__doubled_is_bounded(const dvi__doubled *d)
{
  for (int a = 0; a < d->controls.count; a++)
    if (isfinite(d->least[a]) || isfinite(d->most[a])) return 1;
  return 0;
}

/* ---- the unit of the cost ---- */

dvi_status dvi__doubled_choose_unit(dvi__doubled *d, double t, double span, const double *q,
                                    double *size)
{
  const size_t n = (size_t)d->of->n, m = (size_t)d->controls.count;
  double u[DVI__CONTROLS_MOST], H[DVI__CONTROLS_MOST * DVI__CONTROLS_MOST], width = 1;
  double *rest = d->L_q; /* the velocity and the multipliers are 0 */
  memset(rest, 0, n * sizeof(double));
  const choice c = {d, t, q, rest, rest};
  d->unit = 1;
  d->mu = 0;
  start_choice(d, u);
  DVI_TRY(choice_hessian(&c, u, H));
  const double curvature = dvi__largest(m * m, H), force = dvi__largest(n * m, d->F_u);
  DVI_TRY(dvi__lagrangian_hessian(d->evaluator, 1, &t, q, rest, d->qq, d->qv, d->vv));
  const double mass = dvi__largest((size_t)dvi__pattern_entries(&d->of->vv), d->vv);
  const double unit = curvature * mass / (force * force * span * span);
  if (unit > 0 && isfinite(unit)) d->unit = unit;
  for (size_t a = 0; a < m; a++)
    if (isfinite(d->least[a]) && isfinite(d->most[a]))
      width = fmax(width, d->most[a] - d->least[a]);
  *size = (curvature > 0 ? curvature : 1) * width * width / d->unit;
  return DVI_OK;
}
