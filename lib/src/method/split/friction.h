/* The first kick of Verlet's method with forces that depend on the velocity.
 *
 * With F(t,q,v) in both kicks at the velocity v = (q1 - q0)/h of the straight line, the method is
 *
 *     M v = p0 + h/2 ( F(t0,q0,v) - dV(q0) ),   q1 = q0 + h v,
 *     p1 = M v + h/2 ( F(t1,q1,v) - dV(q1) ).
 *
 * The first equation is solved for v by Newton's method, the rest is explicit. The order is 2, and
 * the method is symmetric. Source: Marsden and West 2001, sec. 3.2.5. */
#ifndef DVI_METHOD_SPLIT_FRICTION_H
#define DVI_METHOD_SPLIT_FRICTION_H
#include "method/method.h"

typedef struct dvi__friction dvi__friction;

/* Create the solver of the first kick. */
dvi_status dvi__friction_create(const dvi_system *system, dvi_counters *counters,
                                dvi__friction **friction);
void dvi__friction_destroy(dvi__friction **friction);

/* Find v and the forces F(t,q,v) for a step of length h. V_q [n] is dV(q). */
dvi_status dvi__friction_solve(dvi__friction *friction, const dvi__state *state, double h,
                               const double *V_q);

/* Evaluate the forces F(t,q,v) at the end of the step, with the same v. */
dvi_status dvi__friction_end(dvi__friction *friction, const dvi__state *state);

/* Give v [n] and the forces [n] that were found or evaluated last. */
const double *dvi__friction_velocity(const dvi__friction *friction);
const double *dvi__friction_force(const dvi__friction *friction);

#endif
