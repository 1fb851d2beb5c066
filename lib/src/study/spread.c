/* Repeated measurements in a few numbers. */
#include <dvi/study.h>
#include <stdlib.h>

static int compare_size(const void *left, const void *right)
{
  const double a = *(const double *)left;
  const double b = *(const double *)right;
  return (a > b) - (a < b);
}

static double quantile(int count, const double *sorted, double part)
{
  const double place = part * (count - 1);
  const int below = (int)place;
  const int above = below + 1 < count ? below + 1 : below;
  return sorted[below] + (place - below) * (sorted[above] - sorted[below]);
}

dvi_study_spread dvi_study_spread_of(int count, double *sample)
{
  qsort(sample, (size_t)count, sizeof *sample, compare_size);
  return (dvi_study_spread){.least = sample[0],
                            .lower = quantile(count, sample, 0.25),
                            .median = quantile(count, sample, 0.5),
                            .upper = quantile(count, sample, 0.75)};
}
