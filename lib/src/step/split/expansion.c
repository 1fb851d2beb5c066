#include "step/split/expansion.h"

#include <limits.h>
#include <math.h>

#include "step/split/modes.h"
#include "num/compensated.h"

static const double pi = 3.14159265358979323846;

/* Return log cosh x, x >= 0. */
static double log_cosh(double x)
{
  return x - log(2) + log1p(exp(-2 * x));
}

/* Return log M of f on the ellipse of rho, or HUGE_VAL where there is no bound.
 *
 * The ends of the interval move by `swell` = (high - low)/4 (rho - 2 + 1/rho) to those of the
 * ellipse. Points of the ellipse have |s - low| - Re(s - low) <= 2 swell, as has the parabola with
 * the focus `low` that touches the ellipse on the left. Hence (Im x)^2 = (|s| - Re
 * s)/2 <= swell - low. The factors of c_1(s), the product of 1 - s/(pi j)^2, are smallest at the
 * right end. */
static double log_most(const dvi__growth *growth, double low, double high, double swell)
{
  double c[4], most = log(growth->mass) + log_cosh(growth->type * sqrt(swell - low));
  if (growth->poles == 0) return most;
  if (high + swell >= pi * pi) return HUGE_VAL;
  dvi__modes_functions(high + swell, c);
  return c[1] > 0 ? most - growth->poles * log(c[1]) : HUGE_VAL;
}

/* Return the log of the truncation error behind degree 0. The error behind degree m is smaller by m
 * log rho. (1 - f)/s is largest at the rim, where |s| >= swell. */
static double log_truncated(const dvi__growth *growth, int divided, double low, double high,
                            double rho)
{
  const double swell = (high - low) / 4 * (rho - 1) * (rho - 1) / rho;
  const double most = log_most(growth, low, high, swell);
  return log(4 / (rho - 1)) +
         (divided ? fmax(most, 0) + log1p(exp(-fabs(most))) - log(swell) : most);
}

int dvi__expansion_degree(const dvi__growth *growth, int divided, double low, double high,
                          double tolerance, double *bound)
{
  const double wanted = log_most(growth, low, high, 0) + log(tolerance);
  double least = HUGE_VAL;
  *bound = HUGE_VAL;
  for (int i = -240; i <= 240; i++) {
    const double rho = 1 + exp2(i / 8.0),
                 truncated = log_truncated(growth, divided, low, high, rho);
    const double degree = fmax(ceil((truncated - wanted) / log(rho)), 0);
    if (!(truncated < HUGE_VAL && degree < least)) continue;
    least = degree;
    *bound = exp(truncated - degree * log(rho));
  }
  return least < HUGE_VAL ? (int)fmin(least, INT_MAX) : -1;
}

/* Return cos(i pi/(2 points)) by its values in the first quadrant. */
static double cosine_at(const double *cosine, long i, long points)
{
  const long turned = i % (4 * points), half = turned > 2 * points ? 4 * points - turned : turned;
  return half > points ? -cosine[2 * points - half] : cosine[half];
}

/* Compute the sums of f(s_j) cos(k phi_j) at s_j = low + (high - low) cos^2(phi_j/2),
 * phi_j = (2j+1) pi/(2m+2). */
void dvi__expansion_make(int degree, double low, double high,
                         double (*f)(const void *user, double s), const void *user, double *room,
                         double *c, int stride)
{
  const int points = degree + 1;
  double *cosine = room, *value = room + points + 1;
  for (int i = 0; i <= points; i++) cosine[i] = cos(i * pi / (2 * points));
  for (int j = 0; j < points; j++) {
    /* this formula keeps all digits near `low` */
    const double half = sin((2 * (points - j) - 1) * pi / (4 * points));
    value[j] = f(user, low + (high - low) * half * half);
  }
  for (int k = 0; k <= degree; k++) {
    double sum = 0, compensation = 0;
    for (int j = 0; j < points; j++)
      dvi__add_compensated(&sum, &compensation,
                           value[j] * cosine_at(cosine, (2 * (long)j + 1) * k, points));
    c[(long)k * stride] = sum * (k > 0 ? 2.0 : 1.0) / points;
  }
}
