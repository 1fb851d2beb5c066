/* The Jacobian frozen at one point of the path, taken apart by the eigen-structure of the trial
 * space: n x n systems, one real or complex for each eigenvalue, instead of one of s n unknowns
 * (Butcher 1976; Hairer and Wanner 1996, sec. IV.8).
 *
 * With L_qq, L_qv, L_vv the same at all nodes the Jacobian of action.h is
 *     K [ h U (x) L_qq + T (x) (L_vq - L_qv) + I (x) L_vv/h ],   K_kl = sum_j b_j psi_k' psi_l',
 *     U = K^{-1} sum_j b_j (psi_k - psi_k(1)) psi_l,   T = K^{-1} sum_j b_j psi_k' psi_l,
 * for quadratures that integrate psi_k' psi_l exactly. Without a mixed part U alone is
 * diagonalised; with one T is, and U = -T^2, which Gauss quadrature with as many nodes as degrees
 * has exactly and others nearly: enough for an iteration's matrix. */
#ifndef DVI_ACTION_DECOUPLED_H
#define DVI_ACTION_DECOUPLED_H
#include "step/element/action.h"

typedef struct dvi__decoupled dvi__decoupled;

/* Memory for factors is taken when one is first needed. DVI_SINGULAR: this space has no full set of
 * eigenvectors. */
dvi_status dvi__decoupled_create(dvi__action *action, dvi_counters *counters,
                                 dvi__decoupled **decoupled);
void dvi__decoupled_destroy(dvi__decoupled **decoupled);

/* Analyse the systems now, if they are not; what all factors cost, in real numbers. DVI_NO_MEMORY,
 * DVI_BAD_SIZE, DVI_SOLVER_FAILED. */
dvi_status dvi__decoupled_analyse(dvi__decoupled *decoupled, dvi__linear_cost *cost);

/* As many times as a real system of their pattern. */
double dvi__decoupled_weight(const dvi__decoupled *decoupled);

/* Where to freeze: t, q [n] and v [n] in the middle of the path Y. */
int dvi__decoupled_point_size(const dvi__decoupled *decoupled);
void dvi__decoupled_point(const dvi__decoupled *decoupled, const double *Y, double *point);

/* Freeze the Jacobian of the action's h at a point, and factor; nothing is done if it is frozen
 * there already. */
dvi_status dvi__decoupled_freeze(dvi__decoupled *decoupled, const double *point);

/* Of what is frozen, whose real parts alone can be singular: the sign of the determinant; and
 * whether the real parts, which must be symmetric, are positive (sign 1) or negative (-1)
 * definite. */
int dvi__decoupled_sign(const dvi__decoupled *decoupled);
int dvi__decoupled_is_definite(const dvi__decoupled *decoupled, int sign);

/* Overwrite R by the correction J^{-1} R. */
void dvi__decoupled_solve(dvi__decoupled *decoupled, double *R);

#endif
