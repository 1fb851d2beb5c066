#include "group/turn.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "group/stumpff.h"
#include "group/turn_core.h"

/* The correction tan(x)/x - 1 = x^2 (c_2 - c_3)/c_0 at x = |f|/2 is small. So is its rounding,
 * which is the same in all steps of a steady turn. At half a turn cos(x) may be rounded to 0. An
 * angle whose square overflows has no digits and gives no turn. */
void dvi__turn_tangent(const double f[3], double w[3])
{
  double c[4];
  const double square = 0.25 * dvi__dot(f, f);
  dvi__stumpff_four(square, c);
  const double more = isinf(square)
                          ? -1
                          : square * (c[2] - c[3]) / (c[0] != 0 ? c[0] : 0.5 * DBL_EPSILON);
  for (int i = 0; i < 3; i++) w[i] = 0.5 * f[i] + more * (0.5 * f[i]);
}

dvi__turn dvi__turn_back(const dvi__turn *turn)
{
  return (dvi__turn){{-turn->w[0], -turn->w[1], -turn->w[2]}, turn->s, turn->s_low};
}

void dvi__turn_change(const dvi__turn *turn, const double x[3], double change[3])
{
  dvi__turn_changed(turn, x, change);
}

FUSED static dvi__turn turn_of(const double w[3])
{
  return dvi__turn_made(w);
}

FUSED static void turn_rows(const dvi__turn *turn, int count, double *x, double *compensation)
{
  const dvi__turn by = *turn; /* because the compiler cannot know that no store changes the turn */
  int at = 0;
  for (; at + 3 <= count; at += 3) dvi__turn_row(&by, x + at, compensation + at);
  if (at == count) return;
  double head[3] = {0}, low[3] = {0};
  const size_t bytes = (size_t)(count - at) * sizeof(double);
  memcpy(head, x + at, bytes);
  memcpy(low, compensation + at, bytes);
  dvi__turn_row(&by, head, low);
  memcpy(x + at, head, bytes);
  memcpy(compensation + at, low, bytes);
}

FUSED static void angular_of_direction(const double *y, const double *y_compensation,
                                       const double *p, const double *p_compensation,
                                       dvi__twofold mu[3])
{
  dvi__turn_angular_of(y, y_compensation, p, p_compensation, mu);
}

FUSED static void momentum_of(const dvi__twofold mu[3], double most, double *y,
                              double *y_compensation, double *p, double *p_compensation)
{
  dvi__turn_momentum_of(mu, most, y, y_compensation, p, p_compensation);
}

/* clang does not export a function that is compiled more than once. */
dvi__turn dvi__turn_of(const double w[3])
{
  return turn_of(w);
}

void dvi__turn_rows(const dvi__turn *turn, int count, double *x, double *compensation)
{
  turn_rows(turn, count, x, compensation);
}

void dvi__turn_angular(const double *y, const double *y_compensation, const double *p,
                       const double *p_compensation, dvi__twofold mu[3])
{
  angular_of_direction(y, y_compensation, p, p_compensation, mu);
}

void dvi__turn_momentum(const dvi__twofold mu[3], double most, double *y, double *y_compensation,
                        double *p, double *p_compensation)
{
  momentum_of(mu, most, y, y_compensation, p, p_compensation);
}
