/* Directions along which a periodic path may be moved at will: in time, and along the symmetries
 * that its ends keep. The Hessian of the action is singular along them. Each gets a multiplier,
 * which holds the path where its guess was and vanishes with the gradient, for the action does not
 * change there (Marsden and West 2001, sec. 1.3.3; for time this holds as far as the discrete
 * motion has a smooth continuation, up to roundoff for short steps). */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "boundary/path_struct.h"

/* A symmetry is kept by the ends if xi(A q_0 + a) = A xi(q_0), to this part of it. */
static const double kept_below = 1e-8;

static double *column(const dvi_path *path, int g)
{
  return path->gauge + (size_t)g * (size_t)path->steps * (size_t)path->n;
}

static double dot(size_t count, const double *x, const double *y)
{
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += x[i] * y[i];
  return sum;
}

static void subtract(size_t count, double factor, const double *x, double *y)
{
  for (size_t i = 0; i < count; i++) y[i] -= factor * x[i];
}

static void divide(size_t count, double by, double *x)
{
  for (size_t i = 0; i < count; i++) x[i] /= by;
}

/* Over all nodes, weighed by the masses. */
static double inner(const dvi_path *path, const double *x, const double *y)
{
  double sum = 0;
  for (int k = 0; k < path->steps; k++, x += path->n, y += path->n)
    for (int i = 0; i < path->n; i++) sum += path->kinetic[i] * x[i] * y[i];
  return sum;
}

static dvi_status generate(const dvi_symmetry *symmetry, const double *q, double *xi)
{
  const int returned = symmetry->generator(q, xi, symmetry->user);
  if (returned == 0) return DVI_OK;
  return dvi__fail(returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY,
                   "symmetry '%s': the callback returned %d", symmetry->name, returned);
}

/* xi at all nodes but the last, and by how much the ends break it: A xi(q_0) - xi(q_N). */
static dvi_status symmetry_column(dvi_path *path, const dvi_symmetry *symmetry, const double *x,
                                  int g)
{
  const size_t n = (size_t)path->n;
  double *xi = column(path, g), *last = path->in_ends[0], *defect = path->defect + (size_t)g * n;
  for (int k = 0; k < path->steps; k++)
    DVI_TRY(generate(symmetry, dvi__path_at(path, x, k), xi + (size_t)k * n));
  DVI_TRY(generate(symmetry, dvi__path_at(path, x, path->steps), last));
  dvi__path_turn(path, xi, defect);
  subtract(n, 1, last, defect);
  return DVI_OK;
}

/* The velocity: the ends keep it, for they are as far apart in time. */
static void time_column(dvi_path *path, const double *x, int g)
{
  const size_t n = (size_t)path->n;
  for (int k = 0; k < path->steps; k++) {
    double *v = column(path, g) + (size_t)k * n;
    memcpy(v, dvi__path_at(path, x, k + 1), n * sizeof(double));
    subtract(n, 1, dvi__path_at(path, x, k), v);
  }
  memset(path->defect + (size_t)g * n, 0, n * sizeof(double));
}

/* Take from direction g what other broken ones can mend, and say whether it is still broken. */
static void mend(dvi_path *path, int g)
{
  const size_t n = (size_t)path->n, length = (size_t)path->steps * n;
  double *defect = path->defect + (size_t)g * n;
  const double size = sqrt(dot(n, column(path, g), column(path, g)));
  for (int b = 0; b < g; b++) {
    if (!path->broken[b]) continue;
    const double part = dot(n, defect, path->defect + (size_t)b * n);
    subtract(n, part, path->defect + (size_t)b * n, defect);
    subtract(length, part, column(path, b), column(path, g));
  }
  const double norm = sqrt(dot(n, defect, defect));
  path->broken[g] = norm > kept_below * size;
  if (!path->broken[g]) return;
  divide(n, norm, defect);
  divide(length, norm, column(path, g));
}

/* Put direction g, if it is one of its own, orthogonal to those in use, behind them. */
static void use(dvi_path *path, int g, double least_own_part)
{
  const size_t length = (size_t)path->steps * (size_t)path->n;
  double *own = column(path, g);
  const double whole = inner(path, own, own);
  for (int pass = 0; pass < 2; pass++)
    for (int b = 0; b < path->in_use; b++)
      subtract(length, inner(path, own, column(path, b)), column(path, b), own);
  const double rest = inner(path, own, own);
  if (!(rest > least_own_part * least_own_part * whole)) return;
  divide(length, sqrt(rest), own);
  memmove(column(path, path->in_use++), own, length * sizeof(double));
}

/* From orthonormal directions to momenta, of the size of a row's response to an unknown. */
static void weigh(dvi_path *path)
{
  for (int g = 0; g < path->gauges; g++)
    for (int k = 0; k < path->steps; k++)
      for (int i = 0; i < path->n; i++) {
        double *entry = column(path, g) + (size_t)k * (size_t)path->n + (size_t)i;
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
  for (int g = 0; g < path->gauges; g++) mend(path, g);
  for (int g = 0; g < system->symmetry_count; g++)
    if (!path->broken[g]) use(path, g, least_own_part);
  const int others = path->in_use;
  if (system->autonomous) use(path, system->symmetry_count, least_own_part);
  path->holds_time = path->in_use > others;
  weigh(path);
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
  memset(column(path, path->in_use), 0, (size_t)path->steps * (size_t)path->n * sizeof(double));
  return 1;
}
