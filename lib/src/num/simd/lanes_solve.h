/* Fixed-point iteration as a whole, with the loops of num/simd/lanes.h. In small systems calls of
 * these one by one would take as long as their work. */
#ifndef DVI_NUM_SIMD_LANES_SOLVE_H
#define DVI_NUM_SIMD_LANES_SOLVE_H
#include "num/simd/lanes.h"
#include "num/simd/settling.h"

typedef struct dvi__lanes_solving {
  dvi__fixed_point *iteration;
  /* Put the forces at the places q [n*stages] into force, at the times t. 0 if this succeeds. */
  int (*evaluate)(int stages, const double *t, const double *q, double *force, void *of);
  void *of;
  const double *t; /* [stages] */
  const dvi__criteria *criteria;
  int most;       /* largest number of iterations */
  double size;    /* as in dvi__test_correction */
  double *before; /* [n*lanes] result, Z before the last iteration, or NULL */
} dvi__lanes_solving;

/* Iterate from the places Q until the test of num/simd/settling.h is met. Returns the number of
 * iterations, with the other sign if it is not met, or the forces fail. */
int dvi__lanes_solve(const dvi__lanes_solving *solving);

#endif
