/* M and K of a system whose potentials are quadratic, V = q.Kq/2 + b(t).q, on one pattern. */
#ifndef DVI_ACTION_QUADRATIC_H
#define DVI_ACTION_QUADRATIC_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__quadratic {
  dvi__pattern pattern;
  double *mass, *stiffness; /* in its order */
} dvi__quadratic;

/* K is asked for at t = 0 and q = 0, by an evaluator of the system with DVI__HESSIANS. What there
 * is of it on failure is for dvi__quadratic_clear, too. */
dvi_status dvi__quadratic_fill(const dvi_system *system, dvi__evaluator *evaluator,
                               dvi__quadratic *quadratic);
void dvi__quadratic_clear(dvi__quadratic *quadratic);

#endif
