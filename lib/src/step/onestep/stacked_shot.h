/* The step of step/onestep/shot_step.h with all points of the shot as unknowns, as one sparse
 * system. Nothing is solved inside. Explicit and implicit one-step methods are treated alike, and
 * the couplings of the coordinates stay local.
 *
 * The unknowns are blocks of 2n. Each piece m has the increments W_j of its stages, z_{m+1} - z_0,
 * Gamma_j of its stages, and lambda_m without -p1. The last block is (p1, pi0).
 *     W_j = h f(Z_j),    z_{m+1} = z_m + sum_j b_j W_j,    kappa_k = h f_z(Z_k)^T Gamma_k,
 *     Gamma_j = b_j lambda_{m+1} + sum_k a_kj kappa_k,
 *     lambda_m = lambda_{m+1} + sum_k kappa_k + h b_m L_z(z_m),
 *     (lambda_0)_q = -p0,   (lambda_0)_p = 0
 * The Jacobian omits third derivatives of L, because those of f_z with the costates and of L_z
 * nearly cancel. */
#ifndef DVI_STEP_ONESTEP_STACKED_SHOT_H
#define DVI_STEP_ONESTEP_STACKED_SHOT_H
#include "step/onestep/shot.h"

typedef struct dvi__stacked_shot dvi__stacked_shot;

/* Create a step for tableaus and quadratures of values. */
dvi_status dvi__stacked_shot_create(const dvi_system *system, const dvi__runge_kutta *method,
                                    const dvi__course *course, dvi_counters *counters,
                                    dvi__stacked_shot **step);
void dvi__stacked_shot_destroy(dvi__stacked_shot **step);

const dvi__pattern *dvi__stacked_shot_pattern(const dvi__stacked_shot *step);

/* These functions are those of step/onestep/shot_step.h. */
dvi_status dvi__stacked_shot_place(dvi__stacked_shot *step, double t0, double h, double whole,
                                   const double *q0, const double *p0, double *v, double *x);
dvi_status dvi__stacked_shot_residual(void *step, const double *x, double *R);
dvi_status dvi__stacked_shot_jacobian(void *step, const double *x, double *values);
void dvi__stacked_shot_ends(const dvi__stacked_shot *step, double *dq, double *dp);
dvi_status dvi__stacked_shot_duration(dvi__stacked_shot *step, double *duration);

#endif
