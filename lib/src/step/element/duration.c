/* Physical time over an element of a time-transformed system, by the action's quadrature
 *
 *     t1 - t0 = h sum_j b_j g(Q_j),
 *
 * which is the derivative of the discrete action by E0. */
#include "step/element/action_struct.h"
#include "core/status.h"
#include "system/rescale/transformed.h"

dvi_status dvi__action_duration(dvi__action *a, const double *Y, double *duration)
{
  dvi__transformed *transformed = dvi__transformed_of(a->system);
  *duration = a->h;
  if (transformed == NULL) return DVI_OK;
  double *g = a->line, sum = 0;
  dvi__action_stages(a, Y);
  DVI_TRY(dvi__monitor_value(dvi__transformed_monitor(transformed), a->r, a->Q, g));
  for (int j = 0; j < a->r; j++) sum += a->weight[j] * g[j];
  *duration = a->h * sum;
  return DVI_OK;
}
