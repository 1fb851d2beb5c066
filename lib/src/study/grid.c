/* Grids of parameters. */
#include "study/grid.h"

#include <math.h>

#include "core/status.h"

int64_t dvi_study_points(int axes, const dvi_study_axis *axis)
{
  int64_t points = 1;
  if (axes < 1 || axes > DVI_STUDY_AXES_MAX || axis == NULL) return -1;
  for (int i = 0; i < axes; i++) {
    if (axis[i].count < 1 || axis[i].count > INT64_MAX / points) return -1;
    points *= axis[i].count;
  }
  return points;
}

dvi_status dvi_study_range(double from, double to, int64_t count, double *value)
{
  if (count < 2 || value == NULL || !isfinite(from) || !isfinite((to - from) * (double)count))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "a range wants two finite numbers and a count from 2, not %g, %g and %lld",
                     from, to, (long long)count);
  for (int64_t k = 0; k < count; k++)
    value[k] = from + (to - from) * (double)k / (double)(count - 1);
  value[count - 1] = to;
  return DVI_OK;
}

void dvi__grid_at(int axes, const dvi_study_axis *axis, int64_t number, int64_t *index,
                  double *value)
{
  for (int i = axes - 1; i >= 0; i--) {
    index[i] = number % axis[i].count;
    value[i] = axis[i].value != NULL ? axis[i].value[index[i]] : (double)NAN;
    number /= axis[i].count;
  }
}
