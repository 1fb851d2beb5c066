/* A space of trial functions that are given by their values and derivatives at quadrature points,
 * and may depend on the length of the step. What space/trial.h is for polynomials:
 *
 *     q(tau) = q0 + sum_k psi_k(tau) Y_k,      psi_k(0) = 0,      psi_0(tau) = tau.
 *
 * Constants belong to the space: so q0 enters by a shift, the end is q0 + sum_k psi_k(1) Y_k, and
 * the multiplier that ties it to the next step's start is p1, which the rows of
 * step/element/action.h have eliminated. A point need not lie on the path: psi_k there is what the
 * quadrature makes of it. */
#ifndef DVI_SPACE_SHAPES_H
#define DVI_SPACE_SHAPES_H

typedef struct dvi__shapes {
  int functions, points;
  void *of; /* first argument of what follows */
  /* Prepare for steps of length h. Nothing else below is asked before, and all of it is about that
   * h. */
  void (*set)(void *of, double h);
  /* Where point j is in [0,1], its weight, and psi_k and psi_k' [functions] there. */
  void (*point)(const void *of, int j, double *tau, double *weight, double *psi, double *dpsi);
  /* psi_k and psi_k' [functions] on the path, tau of any size; dpsi may be NULL. */
  void (*path)(const void *of, double tau, double *psi, double *dpsi);
  /* Whether function k is there: at this h it may depend on the others but for rounding. */
  int (*present)(const void *of, int k);
  /* Coefficients of the last path, for a step of the same length, continued beyond its end. Neither
   * may be the other. */
  void (*next)(const void *of, const double *last, double *Y);
} dvi__shapes;

#endif
