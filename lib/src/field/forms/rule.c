#include "field/forms/rule.h"

#include <dvi/quadrature.h>

#include "core/status.h"

dvi_status dvi__rule_make(dvi__rule *rule)
{
  return dvi_quadrature(DVI_GAUSS, DVI__RULE_POINTS, rule->node, rule->weight);
}

int dvi__rule_count(int k)
{
  int count = 1;
  for (int i = 0; i < k; i++) count *= DVI__RULE_POINTS;
  return count;
}

double dvi__rule_point(const dvi__rule *rule, dvi_cell_kind kind, int k, int point, double *s)
{
  double weight = 1, left = 1;
  for (int i = 0; i < k; i++, point /= DVI__RULE_POINTS) {
    const double t = rule->node[point % DVI__RULE_POINTS];
    weight *= rule->weight[point % DVI__RULE_POINTS];
    s[i] = left * t;
    if (kind != DVI_SIMPLICES) continue;
    for (int j = i + 1; j < k; j++) weight *= 1 - t;
    left *= 1 - t;
  }
  return weight;
}
