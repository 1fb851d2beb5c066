/* The Taylor coefficients of a system's motion in the time s since t0, and of the derivative of the
 * motion by the start. The equations of motion give them order by order.
 *
 * The motion q(s) = sum_k q_k s^k with q_0 = q0, q_1 = v0 solves d/ds L_v = L_q. Coefficient k of
 * this equation is
 *     (k+1) [L_v]_{k+1} = [L_q]_k,     v_{k+1} = (k+2) q_{k+2},
 *     [L_v]_{k+1} = L_vv(t0,q0,v0) v_{k+1} + (the value for v_{k+1} = 0).
 * Each column dq(s) of the derivative begins with a column of the identity in (q0, v0), and solves
 * the linear equations
 *     d/ds (L_vq dq + L_vv dv) = L_qq dq + L_qv dv,
 * exactly, with the coefficients of the Hessians along the motion. Source: Leok and Shingel 2012
 * (the prolongation of the Euler-Lagrange equations); Griewank and Walther 2008, sec. 13.4 (the
 * recurrences). */
#ifndef DVI_STEP_ONESTEP_FLOW_SERIES_H
#define DVI_STEP_ONESTEP_FLOW_SERIES_H
#include "system/evaluate/jet.h"

typedef struct dvi__flow_series dvi__flow_series;

/* Create a series with coefficients up to q_degree, 1 to DVI_TAYLOR_MAX. The system has a constant
 * mass or a general Lagrangian with dvi__system_has_taylor, and must outlive the series. With
 * DVI__HESSIANS the derivative is available, too. counters may be NULL. Nothing allocates after
 * create. */
dvi_status dvi__flow_series_create(const dvi_system *system, int degree, dvi__derivatives most,
                                   dvi_counters *counters, dvi__flow_series **series);
void dvi__flow_series_destroy(dvi__flow_series **series);

/* Expand the motion through q [n] with velocity v [n] at t. DVI_SINGULAR if L_vv is singular.
 * DVI_NOT_FINITE. */
dvi_status dvi__flow_series_expand(dvi__flow_series *series, double t, const double *q,
                                   const double *v);

/* Compute the derivative of the motion that was expanded last. */
dvi_status dvi__flow_series_vary(dvi__flow_series *series);

/* Compute the coefficients of L along that motion, to one degree less than q. L is [degree]. If the
 * motion was varied, L_q0 and L_v0 [degree*n] are the derivatives of coefficient k in q0 and v0 at
 * [k*n]. Both may be NULL. */
dvi_status dvi__flow_series_lagrangian(dvi__flow_series *series, double *L, double *L_q0,
                                       double *L_v0);

/* q_k stands at [k*n], k from 0 to the degree, and v_k = (k+1) q_{k+1} to one degree less. */
const double *dvi__flow_series_q(const dvi__flow_series *series);
const double *dvi__flow_series_v(const dvi__flow_series *series);

/* dq_k/d(q0,v0), n x 2n column by column, stands at [k*2*n*n], and dv_k to one degree less. */
const double *dvi__flow_series_dq(const dvi__flow_series *series);
const double *dvi__flow_series_dv(const dvi__flow_series *series);

#endif
