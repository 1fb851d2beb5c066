/* The equations of motion on a configuration space with factors, as those of a group that acts on
 * the space. Each slot moves by its own group. */
#ifndef DVI_STEP_LIE_FLOW_H
#define DVI_STEP_LIE_FLOW_H
#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

/* The flow has a velocity omega and a momentum m, both [nv], and moves a point y0 by theta.
 *
 *     line, circle   omega = v, m = p;                     y0 + theta, y0 rotated by theta
 *     direction      omega = y x v, m = y x p, in space;   exp(theta^) y0
 *     body           omega = Omega, m = Pi, in the body's frame;   R0 exp(theta^) */
typedef struct dvi__flow dvi__flow;

/* Create the flow of a system with factors. The system and the counters must outlive the flow. */
dvi_status dvi__flow_create(const dvi_system *system, dvi_counters *counters, dvi__flow **flow);
void dvi__flow_destroy(dvi__flow **flow);

/* Replace p by m at q. dvi__flow_leave goes back. Both transform the compensations, too. */
void dvi__flow_enter(const dvi__flow *flow, const dvi__phase *state);
void dvi__flow_leave(const dvi__flow *flow, const dvi__phase *state);

/* Compute omega and the rate of m at (t,q,p), by one gradient. */
dvi_status dvi__flow_rates(dvi__flow *flow, double t, const double *q, const double *p,
                           double *omega, double *m_rate);

/* Compute the rates of q [nq] and p [nv] as plain numbers. At every y and p, on the manifold or off
 * it, the rates conserve the lengths of the vectors in y and the products y.p of directions. The
 * reason is that y and p rotate alike, and that the added rate of p is orthogonal to y. */
void dvi__flow_plain(const dvi__flow *flow, const double *q, const double *p, const double *omega,
                     const double *m_rate, double *q_rate, double *p_rate);

/* Compute q and p of a stage. The start, with m in the place of p, moves by theta, and m by
 * h m_rate. Stages are right to a few roundings. */
void dvi__flow_place(const dvi__flow *flow, const double *theta, double h, const double *m_rate,
                     const dvi__phase *start, double *q, double *p);

/* Move q, with its compensation, by theta. dvi__flow_theta_rate computes theta' of omega by the
 * inverse of dexp. theta_rate may be omega. */
void dvi__flow_move(const dvi__flow *flow, const double *theta, const dvi__phase *state);
void dvi__flow_theta_rate(const dvi__flow *flow, const double *theta, const double *omega,
                          double *theta_rate);

#endif
