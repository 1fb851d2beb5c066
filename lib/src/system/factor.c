#include "system/factor.h"

#include <dvi/group.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "group/vector.h"
#include "num/finite.h"

/* ---- slots ---- */

static dvi_status check_factor(int index, const dvi_factor *factor)
{
  const int turns = factor->kind == DVI_SO3 || factor->kind == DVI_SE3;
  if ((int)factor->kind < DVI_RN || (int)factor->kind > DVI_U1)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: factor %d is of no known kind (%d)", index,
                     (int)factor->kind);
  if (factor->kind == DVI_RN ? factor->size < 1 : factor->size != 0)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: factor %d has size %d; R^n has 1 or more, the others have 0", index,
                     factor->size);
  if (!isfinite(factor->mass) || factor->mass < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: factor %d has mass %g; 0 or more is possible",
                     index, factor->mass);
  if (!turns && factor->inertia != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: factor %d has an inertia matrix; only bodies that turn have", index);
  if (factor->kind == DVI_SO3 && factor->mass != 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: factor %d, of SO(3), has a mass; its inertia says all", index);
  if (factor->kind != DVI_SE3 && factor->centre != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: factor %d has a centre of mass; only rigid motions, SE(3), have",
                     index);
  return DVI_OK;
}

/* Return the count of coordinates of R^n of a factor. The second function returns 1 if a slot of
 * another kind comes before them. */
static int lines_of(const dvi_factor *factor)
{
  return factor->kind == DVI_RN ? factor->size : factor->kind == DVI_SE3 ? 3 : 0;
}

static int has_slot(const dvi_factor *factor, dvi__chart_kind *kind)
{
  *kind = factor->kind == DVI_S2   ? DVI__SPHERE
          : factor->kind == DVI_U1 ? DVI__CIRCLE
                                   : DVI__ROTATION;
  return factor->kind != DVI_RN;
}

static void add_slot(dvi_system *s, dvi__chart_kind kind)
{
  s->slots[s->slot_count++] = (dvi__factor_slot){.kind = kind, .q = s->n, .v = s->nv, .x = s->nx};
  s->terms |= kind == DVI__ROTATION ? DVI__ROTATIONS : kind == DVI__SPHERE ? DVI__DIRECTIONS : 0U;
  s->n += dvi__chart_stored(kind);
  s->nv += dvi__chart_velocities(kind);
  s->nx += dvi__chart_size(kind);
}

static dvi_status count_slots(const dvi_system_terms *terms, size_t *slots)
{
  size_t coordinates = 0;
  *slots = 0;
  for (int f = 0; f < terms->factor_count; f++) {
    dvi__chart_kind kind;
    DVI_TRY(check_factor(f, &terms->factors[f]));
    const size_t lines = (size_t)lines_of(&terms->factors[f]),
                 others = (size_t)has_slot(&terms->factors[f], &kind);
    *slots += others + lines;
    coordinates += others * (size_t)dvi__chart_stored(kind) + lines;
  }
  if (coordinates <= DVI__DIMENSION_MOST) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE,
                   "system: its factors have %zu coordinates; at most %d are possible", coordinates,
                   DVI__DIMENSION_MOST);
}

dvi_status dvi__factors_lay_out(const dvi_system_terms *terms, dvi_system *s)
{
  size_t slots;
  dvi__chart_kind kind;
  if (terms->factor_count == 0) {
    s->n = s->nv = s->nx = terms->dimension;
    return DVI_OK;
  }
  DVI_TRY(count_slots(terms, &slots));
  s->terms |= DVI__FACTORS;
  s->slots = DVI_NEW(dvi__factor_slot, slots);
  if (s->slots == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its factors");
  for (int f = 0; f < terms->factor_count; f++) {
    if (has_slot(&terms->factors[f], &kind)) add_slot(s, kind);
    for (int line = lines_of(&terms->factors[f]); line > 0; line--) add_slot(s, DVI__LINE);
  }
  if (terms->dimension == 0 || terms->dimension == s->n) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE,
                   "system: dimension %d, but the factors have %d coordinates; leave it 0",
                   terms->dimension, s->n);
}

/* ---- mass ---- */

/* Return 1 if the symmetric A/size + shift I is positive definite. The scaling to size 1 keeps
 * products from underflow. */
static int is_positive_matrix(const double *A, double size, double shift)
{
  const double a = A[0] / size + shift, b = A[4] / size + shift, c = A[8] / size + shift;
  const double d = A[1] / size, e = A[2] / size, f = A[5] / size;
  return a > 0 && a * b - d * d > 0 &&
         a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e) > 0;
}

/* Make J symmetric to the last digit, and compute its trace. */
static dvi_status symmetric_inertia(int index, const double *given, double *J, double *trace)
{
  *trace = given[0] + given[4] + given[8];
  if (dvi__first_not_finite(9, given) >= 0 || !isfinite(*trace))
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the inertia of factor %d is not finite", index);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      if (fabs(given[3 * i + j] - given[3 * j + i]) > 1e-12 * fabs(*trace))
        return dvi__fail(DVI_BAD_ARGUMENT,
                         "system: the inertia of factor %d is not symmetric at (%d,%d)", index, i,
                         j);
      J[3 * i + j] = 0.5 * given[3 * i + j] + 0.5 * given[3 * j + i];
    }
  if (*trace > 0 && is_positive_matrix(J, *trace, 0)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "system: the inertia of factor %d is not positive definite",
                   index);
}

/* Compute the second moments of the mass, tr(J)/2 I - J. They are positive semidefinite for a body,
 * and about the centre of mass, too. */
static dvi_status second_moments(int index, const dvi_factor *factor, double *Jd)
{
  double J[9] = {0}, about[9], trace;
  const double rounding = 1e-12, *centre = factor->centre;
  DVI_TRY(symmetric_inertia(index, factor->inertia, J, &trace));
  if (centre != NULL && dvi__first_not_finite(3, centre) >= 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the centre of mass of factor %d is not finite",
                     index);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      Jd[3 * i + j] = (i == j ? 0.5 * trace : 0) - J[3 * i + j];
      const double shift = centre != NULL ? factor->mass * centre[i] * centre[j] : 0;
      about[3 * i + j] = Jd[3 * i + j] - shift;
    }
  if (is_positive_matrix(Jd, trace, rounding) && is_positive_matrix(about, trace, rounding))
    return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system: the inertia of factor %d is that of no body: about its origin and its "
                   "centre of mass no principal "
                   "moment may be larger than the sum of the others",
                   index);
}

/* Entries (row, column, value) of the mass, summed where they meet. */
typedef struct entries {
  int count;
  int *row, *column;
  double *value;
} entries;

static void add_mass_entry(entries *list, int row, int column, double value)
{
  list->row[list->count] = row;
  list->column[list->count] = column;
  list->value[list->count++] = value;
}

/* Add the entries of a body. Its kinetic energy is that of its points x + R rho, the sum over i of
 * (R_i'.Jd R_i' + m x_i'^2)/2 + m x_i' R_i'.centre, with row i of R, R_i. */
static dvi_status add_body_mass(int index, const dvi_factor *factor, int at, entries *list)
{
  double Jd[9] = {0};
  DVI_TRY(second_moments(index, factor, Jd));
  for (int i = 0; i < 3; i++) {
    const int x = at + 9 + i, row = at + 3 * i;
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) add_mass_entry(list, row + j, row + k, Jd[3 * j + k]);
    if (factor->kind == DVI_SO3) continue;
    add_mass_entry(list, x, x, factor->mass);
    for (int j = 0; j < 3 && factor->centre != NULL; j++) {
      add_mass_entry(list, x, row + j, factor->mass * factor->centre[j]);
      add_mass_entry(list, row + j, x, factor->mass * factor->centre[j]);
    }
  }
  return DVI_OK;
}

static int stored_numbers(const dvi_factor *factor)
{
  dvi__chart_kind kind;
  return lines_of(factor) + (has_slot(factor, &kind) ? dvi__chart_stored(kind) : 0);
}

static dvi_status add_factors(const dvi_system_terms *terms, entries *list)
{
  int at = 0;
  for (int f = 0; f < terms->factor_count; f++) {
    const dvi_factor *factor = &terms->factors[f];
    const int stored = stored_numbers(factor);
    if (factor->inertia != NULL) DVI_TRY(add_body_mass(f, factor, at, list));
    if (factor->kind == DVI_SE3 && factor->inertia == NULL && factor->mass != 0)
      return dvi__fail(DVI_BAD_ARGUMENT, "system: factor %d, of SE(3), has a mass but no inertia",
                       f);
    for (int i = 0; i < stored && factor->kind != DVI_SE3 && factor->mass != 0; i++)
      add_mass_entry(list, at + i, at + i, factor->mass);
    at += stored;
  }
  return DVI_OK;
}

static void add_mass(const dvi_mass *mass, const dvi__pattern *pattern, int n, entries *list)
{
  for (int j = 0; j < n && mass->values == NULL; j++)
    if (mass->diagonal != NULL || mass->scalar != 0)
      add_mass_entry(list, j, j, mass->diagonal != NULL ? mass->diagonal[j] : mass->scalar);
  for (int j = 0; j < n && mass->values != NULL; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      add_mass_entry(list, pattern->row[e], j, mass->values[e]);
}

/* Sort the entries into columns with ascending rows, by rows first, then by columns. Each sort
 * keeps the other's order. */
static void sort_entries_by(const int *key, int n, int count, const int *order, int *start,
                            int *sorted)
{
  memset(start, 0, ((size_t)n + 1) * sizeof *start);
  for (int e = 0; e < count; e++) start[key[e] + 1]++;
  for (int i = 0; i < n; i++) start[i + 1] += start[i];
  for (int e = 0; e < count; e++) {
    const int entry = order != NULL ? order[e] : e;
    sorted[start[key[entry]]++] = entry;
  }
}

/* Join equal entries. `sorted` lists the entries column by column. */
static void join_entries(const entries *list, const int *sorted, dvi_system *s)
{
  int made = -1;
  for (int e = 0; e < list->count; e++) {
    const int entry = sorted[e], row = list->row[entry], column = list->column[entry];
    const int new_one = e == 0 || row != list->row[sorted[e - 1]] ||
                        column != list->column[sorted[e - 1]];
    made += new_one;
    s->vv.row[made] = row;
    s->mass_values[made] = (new_one ? 0 : s->mass_values[made]) + list->value[entry];
    s->vv.start[column + 1] = made + 1;
  }
  for (int j = 0; j < s->n; j++)
    if (s->vv.start[j + 1] < s->vv.start[j]) s->vv.start[j + 1] = s->vv.start[j];
}

static dvi_status compress_entries(const entries *list, dvi_system *s)
{
  int *start = DVI_NEW(int, (size_t)s->n + 1), *by_row = DVI_NEW(int, list->count),
      *sorted = DVI_NEW(int, list->count);
  s->vv = (dvi__pattern){.rows = s->n,
                         .columns = s->n,
                         .start = DVI_NEW(int, (size_t)s->n + 1),
                         .row = DVI_NEW(int, list->count)};
  s->mass_values = DVI_NEW(double, list->count);
  const int possible = start && by_row && sorted && s->vv.start && s->vv.row && s->mass_values;
  if (possible) {
    sort_entries_by(list->row, s->n, list->count, NULL, start, by_row);
    sort_entries_by(list->column, s->n, list->count, by_row, start, sorted);
    join_entries(list, sorted, s);
  }
  dvi__release(start);
  dvi__release(by_row);
  dvi__release(sorted);
  return possible ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "system: no memory for its mass");
}

/* Return 1 if a slot has no mass. The momentum of such a slot says nothing of its velocity. */
static int is_massless(const dvi_system *s, const dvi__factor_slot *slot)
{
  const int end = s->vv.start[slot->q + dvi__chart_stored(slot->kind)];
  for (int e = s->vv.start[slot->q]; e < end; e++)
    if (s->mass_values[e] != 0) return 0;
  return 1;
}

static dvi_status check_massive(const dvi_system_terms *terms, const dvi_system *s)
{
  for (int f = 0, c = 0; f < terms->factor_count; f++) {
    dvi__chart_kind kind;
    const int end = c + has_slot(&terms->factors[f], &kind) + lines_of(&terms->factors[f]);
    while (c < end && !is_massless(s, &s->slots[c])) c++;
    const int first = c;
    while (c < end && is_massless(s, &s->slots[c])) c++;
    if (c > first)
      return dvi__fail(DVI_SINGULAR,
                       "system: factor %d has no mass at coordinates %d to %d; give it one of its "
                       "own, or in the system's mass",
                       f, s->slots[first].q,
                       s->slots[c - 1].q + dvi__chart_stored(s->slots[c - 1].kind) - 1);
  }
  return DVI_OK;
}

static size_t most_entries(const dvi_system_terms *terms, const dvi__pattern *declared, int n)
{
  size_t most = (size_t)dvi__pattern_entries(declared) + (size_t)n;
  for (int f = 0; f < terms->factor_count; f++)
    most += 48 + (size_t)stored_numbers(&terms->factors[f]);
  return most;
}

dvi_status dvi__factors_mass(const dvi_system_terms *terms, dvi_system *s)
{
  dvi__pattern declared = {0};
  if (terms->mass.values != NULL)
    DVI_TRY(
        dvi__pattern_copy_symmetric(&terms->mass.pattern, s->n, "system: mass matrix", &declared));
  else
    DVI_TRY(dvi__pattern_empty(s->n, &declared));
  const size_t most = most_entries(terms, &declared, s->n);
  entries list = {0, DVI_NEW(int, most), DVI_NEW(int, most), DVI_NEW(double, most)};
  dvi_status status = DVI_OK;
  if (list.row == NULL || list.column == NULL || list.value == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "system: no memory for its mass");
  if (status == DVI_OK) status = add_factors(terms, &list);
  if (status == DVI_OK) {
    add_mass(&terms->mass, &declared, s->n, &list);
    if (dvi__first_not_finite((size_t)list.count, list.value) >= 0)
      status = dvi__fail(DVI_SINGULAR, "system: the mass matrix is not finite");
  }
  if (status == DVI_OK) status = compress_entries(&list, s);
  if (status == DVI_OK) status = check_massive(terms, s);
  dvi__release(list.row);
  dvi__release(list.column);
  dvi__release(list.value);
  dvi__pattern_clear(&declared);
  return status;
}

/* ---- points ---- */

static double euclidean_length(int count, const double *x)
{
  double sum = 0;
  for (int i = 0; i < count; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

static double distance_of(const dvi__factor_slot *slot, const double *q)
{
  if (slot->kind == DVI__LINE) return 0;
  return slot->kind == DVI__ROTATION
             ? dvi_so3_distance(q + slot->q)
             : fabs(euclidean_length(dvi__chart_stored(slot->kind), q + slot->q) - 1);
}

double dvi_system_distance(const dvi_system *system, const double *q)
{
  double largest = 0;
  if (system == NULL || q == NULL) return (double)NAN;
  for (int c = 0; c < system->slot_count; c++) {
    const double distance = distance_of(&system->slots[c], q);
    if (isnan(distance)) return distance;
    largest = fmax(largest, distance);
  }
  return largest;
}

/* Rounding of numbers that the user has computed. */
static const double near_enough = 1e-12;

dvi_status dvi__factors_check(const dvi_system *s, const double *q, const double *second)
{
  for (int c = 0; c < s->slot_count; c++) {
    const dvi__factor_slot *slot = &s->slots[c];
    const double distance = distance_of(slot, q);
    if (!(distance <= near_enough))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "coordinates %d to %d are no %s: off by %.2e; dvi_system_project puts them "
                       "on the nearest one, if that is meant",
                       slot->q, slot->q + dvi__chart_stored(slot->kind) - 1,
                       slot->kind == DVI__ROTATION ? "rotation matrix" : "unit vector", distance);
    if (slot->kind != DVI__SPHERE) continue;
    const double *x = q + slot->q, *p = second + slot->v,
                 radial = x[0] * p[0] + x[1] * p[1] + x[2] * p[2];
    if (!(fabs(radial) <= near_enough * euclidean_length(3, p)))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "numbers %d to %d of the velocity or momentum of a direction q are not "
                       "orthogonal to it: off by %.2e; subtract "
                       "(p.q) q, or (v.q) q, if that is meant",
                       slot->v, slot->v + 2, fabs(radial));
  }
  return DVI_OK;
}

void dvi__factors_rate(const dvi_system *s, const double *q, const double *v, double *rate)
{
  for (int c = 0; c < s->slot_count; c++) {
    const dvi__factor_slot *slot = &s->slots[c];
    const double *x = q + slot->q, *w = v + slot->v, zero[DVI__CHART_SIZE] = {0};
    double unused[DVI__CHART_POINT];
    dvi__chart chart;
    dvi__functions c_at_zero;
    if (slot->kind == DVI__SPHERE) {
      memcpy(rate + slot->q, w, 3 * sizeof *w);
      continue;
    }
    dvi__chart_centre(slot->kind, x, &chart);
    dvi__chart_functions(slot->kind, zero, &c_at_zero);
    dvi__chart_point(&chart, &c_at_zero, zero, w, unused, rate + slot->q);
  }
}

void dvi__factors_momentum(const dvi_system *s, const double *q, const double *covector, double *p)
{
  for (int c = 0; c < s->slot_count; c++) {
    const dvi__factor_slot *slot = &s->slots[c];
    const double zero[DVI__CHART_SIZE] = {0};
    double in_xi[DVI__CHART_SIZE], local[DVI__CHART_SIZE];
    dvi__chart chart;
    dvi__functions c_at_zero;
    dvi__chart_centre(slot->kind, q + slot->q, &chart);
    dvi__chart_functions(slot->kind, zero, &c_at_zero);
    dvi__chart_gradient(&chart, &c_at_zero, zero, zero, covector + slot->q, covector + slot->q,
                        in_xi, local);
    dvi__chart_store(&chart, local, p + slot->v);
  }
}

/* ---- projection ---- */

/* Scale finite numbers so that none of their products overflows. Return 0 if all of them are 0. */
static int scale_down(int count, double *x)
{
  const double largest = dvi__largest((size_t)count, x);
  for (int i = 0; i < count && largest > 0; i++) x[i] /= largest;
  return largest > 0;
}

static int make_rotation(double *R)
{
  double normal[3];
  if (!scale_down(9, R)) return 0;
  dvi__cross(R, R + 3, normal);
  if (!(dvi__dot(normal, R + 6) > 0)) return 0;
  dvi_so3_project(R, R);
  return 1;
}

static int make_unit(int count, double *x)
{
  if (!scale_down(count, x)) return 0;
  const double size = euclidean_length(count, x);
  for (int i = 0; i < count; i++) x[i] /= size;
  return 1;
}

dvi_status dvi_system_project(const dvi_system *system, double *q)
{
  if (system == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "project: an argument is NULL");
  if (dvi__first_not_finite((size_t)system->n, q) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "project: a coordinate is not finite");
  for (int pass = 0; pass < 2; pass++)
    for (int c = 0; c < system->slot_count; c++) {
      const dvi__factor_slot *slot = &system->slots[c];
      const int stored = dvi__chart_stored(slot->kind);
      double x[DVI__CHART_POINT];
      if (slot->kind == DVI__LINE) continue;
      memcpy(x, q + slot->q, (size_t)stored * sizeof *x);
      if (!(slot->kind == DVI__ROTATION ? make_rotation(x) : make_unit(stored, x)))
        return dvi__fail(DVI_BAD_ARGUMENT, "project: coordinates %d to %d have no nearest %s",
                         slot->q, slot->q + stored - 1,
                         slot->kind == DVI__ROTATION ? "rotation" : "direction");
      if (pass == 1) memcpy(q + slot->q, x, (size_t)stored * sizeof *x);
    }
  return DVI_OK;
}
