/* Fixed-point iteration on the positions at the nodes, for a constant mass without coupling
 * (scalar, diagonal). The rows of action.h are then linear but for the forces, and have the
 * solution
 *
 *     q(c_i) = q0 + h/m [ c_i p0 + sum_j (c_i - P_ij) g_j ],   g_j = h b_j L_q(q(c_j)),
 *     q1 = q0 + h/m [ (p0 + p1)/2 + sum_j (1/2 - c_j) g_j ],   p1 = p0 + sum_j g_j,
 *
 * with P_ij = psi(c_i)^T K^{-1} psi(c_j). One iteration is one product with an r x r matrix. The
 * step is symplectic because P is symmetric (Suris 1989; Hairer, Lubich and Wanner 2006, sec.
 * VI.4.2). It is symplectic to the last bit of c, P and h/m, however h b_j is rounded. With the
 * factors h^2/m and h in these places, each rounded on its own, energy drifts by 1e-18 of itself a
 * step.
 *
 * With a vector potential the rows have psi_k' A beside the forces, which depend on v. Offsets and
 * velocities at the nodes are iterated together, as h v(c_i) beside q(c_i) - q0. With
 * a_j = b_j A(q(c_j)),
 *
 *     q(c_i) = q0 + h/m [ c_i p0 + sum_j (c_i - P_ij) g_j - sum_j W_ij a_j ],
 *     h v(c_i) = h/m [ p0 + sum_j (1 - W_ji) g_j - sum_j U_ij a_j ],
 *     q1 = q0 + h/m [ (p0 + p1)/2 + sum_j (1/2 - c_j) g_j - sum_j a_j ],
 *
 * with W_ij = psi(c_i)^T K^{-1} psi'(c_j) and U_ij = psi'(c_i)^T K^{-1} psi'(c_j). To the loops
 * these are 2 r stages. The iteration contracts with h B/m, where that of forces alone does with
 * h^2 V_qq/m. */
#ifndef DVI_STEP_ELEMENT_FIXED_POINT_H
#define DVI_STEP_ELEMENT_FIXED_POINT_H
#include "num/simd/lanes_solve.h"
#include "step/element/action.h"

/* Prepare tables and memory if the system is of this kind. Does nothing for others. */
dvi_status dvi__action_prepare_fixed_point(dvi__action *action);

int dvi__action_has_fixed_point(const dvi__action *action);

/* Tell whether the iteration takes quadratic potentials implicitly (preconditioner.c). */
int dvi__action_has_preconditioner(const dvi__action *action);

/* Tell whether slow potentials lag behind fast ones in the iteration (system/evaluate/lagged.h). */
int dvi__action_lags(const dvi__action *action);

/* Keep the inverses of `count` lengths of steps, instead of one. DVI_NO_MEMORY. */
dvi_status dvi__action_keep_lengths(dvi__action *action, int count);

/* Put the nodes on the path Y. With a preconditioner they are put on the motion
 * by its potentials alone. */
void dvi__action_fixed_point_begin(dvi__action *action, const double *Y);

/* Give the forces of the last iteration or residual, g [n*r], with a vector potential g and a
 * [n*2r]. Those of a preconditioner's potentials are left out. Where slow potentials lag, the
 * iteration's factors follow, which a residual leaves as they are. The number of all is 0 for a
 * system of another kind, and nothing is done. */
int dvi__action_forces_count(const dvi__action *action);
void dvi__action_forces(const dvi__action *action, double *g);

/* Put the nodes where the continued forces of the last step make them, with ratio = h / h of that
 * step. The error is of the order of one more iteration than that of the continued path
 * (continuation.c). */
void dvi__action_fixed_point_continue(dvi__action *action, double ratio, const double *g);

/* Make one iteration. Gives the largest change of a node's offset from q0, and the largest
 * offset. */
dvi_status dvi__action_iterate(dvi__action *action, double *change, double *largest);

/* Steps of one length, one after the other. Each starts from the forces of the one before. */
typedef struct dvi__element_steps {
  dvi__action *action;
  /* the iteration; without `evaluate` it is not one by the forces of one potential alone, and is
   * made by dvi__action_iterate */
  dvi__lanes_solving solving;
  double largest; /* the largest offset of the last step */
  dvi__ends ends;
  const double *shift; /* the table by which the forces continue */
} dvi__element_steps;

/* Prepare steps of length h from q0 and p0, with dq, dq_low and dp as in dvi__action_ends. The
 * caller sets the criteria. */
void dvi__action_begin_steps(dvi__action *action, double h, const double *q0, const double *p0,
                             double *dq, double *dq_low, double *dp, dvi__element_steps *steps);

/* Solve one step from t, with the forces g of the last one, which was h / ratio long. g becomes
 * the new forces. Returns the number of iterations, with the other sign if they fail. */
int dvi__action_solve_step(dvi__element_steps *steps, double t, double ratio, double *g);

/* Tell whether the iteration is on the nodes' offsets, as above. Its forces then give the path. */
int dvi__action_has_offsets(const dvi__action *action);

/* Give the offsets after the last iteration, and their number. A row for each coordinate is padded
 * with zeros. */
const double *dvi__action_offsets(const dvi__action *action, int *count);

/* Give the residual of the offsets after the last iteration, of which Z is a copy. This is Z less
 * those that one more iteration makes of them. */
dvi_status dvi__action_iteration_residual(dvi__action *action, const double *Z, double *residual);

/* Give the path Y that the last iteration's forces make. dvi__action_ends then gives the ends by
 * these forces. */
void dvi__action_fixed_point_path(const dvi__action *action, double *Y);

/* Give the path of a step of length h from p0 by its forces g, as dvi__action_forces gave them to a
 * system without a preconditioner. */
void dvi__action_path_of_forces(const dvi__action *action, double h, const double *p0,
                                const double *g, double *Y);

/* Tell whether the forces are those of an iteration, and not of a residual. */
int dvi__action_is_iterated(const dvi__action *action);

/* Give the increments of dvi__action_ends by these forces. */
void dvi__action_fixed_point_ends(const dvi__action *action, double *dq, double *dq_low,
                                  double *dp);

#endif
