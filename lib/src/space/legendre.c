/* The three-term recurrence (k+1) P_{k+1} = (2k+1) x P_k - k P_{k-1} is written for the distance y
 * from the end, x = 1 - 2y,
 *
 *     P_{k+1} - P_k = [ k (P_k - P_{k-1}) - 2 (2k+1) y P_k ] / (k+1).
 *
 * Near the end all P_k are close to 1 and their differences are of the size of y. This form keeps
 * the relative accuracy of the differences, and with it that of a node close to the end. */
#include "space/legendre.h"

void dvi__legendre(int degree, long double y, long double *value, long double *difference)
{
  value[0] = 1;
  difference[0] = 0;
  for (int k = 0; k < degree; k++) {
    const long double lower = (long double)k * difference[k],
                      slope = 2 * (long double)(2 * k + 1) * y * value[k];
    difference[k + 1] = (lower - slope) / (long double)(k + 1);
    value[k + 1] = value[k] + difference[k + 1];
  }
}
