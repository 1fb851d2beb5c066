/* Lines from a kept point within the tolerance of all points behind it lie in a cone, which each
 * point narrows (J. Sklansky and V. Gonzalez, Fast polygonal approximation of digitized curves,
 * 1980). A point outside, or one that turns back, makes the point before it a kept one. */
#include "plot/thin.h"

#include <math.h>

/* Directions from the last kept point, as angles around that of its first follower. */
typedef struct cone {
  double x, y; /* last kept point */
  double along;
  double least, most; /* angles relative to `along` */
  double farthest;
} cone;

static double wrap_angle(double angle)
{
  return remainder(angle, 2.0 * acos(-1.0));
}

/* Return whether a line to this point passes all points since the kept one. If it does, narrow the
 * cone. */
static bool cone_narrow(cone *c, bool *aimed, double x, double y, double tolerance)
{
  const double distance = hypot(x - c->x, y - c->y);
  if (distance < c->farthest - tolerance) return false;
  c->farthest = fmax(c->farthest, distance);
  if (distance <= tolerance) return true;
  const double angle = atan2(y - c->y, x - c->x), width = asin(tolerance / distance);
  if (!*aimed) {
    *aimed = true;
    c->along = angle;
    c->least = -width;
    c->most = width;
    return true;
  }
  const double off = wrap_angle(angle - c->along);
  if (off < c->least || off > c->most) return false;
  c->least = fmax(c->least, off - width);
  c->most = fmin(c->most, off + width);
  return true;
}

/* Thin a run of points from first to last, which are all drawable. */
static void thin_run(int first, int last, const double *x, const double *y, double tolerance,
                     bool *keep)
{
  cone c = {.x = x[first], .y = y[first]};
  bool aimed = false;
  for (int i = first + 1; i < last; i++) keep[i] = false;
  for (int i = first + 1; i <= last; i++) {
    if (cone_narrow(&c, &aimed, x[i], y[i], tolerance)) continue;
    keep[i - 1] = true;
    c = (cone){.x = x[i - 1], .y = y[i - 1]};
    aimed = false;
    (void)cone_narrow(&c, &aimed, x[i], y[i], tolerance);
  }
}

void thin_curve(int count, const double *x, const double *y, double tolerance, bool *keep)
{
  for (int first = 0; first < count; first++) {
    if (!keep[first]) continue;
    int last = first;
    while (last + 1 < count && keep[last + 1]) last++;
    thin_run(first, last, x, y, tolerance, keep);
    first = last;
  }
}
