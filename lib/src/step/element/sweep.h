/* Fixed point iteration on the positions at the nodes: for a constant mass without coupling
 * (scalar, diagonal) the rows of action.h are linear but for the forces, and solve themselves:
 *
 *     q(c_i) = q0 + h/m [ c_i p0 + sum_j (c_i - P_ij) g_j ],   g_j = h b_j L_q(q(c_j)),
 *     q1 = q0 + h/m [ (p0 + p1)/2 + sum_j (1/2 - c_j) g_j ],   p1 = p0 + sum_j g_j,
 *
 * with P_ij = psi(c_i)^T K^{-1} psi(c_j). One iteration is one product with an r x r matrix. The
 * step is symplectic because P is symmetric (Suris 1989; Hairer, Lubich and Wanner 2006, sec.
 * VI.4.2), and it is so to the last bit of c, P and h/m, whatever h b_j is rounded to: with the
 * factors h^2/m and h in these places, rounded each for itself, energy drifts by 1e-18 of itself a
 * step. */
#ifndef DVI_ACTION_SWEEP_H
#define DVI_ACTION_SWEEP_H
#include "step/element/action.h"

/* Tables and memory, if the system is of this kind; else nothing. */
dvi_status dvi__action_prepare_sweep(dvi__action *action);

int dvi__action_can_sweep(const dvi__action *action);

/* Put the nodes on the path Y. */
void dvi__action_sweep_from(dvi__action *action, const double *Y);

/* The forces of the last iteration or residual, g [n*r]; for a system of another kind their number
 * is 0, and nothing is done. */
int dvi__action_forces_count(const dvi__action *action);
void dvi__action_forces(const dvi__action *action, double *g);

/* Put the nodes where those forces of the last step, continued, make them; ratio = h / h of that
 * step. Of the order of one more iteration than the continued path (continuation.c). */
void dvi__action_sweep_continue(dvi__action *action, double ratio, const double *g);

/* One iteration: the largest change of a node's offset from q0, and the largest offset. */
dvi_status dvi__action_sweep(dvi__action *action, double *change, double *largest);

/* The path Y that the last iteration's forces make. dvi__action_ends then gives the ends by these
 * forces. */
void dvi__action_sweep_to(dvi__action *action, double *Y);

/* dvi__action_ends by these forces. */
void dvi__action_sweep_ends(const dvi__action *action, double *dq, double *dq_low, double *dp);

#endif
