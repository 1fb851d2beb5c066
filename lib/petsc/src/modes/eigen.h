/* Eigenpairs of symmetric pencils of all processes, K x = lambda M x with a diagonal M, by SLEPc
 * (Hernandez, Roman and Vidal 2005).
 *
 * With y = M^(1/2) x this is a standard problem. Krylov and Schur's method finds the largest
 * eigenvalues 1/(lambda - shift) of M^(1/2) (K - shift M)^-1 M^(1/2). */
#ifndef DVI_PETSC_EIGEN_H
#define DVI_PETSC_EIGEN_H
#include "gradients.h"
#include "pairs.h"

typedef struct dvi__pencil_of_all {
  MPI_Comm comm;
  Mat K;
  Vec mass, root; /* the diagonal of M, and its roots */
  double shift;
  dvi__inverse *inverse;     /* of K - shift M */
  dvi__gradients *gradients; /* which are taken away. NULL if there are none */
  Vec start;                 /* of the iteration, at random */
  Vec room[2];               /* of unknowns */
} dvi__pencil_of_all;

/* Add `count` pairs, the nearest to the shift among those that are orthogonal to the vectors in
 * `pairs`, which has room for them. All processes call it, and have the same pairs.
 *
 * DVI_UNSUPPORTED without SLEPc, DVI_SINGULAR if the shift is an eigenvalue, DVI_NOT_CONVERGED,
 * DVI_SOLVER_FAILED. */
dvi_status dvi__find_pairs(const dvi__pencil_of_all *pencil, PetscInt count, dvi__pairs *pairs);

/* Estimate how far from the shift the next pair is, to a hundredth. It returns likewise. */
dvi_status dvi__estimate_next(const dvi__pencil_of_all *pencil, const dvi__pairs *pairs,
                              double *distance);

#endif
