/* Solving a step's stationarity conditions by Newton's method, and by KINSOL with line search if that fails: what methods share whose step is not one
 * element of the action (element_step.h has those). */
#ifndef DVI_METHOD_STATIONARY_H
#define DVI_METHOD_STATIONARY_H
#include "method/method.h"
#include "solve/nonlinear.h"

/* Fill in what every such method has alike: no fixed point iteration, and zeros on the Jacobian's diagonal. The equations' residual, jacobian and row_scale are the method's. */
dvi_status dvi__stationary_create(dvi__equations *equations, dvi_counters *counters, dvi__solver **solver);

/* From the guess in x. `size` is that of the quantities to which x is an increment. On failure a sentence with iterations and residual. */
dvi_status dvi__stationary_solve(dvi__solver *solver, dvi_counters *counters, double size, int unknowns, const double *guess,
                                 double *x);

#endif
