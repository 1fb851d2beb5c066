/* Static states: minima of the energy -L(q, 0) by damped Newton steps
 *
 *     (H + c diag |H|) d = -g,     q <- q + d,
 *
 * whose damping c grows where H is not positive definite or the energy does not fall, and shrinks
 * otherwise (Marquardt 1963). Positions of nodes may leave the energy nearly as it is. A large
 * kappa, with a regular mesh, comes first, therefore, and is lowered to its value by steps. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"
#include "num/finite.h"
#include "num/linear.h"

enum { ITERATIONS = 500, STAGES = 10 /* values of kappa, each a tenth of the last one */ };

static const double floor_of_gradient = 1e-12, most_damping = 1e12, least_damping = 1e-12,
                    next_damping = 1e-4;

typedef struct statics {
  dvi_moving m; /* with the kappa of this stage */
  double *q, *trial, *gradient, *step, *hessian, *matrix;
  dvi__linear *linear;
  double energy, damping;
  int iterations;
} statics;

/* ---- one state ---- */

static dvi_status verdict(int returned)
{
  if (returned == 0) return DVI_OK;
  char reason[DVI__SENTENCE_SIZE];
  dvi__take_reason(reason);
  return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED, "moving: %s",
                   reason[0] != '\0' ? reason : "a callback failed at a static state");
}

/* Evaluate the energy, and its gradient and Hessian if they are wanted. */
static dvi_status evaluate(const statics *s, const double *q, double *energy, double *g, double *H)
{
  const dvi__moving_state state = {.q = q};
  DVI_TRY(verdict(
      dvi__moving_sum(&s->m, &state, &(dvi__moving_sums){.L = energy, .L_q = g, .L_qq = H})));
  const int entries = dvi__pattern_entries(&s->m.pattern);
  *energy = -*energy;
  for (int i = 0; i < s->m.unknowns && g != NULL; i++) g[i] = -g[i];
  for (int e = 0; e < entries && H != NULL; e++) H[e] = -H[e];
  if (isfinite(*energy) && (g == NULL || dvi__first_not_finite((size_t)s->m.unknowns, g) < 0) &&
      (H == NULL || dvi__first_not_finite((size_t)entries, H) < 0))
    return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "moving: the density is not finite at a static state");
}

static double *diagonal(const statics *s, double *matrix, int i)
{
  return matrix + dvi__pattern_find(&s->m.pattern, i, i);
}

/* Give the size of a gradient that moves an unknown by its whole size. */
static double gradient_size(const statics *s)
{
  double stiff = 0;
  for (int i = 0; i < s->m.unknowns; i++) stiff = fmax(stiff, fabs(*diagonal(s, s->hessian, i)));
  return stiff * fmax(dvi__largest((size_t)s->m.unknowns, s->q),
                      pow(s->m.volume / s->m.cells, 1.0 / s->m.dimension));
}

/* ---- one step ---- */

/* Find a step by the present damping. DVI_SINGULAR if the matrix is not positive definite. */
static dvi_status find_step(statics *s)
{
  const int n = s->m.unknowns;
  memcpy(s->matrix, s->hessian, (size_t)dvi__pattern_entries(&s->m.pattern) * sizeof(double));
  for (int i = 0; i < n; i++) {
    double *d = diagonal(s, s->matrix, i);
    *d += s->damping * fabs(*d);
  }
  DVI_TRY(dvi__linear_factor(s->linear, s->matrix));
  for (int i = 0; i < n; i++) s->step[i] = -s->gradient[i];
  DVI_TRY(dvi__linear_solve(s->linear, s->step));
  for (int i = 0; i < n; i++) s->trial[i] = s->q[i] + s->step[i];
  return dvi__first_not_finite((size_t)n, s->trial) < 0 ? DVI_OK : DVI_SINGULAR;
}

/* Take a step that lowers the energy, up to its rounding. *taken stays 0 if there is none. */
static dvi_status take_step(statics *s, int *taken)
{
  const double rounding = 1e-14 * s->m.cells * fabs(s->energy);
  for (; s->damping < most_damping; s->damping = fmax(4 * s->damping, next_damping)) {
    double energy;
    dvi_status status = find_step(s);
    if (status == DVI_OK) status = evaluate(s, s->trial, &energy, NULL, NULL);
    if (status < 0 && status != DVI_SINGULAR) return status;
    if (status != DVI_OK || energy > s->energy + rounding) continue;
    memcpy(s->q, s->trial, (size_t)s->m.unknowns * sizeof *s->q);
    s->damping = s->damping > least_damping ? s->damping / 10 : 0;
    *taken = 1;
    return DVI_OK;
  }
  return DVI_OK;
}

/* Iterate until the gradient stops to fall at its floor. */
static dvi_status minimise(statics *s, double *residual)
{
  double last = INFINITY;
  s->damping = 1e-3;
  for (int i = 0; i < ITERATIONS; i++, s->iterations++) {
    int taken = 0;
    DVI_TRY(evaluate(s, s->q, &s->energy, s->gradient, s->hessian));
    *residual = dvi__largest((size_t)s->m.unknowns, s->gradient);
    if (*residual <= floor_of_gradient * gradient_size(s) && *residual >= 0.5 * last) return DVI_OK;
    last = *residual;
    DVI_TRY(take_step(s, &taken));
    if (!taken && *residual <= floor_of_gradient * gradient_size(s)) return DVI_OK;
    if (!taken) break;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "moving: the energy's gradient is still %.3g after %d steps with kappa = %.3g: "
                   "start nearer to a minimum, or with a larger kappa",
                   *residual, s->iterations, s->m.kappa);
}

static dvi_status lower_kappa(statics *s, dvi_moving_report *report)
{
  const double kappa = s->m.kappa;
  DVI_TRY(evaluate(s, s->q, &s->energy, NULL, NULL));
  const double most = fabs(s->energy) / s->m.volume;
  for (int k = 0; k < STAGES && s->m.motion == DVI_MOVING_FREE; k++) {
    s->m.kappa = most * pow(10, -k);
    if (s->m.kappa > kappa) DVI_TRY(minimise(s, &report->residual));
  }
  s->m.kappa = kappa;
  DVI_TRY(minimise(s, &report->residual));
  report->iterations = s->iterations;
  report->energy = s->energy;
  return DVI_OK;
}

/* Give kappa's part of the energy. */
static dvi_status find_barrier(statics *s, dvi_moving_report *report)
{
  double without;
  s->m.kappa = 0;
  DVI_TRY(evaluate(s, s->q, &without, NULL, NULL));
  report->barrier = report->energy - without;
  return DVI_OK;
}

dvi_status dvi_moving_solve(const dvi_moving *moving, double *q, dvi_moving_report *report)
{
  if (moving == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and coordinates are needed");
  const size_t n = (size_t)moving->unknowns;
  const size_t entries = (size_t)dvi__pattern_entries(&moving->pattern);
  if (moving->motion == DVI_MOVING_EQUAL)
    return dvi__fail(DVI_UNSUPPORTED, "moving: static states with arcs of one length are not "
                                      "found: let the nodes be free, or prescribe them");
  DVI_TRY(dvi__moving_check(moving, &(dvi__moving_state){.q = q}));
  double *work = DVI_NEW(double, 4 * n + 2 * entries);
  if (work == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for a static state");
  statics s = {.m = *moving, .q = work, .trial = work + n};
  s.gradient = s.trial + n;
  s.step = s.gradient + n;
  s.hessian = s.step + n;
  s.matrix = s.hessian + entries;
  memcpy(s.q, q, n * sizeof *q);
  dvi_moving_report found = {0};
  dvi_status status = dvi__linear_create(&moving->pattern, DVI__LINEAR_DEFINITE, NULL, &s.linear);
  if (status == DVI_OK) status = lower_kappa(&s, &found);
  if (status == DVI_OK) status = find_barrier(&s, &found);
  if (status == DVI_OK) memcpy(q, s.q, n * sizeof *q);
  if (status == DVI_OK && report != NULL) *report = found;
  dvi__linear_destroy(&s.linear);
  dvi__release(work);
  return status;
}
