/* Simplified Newton's method for an element on phase space, in variables of its own. */
#include <math.h>
#include <string.h>

#include "step/hamiltonian/rows.h"
#include "step/hamiltonian/phase_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/simd/wide.h"

/* ---- create ---- */

int dvi__phase_element_has_iteration(const dvi__phase_element *f)
{
  const int most = f->m * (f->k > 0 ? f->k : 1);
  return f->n <= DVI__PHASE_COORDINATES_MOST && most <= DVI__PHASE_ROWS_MOST;
}

static void fill_tables(const dvi__phase_element *f, const dvi__phase_iteration *own)
{
  const int d = f->d, lanes = own->lanes;
  for (int i = 0; i < d; i++) {
    for (int j = 0; j < d; j++) own->a[j * lanes + i] = f->a[i][j];
    for (int l = 0; l < f->k; l++) {
      own->moment[l * lanes + i] = f->b[i] * f->legendre[i][l];
      own->legendre[l * lanes + i] = f->legendre[i][l];
      for (int j = 0; j < d; j++)
        own->a_moment[(l * d + j) * lanes + i] = f->a[i][j] * f->legendre[j][l];
    }
  }
}

/* List the entries of joint for two components of z. */
static void list_entries(const dvi__phase_element *f, dvi__phase_iteration *own)
{
  own->entries = 0;
  for (int j = 0; j < 2 * f->n; j++)
    for (int e = f->joint.start[j]; e < f->joint.start[j + 1]; e++)
      if (f->joint.row[e] < 2 * f->n) {
        own->entry[own->entries] = e;
        own->row[own->entries] = f->joint.row[e];
        own->column[own->entries++] = j;
      }
}

/* Give the next `size` of the numbers, or count them while there are none. */
static double *take(double *numbers, size_t *used, size_t size)
{
  double *at = numbers != NULL ? numbers + *used : NULL;
  *used += size;
  return at;
}

/* Lay all arrays out. Gives their size. */
static size_t lay_out(const dvi__phase_element *f, dvi__phase_iteration *own, double *numbers)
{
  const size_t z = 2 * (size_t)f->n, m = (size_t)f->m, d = (size_t)f->d, k = (size_t)f->k,
               lanes = (size_t)own->lanes, entries = (size_t)dvi__pattern_entries(&f->joint);
  size_t used = 0;
  own->a = take(numbers, &used, d * lanes);
  own->a_moment = take(numbers, &used, k * d * lanes);
  own->moment = take(numbers, &used, k * lanes);
  own->legendre = take(numbers, &used, k * lanes);
  own->W = take(numbers, &used, z * lanes);
  own->D = take(numbers, &used, z);
  own->multipliers = take(numbers, &used, m * (1 + k));
  own->of_W = take(numbers, &used, z * lanes);
  own->of_D = take(numbers, &used, z);
  own->of_moment = take(numbers, &used, m * k);
  own->of_end = take(numbers, &used, m);
  own->gradient = take(numbers, &used, m * z * lanes);
  own->field = take(numbers, &used, m * z * lanes);
  own->moved = take(numbers, &used, m * k * z * lanes);
  own->slope = take(numbers, &used, entries * lanes);
  own->end_gradient = take(numbers, &used, m * z);
  own->end_field = take(numbers, &used, m * z);
  own->end_slope = take(numbers, &used, entries);
  own->base = take(numbers, &used, z * lanes);
  own->there = take(numbers, &used, z * lanes);
  own->moments = take(numbers, &used, m * k * m * k);
  own->end = take(numbers, &used, m * m);
  own->multiplier = take(numbers, &used, m * (k + 1));
  return used;
}

dvi_status dvi__phase_iteration_create(dvi__phase_element *f)
{
  dvi__phase_iteration *own = &f->iteration;
  const size_t entries = (size_t)dvi__pattern_entries(&f->joint);
  if (!dvi__phase_element_has_iteration(f)) return DVI_OK;
  own->lanes = f->d <= BLOCK ? BLOCK : 2 * BLOCK;
  own->numbers = DVI_NEW(double, lay_out(f, own, NULL));
  own->entry = DVI_NEW(int, 3 * entries);
  if (own->numbers == NULL || own->entry == NULL)
    return dvi__fail(DVI_NO_MEMORY, "phase space: no memory for %d stages in %d dimensions", f->d,
                     f->n);
  own->row = own->entry + entries;
  own->column = own->row + entries;
  (void)lay_out(f, own, own->numbers);
  fill_tables(f, own);
  list_entries(f, own);
  return DVI_OK;
}

void dvi__phase_iteration_clear(dvi__phase_iteration *own)
{
  dvi__release(own->numbers);
  dvi__release(own->entry);
}

/* ---- residual ---- */

INLINE void set_points(const dvi__phase_element *f, const dvi__phase_iteration *own, int lanes)
{
  double moved[2 * BLOCK] = {0};
  for (int c = 0; c < 2 * f->n; c++) {
    const double from = c < f->n ? f->q0[c] : f->p0[c - f->n];
    row_product(f->d, lanes, own->a, own->W + c * lanes, moved);
    for (int i = 0; i < f->d; i++) f->Z[c * f->d + i] = from + (f->kick[c] + moved[i]);
    f->end[c] = from + own->D[c];
  }
}

WIDE static void set_points_of(const dvi__phase_element *f)
{
  const dvi__phase_iteration own = f->iteration; /* stores do not alias a copy */
  if (own.lanes == BLOCK)
    set_points(f, &own, BLOCK);
  else
    set_points(f, &own, 2 * BLOCK);
}

static dvi_status set_residual(dvi__phase_element *f)
{
  const dvi__phase_iteration *own = &f->iteration;
  const int d = f->d, z = 2 * f->n, k = f->k;
  set_points_of(f);
  DVI_TRY(dvi__phase_fields(f, own->multipliers));
  for (int c = 0; c < z; c++) {
    const double *W = own->W + c * own->lanes;
    for (int i = 0; i < d; i++) own->of_W[c * own->lanes + i] = W[i] - f->F[c * d + i];
    own->of_D[c] = own->D[c] - f->kick[c] - 0.5 * f->field[c] - sum_of_products(d, f->b, W);
  }
  for (int a = 0; a < f->m; a++) {
    own->of_end[a] = f->weight[a];
    for (int l = 0; l < k; l++) {
      double sum = 0;
      for (int i = 0; i < d; i++) sum += own->moment[l * own->lanes + i] * f->phi[i * f->m + a];
      own->of_moment[a * k + l] = sum;
    }
  }
  return DVI_OK;
}

/* ---- iterate ---- */

void dvi__phase_element_begin(dvi__phase_element *f, const double *x)
{
  dvi__phase_iteration *own = &f->iteration;
  own->is_frozen = own->count = 0;
  for (int c = 0; c < 2 * f->n; c++, x += f->d + 1) {
    for (int i = 0; i < own->lanes; i++) own->W[c * own->lanes + i] = i < f->d ? x[i] : 0;
    own->D[c] = x[f->d];
  }
  memcpy(own->multipliers, x, (size_t)(f->m * (f->k + 1)) * sizeof *x);
}

void dvi__phase_element_finish(const dvi__phase_element *f, double *x)
{
  const dvi__phase_iteration *own = &f->iteration;
  for (int c = 0; c < 2 * f->n; c++, x += f->d + 1) {
    for (int i = 0; i < f->d; i++) x[i] = own->W[c * own->lanes + i];
    x[f->d] = own->D[c];
  }
  memcpy(x, own->multipliers, (size_t)(f->m * (f->k + 1)) * sizeof *x);
}

/* The largest correction, unknown and coordinate of one kind, q or p, and the largest correction as
 * a part of the unknowns of its coordinate, times the largest unknown. */
typedef struct measure {
  largest is;
  double size, own;
} measure;

/* Subtract corrections, in lanes. */
WIDE static void subtract_and_measure(int count, const double *correction, double *x, largest *most)
{
  largest_lanes lanes = {{0}, {0}, {0}};
  block by, next;
  double not_finite = 0;
  int i = 0;
  for (; i + BLOCK <= count; i += BLOCK) {
    memcpy(&by, correction + i, sizeof by);
    memcpy(&next, x + i, sizeof next);
    next -= by;
    memcpy(x + i, &next, sizeof next);
    note_change(&by, &next, &lanes);
  }
  for (; i < count; i++) {
    x[i] -= correction[i];
    most->change = larger(fabs(correction[i]), most->change);
    most->whole = larger(fabs(x[i]), most->whole);
    not_finite += 0 * correction[i];
  }
  if (not_finite != 0) most->change = HUGE_VAL;
  add_largest(&lanes, most);
}

/* The least part of the largest motion as which a smaller one is measured. Changes of one that is
 * smaller yet may be roundings of the others, which would look like an iteration that stalls. */
static const double least_part = 0x1p-13;

/* Measure the corrections of each coordinate as parts of its own unknowns. Otherwise one that moves
 * much less than another would stop short of its own digits, by about the same in every step, and
 * its energy would drift. */
static void correct_kind(int n, int lanes, const double *start, const double *of_W,
                         const double *of_D, double *W, double *D, measure *kind)
{
  largest one[DVI__PHASE_COORDINATES_MOST] = {{0}};
  *kind = (measure){.size = dvi__largest((size_t)n, start)};
  for (int i = 0; i < n; i++) {
    subtract_and_measure(lanes, of_W + i * lanes, W + i * lanes, &one[i]);
    subtract_and_measure(1, of_D + i, D + i, &one[i]);
    kind->is.whole = larger(one[i].whole, kind->is.whole);
    kind->is.change = larger(one[i].change, kind->is.change);
  }
  const double whole = kind->is.whole, least = least_part * whole;
  for (int i = 0; i < n; i++) {
    const double part = whole > 0 ? whole / larger(one[i].whole, least) : 1;
    kind->own = larger(part * one[i].change, kind->own);
  }
  kind->size += whole;
}

/* Subtract the corrections, and measure those of p in a unit in which p is as large as q. *step is
 * the largest correction, and *change the one that is large beside its own coordinate. */
static void correct(dvi__phase_element *f, double *step, double *change, double *whole)
{
  dvi__phase_iteration *own = &f->iteration;
  const int n = f->n, half = n * own->lanes;
  measure q, p;
  correct_kind(n, own->lanes, f->q0, own->of_W, own->of_D, own->W, own->D, &q);
  correct_kind(n, own->lanes, f->p0, own->of_W + half, own->of_D + n, own->W + half, own->D + n,
               &p);
  for (int a = 0; a < f->m; a++) {
    double *multipliers = own->multipliers + a * (f->k + 1);
    multipliers[0] -= own->of_end[a];
    for (int l = 0; l < f->k; l++) multipliers[1 + l] -= own->of_moment[a * f->k + l];
  }
  const double unit = p.size / q.size, weight = isnormal(unit) && isnormal(1 / unit) ? 1 / unit : 1;
  *whole = larger(q.is.whole, weight * p.is.whole);
  *step = larger(q.is.change, weight * p.is.change);
  *change = larger(q.own, weight * p.own);
}

/* A correction of more than this part of the unknowns leaves its matrices so far behind that new
 * ones save more iterations than they cost. */
static const double near_guess = 1e-2;

dvi_status dvi__phase_element_iterate(dvi__phase_element *f, double *change, double *whole)
{
  double step;
  DVI_TRY(set_residual(f));
  if (!f->iteration.is_frozen) DVI_TRY(dvi__phase_freeze(f));
  dvi__phase_correct(f);
  correct(f, &step, change, whole);
  f->iteration.is_frozen = ++f->iteration.count > 1 || step <= near_guess * *whole;
  return DVI_OK;
}
