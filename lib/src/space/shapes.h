/* A space of trial functions that are given by their values and derivatives at quadrature points,
 * and may depend on the length of the step. It is the counterpart of space/trial.h for functions
 * that are no polynomials,
 *
 *     q(tau) = q0 + sum_k psi_k(tau) Y_k,      psi_k(0) = 0,      psi_0(tau) = tau.
 *
 * Constants belong to the space, so q0 enters by a shift, and the end is q0 + sum_k psi_k(1) Y_k.
 * The multiplier that ties the end to the next step's start is p1, which the rows of
 * step/element/action.h have eliminated. A point need not lie on the path, for the quadrature
 * defines psi_k there. */
#ifndef DVI_SPACE_SHAPES_H
#define DVI_SPACE_SHAPES_H

typedef struct dvi__shapes {
  int functions, points;
  void *of; /* first argument of the functions below */
  /* Prepare for steps of length h. The other functions are called afterwards and refer to this
   * h. */
  void (*set)(void *of, double h);
  /* Return the place of point j in [0,1], its weight, and psi_k and psi_k' [functions] there. */
  void (*point)(const void *of, int j, double *tau, double *weight, double *psi, double *dpsi);
  /* Compute psi_k and psi_k' [functions] on the path, at tau of any size. dpsi may be NULL. */
  void (*path)(const void *of, double tau, double *psi, double *dpsi);
  /* Return 1 if function k is present. At this h it may depend on the others but for rounding. */
  int (*present)(const void *of, int k);
  /* Continue the last path beyond its end by coefficients of a step of the same length. last and Y
   * must differ. */
  void (*next)(const void *of, const double *last, double *Y);
} dvi__shapes;

#endif
