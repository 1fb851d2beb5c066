/* Beads on a string of stiff springs. The springs are the fast quadratic potential, and a soft
 * potential is the slow one. Masses m_i and spring constants k_i are uneven,
 *
 *     fast: sum_i k_i (q_(i+1) - q_i)^2/2,
 *     slow: sum_i (1 - cos q_i), or, of a free string, sum_i (q_(i+1) - q_i)^4/4.
 *
 * If the ends are free the momentum is conserved. */
#ifndef SUPPORT_NECKLACE_H
#define SUPPORT_NECKLACE_H
#include <dvi/dvi.h>

typedef enum necklace_kind {
  HELD,   /* both ends are held */
  FREE,   /* both ends are free */
  PUSHED, /* held, and a fast potential -5 q_i^2/2 pushes each third bead away */
  NECKLACES
} necklace_kind;

typedef struct necklace {
  int n;
  necklace_kind kind;
  double *mass, *spring; /* [n], [n+1], where the first and the last spring hold the ends */
  double *q, *p;         /* [n] a start */
  int *first, *row;      /* the pattern */
  int slow_off;          /* if not 0, the slow potential is 0 */
  dvi_system *system;
} necklace;

/* Makes a necklace, which must not move in memory. All omega are below 2 (2 k_i/m_i <= 4). With
 * uneven = 0 they are 2 sin of evenly spaced angles. */
void make_necklace(int n, necklace_kind kind, int uneven, necklace *made);
void destroy_necklace(necklace *made);

dvi_integrator *necklace_integrator(const necklace *string, const char *method);

#endif
