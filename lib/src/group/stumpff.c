/* Stumpff's functions in three ranges of s = theta^2.
 *
 * Up to NEAR the two highest functions are summed by their series, which do not cancel. The others
 * follow by c_k = 1/k! - s c_{k+2}, which damps errors there. Beyond NEAR the first four are sines
 * and cosines of the half angle, so that c_2 keeps its relative accuracy at its zeros. The rest
 * still comes from the top up to FAR, and by the same recurrence upward beyond. Up to NEAR only
 * sums, products and quotients are used, so the digits are the same with every mathematical
 * library. */
#include "group/stumpff.h"

#include <math.h>
#include <string.h>

#include "group/chart_lanes.h"
#include "num/simd/wide.h"

#define NEAR 2.5 /* a quarter turn */
#define FAR 40.0 /* a full turn */

static const double inverse_factorial[] = {1 / 1.0,
                                           1 / 1.0,
                                           1 / 2.0,
                                           1 / 6.0,
                                           1 / 24.0,
                                           1 / 120.0,
                                           1 / 720.0,
                                           1 / 5040.0,
                                           1 / 40320.0,
                                           1 / 362880.0,
                                           1 / 3628800.0,
                                           1 / 39916800.0,
                                           1 / 479001600.0,
                                           1 / 6227020800.0,
                                           1 / 87178291200.0,
                                           1 / 1307674368000.0,
                                           1 / 20922789888000.0,
                                           1 / 355687428096000.0,
                                           1 / 6402373705728000.0,
                                           1 / 121645100408832000.0,
                                           1 / 2432902008176640000.0,
                                           1 / 51090942171709440000.0,
                                           1 / 1124000727777607680000.0,
                                           1 / 25852016738884976640000.0,
                                           1 / 620448401733239439360000.0,
                                           1 / 15511210043330985984000000.0,
                                           1 / 403291461126605635584000000.0,
                                           1 / 10888869450418352160768000000.0,
                                           1 / 304888344611713860501504000000.0,
                                           1 / 8841761993739701954543616000000.0,
                                           1 / 265252859812191058636308480000000.0,
                                           1 / 8222838654177922817725562880000000.0,
                                           1 / 263130836933693530167218012160000000.0,
                                           1 / 8683317618811886495518194401280000000.0,
                                           1 / 295232799039604140847618609643520000000.0,
                                           1 / 10333147966386144929666651337523200000000.0,
                                           1 / 371993326789901217467999448150835200000000.0,
                                           1 / 13763753091226345046315979581580902400000000.0,
                                           1 / 523022617466601111760007224100074291200000000.0};

/* Sum (-s)^j / (2j+k)! over j < 2 pairs, even and odd powers side by side. */
static inline double sum_stumpff_series(int k, int pairs, double s)
{
  const double square = s * s;
  double even = 0, odd = 0;
  for (int j = 4 * (pairs - 1) + k; j >= k; j -= 4) {
    even = inverse_factorial[j] + square * even;
    odd = inverse_factorial[j + 2] + square * odd;
  }
  return even - s * odd;
}

/* Compute c[to], .., c[from] from the functions above them. */
static inline void recur_down(double s, int from, int to, double *c)
{
  for (int k = from; k >= to; k--) c[k] = inverse_factorial[k] - s * c[k + 2];
}

static inline void recur_up(double s, int from, int to, double *c)
{
  for (int k = from; k <= to; k++) c[k] = (inverse_factorial[k - 2] - c[k - 2]) / s;
}

/* Compute c_0, .., c_3 by sine and cosine of theta/2. */
static void functions_by_angle(double s, double *c)
{
  const double theta = sqrt(s), sine = sin(theta / 2), cosine = cos(theta / 2),
               ratio = sine / theta;
  c[0] = (cosine - sine) * (cosine + sine);
  c[1] = 2 * ratio * cosine;
  c[2] = 2 * ratio * ratio;
  c[3] = (1 - c[1]) / s;
}

void dvi__stumpff_four(double s, double c[4])
{
  if (s <= NEAR) {
    c[3] = sum_stumpff_series(3, 6, s); /* the first term left out is below 1e-18 of the sum */
    c[2] = sum_stumpff_series(2, 6, s);
    recur_down(s, 1, 0, c);
  } else if (isinf(s)) {
    c[0] = 1;
    c[1] = c[2] = c[3] = 0;
  } else {
    functions_by_angle(s, c);
  }
}

void dvi__stumpff_six(double s, double c[6])
{
  if (s <= NEAR) {
    c[5] = sum_stumpff_series(5, 5, s); /* the first term left out is below 1e-17 of the sum */
    c[4] = sum_stumpff_series(4, 5, s);
    recur_down(s, 3, 0, c);
  } else {
    double all[9];
    dvi__stumpff(s, all);
    memcpy(c, all, 6 * sizeof *c);
  }
}

void dvi__stumpff(double s, double c[9])
{
  dvi__stumpff_four(s, c);
  if (s <= FAR) {
    const int pairs = s <= NEAR ? 5 : 8; /* the first term left out is below 1e-16 of the sum */
    c[8] = sum_stumpff_series(8, pairs, s);
    c[7] = sum_stumpff_series(7, pairs, s);
    recur_down(s, 6, 4, c);
  } else {
    recur_up(s, 4, 8, c);
  }
}

/* ---- several arguments ---- */

typedef dvi__lane lane;

/* The operations are those of sum_stumpff_series. */
INLINE void sum_series_of(int k, int pairs, const lane *s, lane *sum)
{
  const lane square = *s * *s;
  lane even = {0}, odd = {0};
  for (int j = 4 * (pairs - 1) + k; j >= k; j -= 4) {
    even = inverse_factorial[j] + square * even;
    odd = inverse_factorial[j + 2] + square * odd;
  }
  *sum = even - *s * odd;
}

WIDE static void six_near(const double *s, double *functions)
{
  lane x, c[6];
  load_rows(1, s, 0, DVI__LANES, &x);
  sum_series_of(5, 5, &x, &c[5]);
  sum_series_of(4, 5, &x, &c[4]);
  for (int k = 3; k >= 0; k--) c[k] = inverse_factorial[k] - x * c[k + 2];
  store_rows(6, c, DVI__LANES, DVI__LANES, functions);
}

WIDE static void four_near(const double *s, double *functions)
{
  lane x, c[4];
  load_rows(1, s, 0, DVI__LANES, &x);
  sum_series_of(3, 6, &x, &c[3]);
  sum_series_of(2, 6, &x, &c[2]);
  for (int k = 1; k >= 0; k--) c[k] = inverse_factorial[k] - x * c[k + 2];
  store_rows(4, c, DVI__LANES, DVI__LANES, functions);
}

void dvi__stumpff_four_of(const double s[DVI__STUMPFF_LANES], double c[4][DVI__STUMPFF_LANES])
{
  four_near(s, c[0]);
  for (int k = 0; k < DVI__STUMPFF_LANES; k++)
    if (!(s[k] <= NEAR)) {
      double one[4];
      dvi__stumpff_four(s[k], one);
      for (int i = 0; i < 4; i++) c[i][k] = one[i];
    }
}

void dvi__stumpff_six_of(const double s[DVI__STUMPFF_LANES], double c[6][DVI__STUMPFF_LANES])
{
  six_near(s, c[0]);
  for (int k = 0; k < DVI__STUMPFF_LANES; k++)
    if (!(s[k] <= NEAR)) {
      double one[6];
      dvi__stumpff_six(s[k], one);
      for (int i = 0; i < 6; i++) c[i][k] = one[i];
    }
}
