/* Steps of Verlet's method where each coordinate moves alone, by its momentum divided by its mass,
 * and where potentials exert all forces. */
#ifndef DVI_METHOD_SPLIT_VERLET_ALONE_H
#define DVI_METHOD_SPLIT_VERLET_ALONE_H
#include "method/method.h"
#include "num/simd/lanes.h"

typedef struct dvi__verlet_alone {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi__division by; /* the division by the mass, with its scalar */
  double scalar;
} dvi__verlet_alone;

/* Take `count` steps from `now` to `next`, with the bits of as many single steps. `before` [n] is
 * the gradient at `now`, and `gradient` [n] becomes that at `next`. Returns 0 if a callback fails
 * or if a number is NaN or Inf. */
int dvi__verlet_alone_steps(const dvi__verlet_alone *own, const dvi__state *now,
                            const double *before, dvi__state *next, double *gradient,
                            const double *h, int count);

#endif
