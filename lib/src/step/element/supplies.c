/* What forces supply to the energy and to the momenta of symmetries over an element, by the
 * action's quadrature,
 *
 *     h sum_j b_j F_j.V_j     and     h sum_j b_j F_j.xi(Q_j).
 *
 * Source: Marsden and West 2001, sec. 3.1.4 (the discrete Noether theorem with forces). */
#include <string.h>

#include "core/status.h"
#include "step/element/action_struct.h"

dvi_status dvi__action_supplies(dvi__action *a, const double *Y, double *supply)
{
  const int count = 1 + a->system->symmetry_count;
  if (a->system->force_count == 0) {
    memset(supply, 0, (size_t)count * sizeof(double));
    return DVI_OK;
  }
  dvi__action_stages(a, Y);
  /* the gradients of the last residual are not needed any more */
  DVI_TRY(dvi__forces(a->evaluator, DVI__FORCES, a->r, a->t, a->Q, a->V, a->L_v));
  DVI_TRY(dvi__supply(a->evaluator, a->r, a->weight, a->L_v, a->Q, a->V, supply));
  for (int i = 0; i < count; i++) supply[i] *= a->h;
  return DVI_OK;
}
