/* The piece in an n-simplex T of the dual cell of its face s is the sum over flags
 * s = s_k < s_{k+1} < .. < s_n = T (circumcentric.c),
 *
 *     |*s and T| = sum over flags of  prod_j  lambda_j sqrt|a_j^2| / (n-k)!.
 *
 * A step of a flag goes from a face to its facet, where a_j is the altitude of the corner that the
 * facet leaves out, and lambda_j the barycentric coordinate there of the face's circumcentre. */
#include "field/forms/duals.h"

#include <math.h>

const double dvi__inverse_factorial[] = {1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24};

/* Step from a face to its facets. Returns 0 if the face has no volume. */
static int step_down(const dvi__placed *placed, int set, int k, const int *corner, dvi__duals *d)
{
  dvi__simplex s;
  dvi__simplex_of(placed, k, corner, &s);
  d->volume[set] = s.kappa * s.volume;
  for (int j = 0; j <= k && s.kappa != 0; j++)
    d->piece[set & ~(1 << corner[j])] += d->piece[set] * s.centre[j] / sqrt(fabs(s.square[j]));
  return s.kappa != 0;
}

/* Larger sets of corners have larger numbers than their subsets, so that all flags to a face are
 * summed before it is left. */
int dvi__duals_of(const dvi__placed *placed, int n, int least, dvi__duals *duals)
{
  const int whole = (1 << (n + 1)) - 1;
  for (int set = 1; set <= whole; set++) duals->piece[set] = set == whole;
  for (int set = whole; set > 0; set--) {
    int corner[DVI__SIMPLEX_CORNERS];
    const int k = dvi__corners_of_set(set, corner) - 1;
    if (k < least) continue;
    duals->volume[set] = 1;
    if (k > 0 && !step_down(placed, set, k, corner, duals)) return set;
    duals->piece[set] *= dvi__inverse_factorial[n - k];
  }
  return 0;
}
