/* One step by prolongation and collocation at its ends.
 *
 * Q(t) is the polynomial of degree 2m-1 with Q(t0) = q0 and Q(t1) = q1. Its derivatives up to the
 * m-th at both ends are those that the equations of motion and their prolongation, d^k/dt^k of
 * them, give to Q and Q' there. Beside q0 and q1 the velocities v0, v1 at the ends determine Q. Let
 * A_j = h^j q_j(q0,v0) be the Taylor coefficients of the motion through the start, and B_j = h^j
 * q_j(q1,v1) those of the motion through the end. Hermite's formula for the m-th coefficients
 * leaves
 *
 *     R_0 = sum_{j<m} (a_j A_j + b_j B_j) - A_m = 0,
 *     R_1 = sum_{j<m} (-1)^j (a_j B_j + b_j A_j) - (-1)^m B_m = 0.
 *
 * The discrete Lagrangian is the integral of L along Q by Euler's and Maclaurin's formula with
 * [m/2] terms beside the trapezoid. The formula needs Q'' .. Q^(m) at the ends alone, and therefore
 * the motion's Taylor coefficients there.
 *
 *     Ld(q0,q1) = G_0(q0,v0) + G_1(q1,v1),
 *     G_0 = h sum_j w_j h^j L_j(q0,v0),   G_1 = h sum_j (-1)^j w_j h^j L_j(q1,v1)
 *
 * With multipliers for R = 0, that is dR/d(v0,v1)^T lambda = d(G_0+G_1)/d(v0,v1), its derivatives
 * are exactly
 *     p0 = -D1 Ld = -(dG_0/dq0 - dR/dq0^T lambda),     p1 = D2 Ld = dG_1/dq1 - dR/dq1^T lambda.
 * Source: Leok and Shingel 2012. The elimination by multipliers, the unknowns and the increments
 * are ours.
 *
 * The unknowns of coordinate i are q1 - q0, h v0 and h v1, at x[3 i], x[3 i + 1] and x[3 i + 2].
 * The rows are R_0, R_1 and h (p0 + D1 Ld). */
#ifndef DVI_STEP_ONESTEP_PROLONGATION_H
#define DVI_STEP_ONESTEP_PROLONGATION_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__prolongation dvi__prolongation;

enum { DVI__PROLONGATION_MOST = 10 };

/* m is 1 to DVI__PROLONGATION_MOST. The system must have dvi__system_has_taylor. */
dvi_status dvi__prolongation_create(const dvi_system *system, int m, dvi_counters *counters,
                                    dvi__prolongation **prolongation);
void dvi__prolongation_destroy(dvi__prolongation **prolongation);

const dvi__pattern *dvi__prolongation_pattern(const dvi__prolongation *prolongation);
dvi__evaluator *dvi__prolongation_evaluator(const dvi__prolongation *prolongation);

/* Put the step at (t0, q0, p0). The caller keeps the arrays unchanged. */
void dvi__prolongation_place(dvi__prolongation *prolongation, double t0, double h, const double *q0,
                             const double *p0);

dvi_status dvi__prolongation_residual(dvi__prolongation *prolongation, const double *x, double *R);

/* Compute the Jacobian. It is exact except for the row of the momentum, where L_v(t0,q0,v0) = p0 is
 * used. The difference is of the order of the step's error. */
dvi_status dvi__prolongation_jacobian(dvi__prolongation *prolongation, const double *x,
                                      double *values);

/* Write the size of the rows per unit of an unknown. */
dvi_status dvi__prolongation_scale(dvi__prolongation *prolongation, double *scale);

/* Write the end of a solution. The results are the increments dq and dp [n], and the coefficients
 * A_1 .. A_{m-1}, B_0 - q0, B_1 .. B_{m-1} of the path, [(2m-1)*n]. */
dvi_status dvi__prolongation_end(dvi__prolongation *prolongation, const double *x, double *dq,
                                 double *dp, double *path);

/* Evaluate q - q0, and the velocity of a step of length h, at tau of that path, [n] each. Either
 * may be NULL. */
void dvi__prolongation_path(const dvi__prolongation *prolongation, const double *path, double h,
                            double tau, double *offset, double *v);

/* Write x for a straight line along v [n]. dvi__prolongation_continue starts from the velocity at
 * the last step's end and follows the motion's Taylor polynomial of degree m. */
void dvi__prolongation_straight(const dvi__prolongation *prolongation, const double *v, double *x);
void dvi__prolongation_continue(dvi__prolongation *prolongation, double ratio, const double *last,
                                double *x);

#endif
