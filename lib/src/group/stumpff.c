#include "group/stumpff.h"

/* The two highest by their series, which do not cancel; the others by c_k = 1/k! - s c_{k+2}. */
void dvi__stumpff(double s, double c[9])
{
  static const double inverse_factorial[] = {1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720};
  double seven = 1, eight = 1;
  for (int j = s < 1 ? 8 : 24; j >= 1; j--) {
    seven = 1 - s * seven / ((2 * j + 6) * (2 * j + 7));
    eight = 1 - s * eight / ((2 * j + 7) * (2 * j + 8));
  }
  c[7] = seven / 5040;
  c[8] = eight / 40320;
  for (int k = 6; k >= 0; k--) c[k] = inverse_factorial[k] - s * c[k + 2];
}
