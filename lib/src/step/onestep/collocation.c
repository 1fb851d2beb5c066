#include "step/onestep/collocation.h"

#include <dvi/quadrature.h>

#include "core/status.h"

void dvi__lagrange_weights(int s, const double *c, double tau, double *weight)
{
  for (int j = 0; j < s; j++) {
    weight[j] = 1;
    for (int l = 0; l < s; l++)
      if (l != j) weight[j] *= (tau - c[l]) / (c[j] - c[l]);
  }
}

void dvi__collocate_by(int s, const double *c, const double *node, const double *gauss,
                       double a[DVI__STAGES_MOST][DVI__STAGES_MOST])
{
  double at_node[DVI__STAGES_MOST];
  for (int i = 0; i < s; i++) {
    for (int j = 0; j < s; j++) a[i][j] = 0;
    for (int k = 0; k < s; k++) {
      dvi__lagrange_weights(s, c, c[i] * node[k], at_node);
      for (int j = 0; j < s; j++) a[i][j] += c[i] * gauss[k] * at_node[j];
    }
  }
}

dvi_status dvi__collocate(int s, const double *c, double a[DVI__STAGES_MOST][DVI__STAGES_MOST])
{
  double node[DVI__STAGES_MOST], gauss[DVI__STAGES_MOST];
  DVI_TRY(dvi_quadrature(DVI_GAUSS, s, node, gauss));
  dvi__collocate_by(s, c, node, gauss, a);
  return DVI_OK;
}
