/* M and K of a system with quadratic potentials, V = q.Kq/2 + b(t).q, on one pattern. */
#ifndef DVI_STEP_SPLIT_QUADRATIC_H
#define DVI_STEP_SPLIT_QUADRATIC_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__quadratic {
  dvi__pattern pattern;
  double *mass, *stiffness; /* values in the order of the pattern */
} dvi__quadratic;

/* Evaluate K at t = 0 and q = 0, by an evaluator of the system with DVI__HESSIANS.
 * dvi__quadratic_clear is to be called on failure, too. */
dvi_status dvi__quadratic_fill(const dvi_system *system, dvi__evaluator *evaluator,
                               dvi__quadratic *quadratic);
void dvi__quadratic_clear(dvi__quadratic *quadratic);

#endif
