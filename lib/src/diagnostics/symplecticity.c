/* The symplecticity defect |M^T J M - J| of the map of one step, from its differenced derivative M.
 *
 * Scales. A mass of 1 beside one of 1e-8 makes momenta differ as much, so each coordinate gets a length a_i of its own and each
 * momentum the size b_i = m_i a_i / |h|, the momentum that crosses this length in one step; m_i is differenced from the Legendre
 * map. In units of a_i and |h| a step is a map of a unit of time between numbers of unit size, and its differences are as
 * well conditioned in momenta as in coordinates. The defect is measured in the coordinates
 *
 *     q_i sqrt(b_i / a_i),   p_i sqrt(a_i / b_i),
 *
 * a change of units that leaves J as it is.
 *
 * Differences. The central difference of 10th order over +-1 .. +-5 steps of length d a_i or d b_i errs by about 1e4 (d/R)^10 if
 * the map is analytic within R, and by about 2e-16 / d from roundoff. R is not known (close to a collision it is small), so
 * several d are tried; the smallest defect is the answer, for both errors add to it. The search ends early below the floor of
 * 1e-12: nothing smaller can be told from roundoff.
 *
 * The steps are taken by a second integrator of the same method: that is how the given one keeps its state, on every path. */
#include <dvi/diagnostics.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"

enum { REACH = 5 };

static const double defect_floor = 1e-12;

/* Coordinates and momenta stand in one array z [2n] = (q, p). M is stored by columns: column j = derivative by z_j. */
typedef struct step_map {
  dvi_integrator *probe;
  int n;
  double t, h;
  const double *start; /* [2n] */
  double *z;           /* [2n] a point to start from */
  double *scale;       /* [2n] a and b */
  double *M;           /* [2n * 2n] in the scaled coordinates */
} step_map;

/* a_i = |q_i|, but at least a sixteenth of the largest: a coordinate that happens to be 0 is no smaller than its neighbours. */
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

/* b_i = |p(v + w e_i) - p(v)|_i with w = a_i / |h|. */
static dvi_status momentum_scales(const dvi_system *system, int n, double t, double h, const double *q, double *v, const double *a,
                                  double *moved, double *b)
{
  for (int i = 0; i < n; i++) {
    const double velocity = v[i];
    DVI_TRY(dvi_system_momentum(system, t, q, v, moved));
    const double before = moved[i];
    v[i] = velocity + a[i] / fabs(h);
    DVI_TRY(dvi_system_momentum(system, t, q, v, moved));
    v[i] = velocity;
    b[i] = fabs(moved[i] - before);
    if (!(b[i] > 0)) b[i] = fmax(fabs(before), 1);
  }
  return DVI_OK;
}

static dvi_status choose_scales(const step_map *map)
{
  const int n = map->n;
  const dvi_system *system = dvi_integrator_system(map->probe);
  const double *q = map->start, *p = map->start + n;
  double *v = DVI_NEW(double, n);
  dvi_status status = v ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "symplecticity: no memory for %d velocities", n);
  if (status == DVI_OK) status = dvi_system_velocity(system, map->t, q, p, v);
  if (status == DVI_OK) coordinate_scales(n, q, v, map->h, map->scale);
  if (status == DVI_OK) status = momentum_scales(system, n, map->t, map->h, q, v, map->scale, map->z, map->scale + n);
  dvi__release(v);
  return status;
}

/* One step from start + shift e_j. */
static dvi_status step_from(const step_map *map, int j, double shift)
{
  for (int i = 0; i < 2 * map->n; i++) map->z[i] = map->start[i];
  map->z[j] += shift;
  DVI_TRY(dvi_integrator_start(map->probe, map->t, map->z, map->z + map->n));
  return dvi_integrator_step(map->probe, map->h);
}

/* Add factor times it to column j. */
static dvi_status add_step(const step_map *map, int j, double shift, double factor)
{
  const int n = map->n;
  double *column = map->M + (size_t)j * 2 * (size_t)n;
  DVI_TRY(step_from(map, j, shift));
  const double *q = dvi_integrator_q(map->probe), *p = dvi_integrator_p(map->probe);
  for (int i = 0; i < n; i++) {
    column[i] += factor * (q[i] - map->start[i]); /* the weights of a difference cancel the start; subtracted it rounds less */
    column[n + i] += factor * (p[i] - map->start[n + i]);
  }
  return DVI_OK;
}

/* The factor that turns z_i into scaled coordinates. */
static double unit(const step_map *map, int i)
{
  const int n = map->n;
  return i < n ? sqrt(map->scale[n + i] / map->scale[i]) : sqrt(map->scale[i - n] / map->scale[i]);
}

static dvi_status difference_column(const step_map *map, int j, double d)
{
  static const double weight[REACH] = {5.0 / 6, -5.0 / 21, 5.0 / 84, -5.0 / 504, 1.0 / 1260};
  const int size = 2 * map->n;
  double *column = map->M + (size_t)j * (size_t)size;
  const double step = d * map->scale[j];
  for (int i = 0; i < size; i++) column[i] = 0;
  for (int k = REACH; k >= 1; k--) {
    DVI_TRY(add_step(map, j, k * step, weight[k - 1] / step));
    DVI_TRY(add_step(map, j, -k * step, -weight[k - 1] / step));
  }
  for (int i = 0; i < size; i++) column[i] *= unit(map, i) / unit(map, j);
  return DVI_OK;
}

/* Largest entry of M^T J M - J, which is antisymmetric. */
static double largest_defect(const step_map *map)
{
  const int n = map->n;
  double largest = 0;
  for (int i = 0; i < 2 * n; i++)
    for (int j = i + 1; j < 2 * n; j++) {
      const double *x = map->M + (size_t)i * 2 * (size_t)n, *y = map->M + (size_t)j * 2 * (size_t)n;
      long double form = j == i + n ? -1 : 0;
      for (int k = 0; k < n; k++) form += (long double)x[k] * (long double)y[n + k] - (long double)x[n + k] * (long double)y[k];
      largest = fmax(largest, fabs((double)form));
    }
  return largest;
}

static dvi_status difference_map(const step_map *map, double d, double *defect)
{
  for (int j = 0; j < 2 * map->n; j++) DVI_TRY(difference_column(map, j, d));
  *defect = largest_defect(map);
  return DVI_OK;
}

/* The smallest defect over the difference steps. One that leads outside of the map's domain is left out, unless all do. */
static dvi_status search(const step_map *map, double *defect)
{
  static const double d[] = {0x1p-6, 0x1p-7, 0x1p-5, 0x1p-8, 0x1p-4, 0x1p-9, 0x1p-10, 0x1p-12};
  dvi_status last = DVI_OK;
  double smallest = (double)INFINITY;
  for (size_t i = 0; i < sizeof d / sizeof *d && smallest > defect_floor; i++) {
    double found;
    const dvi_status status = difference_map(map, d[i], &found);
    if (status < 0) return status;
    if (status == DVI_OK)
      smallest = fmin(smallest, found);
    else
      last = status;
  }
  if (!(smallest < (double)INFINITY)) return last;
  *defect = smallest;
  return DVI_OK;
}

static void release(step_map *map, double *start)
{
  dvi_integrator_destroy(&map->probe);
  dvi__release(start);
  dvi__release(map->z);
  dvi__release(map->scale);
  dvi__release(map->M);
}

static dvi_status check(const dvi_integrator *integrator, const double *q, const double *p, double h, const double *defect)
{
  if (!integrator || !q || !p || !defect) return dvi__fail(DVI_BAD_ARGUMENT, "symplecticity: an argument is NULL");
  if (!isfinite(h) || h == 0) return dvi__fail(DVI_BAD_ARGUMENT, "symplecticity: h = %g, a finite step other than 0 is needed", h);
  const dvi_system *system = dvi_integrator_system(integrator);
  if (dvi_system_nq(system) != dvi_system_nv(system))
    return dvi__fail(DVI_UNSUPPORTED, "symplecticity: %d coordinates of %d freedoms are no canonical coordinates",
                     dvi_system_nq(system), dvi_system_nv(system));
  return DVI_OK;
}

dvi_status dvi_symplecticity(dvi_integrator *integrator, double t, const double *q, const double *p, double h, double *defect)
{
  DVI_TRY(check(integrator, q, p, h, defect));
  const int n = dvi_system_nq(dvi_integrator_system(integrator));
  const size_t size = 2 * (size_t)n;
  double *start = DVI_NEW(double, size);
  step_map map = {.n = n, .t = t, .h = h, .start = start, .z = DVI_NEW(double, size), .scale = DVI_NEW(double, size)};
  map.M = (double *)dvi__allocate(size, size * sizeof *map.M);
  dvi_status status = dvi_integrator_create(dvi_integrator_system(integrator), dvi_integrator_method(integrator), &map.probe);
  if (status == DVI_OK && (!start || !map.z || !map.scale || !map.M))
    status = dvi__fail(DVI_NO_MEMORY, "symplecticity: no memory for a derivative of %zu by %zu", size, size);
  for (int i = 0; status == DVI_OK && i < n; i++) {
    start[i] = q[i];
    start[n + i] = p[i];
  }
  if (status == DVI_OK) status = choose_scales(&map);
  if (status == DVI_OK) status = search(&map, defect);
  release(&map, start);
  return status;
}
