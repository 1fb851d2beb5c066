/* What forces supply to the energy and to the momenta of symmetries over an element, by the
 * action's quadrature,
 *
 *     h sum_j b_j F_j.V_j     and     h sum_j b_j F_j.xi(Q_j).
 *
 * Damping takes h sum_j b_j gamma L_v_j.V_j from the energy. From the momenta it takes its part at
 * both ends (method/damping.h), and the weights of a damped action remain in the second sum.
 *
 * A Lagrangian that depends on time supplies -h sum_j b_j L_t_j to the energy.
 *
 * Source: Marsden and West 2001, sec. 3.1.4 (the discrete Noether theorem with forces). */
#include <string.h>

#include "core/status.h"
#include "step/element/action_struct.h"

/* Replace the power of the forces, by damped weights, by that of forces and damping, by the rule's
 * weights b_j. */
static dvi_status count_damping(dvi__action *a, double *power)
{
  const int has_forces = a->system->force_count > 0;
  DVI_TRY(dvi__lagrangian_gradient(a->evaluator, a->r, a->t, a->Q, a->V, NULL, a->L_q));
  *power = 0;
  for (int i = 0; i < a->n; i++)
    for (int j = 0; j < a->r; j++) {
      const int at = i * a->r + j;
      const double F = (has_forces ? a->L_v[at] : 0) - a->system->damping * a->L_q[at];
      *power += a->undamped[j] * F * a->V[at];
    }
  return DVI_OK;
}

dvi_status dvi__action_supplies(dvi__action *a, const double *Y, double *supply)
{
  const dvi_system *s = a->system;
  const int count = 1 + s->symmetry_count;
  memset(supply, 0, (size_t)count * sizeof(double));
  if (s->force_count == 0 && s->damping == 0) return DVI_OK;
  dvi__action_stages(a, Y);
  /* the gradients of the last residual are not needed any more */
  if (s->force_count > 0) {
    DVI_TRY(dvi__forces(a->evaluator, DVI__FORCES, a->r, a->t, a->Q, a->V, a->L_v));
    DVI_TRY(dvi__supply(a->evaluator, a->r, a->weight, a->L_v, a->Q, a->V, supply));
  }
  if (s->damping > 0) DVI_TRY(count_damping(a, &supply[0]));
  for (int i = 0; i < count; i++) supply[i] *= a->h;
  return DVI_OK;
}

dvi_status dvi__action_driving(dvi__action *a, const double *Y, double *work)
{
  double *rate = a->L_q; /* as above */
  dvi__action_stages(a, Y);
  DVI_TRY(dvi__lagrangian_rate(a->evaluator, a->r, a->t, a->Q, a->V, rate));
  *work = 0;
  for (int j = 0; j < a->r; j++) *work -= a->h * a->weight[j] * rate[j];
  return DVI_OK;
}
