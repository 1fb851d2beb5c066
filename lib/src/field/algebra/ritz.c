#include "field/algebra/ritz.h"

#include <math.h>

enum { BETWEEN_TESTS = 16 };

static const double margin = 1e-3, improbable = 1e-8, settled = 1e-9;

/* Count the eigenvalues of T above x by the signs of the pivots (Sturm). */
static int count_above(const dvi__ritz *T, double x)
{
  int count = 0;
  double pivot = 1;
  for (int j = 0; j < T->steps; j++) {
    const double coupling = j > 0 ? T->beta[j] * (T->beta[j] / (pivot != 0 ? pivot : 1e-300)) : 0;
    pivot = T->alpha[j] - x - coupling;
    count += pivot > 0;
  }
  return count;
}

static double largest_value(const dvi__ritz *T)
{
  double low = T->alpha[0], high = 0;
  for (int j = 0; j < T->steps; j++) {
    const double reach = T->beta[j] + (j + 1 < T->steps ? T->beta[j + 1] : 0);
    low = fmax(low, T->alpha[j]);
    high = fmax(high, T->alpha[j] + reach);
  }
  for (int i = 0; i < 60 && high - low > 1e-15 * high; i++) {
    const double middle = 0.5 * (low + high);
    if (count_above(T, middle) > 0)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* The part of the last direction in the eigenvector of theta, by the recurrence from there on, in
 * which the vector grows. */
static double last_component(const dvi__ritz *T, double theta)
{
  double next = 0, here = 1, sum = 1;
  for (int j = T->steps - 1; j > 0; j--) {
    const double before = ((theta - T->alpha[j]) * here - T->beta[j + 1] * next) / T->beta[j];
    next = here;
    here = before;
    sum += here * here;
    if (sum > 1e200) return 0;
  }
  return 1 / sqrt(sum);
}

static int steps_needed(int64_t n)
{
  const double steps = 0.5 * (1 + log(1.648 * sqrt((double)n) / improbable) / sqrt(margin));
  return steps < DVI__RITZ_STEPS ? (int)ceil(steps) : DVI__RITZ_STEPS;
}

int dvi__ritz_suffices(const dvi__ritz *T, int64_t n, double other, double *bound)
{
  const double beta = T->steps > 0 ? T->beta[T->steps] : 1;
  const int is_last = T->steps >= steps_needed(n);
  if (T->steps == 0 || (T->steps % BETWEEN_TESTS != 0 && !is_last && beta > 0)) return 0;
  const double theta = largest_value(T);
  *bound = fmin(theta * (1 + margin), other);
  return is_last || other <= theta * (1 + margin) || !(beta > settled * theta) ||
         beta * last_component(T, theta) <= settled * theta;
}
