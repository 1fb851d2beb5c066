/* The equations of motion on a configuration space with factors, as those of a group that acts on
 * it: each slot is moved by its own turns. */
#ifndef DVI_ACTION_FLOW_H
#define DVI_ACTION_FLOW_H
#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

/* With a velocity omega and a momentum m, both [nv], and what moves a point y0 by theta:
 *
 *     line, circle   omega = v, m = p;                     y0 + theta, y0 turned by theta
 *     direction      omega = y x v, m = y x p, in space;   exp(theta^) y0
 *     body           omega = Omega, m = Pi, in the body's frame;   R0 exp(theta^) */
typedef struct dvi__flow dvi__flow;

/* Of a system with factors, which must outlive it, as must the counters. */
dvi_status dvi__flow_create(const dvi_system *system, dvi_counters *counters, dvi__flow **flow);
void dvi__flow_destroy(dvi__flow **flow);

/* What stands in p becomes m, at q; and back. All with carries. */
void dvi__flow_enter(const dvi__flow *flow, const dvi__phase *state);
void dvi__flow_leave(const dvi__flow *flow, const dvi__phase *state);

/* omega and the rate of m at (t,q,p). One gradient. */
dvi_status dvi__flow_rates(dvi__flow *flow, double t, const double *q, const double *p,
                           double *omega, double *m_rate);

/* The rates of q [nq] and p [nv] as plain numbers. At every y and p, on the manifold or off it,
 * they leave the lengths of the vectors in y as they are, and a direction's y.p: y and p are turned
 * alike, and what is added to p is orthogonal to y. */
void dvi__flow_plain(const dvi__flow *flow, const double *q, const double *p, const double *omega,
                     const double *m_rate, double *q_rate, double *p_rate);

/* q moved by theta, with its carry; theta' of omega, by the inverse of dexp, which may overwrite
 * it. */
void dvi__flow_move(const dvi__flow *flow, const double *theta, const dvi__phase *state);
void dvi__flow_theta_rate(const dvi__flow *flow, const double *theta, const double *omega,
                          double *theta_rate);

#endif
