/* First guesses of a path. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "boundary/path_struct.h"

/* Copy the nodes of x to q, for the queries. Momenta exist only after a solve. */
static void show_guess(dvi_path *path)
{
  const size_t n = (size_t)path->n;
  for (int k = 0; k <= path->steps; k++)
    memcpy(path->q + (size_t)k * n, dvi__path_at(path, path->x, k), n * sizeof(double));
  path->solved = 0;
}

static dvi_status check_guess_points(const dvi_path *path, int points, int dimension,
                                     const double *t, const double *q)
{
  if (t == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the guess has no times or no points");
  if (points < 2)
    return dvi__fail(DVI_BAD_SIZE, "path: the guess has %d points; at least 2 are needed", points);
  if (dimension != path->n)
    return dvi__fail(DVI_BAD_SIZE, "path: the guess has %d coordinates, the system %d", dimension,
                     path->n);
  const ptrdiff_t bad_q = dvi__first_not_finite((size_t)points * (size_t)dimension, q),
                  bad_t = dvi__first_not_finite((size_t)points, t);
  if (bad_q >= 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: point %td of the guess has the coordinate %g",
                     bad_q / dimension, q[bad_q]);
  if (bad_t >= 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: point %td of the guess has the time %g", bad_t,
                     t[bad_t]);
  for (int m = 1; m < points; m++)
    if (!(t[m] > t[m - 1]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "path: the times of the guess are not ascending (%g after %g)", t[m],
                       t[m - 1]);
  return DVI_OK;
}

/* Interpolate between points m and m+1 of the guess. */
static void interpolate_guess(const dvi_path *path, const double *t, const double *q, int m,
                              double time, double *node)
{
  const double part = (time - t[m]) / (t[m + 1] - t[m]);
  const double *left = q + (size_t)m * (size_t)path->n, *right = left + path->n;
  for (int i = 0; i < path->n; i++) node[i] = (1 - part) * left[i] + part * right[i];
}

/* Put the coordinates that mixed ends give into place. */
static void set_given(dvi_path *path)
{
  for (int i = 0; i < 2 * path->n; i++) {
    const int given = dvi__path_given(path, i % 2, i / 2);
    if (given >= 0) path->x[given] = (i % 2 == 0 ? path->q0 : path->q1)[i / 2];
  }
}

dvi_status dvi_path_guess(dvi_path *path, int points, int dimension, const double *t,
                          const double *q)
{
  if (path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "path: no path to guess");
  DVI_TRY(check_guess_points(path, points, dimension, t, q));
  memset(path->x, 0, (size_t)path->unknowns * sizeof(double));
  for (int k = 0, m = 0; k <= path->steps; k++) {
    const double time = t[0] + (t[points - 1] - t[0]) * k / path->steps;
    while (m < points - 2 && time > t[m + 1]) m++;
    if (dvi__path_node(path, k) >= 0)
      interpolate_guess(path, t, q, m, time, path->x + dvi__path_node(path, k));
  }
  set_given(path);
  if (path->free_span) path->x[path->core] = 1;
  show_guess(path);
  return DVI_OK;
}

static int same_shape(const dvi_path *a, const dvi_path *b)
{
  return a->n == b->n && a->s == b->s && a->steps == b->steps && a->ends == b->ends &&
         a->free_span == b->free_span;
}

dvi_status dvi_path_guess_along(dvi_path *path, const dvi_path *last, const dvi_path *before,
                                double ratio)
{
  if (path == NULL || last == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: no path to guess, or none to guess from");
  if (!same_shape(path, last) || (before != NULL && !same_shape(path, before)))
    return dvi__fail(
        DVI_BAD_SIZE,
        "path: a guess from a path of another dimension, degree, number of steps or kind of ends");
  if (!isfinite(ratio))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the guess is to go %g times as far as the last step",
                     ratio);
  for (int c = 0; c < path->core; c++)
    path->x[c] = last->x[c] + (before != NULL ? ratio * (last->x[c] - before->x[c]) : 0);
  for (int c = path->core; c < path->unknowns; c++) path->x[c] = 0;
  set_given(path);
  if (path->free_span) {
    const double span = dvi__path_span(last, last->x),
                 earlier = before != NULL ? dvi__path_span(before, before->x) : span;
    path->x[path->core] = (span + ratio * (span - earlier)) / path->span;
  }
  show_guess(path);
  return DVI_OK;
}
