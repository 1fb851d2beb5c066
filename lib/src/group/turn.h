/* Turning points and momenta of groups and spheres. The rotation is orthogonal, and what it turns
 * is turned with its carry, to twice the digits: a million turns, even by the same rotation, change
 * no length and no momentum in space by more than the last rounding. */
#ifndef DVI_GROUP_TURN_H
#define DVI_GROUP_TURN_H
#include <float.h>

#include "num/compensated.h"

/* F = I + s (w^ + w^^2), s = 2/(1 + |w|^2): the rotation by 2 atan|w| about w. Any w is that of a
 * rotation; s, which makes it one, has twice the digits: s is a float, lest s_low be lost in the
 * rounding of what s gives. */
typedef struct dvi__turn {
  double w[3], s, s_low;
} dvi__turn;

dvi__turn dvi__turn_of(const double w[3]);

/* F^T */
dvi__turn dvi__turn_back(const dvi__turn *turn);

/* w of the rotation exp(f^); both may be one array. */
void dvi__turn_tangent(const double f[3], double w[3]);

/* x^T (F - I): what a row of R, or a body momentum, changes by when R becomes R F. */
void dvi__turn_change(const dvi__turn *turn, const double x[3], double change[3]);

/* Rows x^T <- x^T F with their carries; [count] numbers, by threes; 2 are a vector in the plane of
 * the first axes. */
void dvi__turn_rows(const dvi__turn *turn, int count, double *x, double *carry);

/* Of a direction y [3] and its momentum p [3], all with carries: the angular momentum mu = y x p /
 * |y|^2. */
void dvi__turn_angular(const double *y, const double *y_compensation, const double *p,
                       const double *p_compensation, dvi__twofold mu[3]);

/* And p = mu x y of a mu that is at a right angle to y, but for rounding: y is moved to be so, up
 * to this angle, not mu, which is conserved. Beyond the angle the rounding is that of a small mu,
 * to which something was added. */
#define DVI__TURN_ROUNDINGS (64 * DBL_EPSILON)
#define DVI__TURN_ANY 1.0
void dvi__turn_momentum(const dvi__twofold mu[3], double most, double *y, double *y_compensation,
                        double *p, double *p_compensation);

#endif
