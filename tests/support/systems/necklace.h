/* Beads on a string of stiff springs, a fast quadratic potential, in a soft slow one: masses m_i
 * and the springs' constants k_i are uneven,
 *
 *     fast: sum_i k_i (q_(i+1) - q_i)^2/2,
 *     slow: sum_i (1 - cos q_i), or, of a free string, sum_i (q_(i+1) - q_i)^4/4.
 *
 * The ends are held, or free: then the momentum is conserved. */
#ifndef SUPPORT_NECKLACE_H
#define SUPPORT_NECKLACE_H
#include <dvi/dvi.h>

typedef enum necklace_kind {
  HELD,
  FREE,
  PUSHED,
  NECKLACES
  /* pushed: held, and each third bead pushed away by -5 q_i^2/2, which is fast, too */
} necklace_kind;

typedef struct necklace {
  int n;
  necklace_kind kind;
  double *mass, *spring; /* [n], [n+1]: the first and the last one hold the ends */
  double *q, *p;         /* [n] a start */
  int *first, *row;      /* the pattern */
  int slow_off;          /* not 0: the slow potential is 0 */
  dvi_system *system;
} necklace;

/* `made` must stay where it is. All omega are below 2 (2 k_i/m_i <= 4); uneven = 0: they are 2 sin
 * of even angles. */
void make_necklace(int n, necklace_kind kind, int uneven, necklace *made);
void destroy_necklace(necklace *made);

dvi_integrator *necklace_integrator(const necklace *of, const char *method);

#endif
