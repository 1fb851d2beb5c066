/* Newton's attraction for bodies and chains: potentials -strength/|r| of vectors r that are linear
 * in the stored coordinates, as all points of rigid bodies (x + R rho) and of chains of directions
 * (sum l q_j) are. */
#ifndef PROBLEMS_PULLS_H
#define PROBLEMS_PULLS_H
#include "entry.h"

/* Adds factor (y[first], y[first + stride], y[first + 2 stride]) to r: a place or a direction by
 * stride 1, column k of a rotation by stride 3. */
typedef struct arm {
  int first, stride;
  double factor;
} arm;

/* One vector r and how strongly it pulls. */
typedef struct pull {
  double strength;
  int arms; /* how many */
  const arm *arm;
} pull;

typedef struct pulls {
  int nq, count;
  const pull *pull;
} pulls;

/* The potential of all pulls; its Hessian is full. `all` lives as long as the problem. */
dvi_potential pulls_potential(const char *name, const pulls *all);

#endif
