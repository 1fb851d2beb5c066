/* The Jacobian frozen at one point of the path, decoupled by the eigen-structure of the trial
 * space. There are n x n systems, one real or complex for each eigenvalue, instead of one of s n
 * unknowns (Butcher 1976; Hairer and Wanner 1996, sec. IV.8).
 *
 * With L_qq, L_qv, L_vv the same at all nodes the Jacobian of action.h is
 *
 *     K [ h U (x) L_qq + T (x) (L_vq - L_qv) + I (x) L_vv/h ],   K_kl = sum_j b_j psi_k' psi_l',
 *     U = K^{-1} sum_j b_j (psi_k - psi_k(1)) psi_l,   T = K^{-1} sum_j b_j psi_k' psi_l,
 *
 * for quadratures that integrate psi_k' psi_l exactly. Without a mixed part U alone is
 * diagonalised. With one T is diagonalised, and U = -T^2. Gauss quadrature with as many nodes as
 * degrees has that exactly and others nearly, which is enough for an iteration's matrix. */
#ifndef DVI_STEP_ELEMENT_DECOUPLED_H
#define DVI_STEP_ELEMENT_DECOUPLED_H
#include "step/element/action.h"

typedef struct dvi__decoupled dvi__decoupled;

/* Create the systems. Memory for factors is allocated when one is first needed. DVI_SINGULAR if the
 * space has no full set of eigenvectors. */
dvi_status dvi__decoupled_create(dvi__action *action, dvi_counters *counters,
                                 dvi__decoupled **decoupled);
void dvi__decoupled_destroy(dvi__decoupled **decoupled);

/* Analyse the systems, unless that is done. Gives the cost of all factors, in real numbers.
 * DVI_NO_MEMORY, DVI_BAD_SIZE, DVI_SOLVER_FAILED. */
dvi_status dvi__decoupled_analyse(dvi__decoupled *decoupled, dvi__linear_cost *cost);

/* Tell whether the systems are sparse where the Hessian is not (transformed.c). */
int dvi__decoupled_has_rank_two(const dvi__decoupled *decoupled);

/* Give the cost of all factors as a multiple of that of one real system of their pattern. */
double dvi__decoupled_weight(const dvi__decoupled *decoupled);

/* Give the point to freeze at, which is t, q [n] and v [n] in the middle of the path Y. */
int dvi__decoupled_point_size(const dvi__decoupled *decoupled);
void dvi__decoupled_point(const dvi__decoupled *decoupled, const double *Y, double *point);

/* Freeze the Jacobian of the action's h at a point, and factor. Does nothing if it is frozen there
 * already. */
dvi_status dvi__decoupled_freeze(dvi__decoupled *decoupled, const double *point);

/* Give the sign of the frozen determinant, and tell whether the real parts, which must be
 * symmetric, are positive (sign 1) or negative (-1) definite. Real parts alone can be singular. */
int dvi__decoupled_sign(const dvi__decoupled *decoupled);
int dvi__decoupled_is_definite(const dvi__decoupled *decoupled, int sign);

/* Overwrite R by the correction J^{-1} R. */
void dvi__decoupled_solve(dvi__decoupled *decoupled, double *R);

#endif
