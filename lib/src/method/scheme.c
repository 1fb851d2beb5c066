#include "method/scheme.h"

#include <stddef.h>

static const dvi__scheme schemes[] = {
    {4, 5, 2, 2.72, {0.41449077179437573714, 0.41449077179437573714, -0.65796308717750294857}},
    {6,
     9,
     5,
     2.532,
     {0.39216144400731413928, 0.33259913678935943860, -0.70624617255763935981,
      0.08221359629355080023, 0.79854399093482996340}},
    {8,
     17,
     9,
     3.096,
     {0.13020248308889008088, 0.56116298177510838456, -0.38947496264484728641,
      0.15884190655515560090, -0.39590389413323757734, 0.18453964097831570709,
      0.25837438768632204729, 0.29501172360931029887, -0.60550853383003451170}},
};

const char *dvi__scheme_name(int index)
{
  static const char *const name[] = {"4", "6", "8"};
  return index >= 0 && index < 3 ? name[index] : NULL;
}

const dvi__scheme *dvi__scheme_at(int index)
{
  return &schemes[index];
}

double dvi__scheme_part(const dvi__scheme *scheme, int i)
{
  return scheme->weight[i < scheme->substeps - 1 - i ? i : scheme->substeps - 1 - i];
}

void dvi__scheme_lengths(const dvi__scheme *scheme, double h, double *length)
{
  for (int i = 0, last = scheme->substeps - 1; 2 * i <= last; i++)
    length[i] = length[last - i] = h * scheme->weight[i];
}
