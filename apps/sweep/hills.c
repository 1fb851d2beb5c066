#include "sweep/hills.h"

#include <math.h>

/* The lowest ground from point i in one direction, before higher ground, and to the left before equal; infinity if that is next to it, -infinity if the
 * range ends there. */
static double ground_beside(int count, const double *y, int i, int direction)
{
  double lowest = (double)INFINITY;
  int j = i + direction;
  if (j < 0 || j >= count) return (double)-INFINITY;
  for (; j >= 0 && j < count && (y[j] < y[i] || (direction > 0 && y[j] <= y[i])); j += direction) lowest = fmin(lowest, y[j]);
  return lowest;
}

static bool is_top(int count, const double *y, int i)
{
  return y[i] - fmax(ground_beside(count, y, i, -1), ground_beside(count, y, i, 1)) >= HILLS_RISE;
}

int hills_gaps(int count, const double *x, const double *y, double width, bool *top, bool *halve)
{
  int marked = 0;
  for (int i = 0; i < count; i++) top[i] = is_top(count, y, i);
  for (int i = 0; i + 1 < count; i++) {
    halve[i] = x[i + 1] - x[i] > width && (top[i] || top[i + 1] || fabs(y[i + 1] - y[i]) > HILLS_STEEP);
    marked += halve[i];
  }
  return marked;
}
