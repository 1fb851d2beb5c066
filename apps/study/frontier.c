#include "study/frontier.h"

#include <math.h>
#include <stdbool.h>

static bool is_finite_positive(double x)
{
  return x > 0.0 && isfinite(x);
}

/* Return whether point j makes point i superfluous. Equal points both stay, which is harmless. */
static bool point_beats(const double *error, const double *cost, int j, int i)
{
  if (!is_finite_positive(error[j]) || !is_finite_positive(cost[j]) || error[j] > error[i] ||
      cost[j] > cost[i])
    return false;
  return error[j] < error[i] || cost[j] < cost[i];
}

static bool is_on_curve(int count, const double *error, const double *cost, int i)
{
  if (!is_finite_positive(error[i]) || !is_finite_positive(cost[i])) return false;
  for (int j = 0; j < count; j++)
    if (point_beats(error, cost, j, i)) return false;
  return true;
}

frontier_answer frontier_cost(int count, const double *error, const double *cost, double asked,
                              double *least)
{
  int below = -1; /* index of the largest error that does not exceed the asked one */
  int above = -1; /* index of the smallest error that exceeds the asked one */
  for (int i = 0; i < count; i++) {
    if (!is_on_curve(count, error, cost, i)) continue;
    if (error[i] <= asked && (below < 0 || error[i] > error[below])) below = i;
    if (error[i] > asked && (above < 0 || error[i] < error[above])) above = i;
  }
  *least = below >= 0 ? cost[below] : (double)NAN;
  if (below < 0) return FRONTIER_NOT_REACHED;
  if (error[below] >= asked) return FRONTIER_BETWEEN; /* a setting has the asked error itself */
  if (above < 0) return FRONTIER_AT_MOST;
  const double way = log(asked / error[below]) / log(error[above] / error[below]);
  *least = cost[below] * pow(cost[above] / cost[below], way);
  return FRONTIER_BETWEEN;
}
