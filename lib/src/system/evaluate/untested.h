/* Gradients for an iteration, whose change shows numbers that are not finite. */
#ifndef DVI_SYSTEM_EVALUATE_UNTESTED_H
#define DVI_SYSTEM_EVALUATE_UNTESTED_H
#include "system/evaluate/evaluator.h"

/* Compute V_q as dvi__potentials_gradient, with its bits, but do not always look for NaN and Inf
 * among its numbers. */
dvi_status dvi__potentials_gradient_untested(dvi__evaluator *e, int count, const double *t,
                                             const double *q, double *V_q);

typedef int dvi__gradient_callback(int count, const double *t, const double *q, double *V_q,
                                   void *user);

/* Give the callback for batches of the one potential that makes all of V_q, and its user pointer.
 * NULL if there is none such. Who calls it counts the gradients. */
dvi__gradient_callback *dvi__lone_gradient(const dvi__evaluator *e, void **user);

/* Compute the sum of the gradients of all potentials that are declared fast (1), or of all others
 * (0), of which there are some, without such a look. Fast ones count as gradients. */
dvi_status dvi__some_gradients_untested(dvi__evaluator *e, int fast, int count, const double *t,
                                        const double *q, double *V_q);

#endif
