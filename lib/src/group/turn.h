/* Moving a point of a group or a sphere by increments whose defect is known to the square of the rounding, into compensated sums: a thousand steps of the same
 * rotation leave the group by no more than a thousand of different ones. */
#ifndef DVI_GROUP_TURN_H
#define DVI_GROUP_TURN_H

/* F = I + s (w^ + w^^2), s = 2/(1 + |w|^2): the rotation by 2 atan|w| about w. Any w is that of a rotation; s, which makes it one, has twice the digits: s is a
 * float, lest s_low be lost in the rounding of what s gives. */
typedef struct dvi__turn {
  double w[3], s, s_low;
} dvi__turn;

dvi__turn dvi__turn_of(const double w[3]);

/* F^T */
dvi__turn dvi__turn_back(const dvi__turn *turn);

/* w of the rotation exp(f^), |f| below half a turn; both may be one array. */
void dvi__turn_tangent(const double f[3], double w[3]);

/* x^T (F - I): what a row of R, or a body momentum, changes by when R becomes R F. */
void dvi__turn_change(const dvi__turn *turn, const double x[3], double change[3]);

/* R [9] <- R F with its carries. */
void dvi__turn_frame(const dvi__turn *turn, double *R, double *carry);

/* What y [count] changes by when it becomes (1 + d) y + u, for a unit vector y and u orthogonal to it of length sin(a), d = cos(a) - 1. change [count] may be u. */
void dvi__swing(int count, double d, const double *u, const double *y, double *change);

/* cos(a) - 1 for |u| = sin(a), up to a quarter turn. */
double dvi__swing_cosine(int count, const double *u);

/* The momentum p of a direction that has changed to y with the angular momentum mu kept. */
void dvi__swing_momentum(const double mu[3], const double change[3], const double y[3], double p[3]);

#endif
