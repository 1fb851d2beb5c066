/* Checking Taylor coefficients, all that may be requested, along a curve q(s) of degree 3 through
 * the point. The curve is expanded anew about points s = +-sigma, +-2 sigma, +-3 sigma. If c_k(s)
 * is coefficient k of a function about s, then (k+1) c_{k+1} is the slope of c_k. Central
 * differences of 6th order give this slope. Neither the requested degree nor the set of requested
 * results may change a coefficient. */
#include "system/check/check_taylor.h"

#include <dvi/taylor.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/evaluate/jet.h"

enum {
  DEGREE = DVI_TAYLOR_MAX,
  COEFFICIENTS = DEGREE + 1,
  PROBE = 4,
  CURVE = 3,
  SIDES = 3,
  BLOCKS = 6,
  ALL = (1 << BLOCKS) - 1
};

/* The coefficients of a curve, t [COEFFICIENTS], q and v [COEFFICIENTS*n]. */
typedef struct curve {
  double *t, *q, *v;
} curve;

/* A term, which is one of potential and lagrangian, and its curve. */
typedef struct subject {
  const dvi__potential_term *potential;
  const dvi__lagrangian_term *lagrangian;
  char owner[48]; /* name for messages */
  dvi__scratch *scratch;
  int n;
  curve own, moved; /* the curve, and its expansion about another point */
  /* Counts of entries of L, L_q, L_v, L_qq, L_qv, L_vv. They are 0 where a potential has none. */
  size_t length[BLOCKS];
  /* Coefficients [COEFFICIENTS times the counts] about the point, about another point, and the sum
   * of the differences. */
  double *here, *there, *sum;
  double noise[COEFFICIENTS]; /* effect of roundoff on coefficients up to k */
} subject;

static const char *const names[2][BLOCKS] = {{"V", "V_q", "", "V_qq", "", ""},
                                             {"L", "L_q", "L_v", "L_qq", "L_qv", "L_vv"}};

/* ---- evaluation ---- */

static void place_blocks(const subject *s, int degree, double *all, double **block)
{
  for (int b = 0; b < BLOCKS; all += (size_t)(degree + 1) * s->length[b++]) block[b] = all;
}

static size_t length_of_blocks(const subject *s, int degree)
{
  size_t length = 0;
  for (int b = 0; b < BLOCKS; b++) length += (size_t)(degree + 1) * s->length[b];
  return length;
}

/* Evaluate the series of the blocks in `wanted`. Each begins as NaN, so that missing numbers are
 * found. */
static dvi_status series_of(const subject *s, int degree, const curve *along, unsigned wanted,
                            double *all)
{
  double *block[BLOCKS];
  place_blocks(s, degree, all, block);
  memset(all, 0xff, length_of_blocks(s, degree) * sizeof *all);
  for (int b = 0; b < BLOCKS; b++)
    if ((wanted >> b & 1U) == 0) block[b] = NULL;
  if (s->potential != NULL)
    return dvi__potential_taylor(s->potential, s->n, degree, along->t, along->q, block[0], block[1],
                                 block[3]);
  const dvi__jets jets = {block[0], block[1], block[2], block[3], block[4], block[5]};
  return dvi__general_taylor(s->lagrangian, s->n, degree, along->t, along->q, along->v, &jets);
}

/* Expand x, of `count` numbers a coefficient, about sigma. Repeated synthetic division gives the
 * binomial formula. */
static void shift_series(int count, const double *x, double sigma, double *moved)
{
  memcpy(moved, x, COEFFICIENTS * (size_t)count * sizeof *moved);
  for (int first = 0; first < CURVE; first++)
    for (int k = CURVE - 1; k >= first; k--)
      for (int i = 0; i < count; i++) moved[k * count + i] += sigma * moved[(k + 1) * count + i];
}

static void move_curve(const subject *s, double sigma)
{
  shift_series(1, s->own.t, sigma, s->moved.t);
  shift_series(s->n, s->own.q, sigma, s->moved.q);
  shift_series(s->n, s->own.v, sigma, s->moved.v);
}

/* Count the numbers of a curve. They stand in a row that begins with t. */
static size_t numbers_of(int n)
{
  return COEFFICIENTS * (2 * (size_t)n + 1);
}

/* Evaluate the one-point callbacks in the place of coefficient 0. */
static dvi_status points_at(const subject *s, double *all)
{
  double *block[BLOCKS];
  const double *t = s->own.t, *q = s->own.q, *v = s->own.v;
  place_blocks(s, DEGREE, all, block);
  if (s->potential != NULL) {
    DVI_TRY(dvi__potential_value(s->potential, s->scratch, 1, t, q, block[0]));
    DVI_TRY(dvi__potential_gradient(s->potential, s->scratch, 1, t, q, block[1]));
    return dvi__potential_hessian(s->potential, s->scratch, 1, t, q, block[3]);
  }
  DVI_TRY(dvi__general_value(s->lagrangian, s->scratch, 1, t, q, v, block[0]));
  DVI_TRY(dvi__general_gradient(s->lagrangian, s->scratch, 1, t, q, v, block[1], block[2]));
  return dvi__general_hessian(s->lagrangian, s->scratch, 1, t, q, v, block[3], block[4], block[5]);
}

/* ---- sizes ---- */

static double largest_of(size_t count, const double *x)
{
  double largest = 0;
  for (size_t i = 0; i < count; i++) largest = fmax(largest, fabs(x[i]));
  return largest;
}

/* Return the largest coefficient k of all blocks, for terms of one block may cancel in another. */
static double largest_at(const subject *s, int degree, int k, const double *all)
{
  double largest = 0;
  for (int b = 0; b < BLOCKS; all += (size_t)(degree + 1) * s->length[b++])
    largest = fmax(largest, largest_of(s->length[b], all + (size_t)k * s->length[b]));
  return largest;
}

/* Return the growth rate of the coefficients, 1 over a length along the curve. */
static double growth_of(const subject *s, int degree)
{
  const double first = largest_at(s, degree, 0, s->here);
  double growth = 1;
  for (int k = 1; k <= degree && first > 0; k++)
    growth = fmax(growth, pow(largest_at(s, degree, k, s->here) / first, 1.0 / k));
  return growth;
}

/* Estimate the rounding of each coefficient. This is a rounding of the largest coefficient
 * below, or the effect of several roundings of the curve. A series may end though its recurrence
 * does not. */
static dvi_status measure_series_noise(subject *s)
{
  enum { SAMPLES = 4 };
  double change[COEFFICIENTS] = {0}, largest = 0;
  for (int sample = 1; sample <= SAMPLES; sample++) {
    for (size_t i = 0; i < numbers_of(s->n); i++)
      s->moved.t[i] = s->own.t[i] *
                      (1 + copysign(DBL_EPSILON, cos((double)sample * (double)(i + 1))));
    DVI_TRY(series_of(s, DEGREE, &s->moved, ALL, s->there));
    for (size_t i = 0; i < length_of_blocks(s, DEGREE); i++) s->there[i] -= s->here[i];
    for (int k = 0; k <= DEGREE; k++)
      change[k] = fmax(change[k], largest_at(s, DEGREE, k, s->there));
  }
  for (int k = 0; k <= DEGREE; k++) {
    if (k > 0) change[k] = fmax(change[k], change[k - 1]);
    largest = fmax(largest, largest_at(s, DEGREE, k, s->here));
    s->noise[k] = 64 * fmax(DBL_EPSILON * largest, change[k]);
  }
  return DVI_OK;
}

/* ---- comparing ---- */

/* Compare coefficient k of one block as given and as found otherwise, with the noise of the
 * latter. */
static dvi_status compare_coefficients(const subject *s, int b, int k, const double *given,
                                       const double *found, double noise, double tolerance,
                                       const char *how, dvi_derivative_check *result)
{
  const double largest = fmax(largest_of(s->length[b], given), largest_of(s->length[b], found));
  for (size_t e = 0; e < s->length[b]; e++) {
    const double wrong = fabs(given[e] - found[e]) - noise;
    if (wrong > 0) result->taylor_error = fmax(result->taylor_error, wrong / largest);
    if (!(wrong > tolerance * largest)) continue;
    const char *name = names[s->potential == NULL][b];
    (void)snprintf(result->where, sizeof result->where, "%s: Taylor coefficient %d of %s is wrong",
                   s->owner, k, name);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system check: %s: Taylor coefficient %d of %s (entry %zu) is %.15g from the "
                     "callback, %.15g %s",
                     s->owner, k, name, e, given[e], found[e], how);
  }
  return DVI_OK;
}

static dvi_status compare_points(const subject *s, double tolerance, dvi_derivative_check *result)
{
  double *given[BLOCKS], *found[BLOCKS];
  place_blocks(s, DEGREE, s->here, given);
  place_blocks(s, DEGREE, s->there, found);
  DVI_TRY(points_at(s, s->there));
  for (int b = 0; b < BLOCKS; b++)
    DVI_TRY(compare_coefficients(s, b, 0, given[b], found[b], s->noise[0], tolerance,
                                 "from the one-point callback", result));
  return DVI_OK;
}

/* Compare with the same coefficients of a lower degree, or with some blocks not requested. */
static dvi_status compare_asked(const subject *s, int degree, unsigned wanted, double tolerance,
                                dvi_derivative_check *result)
{
  double *given[BLOCKS], *found[BLOCKS];
  char how[64];
  place_blocks(s, DEGREE, s->here, given);
  place_blocks(s, degree, s->there, found);
  DVI_TRY(series_of(s, degree, &s->own, wanted, s->there));
  (void)snprintf(how, sizeof how, "if degree %d is asked for%s", degree,
                 wanted == ALL ? "" : ", and other results are NULL");
  for (int b = 0; b < BLOCKS; b++)
    for (int k = 0; k <= degree && (wanted >> b & 1U) != 0; k++) {
      const size_t at = (size_t)k * s->length[b];
      DVI_TRY(compare_coefficients(s, b, k, given[b] + at, found[b] + at, s->noise[k], tolerance,
                                   how, result));
    }
  return DVI_OK;
}

static dvi_status compare_differences(const subject *s, double tolerance,
                                      dvi_derivative_check *result)
{
  static const double weight[SIDES] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  /* the error (47 sigma)^6/140 of the last coefficient is below rounding */
  const double sigma = 1 / (4096 * growth_of(s, DEGREE));
  const size_t length = length_of_blocks(s, DEGREE);
  memset(s->sum, 0, length * sizeof *s->sum);
  for (int side = -SIDES; side <= SIDES; side++) {
    if (side == 0) continue;
    move_curve(s, side * sigma);
    DVI_TRY(series_of(s, DEGREE, &s->moved, ALL, s->there));
    const double w = (side > 0 ? weight[side - 1] : -weight[-side - 1]) / sigma;
    for (size_t i = 0; i < length; i++) s->sum[i] += w * s->there[i];
  }
  double *given[BLOCKS], *slope[BLOCKS];
  place_blocks(s, DEGREE, s->here, given);
  place_blocks(s, DEGREE, s->sum, slope);
  for (int b = 0; b < BLOCKS; b++)
    for (int k = 0; k < DEGREE; k++) {
      double *found = slope[b] + (size_t)k * s->length[b],
             *above = given[b] + (size_t)(k + 1) * s->length[b];
      for (size_t e = 0; e < s->length[b]; e++) found[e] /= k + 1;
      DVI_TRY(compare_coefficients(s, b, k + 1, above, found, s->noise[k] / sigma / (k + 1),
                                   tolerance, "from differences", result));
    }
  return DVI_OK;
}

/* ---- a term ---- */

/* Expand about the point. If the coefficients grow so fast that high ones overflow, follow a slower
 * curve. There need be no series at the point, for |x|^3 has two derivatives at 0. Then expand a
 * little further along. */
static dvi_status expand_term(subject *s)
{
  enum { FASTEST = 1000 };
  if (series_of(s, PROBE, &s->own, ALL, s->here) > 0) {
    move_curve(s, 0.01);
    memcpy(s->own.t, s->moved.t, numbers_of(s->n) * sizeof *s->own.t);
    DVI_TRY(series_of(s, PROBE, &s->own, ALL, s->here));
  }
  const double slower = fmin(1, FASTEST / growth_of(s, PROBE));
  for (int k = 1; k <= CURVE; k++) {
    const double factor = pow(slower, k);
    s->own.t[k] *= factor;
    for (int i = 0; i < s->n; i++) {
      s->own.q[k * s->n + i] *= factor;
      s->own.v[k * s->n + i] *= factor;
    }
  }
  return series_of(s, DEGREE, &s->own, ALL, s->here);
}

static dvi_status compare_all(subject *s, double tolerance, dvi_derivative_check *result)
{
  DVI_TRY(expand_term(s));
  DVI_TRY(measure_series_noise(s));
  DVI_TRY(compare_points(s, tolerance, result));
  for (int degree = 0; degree < DEGREE; degree++)
    DVI_TRY(compare_asked(s, degree, ALL, tolerance, result));
  for (unsigned wanted = 1; wanted < ALL; wanted++)
    DVI_TRY(compare_asked(s, DEGREE, wanted, tolerance, result));
  return compare_differences(s, tolerance, result);
}

static dvi_status check_term(subject s, const double *drawn, double tolerance,
                             dvi_derivative_check *result)
{
  const size_t n = (size_t)s.n;
  const dvi__lagrangian_term *l = s.lagrangian;
  s.length[0] = 1;
  s.length[1] = n;
  s.length[2] = l != NULL ? n : 0;
  s.length[3] = (size_t)dvi__pattern_entries(l != NULL ? &l->qq : &s.potential->qq);
  s.length[4] = l != NULL ? (size_t)dvi__pattern_entries(&l->qv) : 0;
  s.length[5] = l != NULL ? (size_t)dvi__pattern_entries(&l->vv) : 0;
  const size_t length = length_of_blocks(&s, DEGREE);
  s.here = DVI_NEW(double, 3 * length);
  if (s.here == NULL)
    return dvi__fail(DVI_NO_MEMORY, "system check: no memory for Taylor coefficients");
  s.there = s.here + length;
  s.sum = s.there + length;
  memcpy(s.own.t, drawn, numbers_of(s.n) * sizeof *drawn);
  const dvi_status status = compare_all(&s, tolerance, result);
  dvi__release(s.here);
  return status;
}

/* ---- all terms ---- */

static curve curve_in(int n, double *numbers)
{
  double *q = numbers + COEFFICIENTS;
  return (curve){.t = numbers, .q = q, .v = q + COEFFICIENTS * (size_t)n};
}

/* Draw the curve t = t0 + s. q begins along v and bends differently for each coordinate. v bends
 * independently. */
static void draw_curve(int n, double t0, const double *q0, const double *v0, const curve *c)
{
  const double size = fmax(largest_of((size_t)n, q0), largest_of((size_t)n, v0));
  const double bend = size > 0 ? size : 1;
  c->t[0] = t0;
  c->t[1] = 1;
  for (int i = 0; i < n; i++) {
    c->q[i] = q0[i];
    c->v[i] = v0[i];
    for (int k = 1; k <= CURVE; k++) {
      c->q[k * n + i] = (k == 1 ? v0[i] : 0) + 0.25 * bend * cos(k + 2 * i);
      c->v[k * n + i] = 0.25 * bend * sin(2 * k + i);
    }
  }
}

dvi_status dvi__check_taylor(const dvi_system *system, dvi__scratch *scratch, double t0,
                             const double *q0, const double *v0, double tolerance,
                             dvi_derivative_check *result)
{
  const int n = system->n;
  const size_t numbers = numbers_of(n);
  double *drawn = DVI_NEW(double, 3 * numbers);
  if (drawn == NULL)
    return dvi__fail(DVI_NO_MEMORY, "system check: no memory for a curve in %d dimensions", n);
  const curve first = curve_in(n, drawn);
  subject s = {.scratch = scratch,
               .n = n,
               .own = curve_in(n, drawn + numbers),
               .moved = curve_in(n, drawn + 2 * numbers)};
  dvi_status status = DVI_OK;
  /* velocities of factors are fewer numbers */
  draw_curve(n, t0, q0, system->slots == NULL ? v0 : q0, &first);
  if (system->lagrangian != NULL && dvi__general_has_taylor(system->lagrangian)) {
    s.lagrangian = system->lagrangian;
    (void)snprintf(s.owner, sizeof s.owner, "%s", s.lagrangian->name);
    status = check_term(s, drawn, tolerance, result);
    s.lagrangian = NULL;
  }
  for (int k = 0; status == DVI_OK && k < system->potential_count; k++) {
    s.potential = &system->potentials[k];
    (void)snprintf(s.owner, sizeof s.owner, "potential '%.24s'", s.potential->name);
    if (dvi__potential_has_taylor(s.potential)) status = check_term(s, drawn, tolerance, result);
  }
  dvi__release(drawn);
  return status;
}
