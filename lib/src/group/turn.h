/* Rotation of points and momenta of groups and spheres. The rotation is orthogonal, and vectors are
 * turned with their compensation, to twice the digits. A million turns, even by the same rotation,
 * change no length and no momentum in space by more than the last rounding. */
#ifndef DVI_GROUP_TURN_H
#define DVI_GROUP_TURN_H
#include <float.h>

#include "num/compensated.h"

/* The rotation F = I + s (w^ + w^^2) by 2 atan|w| about w, s = 2/(1 + |w|^2). Any w belongs to a
 * rotation. s makes F orthogonal and has twice the digits. s is rounded to a float, lest s_low be
 * lost in the rounding of products with s. */
typedef struct dvi__turn {
  double w[3], s, s_low;
} dvi__turn;

dvi__turn dvi__turn_of(const double w[3]);

/* Reverse a rotation to F^T. */
dvi__turn dvi__turn_back(const dvi__turn *turn);

/* Compute w of the rotation exp(f^). Both may be one array. */
void dvi__turn_tangent(const double f[3], double w[3]);

/* Compute x^T (F - I), the change of a row of R, or of a body momentum, when R becomes R F. */
void dvi__turn_change(const dvi__turn *turn, const double x[3], double change[3]);

/* Turn rows x^T <- x^T F with their compensations. The numbers [count] are taken by threes. Two
 * numbers are a vector in the plane of the first axes. */
void dvi__turn_rows(const dvi__turn *turn, int count, double *x, double *compensation);

/* Compute the angular momentum mu = y x p / |y|^2 of a direction y [3] with the momentum p [3], all
 * compensated. */
void dvi__turn_angular(const double *y, const double *y_compensation, const double *p,
                       const double *p_compensation, dvi__twofold mu[3]);

/* Compute p = mu x y for mu orthogonal to y but for rounding. y is moved to be orthogonal, up to
 * the angle `most`. mu stays as it is, because mu is conserved. Beyond this angle the error is the
 * rounding of a small mu to which something was added. */
#define DVI__TURN_ROUNDINGS (64 * DBL_EPSILON)
#define DVI__TURN_ANY 1.0
void dvi__turn_momentum(const dvi__twofold mu[3], double most, double *y, double *y_compensation,
                        double *p, double *p_compensation);

#endif
