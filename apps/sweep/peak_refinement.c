#include "sweep/peak_refinement.h"

#include <math.h>

/* Return the lowest point beside point i in one direction, before higher ones, and to the left
 * before equal ones. It is infinity if such a point is next to point i, and -infinity if the range
 * ends there. */
static double lowest_beside(int count, const double *y, int i, int direction)
{
  double lowest = (double)INFINITY;
  int j = i + direction;
  if (j < 0 || j >= count) return (double)-INFINITY;
  for (; j >= 0 && j < count && (y[j] < y[i] || (direction > 0 && y[j] <= y[i])); j += direction)
    lowest = fmin(lowest, y[j]);
  return lowest;
}

static bool is_top(int count, const double *y, int i)
{
  return y[i] - fmax(lowest_beside(count, y, i, -1), lowest_beside(count, y, i, 1)) >= PEAK_RISE;
}

int peak_gaps(int count, const double *x, const double *y, double width, bool *top, bool *halve)
{
  int marked = 0;
  for (int i = 0; i < count; i++) top[i] = is_top(count, y, i);
  for (int i = 0; i + 1 < count; i++) {
    halve[i] = x[i + 1] - x[i] > width &&
               (top[i] || top[i + 1] || fabs(y[i + 1] - y[i]) > PEAK_STEEP);
    marked += halve[i];
  }
  return marked;
}
