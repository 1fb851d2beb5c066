/* The symplecticity defect |M^T J M - D^T J D| of the map of one step. M is the differenced
 * derivative of a step's end, and D that of its start, both by the shift of a state that is then
 * projected onto the constraints. With holonomic constraints this is the two-form on T*{phi = 0}.
 * Without constraints D is the unit matrix.
 *
 * Units. A mass of 1 beside one of 1e-8 makes momenta differ as much. Each coordinate therefore has
 * a length a_i of its own, and each momentum a size b_i = m_i w_i. Here m_i is the slope of the
 * Legendre map at the point and w_i the velocity that crosses a_i in one step. The velocity is
 * halved until the Legendre map is nearly linear over it, because a derivative at the point is
 * valid only there. The momenta of a Hamiltonian have sizes as the coordinates have. The defect is
 * measured in the coordinates
 *
 *     q_i sqrt(b_i / a_i),   p_i sqrt(a_i / b_i),
 *
 * a change of units that leaves J as it is.
 *
 * Differences. The length over which the map is smooth differs from column to column, and is small
 * close to a collision. Each column of M is therefore extrapolated on its own, by Richardson's
 * method with Ridders' choice of an entry (1982). Central differences over lengths d_k = r^k d_0
 * have errors in even powers of d_k, and
 *
 *     T_k0 = (z(d_k) - z(-d_k)) / (2 d_k),    T_km = T_k,m-1 + (T_k,m-1 - T_k-1,m-1) / (r^-2m - 1)
 *
 * removes m of them. The error of T_km is estimated by its distance to both of the entries it comes
 * from, and the entry with the smallest estimated error is the column. This choice never looks at
 * the defect, so it can not favour a small one. Several lengths may be multiples of the period of a
 * force, and would agree on a wrong slope. That is why an entry counts only if four lengths went
 * into it, and why the ratio r is neither a power of two nor a simple fraction.
 *
 * A second integrator of the same method takes the steps, so that the given one keeps its state. */
#include <dvi/diagnostics.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/evaluate/dynamics.h"

enum {
  /* entries of a row of the extrapolation, which removes even powers of the length up to the
   * 10th */
  ORDERS = 6,
  /* powers that an entry must have removed to count, because fewer lengths could agree by chance */
  FEWEST = 3,
  HALVINGS = 50
};

/* Ratio and range of the lengths, in units. */
static const double ratio = 0.59, longest = 0x1p-3, shortest = 1e-14;
/* Rounding of a step's end, relative to its size. */
static const double rounding = 10 * DBL_EPSILON;

/* The map of a step. Coordinates and momenta stand in one array z [2n] = (q, p). M is stored by
 * columns, and column j is the derivative by a shift of z_j. */
typedef struct step_map {
  dvi_integrator *probe;
  int n;
  double t, h;
  const double *start; /* [2n] */
  double *z;           /* [2n] a point to start from, then its distance from `start` */
  double *scale;       /* [2n] a and b */
  /* [(ORDERS + 1) * 4n] last row T_k of the current columns in the scaled coordinates, then the
   * next T_k0 */
  double *row;
  double *M; /* [2n][4n] columns of M and of D below them, in the scaled coordinates */
} step_map;

/* Return the length of a column of M and D. */
static size_t column_length(const step_map *map)
{
  return 4 * (size_t)map->n;
}

/* Set a_i = |q_i|, but at least a sixteenth of the largest, because a coordinate that happens to be
 * 0 is no smaller than its neighbours. */
static void coordinate_scales(int n, const double *q, const double *v, double h, double *a)
{
  double largest = 0, moved = 0;
  for (int i = 0; i < n; i++) {
    largest = fmax(largest, fabs(q[i]));
    moved = fmax(moved, fabs(h * v[i]));
  }
  if (largest == 0) largest = moved > 0 ? moved : 1;
  for (int i = 0; i < n; i++) a[i] = fmax(fabs(q[i]), largest / 16);
}

/* Compute the slope (p(v + w e_i) - p(v))_i / w. v is unchanged afterwards. */
static dvi_status legendre_slope(const step_map *map, double *v, int i, double w, double *slope)
{
  const double *q = map->start, *p = map->start + map->n, velocity = v[i];
  v[i] = velocity + w;
  const double moved = v[i] - velocity;
  const dvi_status status = dvi_system_momentum(dvi_integrator_system(map->probe), map->t, q, v,
                                                map->z);
  v[i] = velocity;
  if (status == DVI_OK) *slope = (map->z[i] - p[i]) / moved;
  return status;
}

/* Test whether the Legendre map's slopes over w, -w and w/2 are within a quarter of each other. A
 * positive status says that the map is not defined so far out. */
static dvi_status nearly_linear(const step_map *map, double *v, int i, double w, double *slope,
                                int *linear)
{
  double forward, backward;
  DVI_TRY(legendre_slope(map, v, i, w, &forward));
  DVI_TRY(legendre_slope(map, v, i, -w, &backward));
  DVI_TRY(legendre_slope(map, v, i, w / 2, slope));
  const double least = fmin(fmin(forward, backward), *slope),
               most = fmax(fmax(forward, backward), *slope);
  *linear = *slope != 0 && most - least <= fabs(*slope) / 4;
  return DVI_OK;
}

/* Set b_i = m_i w_i, or the size of the momentum itself where the Legendre map has no slope. */
static dvi_status momentum_scale(const step_map *map, double *v, int i, double *b)
{
  double w = map->scale[i] / fabs(map->h);
  *b = fmax(fabs(map->start[map->n + i]), 1);
  for (int halving = 0; halving < HALVINGS; halving++, w /= 2) {
    double slope;
    int linear = 0;
    const dvi_status status = nearly_linear(map, v, i, w, &slope, &linear);
    if (status < 0) return status;
    if (status == DVI_OK && linear) {
      *b = fabs(slope) * w;
      return DVI_OK;
    }
  }
  return DVI_OK;
}

static dvi_status choose_scales(const step_map *map)
{
  const int n = map->n;
  const double *q = map->start, *p = map->start + n;
  double *v = DVI_NEW(double, n);
  dvi_status status = v ? DVI_OK
                        : dvi__fail(DVI_NO_MEMORY, "symplecticity: no memory for %d velocities", n);
  if (status == DVI_OK)
    status = dvi_system_velocity(dvi_integrator_system(map->probe), map->t, q, p, v);
  if (status == DVI_OK) coordinate_scales(n, q, v, map->h, map->scale);
  if (dvi_integrator_system(map->probe)->dynamics->by_momentum)
    coordinate_scales(n, p, v, 0, map->scale + n);
  else
    for (int i = 0; status == DVI_OK && i < n; i++)
      status = momentum_scale(map, v, i, &map->scale[n + i]);
  dvi__release(v);
  return status;
}

/* Return the probe's state less the start. The start cancels in a difference, and rounding is less
 * without it. */
static double state_change(const step_map *map, int i)
{
  const int n = map->n;
  return (i < n ? dvi_integrator_q(map->probe)[i] : dvi_integrator_p(map->probe)[i - n]) -
         map->start[i];
}

/* Take one step from start + shift e_j, projected onto the constraints if there are any. `shift`
 * becomes the shift after rounding, and z the distance of the projected point. */
static dvi_status step_from(const step_map *map, int j, double *shift)
{
  for (int i = 0; i < 2 * map->n; i++) map->z[i] = map->start[i];
  map->z[j] += *shift;
  *shift = map->z[j] - map->start[j];
  const dvi_start_options options = {.project = *shift != 0};
  DVI_TRY(dvi_integrator_start_with(map->probe, map->t, map->z, map->z + map->n, &options));
  for (int i = 0; i < 2 * map->n; i++) map->z[i] = state_change(map, i);
  return dvi_integrator_step(map->probe, map->h);
}

/* Return the factor of z_i in scaled coordinates. */
static double scaled_unit(const step_map *map, int i)
{
  const int n = map->n;
  return i < n ? sqrt(map->scale[n + i] / map->scale[i]) : sqrt(map->scale[i - n] / map->scale[i]);
}

/* Compute T_k0 of column j for the length d, the mean slope between the two rounded points. */
static dvi_status difference_slope(const step_map *map, int j, double d, double *slope)
{
  const int size = 2 * map->n;
  double ahead = d * map->scale[j], behind = -ahead, *started = slope + size;
  DVI_TRY(step_from(map, j, &ahead));
  for (int i = 0; i < size; i++) {
    slope[i] = state_change(map, i);
    started[i] = map->z[i];
  }
  DVI_TRY(step_from(map, j, &behind));
  for (int i = 0; i < size; i++) {
    const double unit = scaled_unit(map, i) / scaled_unit(map, j);
    slope[i] = (slope[i] - state_change(map, i)) / (ahead - behind) * unit;
    started[i] = (started[i] - map->z[i]) / (ahead - behind) * unit;
  }
  return DVI_OK;
}

static double column_size(size_t size, const double *x)
{
  double largest = 0;
  for (size_t i = 0; i < size; i++) largest = fmax(largest, fabs(x[i]));
  return largest;
}

/* Replace T_k-1 by T_k, whose first entry is `slope`. `rows` is the number of rows so far, this one
 * included. Return the entry with the smallest estimated error of those that count. The error is
 * infinite if none counts yet. */
static const double *extrapolate_row(const step_map *map, const double *slope, int rows,
                                     double *error)
{
  const size_t size = column_length(map);
  const int entries = rows < ORDERS ? rows : ORDERS;
  double estimated[ORDERS] = {(double)INFINITY}; /* estimated errors. Entry 0 has no estimate */
  int best = 0;
  for (size_t i = 0; i < size; i++) {
    double above = map->row[i], power = 1;
    map->row[i] = slope[i];
    for (int m = 1; m < entries; m++) {
      double *entry = map->row + (size_t)m * size + i;
      const double left = map->row[(size_t)(m - 1) * size + i], gap = left - above;
      above = *entry;
      power /= ratio * ratio;
      *entry = left + gap / (power - 1);
      /* distance from the entry above and from the left one, which is nearer */
      const double apart = fabs(gap) * power / (power - 1);
      if (!(apart <= estimated[m])) estimated[m] = apart;
    }
  }
  for (int m = FEWEST; m < entries; m++)
    if (estimated[m] < estimated[best]) best = m;
  *error = estimated[best] / fmax(1, column_size(size, map->row + (size_t)best * size));
  return map->row + (size_t)best * size;
}

/* Test whether a shorter difference may succeed, inside the domain where the map is defined or
 * regular. */
static int may_be_shortened(dvi_status status)
{
  return status > 0 || status == DVI_SINGULAR;
}

/* Return the rounding of a step, in units of the size of column j's differences. */
static double rounding_of(const step_map *map, int j)
{
  double largest = scaled_unit(map, j) * map->scale[j];
  for (int i = 0; i < 2 * map->n; i++)
    largest = fmax(largest, fabs(map->start[i]) * scaled_unit(map, i));
  return rounding * largest / (scaled_unit(map, j) * map->scale[j]);
}

/* Compute column j of M from the lengths whose steps succeed. If too few succeed, return the last
 * failure. The loop ends when shorter lengths could not give a smaller error. */
static dvi_status difference_column(const step_map *map, int j)
{
  const size_t size = column_length(map);
  const double rounded = rounding_of(map, j),
               last = fmax(shortest, 4 * DBL_EPSILON * fabs(map->start[j]) / map->scale[j]);
  double *column = map->M + (size_t)j * size, *slope = map->row + ORDERS * size,
         least = (double)INFINITY;
  dvi_status failure = DVI_OK;
  int rows = 0;
  for (double d = longest; d >= last && least > rounded / d; d *= ratio) {
    const dvi_status status = difference_slope(map, j, d, slope);
    if (status != DVI_OK && !may_be_shortened(status)) return status;
    if (status != DVI_OK) failure = status;
    rows = status == DVI_OK ? rows + 1 : 0;
    double error = (double)INFINITY;
    const double *entry = rows > 0 ? extrapolate_row(map, slope, rows, &error) : slope;
    if (error < least) memcpy(column, entry, size * sizeof *column);
    least = fmin(least, error);
  }
  if (least < (double)INFINITY) return DVI_OK;
  if (failure != DVI_OK) return failure;
  return dvi__fail(DVI_NOT_FINITE, "symplecticity: differences of variable %d are lost in rounding",
                   j);
}

/* Return x^T J y for x, y [2n]. */
static long double two_form(int n, const double *x, const double *y)
{
  long double form = 0;
  for (int k = 0; k < n; k++)
    form += (long double)x[k] * (long double)y[n + k] - (long double)x[n + k] * (long double)y[k];
  return form;
}

/* Return the largest entry of M^T J M - D^T J D, which is antisymmetric. */
static double largest_defect(const step_map *map)
{
  const int n = map->n;
  double largest = 0;
  for (int i = 0; i < 2 * n; i++)
    for (int j = i + 1; j < 2 * n; j++) {
      const double *x = map->M + (size_t)i * column_length(map),
                   *y = map->M + (size_t)j * column_length(map);
      const double defect = (double)(two_form(n, x, y) - two_form(n, x + 2 * n, y + 2 * n));
      if (!(fabs(defect) <= largest)) largest = fabs(defect); /* a NaN stays */
    }
  return largest;
}

static dvi_status measure_defect(const step_map *map, double *defect)
{
  double none = 0;
  DVI_TRY(step_from(map, 0, &none)); /* if the step itself fails, the map has no derivative */
  DVI_TRY(choose_scales(map));
  for (int j = 0; j < 2 * map->n; j++) DVI_TRY(difference_column(map, j));
  *defect = largest_defect(map);
  return DVI_OK;
}

static void step_map_release(step_map *map, double *start)
{
  dvi_integrator_destroy(&map->probe);
  dvi__release(start);
  dvi__release(map->z);
  dvi__release(map->scale);
  dvi__release(map->row);
  dvi__release(map->M);
}

static dvi_status symplecticity_check(const dvi_integrator *integrator, const double *q,
                                      const double *p, double h, const double *defect)
{
  if (!integrator || !q || !p || !defect)
    return dvi__fail(DVI_BAD_ARGUMENT, "symplecticity: an argument is NULL");
  if (!isfinite(h) || h == 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "symplecticity: h = %g, a finite step other than 0 is needed", h);
  const dvi_system *system = dvi_integrator_system(integrator);
  if (system->noise.friction > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "symplecticity: the system declares noise, and friction shrinks the two-form");
  if (system->dynamics->on_manifold)
    return dvi__fail(DVI_UNSUPPORTED,
                     "symplecticity: the %d coordinates of a system with factors, and its momenta, "
                     "are no canonical coordinates",
                     dvi_system_nq(system));
  if (system->dynamics->constraint != NULL &&
      (system->terms & (DVI__HOLONOMIC | DVI__NONHOLONOMIC)) == 0)
    return dvi__fail(DVI_UNSUPPORTED, "symplecticity: the system is degenerate, and no step starts "
                                      "off its constraint, where the map would be "
                                      "differenced; use dvi_loop_integral over a loop of starts");
  return DVI_OK;
}

dvi_status dvi_symplecticity(dvi_integrator *integrator, double t, const double *q, const double *p,
                             double h, double *defect)
{
  DVI_TRY(symplecticity_check(integrator, q, p, h, defect));
  const int n = dvi_system_nq(dvi_integrator_system(integrator));
  const size_t size = 2 * (size_t)n;
  double *start = DVI_NEW(double, size);
  step_map map = {.n = n,
                  .t = t,
                  .h = h,
                  .start = start,
                  .z = DVI_NEW(double, size),
                  .scale = DVI_NEW(double, size)};
  map.row = DVI_NEW(double, (ORDERS + 1) * column_length(&map));
  map.M = (double *)dvi__allocate(size, column_length(&map) * sizeof *map.M);
  dvi_status status = dvi_integrator_create_like(integrator, &map.probe);
  if (status == DVI_OK && (!start || !map.z || !map.scale || !map.row || !map.M))
    status = dvi__fail(DVI_NO_MEMORY, "symplecticity: no memory for a derivative of %zu by %zu",
                       size, size);
  for (int i = 0; status == DVI_OK && i < n; i++) {
    start[i] = q[i];
    start[n + i] = p[i];
  }
  if (status == DVI_OK) status = measure_defect(&map, defect);
  step_map_release(&map, start);
  return status;
}
