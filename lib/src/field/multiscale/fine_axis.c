#include "field/multiscale/fine_axis.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"

dvi_status dvi__fine_axis_create(const double *node, int cells, int fine, int is_periodic,
                                 dvi__fine_axis *axis)
{
  *axis = (dvi__fine_axis){cells, fine, cells * fine, is_periodic, NULL};
  axis->end = DVI_NEW(double, axis->parts + 1);
  if (axis->end == NULL)
    return dvi__fail(DVI_NO_MEMORY, "msfem: no memory for %d parts of an axis", axis->parts);
  for (int i = 0; i < axis->parts; i++) {
    const int cell = i / fine;
    axis->end[i] = node[cell] + (node[cell + 1] - node[cell]) * (i % fine) / fine;
  }
  axis->end[axis->parts] = node[cells];
  return DVI_OK;
}

void dvi__fine_axis_clear(dvi__fine_axis *axis)
{
  dvi__release(axis->end);
  *axis = (dvi__fine_axis){0};
}

int dvi__fine_axis_nodes(const dvi__fine_axis *axis)
{
  return axis->is_periodic ? axis->cells : axis->cells + 1;
}

int dvi__fine_axis_node(const dvi__fine_axis *axis, int cell, int right)
{
  return (cell + right) % dvi__fine_axis_nodes(axis);
}

int dvi__fine_axis_locate(const dvi__fine_axis *axis, double x, int *part, double *place)
{
  const double from = axis->end[0], to = axis->end[axis->parts];
  if (!isfinite(x)) return 0;
  if (axis->is_periodic)
    x = fmin(fmax(x - (to - from) * floor((x - from) / (to - from)), from), to);
  if (x < from || x > to) return 0;
  int low = 0, high = axis->parts;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    *(x < axis->end[middle] ? &high : &low) = middle;
  }
  *part = low;
  *place = (x - axis->end[low]) / dvi__fine_axis_length(axis, low);
  return 1;
}
