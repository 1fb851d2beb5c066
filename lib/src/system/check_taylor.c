/* Checking Taylor coefficients. A curve q(s) of degree 3 is written anew about points s = +-sigma, +-2 sigma, +-3 sigma. If c_k(s) is coefficient k of a
 * function about s, then (k+1) c_{k+1} is the slope of c_k: central differences of 6th order give it. */
#include "system/check_taylor.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/jet.h"

enum { DEGREE = 4, COEFFICIENTS = DEGREE + 1, CURVE = 3, SIDES = 3, BLOCKS = 6 };

/* A term, and the curve: its coefficients about the point. */
typedef struct subject {
  const dvi__potential_term *potential; /* or: */
  const dvi__lagrangian_term *lagrangian;
  dvi__scratch *scratch;
  int n;
  const double *t, *q, *v;    /* [COEFFICIENTS], and times n */
  double *moved;              /* [COEFFICIENTS*(2 n + 1)]: the curve about another point */
  size_t length[BLOCKS];      /* entries of L, L_q, L_v, L_qq, L_qv, L_vv; of a potential 0 where it has none */
  double *here, *there, *sum; /* [COEFFICIENTS times all these]: about the point, about another, and the sum of the differences */
} subject;

static const char *const names[2][BLOCKS] = {{"V", "V_q", "", "V_qq", "", ""}, {"L", "L_q", "L_v", "L_qq", "L_qv", "L_vv"}};

/* ---- asking ---- */

static dvi_status series_at(const subject *s, const double *t, const double *q, const double *v, double *all)
{
  double *block[BLOCKS];
  for (int b = 0; b < BLOCKS; all += COEFFICIENTS * s->length[b++]) block[b] = all;
  if (s->potential != NULL) return dvi__potential_taylor(s->potential, s->n, DEGREE, t, q, block[0], block[1], block[3]);
  const dvi__jets wanted = {block[0], block[1], block[2], block[3], block[4], block[5]};
  return dvi__general_taylor(s->lagrangian, s->n, DEGREE, t, q, v, &wanted);
}

/* x of `count` numbers a coefficient, about sigma: the binomial formula by repeated synthetic division. */
static void shift(int count, const double *x, double sigma, double *moved)
{
  memcpy(moved, x, COEFFICIENTS * (size_t)count * sizeof *moved);
  for (int first = 0; first < DEGREE; first++)
    for (int k = DEGREE - 1; k >= first; k--)
      for (int i = 0; i < count; i++) moved[k * count + i] += sigma * moved[(k + 1) * count + i];
}

static dvi_status series_about(const subject *s, double sigma, double *all)
{
  double *q = s->moved, *v = q + COEFFICIENTS * (size_t)s->n, *t = v + COEFFICIENTS * (size_t)s->n;
  shift(s->n, s->q, sigma, q);
  shift(s->n, s->v, sigma, v);
  shift(1, s->t, sigma, t);
  return series_at(s, t, q, v, all);
}

/* What the one-point callbacks say, in the place of coefficient 0. */
static dvi_status points_at(const subject *s, double *all)
{
  double *block[BLOCKS];
  for (int b = 0; b < BLOCKS; all += COEFFICIENTS * s->length[b++]) block[b] = all;
  if (s->potential != NULL) {
    DVI_TRY(dvi__potential_value(s->potential, s->scratch, 1, s->t, s->q, block[0]));
    DVI_TRY(dvi__potential_gradient(s->potential, s->scratch, 1, s->t, s->q, block[1]));
    return dvi__potential_hessian(s->potential, s->scratch, 1, s->t, s->q, block[3]);
  }
  DVI_TRY(dvi__general_value(s->lagrangian, s->scratch, 1, s->t, s->q, s->v, block[0]));
  DVI_TRY(dvi__general_gradient(s->lagrangian, s->scratch, 1, s->t, s->q, s->v, block[1], block[2]));
  return dvi__general_hessian(s->lagrangian, s->scratch, 1, s->t, s->q, s->v, block[3], block[4], block[5]);
}

/* ---- comparing ---- */

static size_t length_of(const subject *s)
{
  size_t length = 0;
  for (int b = 0; b < BLOCKS; b++) length += COEFFICIENTS * s->length[b];
  return length;
}

/* How fast the coefficients grow: 1 over a length along the curve. */
static double growth_of(const subject *s)
{
  double growth = 1;
  const double *at = s->here;
  for (int b = 0; b < BLOCKS; at += COEFFICIENTS * s->length[b++])
    for (size_t e = 0; e < s->length[b]; e++)
      for (size_t k = 1; k <= DEGREE && at[e] != 0; k++)
        growth = fmax(growth, pow(fabs(at[k * s->length[b] + e] / at[e]), 1.0 / (double)k));
  return fmin(growth, 1e6); /* an entry that is 0 but for rounding says nothing */
}

static double largest_of(size_t count, const double *x)
{
  double largest = 0;
  for (size_t i = 0; i < count; i++) largest = fmax(largest, fabs(x[i]));
  return largest;
}

/* Coefficient k of one block as it is given and as it is found otherwise, with the noise of the latter. */
static dvi_status compare(const subject *s, int b, int k, const double *given, const double *found, double noise, double tolerance,
                          dvi_derivative_check *result)
{
  const double largest = fmax(largest_of(s->length[b], given), largest_of(s->length[b], found));
  char owner[48];
  for (size_t e = 0; e < s->length[b]; e++) {
    const double wrong = fabs(given[e] - found[e]) - noise;
    if (wrong > 0) result->taylor_error = fmax(result->taylor_error, wrong / largest);
    if (!(wrong > tolerance * largest)) continue;
    const char *name = names[s->lagrangian != NULL][b];
    (void)snprintf(owner, sizeof owner, s->potential != NULL ? "potential '%.24s'" : "%s",
                   s->potential != NULL ? s->potential->name : s->lagrangian->name);
    (void)snprintf(result->where, sizeof result->where, "%s: Taylor coefficient %d of %s is wrong", owner, k, name);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system check: %s: Taylor coefficient %d of %s (entry %zu) is %.15g from the callback, %.15g from %s", owner,
                     k, name, e, given[e], found[e], k == 0 ? "the one-point callback" : "differences");
  }
  return DVI_OK;
}

static dvi_status compare_points(const subject *s, double tolerance, dvi_derivative_check *result)
{
  const double *given = s->here, *found = s->there;
  DVI_TRY(points_at(s, s->there));
  for (int b = 0; b < BLOCKS; given += COEFFICIENTS * s->length[b], found += COEFFICIENTS * s->length[b], b++)
    DVI_TRY(compare(s, b, 0, given, found, 64 * DBL_EPSILON * largest_of(s->length[b], given), tolerance, result));
  return DVI_OK;
}

static dvi_status compare_differences(const subject *s, double tolerance, dvi_derivative_check *result)
{
  static const double weight[SIDES] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const double sigma = 1 / (128 * growth_of(s));
  const size_t length = length_of(s);
  memset(s->sum, 0, length * sizeof *s->sum);
  for (int side = -SIDES; side <= SIDES; side++) {
    if (side == 0) continue;
    DVI_TRY(series_about(s, side * sigma, s->there));
    const double w = (side > 0 ? weight[side - 1] : -weight[-side - 1]) / sigma;
    for (size_t i = 0; i < length; i++) s->sum[i] += w * s->there[i];
  }
  size_t at = 0;
  for (int b = 0; b < BLOCKS; at += COEFFICIENTS * s->length[b++])
    for (int k = 0; k < DEGREE; k++) {
      double *below = s->sum + at + (size_t)k * s->length[b], *given = s->here + at + (size_t)(k + 1) * s->length[b];
      const double noise = 64 * DBL_EPSILON * largest_of(s->length[b], given - s->length[b]) / sigma / (k + 1);
      for (size_t e = 0; e < s->length[b]; e++) below[e] /= k + 1;
      DVI_TRY(compare(s, b, k + 1, given, below, noise, tolerance, result));
    }
  return DVI_OK;
}

/* ---- all terms ---- */

static dvi_status check_term(subject s, double tolerance, dvi_derivative_check *result)
{
  const size_t n = (size_t)s.n;
  const dvi__lagrangian_term *l = s.lagrangian;
  s.length[0] = 1;
  s.length[1] = n;
  s.length[2] = l != NULL ? n : 0;
  s.length[3] = (size_t)dvi__pattern_entries(l != NULL ? &l->qq : &s.potential->qq);
  s.length[4] = l != NULL ? (size_t)dvi__pattern_entries(&l->qv) : 0;
  s.length[5] = l != NULL ? (size_t)dvi__pattern_entries(&l->vv) : 0;
  const size_t length = length_of(&s);
  s.here = DVI_NEW(double, 3 * length);
  if (s.here == NULL) return dvi__fail(DVI_NO_MEMORY, "system check: no memory for Taylor coefficients");
  s.there = s.here + length;
  s.sum = s.there + length;
  dvi_status status = series_at(&s, s.t, s.q, s.v, s.here);
  if (status == DVI_OK) status = compare_points(&s, tolerance, result);
  if (status == DVI_OK) status = compare_differences(&s, tolerance, result);
  dvi__release(s.here);
  return status;
}

/* t = t0 + s; q begins along v and bends, in a way that is its own for each coordinate; v bends by itself. */
static void draw(int n, const double *q0, const double *v0, double *q, double *v)
{
  const double size = fmax(largest_of((size_t)n, q0), largest_of((size_t)n, v0));
  const double bend = size > 0 ? size : 1;
  for (int i = 0; i < n; i++) {
    q[i] = q0[i];
    v[i] = v0[i];
    for (int k = 1; k <= CURVE; k++) {
      q[k * n + i] = (k == 1 ? v0[i] : 0) + 0.25 * bend * cos(k + 2 * i);
      v[k * n + i] = 0.25 * bend * sin(2 * k + i);
    }
  }
}

dvi_status dvi__check_taylor(const dvi_system *system, dvi__scratch *scratch, double t0, const double *q0, const double *v0,
                             double tolerance, dvi_derivative_check *result)
{
  const size_t numbers = COEFFICIENTS * (2 * (size_t)system->n + 1);
  double *curve = DVI_NEW(double, 2 * numbers);
  if (curve == NULL) return dvi__fail(DVI_NO_MEMORY, "system check: no memory for a curve in %d dimensions", system->n);
  double *q = curve, *v = q + COEFFICIENTS * (size_t)system->n, *t = v + COEFFICIENTS * (size_t)system->n;
  subject s = {.scratch = scratch, .n = system->n, .t = t, .q = q, .v = v, .moved = curve + numbers};
  dvi_status status = DVI_OK;
  draw(system->n, q0, system->cells == NULL ? v0 : q0, q, v); /* the velocities of factors are fewer numbers */
  t[0] = t0;
  t[1] = 1;
  if (system->lagrangian != NULL && dvi__general_has_taylor(system->lagrangian)) {
    s.lagrangian = system->lagrangian;
    status = check_term(s, tolerance, result);
    s.lagrangian = NULL;
  }
  for (int k = 0; status == DVI_OK && k < system->potential_count; k++) {
    s.potential = &system->potentials[k];
    if (dvi__potential_has_taylor(s.potential)) status = check_term(s, tolerance, result);
  }
  dvi__release(curve);
  return status;
}
