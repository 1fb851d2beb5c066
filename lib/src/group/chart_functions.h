/* Small matrices shared by the files chart*.c. */
#ifndef DVI_GROUP_CHART_FUNCTIONS_H
#define DVI_GROUP_CHART_FUNCTIONS_H
#include "group/chart.h"
#include "group/turn.h"

/* Compute B x, the tangent vector with the coordinates x. */
void dvi__chart_lift(const dvi__chart *chart, const double *x, double *out);

/* Find the rotation by which the rows of y0 become those of y(xi). A direction and an angle are one
 * row. A line has none. */
dvi__turn dvi__chart_turn(const dvi__chart *chart, const double *xi);

static inline double dvi__inner(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* H += factor (a b^T + b a^T). */
static inline void dvi__add_outer(int n, double factor, const double *a, const double *b, double *H)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) H[i * n + j] += factor * (a[i] * b[j] + b[i] * a[j]);
}

/* H += factor I. */
static inline void dvi__add_identity(int n, double factor, double *H)
{
  for (int i = 0; i < n; i++) H[i * n + i] += factor;
}

#endif
