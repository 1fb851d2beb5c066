/* Stumpff's functions. The exponential and its derivatives on every group here are made of them. */
#ifndef DVI_GROUP_STUMPFF_H
#define DVI_GROUP_STUMPFF_H

/* Compute c[k] = c_k(s) = sum_j (-s)^j / (2j+k)!, s >= 0. With s = theta^2
 *
 *     c_0 = cos theta,                      c_1 = sin theta / theta,
 *     c_2 = (1 - cos theta) / theta^2,      c_3 = (theta - sin theta) / theta^3,   ...
 *
 * They are entire functions of s, so small angles are no special case. Their derivatives are d c_k
 * / ds = (k c_{k+2} - c_{k+1}) / 2. For s up to (4 pi)^2 the results are right to 4 ulp. The
 * functions c_0, c_1 and c_2 have zeros, and their errors are measured by the bounds 1, 1/theta and
 * 4/s of their oscillations. If s has overflowed then c_0 is 1 and the others are 0. Source:
 * Stiefel and Scheifele 1971, sec. 11. */
void dvi__stumpff(double s, double c[9]);

/* Compute the first four alone, with the same digits. */
void dvi__stumpff_four(double s, double c[4]);

/* Compute the first six alone. Up to a quarter turn their last digits are those of a shorter
 * recurrence. */
void dvi__stumpff_six(double s, double c[6]);

/* Compute the first four, or six, of several arguments side by side, with the same digits. */
enum { DVI__STUMPFF_LANES = 4 };
void dvi__stumpff_four_of(const double s[DVI__STUMPFF_LANES], double c[4][DVI__STUMPFF_LANES]);
void dvi__stumpff_six_of(const double s[DVI__STUMPFF_LANES], double c[6][DVI__STUMPFF_LANES]);

#endif
