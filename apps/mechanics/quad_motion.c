/* Gragg's modified midpoint rule, extrapolated (Bulirsch and Stoer 1966), on qdot = v, pdot = L_q
 * with p = L_v(t,q,v) solved for v. No part of it is a variational integrator. */
#include "mechanics/quad_motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef QUAD_EXISTS
enum { COLUMNS = 12, ITERATIONS = 200, PARTS_MAX = 64, ROOM = 2 * COLUMNS + 16 };
static const double last_place = 1e-32; /* relative change of the velocity, two rounding errors */
static const double noise = 1e-26;      /* relative change that shrinks no more */
/* difference of velocities, exact for energies quadratic in them */
static const double difference = 1e-12;
/* error of a flow beyond which more steps would gain little */
static const double least_error = 3e-30;

bool quad_motion_init(quad_motion *motion, const dvi_scene *scene, int n)
{
  const size_t count = (size_t)n;
  *motion = (quad_motion){.scene = scene, .n = n, .q_size = 1.0, .p_size = 1.0};
  motion->inverse = calloc(3 * count * count, sizeof *motion->inverse);
  motion->room = calloc(ROOM * count, sizeof *motion->room);
  motion->pair = calloc(4 * count, sizeof *motion->pair);
  if (motion->inverse != NULL) motion->tracked = motion->inverse + 2 * count * count;
  return motion->inverse != NULL && motion->room != NULL && motion->pair != NULL;
}

void quad_motion_clear(quad_motion *motion)
{
  free(motion->inverse);
  free(motion->room);
  free(motion->pair);
}

static dvi_pair pair_of_quad(quad x)
{
  const double high = (double)x;
  return (dvi_pair){.high = high, .low = (double)(x - (quad)high)};
}

bool quad_motion_gradient(quad_motion *motion, quad t, const quad *q, const quad *v, quad *L_q,
                          quad *L_v)
{
  const int n = motion->n;
  dvi_pair *at = motion->pair, *L = at + 2 * n;
  for (int i = 0; i < n; i++) at[i] = pair_of_quad(q[i]), at[n + i] = pair_of_quad(v[i]);
  if (dvi_scene_quad_gradient(motion->scene, pair_of_quad(t), at, at + n, L, L + n) != DVI_OK)
    return false;
  for (int i = 0; i < n; i++) {
    L_q[i] = (quad)L[i].high + (quad)L[i].low;
    L_v[i] = (quad)L[n + i].high + (quad)L[n + i].low;
  }
  return true;
}

bool quad_motion_settle(quad_motion *motion, quad t, const quad *q, const quad *v)
{
  const int n = motion->n;
  quad *mass = motion->inverse + n * n, *moved = motion->room, *L_q = moved + n, *here = L_q + n,
       *there = here + n;
  const quad step = (quad)(difference * fmax(quad_largest(n, v), 1.0));
  if (!quad_motion_gradient(motion, t, q, v, L_q, here)) return false;
  for (int j = 0; j < n; j++) {
    memcpy(moved, v, (size_t)n * sizeof *moved);
    moved[j] += step;
    if (!quad_motion_gradient(motion, t, q, moved, L_q, there)) return false;
    for (int i = 0; i < n; i++) mass[i * n + j] = (there[i] - here[i]) / step;
  }
  return quad_invert(n, mass, motion->inverse);
}

/* Compute change = tracked * rest. */
static void multiply_tracked(const quad_motion *motion, const quad *rest, quad *change)
{
  const int n = motion->n;
  for (int i = 0; i < n; i++) {
    change[i] = 0;
    for (int j = 0; j < n; j++) change[i] += motion->tracked[i * n + j] * rest[j];
  }
}

/* Update B^-1 after a change s = B^-1 r of the velocity that left the residual r', with w = B^-1
 * r', by B^-1 += w (s^T B^-1) / s.(s - w). */
static void update_tracked(quad_motion *motion, const quad *s, const quad *w, quad *row)
{
  const int n = motion->n;
  quad divisor = 0;
  for (int i = 0; i < n; i++) divisor += s[i] * (s[i] - w[i]);
  if (!(fabs((double)divisor) > 0.0)) return;
  for (int j = 0; j < n; j++) {
    row[j] = 0;
    for (int i = 0; i < n; i++) row[j] += s[i] * motion->tracked[i * n + j] / divisor;
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) motion->tracked[i * n + j] += w[i] * row[j];
}

/* Solve for v by Broyden's method. L_q [n] belongs to the velocity before the last change, which is
 * a rounding error. */
static bool solve_velocity(quad_motion *motion, quad t, const quad *q, const quad *p, quad *v,
                           quad *L_q)
{
  const int n = motion->n;
  quad *rest = motion->room, *change = rest + n, *before = change + n, *row = before + n;
  double last = HUGE_VAL;
  for (int k = 0; k < ITERATIONS; k++) {
    if (!quad_motion_gradient(motion, t, q, v, L_q, rest)) return false;
    for (int i = 0; i < n; i++) rest[i] = p[i] - rest[i];
    multiply_tracked(motion, rest, change);
    const double moved = quad_largest(n, change), size = quad_largest(n, v);
    if (k > 0 && moved > noise * size) {
      update_tracked(motion, before, change, row);
      multiply_tracked(motion, rest, change);
    }
    for (int i = 0; i < n; i++) v[i] += change[i];
    if (moved <= last_place * size || (moved <= noise * size && moved >= 0.5 * last)) return true;
    memcpy(before, change, (size_t)n * sizeof *before);
    last = moved;
  }
  return false;
}

static void start_tracking(quad_motion *motion)
{
  memcpy(motion->tracked, motion->inverse,
         (size_t)(motion->n * motion->n) * sizeof *motion->inverse);
}

bool quad_motion_velocity(quad_motion *motion, quad t, const quad *q, const quad *p, quad *v)
{
  start_tracking(motion);
  return solve_velocity(motion, t, q, p, v, motion->room + 4 * motion->n);
}

/* Working memory of a flow, [n] or [2 n] each. */
typedef struct quad_flow {
  quad *v, *rate, *before, *column;
} quad_flow;

static bool flow_rate(quad_motion *motion, quad t, const quad *z, quad_flow *f)
{
  const int n = motion->n;
  const bool good = solve_velocity(motion, t, z, z + n, f->v, f->rate + n);
  memcpy(f->rate, f->v, (size_t)n * sizeof *f->v);
  return good;
}

/* Write z at t + span to `to`, by an even number `steps` of steps of the midpoint rule. */
static bool leapfrog(quad_motion *motion, quad t, quad span, int steps, const quad *z, quad_flow *f,
                     quad *to)
{
  const int size = 2 * motion->n;
  const quad h = span / steps;
  memcpy(f->before, z, (size_t)size * sizeof *z);
  if (!flow_rate(motion, t, z, f)) return false;
  for (int i = 0; i < size; i++) to[i] = z[i] + h * f->rate[i];
  for (int k = 1; k < steps; k++) {
    if (!flow_rate(motion, t + k * h, to, f)) return false;
    for (int i = 0; i < size; i++) {
      const quad next = f->before[i] + 2 * h * f->rate[i];
      f->before[i] = to[i];
      to[i] = next;
    }
  }
  return true;
}

/* Extrapolate columns of 2, 4, 6, .. steps to h = 0 by Neville's scheme in h^2. */
static bool extrapolate_flow(quad_motion *motion, quad t, quad span, quad_flow *f, quad *z)
{
  const int size = 2 * motion->n;
  for (int k = 0; k < COLUMNS; k++) {
    quad *last = f->column + k * size;
    if (!leapfrog(motion, t, span, 2 * (k + 1), z, f, last)) return false;
    for (int j = k - 1; j >= 0; j--) {
      const quad ratio = (quad)((k + 1) * (k + 1)) / ((j + 1) * (j + 1));
      quad *lower = f->column + j * size;
      for (int i = 0; i < size; i++)
        lower[i] = lower[i + size] + (lower[i + size] - lower[i]) / (ratio - 1);
    }
  }
  memcpy(z, f->column, (size_t)size * sizeof *z);
  return true;
}

double quad_motion_distance(const quad_motion *motion, const quad *z, const quad *other)
{
  const int n = motion->n;
  return hypot(quad_distance(n, z, other) / motion->q_size,
               quad_distance(n, z + n, other + n) / motion->p_size);
}

bool quad_motion_flow(quad_motion *motion, quad t, quad span, const quad *v, quad *z, double *error)
{
  const size_t n = (size_t)motion->n;
  quad *last = motion->room + 4 * n, *now = last + 2 * n;
  quad_flow f = {
      .v = now + 2 * n, .rate = now + 3 * n, .before = now + 5 * n, .column = now + 7 * n};
  const double wanted = fmax(*error, least_error);
  *error = HUGE_VAL;
  start_tracking(motion);
  for (int parts = 1; parts <= PARTS_MAX && *error > wanted; parts *= 2) {
    memcpy(now, z, 2 * n * sizeof *now);
    memcpy(f.v, v, n * sizeof *f.v);
    for (int k = 0; k < parts; k++)
      if (!extrapolate_flow(motion, t + k * span / parts, span / parts, &f, now)) return false;
    const double apart = parts > 1 ? quad_motion_distance(motion, now, last) : HUGE_VAL;
    memcpy(last, now, 2 * n * sizeof *last);
    if (parts > 1 && apart >= *error) break;
    *error = apart;
  }
  memcpy(z, last, 2 * n * sizeof *z);
  return isfinite(*error);
}
#endif
