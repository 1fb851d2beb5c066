/* Newton's attraction for bodies and chains. The potentials are -strength/|r| of vectors r that are
 * linear in the stored coordinates, as all points of rigid bodies (x + R rho) and of chains of
 * directions (sum l q_j) are. */
#ifndef PROBLEMS_PULLS_H
#define PROBLEMS_PULLS_H
#include "entry.h"

/* An arm, which adds factor (y[first], y[first + stride], y[first + 2 stride]) to r. It is a place
 * or a direction by stride 1, or column k of a rotation by stride 3. */
typedef struct arm {
  int first, stride;
  double factor;
} arm;

/* One vector r and the strength of its pull. */
typedef struct pull {
  double strength;
  int arms; /* number of arms */
  const arm *arm;
} pull;

typedef struct pulls {
  int nq, count;
  const pull *pull;
} pulls;

/* Return the potential of all pulls. Its Hessian is full. `all` must live as long as the
 * problem. */
dvi_potential pulls_potential(const char *name, const pulls *all);

#endif
