/* Directions along which a periodic path may be moved at will: in time, and along the symmetries
 * that its ends keep. The Hessian of the action is singular along these directions. Each direction
 * has a multiplier, which holds the path at the place of its guess. The multiplier vanishes with
 * the gradient, because the action does not change along the direction (Marsden and West 2001, sec.
 * 1.3.3). For time this holds as far as the discrete motion has a smooth continuation, up to
 * roundoff for short steps. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "boundary/path_struct.h"

/* The ends keep a symmetry if xi(A q_0 + a) = A xi(q_0), to this part of xi. */
static const double kept_below = 1e-8;

static double *gauge_column(const dvi_path *path, int g)
{
  return path->gauge + (size_t)g * (size_t)path->steps * (size_t)path->n;
}

static double euclidean_product(size_t count, const double *x, const double *y)
{
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += x[i] * y[i];
  return sum;
}

static void subtract_multiple(size_t count, double factor, const double *x, double *y)
{
  for (size_t i = 0; i < count; i++) y[i] -= factor * x[i];
}

static void divide_vector(size_t count, double by, double *x)
{
  for (size_t i = 0; i < count; i++) x[i] /= by;
}

/* Return the inner product over all nodes, weighted by the masses. */
static double mass_product(const dvi_path *path, const double *x, const double *y)
{
  double sum = 0;
  for (int k = 0; k < path->steps; k++, x += path->n, y += path->n)
    for (int i = 0; i < path->n; i++) sum += path->kinetic[i] * x[i] * y[i];
  return sum;
}

static dvi_status symmetry_direction(const dvi_symmetry *symmetry, const double *q, double *xi)
{
  const int returned = symmetry->generator(q, xi, symmetry->user);
  if (returned == 0) return DVI_OK;
  return dvi__fail(returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY,
                   "symmetry '%s': the callback returned %d", symmetry->name, returned);
}

/* Evaluate xi at all nodes but the last, and the defect A xi(q_0) - xi(q_N) of the ends. */
static dvi_status symmetry_column(dvi_path *path, const dvi_symmetry *symmetry, const double *x,
                                  int g)
{
  const size_t n = (size_t)path->n;
  double *xi = gauge_column(path, g), *last = path->in_ends[0],
         *defect = path->defect + (size_t)g * n;
  for (int k = 0; k < path->steps; k++)
    DVI_TRY(symmetry_direction(symmetry, dvi__path_at(path, x, k), xi + (size_t)k * n));
  DVI_TRY(symmetry_direction(symmetry, dvi__path_at(path, x, path->steps), last));
  dvi__path_turn(path, xi, defect);
  subtract_multiple(n, 1, last, defect);
  return DVI_OK;
}

/* Compute the direction of time, the velocity at the nodes. The ends keep it, because the span is
 * fixed. */
static void time_column(dvi_path *path, const double *x, int g)
{
  const size_t n = (size_t)path->n;
  for (int k = 0; k < path->steps; k++) {
    double *v = gauge_column(path, g) + (size_t)k * n;
    memcpy(v, dvi__path_at(path, x, k + 1), n * sizeof(double));
    subtract_multiple(n, 1, dvi__path_at(path, x, k), v);
  }
  memset(path->defect + (size_t)g * n, 0, n * sizeof(double));
}

/* Reduce the defect of direction g by a combination with other broken directions, and test whether
 * the direction is still broken. */
static void mend_gauge(dvi_path *path, int g)
{
  const size_t n = (size_t)path->n, length = (size_t)path->steps * n;
  double *defect = path->defect + (size_t)g * n;
  const double size = sqrt(euclidean_product(n, gauge_column(path, g), gauge_column(path, g)));
  for (int b = 0; b < g; b++) {
    if (!path->broken[b]) continue;
    const double part = euclidean_product(n, defect, path->defect + (size_t)b * n);
    subtract_multiple(n, part, path->defect + (size_t)b * n, defect);
    subtract_multiple(length, part, gauge_column(path, b), gauge_column(path, g));
  }
  const double norm = sqrt(euclidean_product(n, defect, defect));
  path->broken[g] = norm > kept_below * size;
  if (!path->broken[g]) return;
  divide_vector(n, norm, defect);
  divide_vector(length, norm, gauge_column(path, g));
}

/* Append direction g, made orthogonal to those in use, unless it depends on them. */
static void take_gauge_in_use(dvi_path *path, int g, double least_own_part)
{
  const size_t length = (size_t)path->steps * (size_t)path->n;
  double *own = gauge_column(path, g);
  const double whole = mass_product(path, own, own);
  for (int pass = 0; pass < 2; pass++)
    for (int b = 0; b < path->in_use; b++)
      subtract_multiple(length, mass_product(path, own, gauge_column(path, b)),
                        gauge_column(path, b), own);
  const double rest = mass_product(path, own, own);
  if (!(rest > least_own_part * least_own_part * whole)) return;
  divide_vector(length, sqrt(rest), own);
  memmove(gauge_column(path, path->in_use++), own, length * sizeof(double));
}

/* Scale orthonormal directions to momenta, of the size of a row's response to an unknown. */
static void weigh_gauges(dvi_path *path)
{
  for (int g = 0; g < path->gauges; g++)
    for (int k = 0; k < path->steps; k++)
      for (int i = 0; i < path->n; i++) {
        double *entry = gauge_column(path, g) + (size_t)k * (size_t)path->n + (size_t)i;
        *entry = g < path->in_use ? *entry * path->row_scale[i * path->s] : 0;
      }
}

dvi_status dvi__path_fix_gauge(dvi_path *path, const double *x, double least_own_part)
{
  const dvi_system *system = path->system;
  path->in_use = path->holds_time = 0;
  if (path->gauges == 0) return DVI_OK;
  for (int g = 0; g < system->symmetry_count; g++)
    DVI_TRY(symmetry_column(path, &system->symmetries[g], x, g));
  if (system->autonomous) time_column(path, x, system->symmetry_count);
  for (int g = 0; g < path->gauges; g++) mend_gauge(path, g);
  for (int g = 0; g < system->symmetry_count; g++)
    if (!path->broken[g]) take_gauge_in_use(path, g, least_own_part);
  const int others = path->in_use;
  if (system->autonomous) take_gauge_in_use(path, system->symmetry_count, least_own_part);
  path->holds_time = path->in_use > others;
  weigh_gauges(path);
  for (int k = 0; k < path->steps; k++)
    memcpy(path->origin + (size_t)k * (size_t)path->n, dvi__path_at(path, x, k),
           (size_t)path->n * sizeof(double));
  return DVI_OK;
}

int dvi__path_release_time(dvi_path *path)
{
  if (!path->holds_time) return 0;
  path->holds_time = 0;
  path->in_use--;
  memset(gauge_column(path, path->in_use), 0,
         (size_t)path->steps * (size_t)path->n * sizeof(double));
  return 1;
}
