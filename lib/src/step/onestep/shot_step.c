#include "step/onestep/shot_step.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

struct dvi__shot_step {
  dvi__shot *shot;
  dvi__evaluator *evaluator;
  dvi__pattern pattern; /* full */
  int n, type, on_H;    /* on_H is not 0 if the system declares a Hamiltonian */
  double t0;
  const double *q0, *p0;
  double *unit;               /* [n] momentum of a unit of q a step */
  double *start, *q, *p;      /* [2n] start k0 and pi0 of the last shot, and its halves */
  int known;                  /* extent of the knowledge about that shot, see below */
  double *shift;              /* [n] mu, or k0 - q0 */
  double *end, *reach, *gain; /* [2n] */
  double *x;                  /* [2n] unknowns of the last residual */
  double *motion, *values;    /* [2n*2n] motion and values of the last Jacobian */
};

enum { NOTHING, REACH, DERIVATIVES };

/* ---- create ---- */

static double **shot_step_owned_array(dvi__shot_step *s, int i)
{
  double **const all[] = {&s->unit, &s->start, &s->shift,  &s->end,   &s->reach,
                          &s->gain, &s->x,     &s->motion, &s->values};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status shot_step_allocate(dvi__shot_step *s)
{
  const size_t n = (size_t)s->n,
               size[] = {n, 2 * n, n, 2 * n, 2 * n, 2 * n, 2 * n, 4 * n * n, 4 * n * n};
  for (int i = 0; shot_step_owned_array(s, i) != NULL; i++) {
    *shot_step_owned_array(s, i) = DVI_NEW(double, size[i]);
    if (*shot_step_owned_array(s, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d dimensions", s->n);
  }
  s->q = s->start;
  s->p = s->start + n;
  return DVI_OK;
}

static dvi_status shot_step_initialise(dvi__shot_step *s, const dvi_system *system,
                                       const dvi__runge_kutta *method, const dvi__course *course,
                                       dvi_counters *counters)
{
  DVI_TRY(shot_step_allocate(s));
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, 2 * s->n, "shooting", &s->pattern));
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__GRADIENTS, counters, &s->evaluator));
  return dvi__shot_create(system, method, course, counters, &s->shot);
}

dvi_status dvi__shot_step_create(const dvi_system *system, int type, const dvi__runge_kutta *method,
                                 const dvi__course *course, dvi_counters *counters,
                                 dvi__shot_step **step)
{
  *step = NULL;
  dvi__shot_step *s = DVI_NEW(dvi__shot_step, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  s->n = system->n;
  s->type = type;
  s->on_H = (system->terms & DVI__HAMILTONIAN) != 0;
  const dvi_status status = shot_step_initialise(s, system, method, course, counters);
  if (status != DVI_OK) dvi__shot_step_destroy(&s);
  *step = s;
  return status;
}

void dvi__shot_step_destroy(dvi__shot_step **step)
{
  dvi__shot_step *s = *step;
  if (s == NULL) return;
  dvi__shot_destroy(&s->shot);
  dvi__evaluator_destroy(&s->evaluator);
  dvi__pattern_clear(&s->pattern);
  for (int i = 0; shot_step_owned_array(s, i) != NULL; i++)
    dvi__release(*shot_step_owned_array(s, i));
  dvi__release(s);
  *step = NULL;
}

const dvi__pattern *dvi__shot_step_pattern(const dvi__shot_step *s)
{
  return &s->pattern;
}

/* ---- the step ---- */

/* Choose the momentum that moves q by one unit in a step. The momenta of a Hamiltonian may not move
 * q, so that their sizes relative to q are taken. */
static dvi_status shot_step_choose_units(dvi__shot_step *s, double t0, double h, const double *v)
{
  const size_t n = (size_t)s->n;
  if (!s->on_H) {
    DVI_TRY(dvi__vector_field_mass(dvi__shot_vector_field(s->shot), t0, s->q0, v, s->unit));
    for (size_t i = 0; i < n; i++) s->unit[i] /= fabs(h);
    return DVI_OK;
  }
  DVI_TRY(dvi__state_rates(s->evaluator, t0, s->q0, s->p0, s->q, s->p, NULL));
  const double of_q = fmax(dvi__largest(n, s->q0), fabs(h) * dvi__largest(n, s->q));
  const double least = 0x1p-40 * fmax(dvi__largest(n, s->p0), fabs(h) * dvi__largest(n, s->p));
  for (size_t i = 0; i < n; i++) {
    const double unit = fmax(fmax(fabs(s->p0[i]), fabs(h * s->p[i])), least) / of_q;
    s->unit[i] = isnormal(unit) && isnormal(1 / unit) ? unit : 1;
  }
  return DVI_OK;
}

/* Put the start of the shot for x. If the last shot had the same start, all its results remain
 * valid. */
static void shot_step_put(dvi__shot_step *s, const double *x)
{
  for (int i = 0; i < s->n; i++) {
    const double q = s->q0[i] + (s->type == 3 ? x[i] : 0),
                 p = s->type == 3 ? s->p0[i] : s->unit[i] * x[i];
    if (q != s->q[i] || p != s->p[i]) s->known = NOTHING;
    s->shift[i] = s->type == 1 ? 0 : s->type == 2 ? x[s->n + i] : x[i];
    s->q[i] = q;
    s->p[i] = p;
  }
}

static dvi_status shot_step_fire(dvi__shot_step *s)
{
  if (s->known >= REACH) return DVI_OK;
  DVI_TRY(dvi__shot_fire(s->shot, s->p, s->reach));
  s->known = REACH;
  return DVI_OK;
}

static dvi_status shot_step_trace(dvi__shot_step *s)
{
  if (s->known == DERIVATIVES) return DVI_OK;
  DVI_TRY(shot_step_fire(s));
  DVI_TRY(dvi__shot_trace(s->shot));
  s->known = DERIVATIVES;
  return DVI_OK;
}

dvi_status dvi__shot_step_place(dvi__shot_step *s, double t0, double h, double whole,
                                const double *q0, const double *p0, double *v, double *x)
{
  s->q0 = q0;
  s->p0 = p0;
  DVI_TRY(dvi__legendre_inverse(s->evaluator, t0, q0, p0, v));
  DVI_TRY(shot_step_choose_units(s, t0, whole, v));
  dvi__shot_aim(s->shot, t0, h, s->q, s->unit);
  dvi__vector_field_guess(dvi__shot_vector_field(s->shot), v);
  for (int i = 0; i < s->n; i++) {
    x[i] = s->type == 3 ? 0 : p0[i] / s->unit[i];
    x[s->n + i] = 0;
  }
  shot_step_put(s, x);
  s->known = NOTHING;
  DVI_TRY(shot_step_fire(s));
  for (int i = 0; i < s->n && s->type != 2; i++)
    x[s->n + i] = (s->p[i] + s->reach[s->n + i]) / s->unit[i];
  return DVI_OK;
}

dvi_status dvi__shot_step_residual(void *step, const double *x, double *R)
{
  dvi__shot_step *s = step;
  const int n = s->n;
  shot_step_put(s, x);
  DVI_TRY(shot_step_trace(s));
  memcpy(s->x, x, 2 * (size_t)n * sizeof *x);
  for (int i = 0; i < n; i++) {
    s->end[i] = s->type == 2 ? -(s->p[i] + s->reach[n + i]) : -s->unit[i] * x[n + i];
    s->end[n + i] = s->type == 2 ? s->shift[i] : 0;
  }
  DVI_TRY(dvi__shot_costate(s->shot, s->end, s->gain));
  for (int i = 0; i < n; i++) {
    R[i] = s->gain[n + i] + s->shift[i];
    R[n + i] = (s->gain[i] + (s->p0[i] + s->end[i])) / s->unit[i];
  }
  return DVI_OK;
}

/* Compute the columns. These are motions of the start along q, then along p in its units. */
static dvi_status shot_step_motions(dvi__shot_step *s)
{
  const size_t z = 2 * (size_t)s->n;
  memset(s->motion, 0, z * z * sizeof *s->motion);
  for (size_t k = 0; k < z; k++)
    s->motion[k * z + k] = k < (size_t)s->n ? 1 : s->unit[k - (size_t)s->n];
  return dvi__shot_move(s->shot, s->motion);
}

/* Return the derivative of component l of the shot's end in direction i of its start, along q or
 * along p in units of unit_i. */
static double shot_step_moved(const dvi__shot_step *s, int l, int i)
{
  const double *column = s->motion + (size_t)i * 2 * (size_t)s->n;
  return i < s->n ? column[l] : column[l] / s->unit[i - s->n];
}

/* Return the effect of unknown k, which moves the start, on the row of direction `along`. This is
 * Q^T Pi and the terms beside G in the row. */
static double of_start(const dvi__shot_step *s, int k, int along, int own)
{
  const int n = s->n;
  double sum = s->type == 3 ? own : 0;
  for (int l = 0; l < n && s->type != 2; l++)
    sum += shot_step_moved(s, l, along) * s->motion[(s->type == 3 ? k : n + k) * 2 * n + n + l];
  return sum;
}

dvi_status dvi__shot_step_jacobian(void *step, const double *x, double *values)
{
  dvi__shot_step *s = step;
  const int n = s->n, z = 2 * n;
  shot_step_put(s, x);
  DVI_TRY(shot_step_trace(s));
  DVI_TRY(shot_step_motions(s));
  for (int k = 0; k < n; k++)
    for (int i = 0; i < z; i++) {
      const int along = i < n ? n + i : i - n; /* the motion of row i */
      const double row = i < n ? 1 : 1 / s->unit[i - n];
      values[k * z + i] = row * of_start(s, k, along, i == k) - (s->type != 3 && i == n + k);
      values[(n + k) * z + i] = row * (s->type == 2 ? shot_step_moved(s, n + k, along)
                                                    : -shot_step_moved(s, k, along) * s->unit[k]);
    }
  memcpy(s->values, values, (size_t)z * (size_t)z * sizeof *values);
  return DVI_OK;
}

/* Compute the increments, which are small. Their changes come from those of x and not from the
 * rows, where p1 is rounded. */
void dvi__shot_step_ends(const dvi__shot_step *s, const double *x, double *dq, double *dp)
{
  const int n = s->n, z = 2 * n;
  for (int i = 0; i < n; i++) {
    const double change = x[n + i] - s->x[n + i];
    dq[i] = s->reach[i] + s->shift[i] + (s->type == 2 ? change : 0);
    dp[i] = s->gain[i] + (s->type == 2 ? 0 : s->unit[i] * change);
  }
  for (int k = 0; k < z; k++)
    for (int i = 0; i < n; i++) dp[i] += s->unit[i] * s->values[k * z + n + i] * (x[k] - s->x[k]);
  for (int k = 0; k < n; k++) {
    const double change = x[k] - s->x[k], *motion = s->motion + (s->type == 3 ? k : n + k) * z;
    for (int i = 0; i < n; i++) dq[i] += motion[i] * change;
    for (int i = 0; i < n && s->type == 2; i++) dp[i] += motion[n + i] * change;
  }
}

dvi_status dvi__shot_step_duration(dvi__shot_step *s, const double *x, double *duration)
{
  shot_step_put(s, x);
  DVI_TRY(shot_step_fire(s));
  return dvi__shot_duration(s->shot, duration);
}
