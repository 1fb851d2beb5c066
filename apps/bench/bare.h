/** A bare loop of Gauss' methods. It shows what the library's checks cost. */
#ifndef BARE_H
#define BARE_H
#include <stdbool.h>

#include "problem.h"

/** A loop of steps of the same length with s Gauss stages. Its steps are those of galerkin of
 * degree s by fixed-point iteration, with the same guess from the last step's forces, the same test
 * of convergence, and the same callbacks.
 *
 * It leaves out everything else. Nothing is tested for finite numbers, an iteration that does not
 * converge is taken as it is after 60 iterations, no callback's failure is seen, no step is tried
 * again or looked at afterwards, and q, p and t are plain sums without compensation. Quadratic
 * potentials are iterated like all others. */
typedef struct bare bare;

/** Return the degree of galerkin:degree=s, if a bare loop has the same steps, or 0. */
int bare_degree(const char *method);

/** Tell whether there is a bare loop for the problem. It is for a constant mass, scalar or
 * diagonal, and potentials with gradients, and nothing else. */
bool bare_takes(const problem *scene);

/** Make a loop. Returns NULL without memory. Destroyed by bare_destroy. */
bare *bare_create(const problem *scene, int degree, double h);

/** Make so many steps from the start. Gives the end, q and p [n], and returns the number of points
 * at which the gradient was evaluated. */
long bare_run(bare *loop, long steps, double *q, double *p);

/** NULL is allowed. */
void bare_destroy(bare *loop);
#endif
